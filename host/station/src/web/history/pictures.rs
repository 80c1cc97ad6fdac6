//! Pictures of frames that a run failed with. They are made from the evidence when somebody looks, so no verdict waits
//! for them.

use axum::extract::{Path, State};
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse as _, Response};
use halfrow::frames::{self, ReadOptions};
use halfrow::model::{BitDepth, Frame};
use halfrow::report::pictures;
use halfrow::result::{FrameReport, MissingRows};
use maud::{Markup, html};
use serde::Deserialize as _;
use serde_json::Value;

use super::evidence::{Whereabouts, attached, read};
use super::show;
use crate::history::runs::RunLine;
use crate::history::unit::{self, UnitRun};
use crate::lane::kept_frame::{KeptFrame, View};
use crate::record::{Attachment, Record};
use crate::store::Snapshot;
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// The widest preview, in pixels.
const WIDTH: usize = 960;

/// A frame of the evidence, developed for the screen.
pub(super) async fn preview(
    State(app): State<App>,
    visit: Visit,
    Path((run, hash)): Path<(String, String)>,
) -> Result<Response, Trouble> {
    let frame = attached(&app, &visit, run, hash).await?;
    let picture = app.blocking(&visit, move || pictures::developed(&decoded(&frame)?, WIDTH).ok()).await?;
    picture.map(answer).ok_or_else(|| Trouble::missing(&visit))
}

/// Where two frames of the evidence differ.
pub(super) async fn difference(
    State(app): State<App>,
    visit: Visit,
    Path((run, found, expected)): Path<(String, String, String)>,
) -> Result<Response, Trouble> {
    let look = move |now: &Snapshot| {
        let Some(UnitRun { line, attachments, .. }) = unit::run_of(now, &run)? else { return Ok(None) };
        let [found, expected] = [&found, &expected].map(|hash| read(now, &attachments, hash));
        let record = line.record_sha256.and_then(|hash| now.record(&hash).ok());
        Ok(found?.zip(expected?).map(|frames| (frames, record)))
    };
    let looked = app.look(&visit, look).await?.ok_or_else(|| Trouble::missing(&visit))?;
    let made = move || {
        let ((found, expected), record) = looked;
        let missing = record.and_then(|(record, _)| missing(&record, &found.1)).unwrap_or_default();
        let (found, expected) = (decoded(&found)?, decoded(&expected)?);
        pictures::differences(&expected, &found, &missing).ok()
    };
    let picture = app.blocking(&visit, made).await?;
    picture.map(answer).ok_or_else(|| Trouble::missing(&visit))
}

/// The rows that did not come back of the frame that an attachment holds.
fn missing(record: &Record, attachment: &Attachment) -> Option<MissingRows> {
    let (frame, _) = KeptFrame::of(&attachment.name)?;
    FrameReport::deserialize(of_frame(record, &frame)?).ok().map(|frame| frame.missing)
}

/// The frame that an attachment is, if it is one.
fn decoded((bytes, attachment): &(Vec<u8>, Attachment)) -> Option<Frame> {
    let (KeptFrame { depth, phase, .. }, _) = KeptFrame::of(&attachment.name)?;
    // A broken board may have returned samples that exceed the depth.
    [depth, BitDepth::Twelve]
        .into_iter()
        .find_map(|depth| frames::decode(bytes, &ReadOptions { depth, phase, ..ReadOptions::default() }).ok())
}

fn answer(picture: Vec<u8>) -> Response {
    ([(CONTENT_TYPE, "image/png")], picture).into_response()
}

/// The frames that were kept of a run, each as it went in, as it came out, as it should have come out, and where it differs.
pub(super) fn of_run(
    visit: &Visit,
    run: &RunLine,
    record: Option<&Record>,
    kept: &[(Attachment, Whereabouts)],
) -> Markup {
    let here = || kept.iter().filter(|(_, place)| *place == Whereabouts::Here).map(|(one, _)| one);
    let hash = |frame: &KeptFrame, view| {
        let name = frame.name(view);
        here().find(|one| one.name == name).map(|one| one.sha256.as_str())
    };
    let frames = here().filter_map(|one| KeptFrame::of(&one.name)).filter(|(_, view)| *view == View::In);
    html! {
        @for (frame, _) in frames {
            @if let [Some(input), Some(found), Some(expected)] = KeptFrame::VIEWS.map(|view| hash(&frame, view)) {
                (section(visit, run, (&frame, record), [input, found, expected]))
            }
        }
    }
}

