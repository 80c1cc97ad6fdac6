//! The sections with pictures: how a frame went in, what came out, and where it is wrong.

use std::borrow::Cow;

use halfrow_model::Frame;
use maud::{Markup, html};
use png::EncodingError;

use super::charts;
use super::facts::{mark, pair};
use crate::report::pictures::{self, Picture, Window};
use crate::report::wording::{self, count, grouped};
use crate::result::{Evidence, FrameReport, Report, sha256};
use crate::verdict::Verdict;

/// Bytes of all pictures together, of a PASS and of anything else. Base 64 makes 1.5 and 3.4 MB of them, which leaves half a megabyte of
/// 2 and of 4 to text and charts.
const MOST_BYTES: (usize, usize) = (1_100_000, 2_550_000);
/// The widest preview of a frame that is wrong, and of one that is right, in pixels.
const MAX_WIDTH: (usize, usize) = (960, 480);
/// Bytes that the map and the crops of one frame stay under, even of noise.
const DETAIL_BYTES: usize = 150_000;
/// Windows of a frame that are shown sample by sample.
const MOST_WINDOWS: usize = 3;
/// Screen pixels to a sample there.
const ZOOM: usize = 8;

/// A section for each frame of `evidence`, in order.
///
/// # Errors
/// The PNG encoder's.
pub(super) fn sections(report: &Report, evidence: &[Evidence]) -> Result<Markup, EncodingError> {
    let known = evidence.iter().filter_map(|kept| Some((kept, report.frames.get(kept.index)?)));
    let known: Vec<_> = known.collect();
    let mut left = if report.verdict == Verdict::Pass { MOST_BYTES.0 } else { MOST_BYTES.1 };
    let mut sections = Vec::with_capacity(known.len());
    for (place, (kept, frame)) in known.iter().enumerate() {
        let share = left / (known.len() - place);
        let (section, used) = section(report, frame, kept, share)?;
        left = left.saturating_sub(used);
        sections.push(section);
    }
    Ok(html! { @for section in sections { (section) } })
}

/// One frame's section of at most `most_bytes` of pictures, and the bytes that it took.
fn section(
    report: &Report,
    frame: &FrameReport,
    kept: &Evidence,
    most_bytes: usize,
) -> Result<(Markup, usize), EncodingError> {
    let differs = frame.comparison.differences > 0;
    let (details, used) =
        if differs && most_bytes > DETAIL_BYTES { details(frame, kept)? } else { Default::default() };
    let left = most_bytes.saturating_sub(used);
    let width = if differs { MAX_WIDTH.0 } else { MAX_WIDTH.1 };
    let input = pictures::preview(&kept.input, width, left / 2)?;
    let found = pictures::preview(&as_bright(kept), width, left - input.as_ref().map_or(0, Picture::len))?;
    let used = used + [&input, &found].into_iter().flatten().map(Picture::len).sum::<usize>();
    let markup = html! {
        section.frame {
            h2 {
                (mark(wording::frame_outcome(report, frame)))
                " Frame " (frame.number) ": " (wording::frame_name(frame))
            }
            (summary(frame, kept))
            div.previews {
                (preview(input.as_ref(), "As it went in, developed for the screen"))
                (preview(found.as_ref(), &came_out(frame)))
            }
            (details)
        }
    };
    Ok((markup, used))
}

/// What came out, with the white of what should have; what lies beyond its depth is white.
fn as_bright(kept: &Evidence) -> Cow<'_, Frame> {
    let Evidence { found, expected, .. } = kept;
    let white = expected.depth().max();
    let samples = || found.samples().iter().map(|&sample| sample.min(white)).collect();
    let clipped = (found.depth() != expected.depth())
        .then(|| Frame::new(expected.width(), expected.depth(), expected.phase(), samples()));
    clipped.and_then(Result::ok).map_or(Cow::Borrowed(found), Cow::Owned)
}

fn came_out(frame: &FrameReport) -> String {
    match frame.comparison.by_row.len().saturating_sub(frame.rows) {
        0 => "As the board corrected it".to_owned(),
        missing => {
            format!("As the board corrected it; {} never came back and are black", count(missing, "row"))
        }
    }
}

fn summary(frame: &FrameReport, kept: &Evidence) -> Markup {
    let comparison = &frame.comparison;
    let share = wording::percent(comparison.differences as f64 / comparison.samples.max(1) as f64);
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
            (pair("SHA-256 of those that came out", sha256(kept.found.rows().map(little_endian))))
        }
    }
}

/// As the hash of what went in has them.
fn little_endian(samples: &[u16]) -> Vec<u8> {
    samples.iter().map(|sample| sample.to_le_bytes()).collect::<Vec<_>>().into_flattened()
}

fn preview(picture: Option<&Picture>, caption: &str) -> Markup {
    match picture {
        Some(picture) => figure(picture, 1, caption),
        None => html! { p { (caption) ": left out to keep the page small." } },
    }
}

/// The map, its charts and the crops, and the bytes of their pictures.
fn details(frame: &FrameReport, kept: &Evidence) -> Result<(Markup, usize), EncodingError> {
    let map = pictures::difference_map(&kept.expected, &kept.found)?;
    let mut used = map.len();
    let mut crops = Vec::new();
    for window in pictures::windows(&kept.expected, &kept.found, MOST_WINDOWS) {
        let (markup, bytes) = self::crops(window, kept)?;
        used += bytes;
        crops.push(markup);
    }
    let (rows, columns) = (&frame.comparison.by_row, &frame.comparison.by_column);
    let side = pictures::side(frame.comparison.samples);
    let markup = html! {
        h3 { "Where it differs" }
        div.map {
            img.samples src=(map.data_uri()) width=(map.width) height=(map.height) alt="Map of differences";
            (charts::by_row(rows, side))
            (charts::by_column(columns, side))
        }
        p.legend {
            @if side == 1 { "|found − expected| of each sample:" }
            @else { "Largest |found − expected| in each " (side) " × " (side) " samples:" }
            @for step in pictures::steps_up_to(frame.comparison.largest) {
                @let [red, green, blue] = step.colour;
                " " span.key {
                    span.swatch style=(format!("background:rgb({red} {green} {blue})")) {} " from " (step.from)
                }
            }
            ". The bars count the differences by row and by column."
        }
        @for crop in crops { (crop) }
    };
    Ok((markup, used))
}

/// One window of all three frames, and the bytes of its pictures.
fn crops(window: Window, kept: &Evidence) -> Result<(Markup, usize), EncodingError> {
    let crops = window.crops(kept)?;
    let Window { around, top, left, height, width } = window;
    let all = [
        (&crops.input, "Input"),
        (&crops.difference, "Difference, colours as in the map"),
        (&crops.expected, "Expected"),
        (&crops.found, "Found"),
    ];
    let markup = html! {
        h3 { "Around row " (around.row) ", column " (around.column) ": expected " (around.expected) ", found " (around.found) }
        p {
            "Rows " (top) " to " (top + height - 1) ", columns " (left) " to " (left + width - 1)
            ", raw samples; black is " (crops.range.0) ", white is " (crops.range.1) "."
        }
        div.crops { @for (picture, caption) in all { (figure(picture, ZOOM, caption)) } }
    };
    Ok((markup, all.iter().map(|(picture, _)| picture.len()).sum()))
}

fn figure(picture: &Picture, zoom: usize, caption: &str) -> Markup {
    let (width, height) = (picture.width * zoom, picture.height * zoom);
    html! {
        figure {
            img.samples[zoom > 1] src=(picture.data_uri()) width=(width) height=(height) alt=(caption);
            figcaption { (caption) }
        }
    }
}
