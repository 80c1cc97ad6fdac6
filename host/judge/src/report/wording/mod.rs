//! The words of a report. All views share them, here and in programs, so that they say the same.

mod coverage;
mod summary;
mod within;

use std::borrow::Cow;

use crate::board::MAX_LATENCY;
use crate::result::wording::named_clock;
use crate::result::{
    Account, BoardKind, BoardReport, EqualAtSpeed, Finding, FrameReport, FrameTotals, LatencyReport,
    LinkReport, NotExercised, Outcome, Reconnection, Report, SoakDifference, SoakLength, SoakReport,
    StreetReport, Suspect,
};
use crate::verdict::{Cause, Verdict};
use crate::words::{board_name, bytes, count, grouped, percent, plain, span, verb};

pub use coverage::coverage;
pub(super) use summary::{advice, lacks};
pub use summary::{bench_then_next, codes, of_suspect, summary, what_to_do};
pub use within::within;

/// The word for a check's outcome. Those that call for action are in capitals.
#[must_use]
pub const fn mark(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "ok",
        Outcome::Failed => "FAIL",
        Outcome::Error => "ERROR",
        Outcome::Skipped => "skipped",
    }
}

/// The words for a board's kind.
#[must_use]
pub const fn kind(kind: BoardKind) -> &'static str {
    match kind {
        BoardKind::Mock => "mock board",
        BoardKind::Sim => "simulated board",
        BoardKind::Replay => "recording",
        BoardKind::Hardware => "hardware",
    }
}

/// What is said of a board that never told what it is.
pub const UNIDENTIFIED: &str = "it did not identify itself";

/// The words for what was judged, or for something that never told what it is, which need not be a board.
#[must_use]
pub const fn kind_of(board: &BoardReport) -> &'static str {
    match (board.kind, &board.identity) {
        (BoardKind::Hardware, None) => "unknown board",
        (other, _) => kind(other),
    }
}

/// The words for why a run ended as it did.
#[must_use]
pub const fn cause(cause: Cause) -> &'static str {
    match cause {
        Cause::Equal => "all equal",
        Cause::Different => "the board is wrong",
        Cause::Station => "the link, this computer or its settings",
        Cause::Busy => "another host is using the board",
        Cause::Refused => "the board's identity, datapath or protocol version was refused",
        Cause::NothingJudged => "nothing was judged",
        Cause::Stopped(_) => "the run was stopped",
    }
}

/// What kind of board a result is for; unless it is hardware, it says that no hardware was tested.
#[must_use]
pub fn remark(board: &BoardReport) -> String {
    match (board.kind, &board.identity) {
        (BoardKind::Hardware, Some(identity)) => {
            format!("hardware {}, serial {}", board_name(&identity.name), plain(&identity.serial))
        }
        (BoardKind::Hardware, None) => kind_of(board).to_owned(),
        (other, _) => format!("{}: no hardware was tested", kind(other)),
    }
}

/// The verdict in one line, for people and for `tail -1`.
#[must_use]
pub fn verdict_line(report: &Report) -> String {
    match report.verdict() {
        Verdict::Pass => format!("PASS ({})  {}", remark(&report.board), facts(report)),
        verdict => format!("{verdict}: {}", plain(&report.headline())),
    }
}

/// What to do, unless a suspect or the headline already says it.
#[must_use]
pub fn remedy(report: &Report) -> Option<String> {
    let headline = report.headline();
    let said = |remedy: &String| report.suspects.iter().any(|suspect| suspect.designer() == *remedy);
    report.remedy().filter(|remedy| !said(remedy) && !says(&headline, remedy))
}

/// What a technician should do, where no suspect says it.
#[must_use]
pub fn technician(report: &Report) -> Option<String> {
    report.technician().filter(|_| report.suspects.is_empty())
}

/// Whether a headline already contains a remedy.
#[must_use]
pub fn says(headline: &str, remedy: &str) -> bool {
    headline.to_lowercase().contains(remedy.trim_end_matches('.').to_lowercase().as_str())
}

/// A frame's name, followed by its tables and settings if they are not those to judge with, and by the number of rows that
/// were streamed if not all were.
#[must_use]
pub fn frame_name(frame: &FrameReport) -> Cow<'_, str> {
    let mut name = plain(&frame.name);
    if frame.is_decoy() {
        name = format!("{name}, decoy tables").into();
    }
    if let Some(variation) = frame.variation {
        name = format!("{name}, {variation}").into();
    }
    match frame.first_rows {
        None => name,
        Some(1) => format!("{name}, row 0").into(),
        Some(rows) => format!("{name}, {rows} rows").into(),
    }
}

/// What a PASS does not cover, in one sentence without a full stop; none where nothing of the kind is known.
#[must_use]
pub fn not_exercised(report: &Report) -> Option<String> {
    let words: Vec<_> = report.not_exercised.iter().map(NotExercised::words).collect();
    (!words.is_empty()).then(|| format!("not exercised: {}", words.join("; ")))
}