fn section(
    visit: &Visit,
    run: &RunLine,
    (frame, record): (&KeptFrame, Option<&Record>),
    [input, found, expected]: [&str; 3],
) -> Markup {
    let address = show::run_address(&run.id);
    let preview = |hash: &str| format!("{address}/preview/{hash}");
    let all = [
        (preview(input), visit.say("pictures.input")),
        (preview(found), visit.say("pictures.found")),
        (preview(expected), visit.say("pictures.expected")),
        (format!("{address}/difference/{found}/{expected}"), visit.say("pictures.difference")),
    ];
    let known = record.and_then(|record| of_frame(record, frame));
    html! {
        section.pictures {
            h2 {
                (visit.say("pictures.title"))
                @if let Some(name) = known.and_then(|known| known.get("name")?.as_str()) { " " (show::said(name)) }
            }
            @if let Some(said) = known.and_then(|known| counted(visit, known)) { p.soft { (said) } }
            div.four {
                @for (address, caption) in all {
                    figure {
                        a href=(address) { img src=(address) alt=(caption) loading="lazy"; }
                        figcaption { (caption) }
                    }
                }
            }
            @if let Some(known) = known { (legend(visit, known)) }
        }
    }
}

/// What the colours of the last picture mean.
fn legend(visit: &Visit, known: &Value) -> Markup {
    let Ok(frame) = FrameReport::deserialize(known) else { return Markup::default() };
    let squares = match pictures::side(samples(&frame)) {
        1 => visit.say("pictures.samples").to_owned(),
        side => visit.words.fill("pictures.squares", &[("side", &side.to_string())]),
    };
    html! {
        p.soft {
            (visit.say("pictures.difference")) (visit.say("told.colon")) (squares)
            @for step in pictures::steps_up_to(frame.comparison.largest) {
                (key(step.colour, &visit.words.fill("pictures.from_on", &[("from", &step.from.to_string())])))
            }
            @if !frame.missing.is_empty() { (key(pictures::MISSING, visit.say("pictures.missing"))) }
        }
    }
}

/// What a colour means.
fn key([red, green, blue]: [u8; 3], meaning: &str) -> Markup {
    html! {
        " " span.key {
            svg viewBox="0 0 1 1" aria-hidden="true" { rect width="1" height="1" fill=(format!("rgb({red} {green} {blue})")) {} }
            " " (meaning)
        }
    }
}

/// The samples of a frame, whether they came back or not.
fn samples(frame: &FrameReport) -> usize {
    let width = frame.comparison.samples.checked_div(frame.rows).unwrap_or_default();
    width * frame.height()
}

/// What the report says of a frame.
fn of_frame<'a>(record: &'a Record, frame: &KeptFrame) -> Option<&'a Value> {
    let step = record.steps.iter().find(|step| (step.seq, step.attempt) == (frame.seq, frame.attempt))?;
    step.evidence.as_ref()?.get("frames")?.get(frame.index)
}

/// How many samples differ, and the first of them.
fn counted(visit: &Visit, known: &Value) -> Option<String> {
    let comparison = known.get("comparison")?;
    let number = |of: &Value, key: &str| Some(visit.words.count(of.get(key)?.as_u64()?));
    let first = comparison.get("first")?;
    let [differing, samples] = ["differences", "samples"].map(|key| number(comparison, key));
    let [row, column, expected, found] = ["row", "column", "expected", "found"].map(|key| number(first, key));
    let (differing, samples, row, column, expected, found) =
        (differing?, samples?, row?, column?, expected?, found?);
    let values = [
        ("differing", differing.as_str()),
        ("samples", &samples),
        ("row", &row),
        ("column", &column),
        ("expected", &expected),
        ("found", &found),
    ];
    Some(visit.words.fill("pictures.differing", &values))
}

#[cfg(test)]
mod tests {
    use halfrow::compare::Comparison;
    use halfrow::model::Phase;
    use halfrow::result::FrameTiming;

    use super::*;

    #[test]
    fn rows_that_did_not_come_back_belong_to_the_frame_too() {
        let mut comparison = Comparison::new(256, 72);
        (0..4).for_each(|row| comparison.row(row, &[0; 256], &[1; 256]));
        let mut frame = FrameReport {
            name: String::new(),
            number: 0,
            sha256: String::new(),
            phase: Phase::default(),
            generation: 2,
            timing: FrameTiming::LeastBlanking { clocks: 0 },
            variation: None,
            comparison,
            first_rows: None,
            rows: 4,
            missing: MissingRows::of(&[true; 4]),
            seconds: 0.0,
        };
        assert_eq!(samples(&frame), 256 * 72);
        // Of a frame that came back whole, the counts need not be kept.
        let whole = Comparison { samples: 256 * 72, ..Comparison::new(0, 0) };
        (frame.rows, frame.comparison) = (72, whole);
        assert_eq!(samples(&frame), 256 * 72);
    }
}
