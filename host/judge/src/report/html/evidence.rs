//! The sections with pictures: how a frame went in, what came out, and where it is wrong.

use std::borrow::Cow;

use halfrow_model::Frame;
use maud::{Markup, html};
use png::EncodingError;

use super::charts;
use super::facts::{mark, pair};
use crate::report::pictures::{self, Picture, Window};
use crate::report::wording;
use crate::result::{Evidence, FrameReport, Report, little_endian, sha256};
use crate::verdict::Verdict;
use crate::words::{count, grouped, percent};

/// Bytes of all sections together, for a PASS and for anything else. They leave a quarter of a megabyte of 2 and 4 MB for the
/// rest of the page.
const MOST_BYTES: (usize, usize) = (1_750_000, 3_750_000);
/// Bytes of all maps, charts and crops together. They leave 27 kB for the previews of each of sixteen frames.
const MOST_OF_DETAILS: usize = MOST_BYTES.1 - 16 * 27_000;
/// Bytes of a section without its pictures and its details.
const TEXT: usize = 1200;
/// The widest preview of a wrong frame and of a right one, in pixels.
const MAX_WIDTH: (usize, usize) = (960, 480);
/// The most frames that have a section.
const MOST_SECTIONS: usize = 400;
/// The most windows of a frame that are shown sample by sample.
const MOST_WINDOWS: usize = 3;
/// The width in pixels from which on an enlarged picture is smoothed: below, samples would only look blurred.
const SMOOTHED: usize = 240;
/// The heights of the tallest preview and map, and the width of the bars beside a map, in rem.
const PREVIEW_REM: f64 = 30.0;
const MAP_REM: f64 = 45.0;
const BARS_REM: f64 = 6.25;
/// The side of a sample in these windows, in screen pixels.
const ZOOM: usize = 8;

/// The samples that were kept of a frame, and the report on it.
type FrameEvidence<'a> = (&'a Evidence, &'a FrameReport);

/// A section for each frame of `evidence`, as far as there is room. Frames that differ come first, and the first ones of these
/// have maps and crops.
///
/// # Errors
/// The PNG encoder's.
pub(super) fn sections(report: &Report, evidence: &[Evidence]) -> Result<Markup, EncodingError> {
    let known: Vec<_> =
        evidence.iter().filter_map(|kept| Some((kept, report.frames.get(kept.index)?))).collect();
    let (shown, left_out) = shown(known);
    let most_bytes = if report.verdict() == Verdict::Pass { MOST_BYTES.0 } else { MOST_BYTES.1 };
    let (mut details, used) = all_details(&shown)?;
    let mut left = most_bytes.saturating_sub(used);
    let not_kept = report.evidence.left_out;
    let mut sections = Vec::with_capacity(shown.len());
    for (place, kept) in shown.iter().enumerate() {
        let share = left / (shown.len() - place);
        let none = || html! { p { "Map and crops: left out to keep the page small." } };
        let details = if differs(kept) { details.next().unwrap_or_else(none) } else { Markup::default() };
        let section = section(report, kept, &details, in_base64(share.saturating_sub(TEXT)))?;
        left = left.saturating_sub(length(&section) - length(&details));
        sections.push(section);
    }
    Ok(html! {
        @for section in sections { (section) }
        @if left_out > 0 { section { p { "And " (count(left_out, "more frame")) " that were kept." } } }
        @if not_kept > 0 { section { p { "And " (count(not_kept, "more frame")) " for which there was no room in memory." } } }
    })
}

fn length(markup: &Markup) -> usize {
    markup.0.len()
}

/// How many bytes take `length` bytes in Base64.
const fn in_base64(length: usize) -> usize {
    length / 4 * 3
}

/// The frames that get a section, and how many do not.
fn shown(mut known: Vec<FrameEvidence<'_>>) -> (Vec<FrameEvidence<'_>>, usize) {
    let all = known.len();
    let wrong = known.iter().filter(|kept| differs(kept)).count();
    let (mut room, mut room_of_equal) = (MOST_SECTIONS, MOST_SECTIONS.saturating_sub(wrong));
    known.retain(|kept| {
        let room = if differs(kept) { &mut room } else { &mut room_of_equal };
        let has_room = *room > 0;
        *room -= usize::from(has_room);
        has_room
    });
    known.sort_by_key(|kept| !differs(kept));
    let left_out = all - known.len();
    (known, left_out)
}

fn differs((_, frame): &FrameEvidence<'_>) -> bool {
    frame.comparison.differences > 0
}

/// The maps and crops of the first frames that differ, and their bytes.
fn all_details(shown: &[FrameEvidence<'_>]) -> Result<(impl Iterator<Item = Markup>, usize), EncodingError> {
    let (mut all, mut used) = (Vec::new(), 0);
    let most = MOST_OF_DETAILS.saturating_sub(shown.len() * TEXT);
    for (kept, _) in shown.iter().filter(|kept| differs(kept)) {
        let details = details(kept)?;
        if used + length(&details) > most {
            break;
        }
        used += length(&details);
        all.push(details);
    }
    Ok((all.into_iter(), used))
}

/// One frame's section with at most `most_bytes` of previews.
fn section(
    report: &Report,
    shown: &FrameEvidence<'_>,
    details: &Markup,
    most_bytes: usize,
) -> Result<Markup, EncodingError> {
    let (kept, frame) = shown;
    let width = if differs(shown) { MAX_WIDTH.0 } else { MAX_WIDTH.1 };
    let input = pictures::preview(&kept.input, width, most_bytes / 2)?;
    let left = most_bytes - input.as_ref().map_or(0, Picture::len);
    let found = pictures::preview(&as_bright(kept), width, left)?;
    Ok(html! {
        section.frame {
            h2 {
                (mark(wording::frame_outcome(report, frame)))
                " Frame " (frame.number) ": " (wording::frame_name(frame))
            }
            (summary(frame, kept))
            div.previews {
                (preview(input.as_ref(), "Input (rendered for viewing)"))
                (preview(found.as_ref(), &came_out(frame)))
            }
            (details)
        }
    })
}

/// The frame that came out, developed with the white level of the expected one; samples above its depth become white.
fn as_bright(kept: &Evidence) -> Cow<'_, Frame> {
    let Evidence { found, expected, .. } = kept;
    let white = expected.depth().max();
    let samples = || found.samples().iter().map(|&sample| sample.min(white)).collect();
    let clipped = (found.depth() != expected.depth())
        .then(|| Frame::new(expected.width(), expected.depth(), expected.phase(), samples()));
    clipped.and_then(Result::ok).map_or(Cow::Borrowed(found), Cow::Owned)
}