/// What was judged, in figures.
#[must_use]
pub fn facts(report: &Report) -> String {
    let FrameTotals { frames, samples, differences, .. } = FrameTotals::of(&report.frames);
    let samples = match differences {
        _ if samples == 0 => "nothing judged".to_owned(),
        0 => format!("{} equal", count(samples, "sample")),
        _ => format!("{} of {} different", grouped(differences), count(samples, "sample")),
    };
    format!("{}, {samples}, {}", count(frames, "frame"), further_facts(report))
}

/// What stands below the headline of a FAIL or an ERROR: the same, without what the headline says of frames and samples.
pub(super) fn facts_below(report: &Report) -> String {
    match report.finding {
        Finding::SamplesDiffer { tried: None, .. } => further_facts(report),
        _ => facts(report),
    }
}

/// The figures beside how many frames and samples were judged.
fn further_facts(report: &Report) -> String {
    let latency = report.latency.map(|latency| format!("latency {}", measured(&latency)));
    let further = [latency, at_speed(report), report.within.as_ref().map(within::left_out)];
    let seconds = format!("{:.1} s", report.run.seconds);
    further.into_iter().flatten().chain([seconds]).collect::<Vec<_>>().join(", ")
}

/// What was judged at the full pixel clock; none where the run did not get that far.
fn at_speed(report: &Report) -> Option<String> {
    report.checks.iter().find_map(|check| match check.finding {
        Finding::EqualAtSpeed(EqualAtSpeed { frames, clock_hz: 0, .. }) => {
            Some(format!("{} at speed", count(frames, "frame")))
        }
        Finding::EqualAtSpeed(EqualAtSpeed { frames, clock_hz, seen, .. }) => {
            Some(format!("{} at {}", count(frames, "frame"), named_clock(clock_hz, seen)))
        }
        Finding::PausedAtSpeed { .. } | Finding::NothingAtSpeed { .. } => Some("none at speed".to_owned()),
        _ => None,
    })
}

/// The latency of all rows, in one sentence without a full stop.
#[must_use]
pub fn latency(latency: &LatencyReport) -> String {
    let rows = count(latency.rows, "row");
    let allowed = format!("at most {} allowed", latency.limit);
    match latency.wrong_rows {
        0 if latency.rows == 1 => format!("{} in the one row ({allowed})", measured(latency)),
        0 => format!("{} in all {rows} ({allowed})", measured(latency)),
        wrong => format!("{}; wrong in {} of {rows} ({allowed})", measured(latency), grouped(wrong)),
    }
}

/// `972 = 960 + 12 pixel clocks`: half a row plus the build's own L; or what was measured instead.
fn measured(latency: &LatencyReport) -> String {
    let half_row = latency.limit.saturating_sub(MAX_LATENCY.into());
    let claim = match latency.claimed.checked_sub(half_row) {
        Some(own) => format!("{} = {half_row} + {own}", latency.claimed),
        None => latency.claimed.to_string(),
    };
    match (latency.least, latency.most) {
        (least, most) if (least, most) == (latency.claimed, latency.claimed) => {
            format!("{claim} pixel clocks")
        }
        (least, most) if least == most => format!("{least} pixel clocks instead of {claim}"),
        (least, most) => format!("{least} to {most} pixel clocks instead of {claim}"),
    }
}

/// How straight the street's façade edges are, without a full stop; none where it was not judged.
#[must_use]
pub fn street(report: &Report) -> Option<String> {
    let StreetReport { before, after } = report.street.as_ref()?;
    // Only tables that were made from a lens know its image circle.
    let lens = match report.tables.rows_outside_circle {
        Some(_) => "",
        None => "; it is seen through a lens that the tables may not be for",
    };
    Some(format!(
        "{} {:.2} px off straight before, {:.2} px after (at most {:.2}, {:.2}){lens}",
        count(before.edges, "façade edge"),
        before.mean_px,
        after.mean_px,
        before.max_px,
        after.max_px
    ))
}

/// What the link did, in one sentence without a full stop. Trouble is named only if there was any.
#[must_use]
pub fn link(link: &LinkReport) -> String {
    let mut parts = vec![
        format!("{} out, {} in", bytes(link.bytes_out), bytes(link.bytes_in)),
        count(link.packets_out.saturating_add(link.packets_in), "packet"),
    ];
    match (link.damaged_in.saturating_add(link.damaged_out), link.retries) {
        (0, 0) => parts.push("none damaged".to_owned()),
        (damaged, retries) => parts.push(format!(
            "{} damaged, {} sent again (limit {})",
            grouped(damaged),
            grouped(retries),
            grouped(link.retry_limit)
        )),
    }
    parts.extend(late(link));
    if link.line_errors.sum() > 0 {
        parts.push(format!("errors on the line: {}", link.line_errors));
    }
    // A virtual clock may stand still during a round trip.
    parts.extend(
        link.round_trip_us.filter(|&time| time > 0).map(|time| format!("round trip {} µs", grouped(time))),
    );
    if !link.reconnections.is_empty() {
        parts.push(format!("the board went away and came back {}", count(link.reconnections.len(), "time")));
    }
    format!("{}: {}", link.name, parts.join(", "))
}