fn came_out(frame: &FrameReport) -> String {
    match frame.height() - frame.rows {
        0 => "Board output".to_owned(),
        missing => {
            let rows = count(missing, "row");
            format!("Board output; {rows} had not come back when the run ended, and are black")
        }
    }
}

fn summary(frame: &FrameReport, kept: &Evidence) -> Markup {
    let comparison = &frame.comparison;
    let share = percent(comparison.differences as f64 / comparison.samples.max(1) as f64);
    html! {
        dl {
            @if let (Some(first), Some((least, most))) = (comparison.first, comparison.extremes) {
                (pair("Differences", format!("{} of {} ({share})",
                    grouped(comparison.differences), count(comparison.samples, "sample"))))
                (pair("First", format!("row {}, column {}: expected {}, found {}",
                    first.row, first.column, first.expected, first.found)))
                (pair("Found − expected", format!("{least:+} to {most:+}")))
            } @else {
                (pair("Differences", format!("none in {}", count(comparison.samples, "sample"))))
            }
            (pair("Timing", frame.timing.to_string()))
            (pair("Phase", frame.phase.to_string()))
            (pair("Table generation", frame.generation.to_string()))
            (pair("SHA-256 of the samples that went in", &frame.sha256))
            @if kept.missing.is_empty() {
                (pair("SHA-256 of those that came out", sha256(kept.found.rows().map(little_endian))))
            }
        }
    }
}

fn preview(picture: Option<&Picture>, caption: &str) -> Markup {
    match picture {
        Some(picture) => figure(picture, 1, caption),
        None => html! { p { (caption) ": left out to keep the page small." } },
    }
}

/// The map, its charts and the crops.
fn details(kept: &Evidence) -> Result<Markup, EncodingError> {
    let map = pictures::difference_map(&kept.expected, &kept.found, &kept.missing)?;
    let mut crops = Vec::new();
    for window in pictures::windows(kept, MOST_WINDOWS) {
        crops.push(self::crops(window, kept)?);
    }
    // The report on the frame need not have the counts by row and column.
    let comparison = kept.compared();
    let side = pictures::side(kept.expected.samples().len());
    Ok(html! {
        h3 { "Where it differs" }
        div.map style=(no_taller(&map, MAP_REM, BARS_REM)) {
            img.samples src=(map.data_uri()) width=(map.width) height=(map.height) alt="Map of differences";
            (charts::by_row(&comparison.by_row, side))
            (charts::by_column(&comparison.by_column, side))
        }
        p.legend {
            @if side == 1 { "|found − expected| of each sample:" }
            @else { "Largest |found − expected| in each " (side) " × " (side) " samples:" }
            @for step in pictures::steps_up_to(comparison.largest) {
                (key(step.colour, &format!("from {}", step.from)))
            }
            @if !kept.missing.is_empty() { (key(pictures::MISSING, "did not come back")) }
            ". The bars count the differences by row and by column."
        }
        @for crop in crops { (crop) }
    })
}

/// A style that lets a picture be as wide as there is room, but at most `most` rem tall, with something `beside` it.
fn no_taller(picture: &Picture, most: f64, beside: f64) -> String {
    format!("max-width:min(100%,{:.1}rem)", most * picture.width as f64 / picture.height as f64 + beside)
}

/// What a colour of the map means.
fn key([red, green, blue]: [u8; 3], meaning: &str) -> Markup {
    html! {
        " " span.key { span.swatch style=(format!("background:rgb({red} {green} {blue})")) {} " " (meaning) }
    }
}

/// One window in all three frames.
fn crops(window: Window, kept: &Evidence) -> Result<Markup, EncodingError> {
    let crops = window.crops(kept)?;
    let Window { around, top, left, height, width } = window;
    let all = [
        (&crops.input, "Input"),
        (&crops.difference, "Difference, colours as in the map"),
        (&crops.expected, "Expected"),
        (&crops.found, "Found"),
    ];
    Ok(html! {
        h3 { "Around row " (around.row) ", column " (around.column) ": expected " (around.expected) ", found " (around.found) }
        p {
            "Rows " (top) " to " (top + height - 1) ", columns " (left) " to " (left + width - 1)
            ", raw samples; black is " (crops.range.0) ", white is " (crops.range.1) "."
        }
        div.crops { @for (picture, caption) in all { (figure(picture, ZOOM, caption)) } }
    })
}

fn figure(picture: &Picture, zoom: usize, caption: &str) -> Markup {
    let (width, height) = (picture.width * zoom, picture.height * zoom);
    html! {
        figure {
            img.samples[zoom > 1 || picture.width < SMOOTHED] src=(picture.data_uri()) width=(width) height=(height)
                style=(no_taller(picture, PREVIEW_REM, 0.0)) alt=(caption);
            figcaption { (caption) }
        }
    }
}