/// What came late over a link, or twice, if anything.
pub(super) fn late(link: &LinkReport) -> Option<String> {
    let late = (link.late > 0).then(|| format!("{} answered late", count(link.late, "request")));
    let strays = count(link.strays, "unexpected packet");
    let strays = (link.strays > 0).then(|| format!("{strays} (duplicates or late answers)"));
    let told: Vec<_> = late.into_iter().chain(strays).collect();
    (!told.is_empty()).then(|| told.join(", "))
}

/// The share of the differences that a suspect explains; none where there is nothing to count.
#[must_use]
pub fn share(suspect: &Suspect) -> Option<String> {
    let counted = !matches!(suspect.account, Account::Nothing);
    counted.then(|| format!("explains {} of the differences", percent(suspect.explained)))
}

/// How a board went away and came back, in one sentence without a full stop.
#[must_use]
pub fn away(away: &Reconnection) -> String {
    let kept = match away.kept_tables {
        None => "",
        Some(true) => "; it had kept running, and still had its tables",
        Some(false) => "; it had started again, without tables",
    };
    format!("for {:.1} s: {}{kept}", away.seconds_away, away.reason)
}

/// How a board went away several times in the same way: [`away`] gives the same words for each.
pub(super) fn away_together(together: &[Reconnection]) -> String {
    let Some(first) = together.first() else { return String::new() };
    match together.len() {
        1 => away(first),
        times => format!("{times} times, each {}", away(first)),
    }
}

/// What a soak judged, in one sentence without a full stop.
#[must_use]
pub fn soak(soak: &SoakReport) -> String {
    let time = span(soak.seconds);
    let mut words = match soak.asked {
        SoakLength::Time { seconds } => format!("{time} of {}", span(seconds)),
        SoakLength::Frames { frames } => format!("{} asked for, {time}", count(frames, "frame")),
    };
    if soak.is_idle() {
        words.push_str(&format!(", with frames in {} of it", span(soak.seconds - soak.idle_seconds)));
    }
    let judged = format!(": {} in {}", count(soak.frames, "frame"), count(soak.bursts, "burst"));
    words.push_str(&judged);
    let mut wrong = Vec::new();
    if soak.wrong > 0 {
        wrong.push(format!("{} of which {}", grouped(soak.wrong), verb(soak.wrong, "differ")));
    }
    if soak.miscounted > 0 {
        let have = verb(soak.miscounted, "have");
        wrong.push(format!("{} of which {have} wrong counts", grouped(soak.miscounted)));
    }
    let wrong = if wrong.is_empty() { "none of which differs".to_owned() } else { wrong.join(" and ") };
    words.push_str(&format!(", {wrong}"));
    if soak.paused > 0 {
        words.push_str(&format!("; {} with pauses", grouped(soak.paused)));
    }
    if let Some(ended) = &soak.ended {
        words.push_str(&format!("; it ended early: {}", ended.sentence()));
    }
    words
}

/// When and how something differed in a soak, in one sentence without a full stop.
#[must_use]
pub fn soak_difference(difference: &SoakDifference) -> String {
    let SoakDifference { seconds, seed, generation, finding, .. } = difference;
    format!(
        "after {}, in a burst with content of seed {seed:08x} and tables of generation {generation}: {}",
        span(*seconds),
        finding.sentence()
    )
}

/// A frame's outcome. Under the verdict ERROR nothing is the board's fault.
#[must_use]
pub(crate) fn frame_outcome(report: &Report, frame: &FrameReport) -> Outcome {
    let judged = frame.rows == frame.height() && frame.comparison.samples > 0;
    match (report.verdict(), frame.comparison.differences) {
        (_, 0) if judged => Outcome::Passed,
        (Verdict::Fail, 0) if is_swallowed(report, frame) => Outcome::Failed,
        (Verdict::Error, _) | (_, 0) => Outcome::Error,
        (Verdict::Pass | Verdict::Fail, _) => Outcome::Failed,
    }
}

/// Whether the board took a row of this frame that never came out.
fn is_swallowed(report: &Report, frame: &FrameReport) -> bool {
    let mut found = report.checks.iter().map(|check| &check.finding).chain([&report.finding]);
    found.any(|finding| matches!(finding, Finding::RowSwallowed { frame: of, .. } if *of == frame.number))
}

/// How many samples of a frame differ. `0` is only said of a frame that came back whole.
#[must_use]
pub fn differences(report: &Report, frame: &FrameReport) -> String {
    match (frame.comparison.differences, frame_outcome(report, frame)) {
        (0, Outcome::Error | Outcome::Failed) => "incomplete".to_owned(),
        (some, _) => grouped(some),
    }
}

/// The frames to list when there is room for `most`, and the number of frames left out: all if they fit, otherwise those that
/// are not equal, in order.
#[must_use]
pub fn worth_listing(report: &Report, most: usize) -> (Vec<&FrameReport>, usize) {
    let all = report.frames.len();
    let wanted = |frame: &&FrameReport| all <= most || frame_outcome(report, frame) != Outcome::Passed;
    let listed: Vec<_> = report.frames.iter().filter(wanted).take(most).collect();
    let left_out = all - listed.len();
    (listed, left_out)
}
