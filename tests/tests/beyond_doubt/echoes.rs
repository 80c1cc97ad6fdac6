//! Lines that begin to echo in the middle of a run, instead of the board or besides it: a request is no answer to itself.

use std::time::{Duration, Instant};

use halfrow::link::{Candidate, Link, LinkError};
use halfrow::result::Report;
use halfrow::run::{Part, Plan, Selection};
use halfrow::target::BoardKind;
use halfrow::verdict::Verdict;
use halfrow_tests::system::{System, judge_by_plan, open};
use halfrow_tests::through::Through;

/// What is reported of a line that echoes.
const SAID: &str = "the line returns what is sent to it";

/// The report on a sound board, with the wire's rules, whose line echoes once it was sent `after` bytes; with `beside`, the board
/// still gets what is sent.
fn echoing(after: usize, beside: bool) -> Report {
    let plan = Plan { selection: Some(Selection::least().with(Part::Rules, 1)), ..System::TINY.plan() };
    let candidate = open("mock");
    let mut left = after;
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        if left > 0 {
            let taken = link.exchange(out, back, wait)?;
            left = left.saturating_sub(taken);
            return Ok(taken);
        }
        if !beside && !out.is_empty() {
            back.extend(out);
            return Ok(out.len());
        }
        let mut said = Vec::new();
        let taken = link.exchange(out, &mut said, wait)?;
        back.extend(&out[..taken]);
        back.extend(said);
        Ok(taken)
    });
    judge_by_plan(&plan, Candidate { link, ..candidate })
}

#[test]
fn a_line_that_begins_to_echo_makes_no_sound_board_fail() {
    let quiet = echoing(usize::MAX, false);
    assert_eq!(quiet.verdict(), Verdict::Pass, "{}", quiet.headline());
    let sent = quiet.link.bytes_out;
    for beside in [false, true] {
        let (mut named, mut errors) = (0, 0);
        for after in (3_000..sent as usize).step_by(4_001) {
            let report = echoing(after, beside);
            let what = format!("after {after} bytes, beside: {beside}: {}", report.headline());
            assert_eq!(report.verdict(), Verdict::Error, "{what}");
            errors += 1;
            named += usize::from(report.headline().contains(SAID));
        }
        // In the middle of rows, missing rows are reported instead.
        assert!(errors > 15 && 2 * named > errors, "beside: {beside}: {named} of {errors}");
    }
}

#[test]
fn a_line_that_echoes_from_the_first_is_named_with_a_board_and_without() {
    for beside in [false, true] {
        let report = echoing(0, beside);
        assert!(report.headline().contains(SAID), "beside: {beside}: {}", report.headline());
    }
}

/// A console or a modem: it echoes what it is sent, and says something of its own, at once or later.
struct Console {
    begun: Instant,
    says: &'static [u8],
    /// Whether it says that together with the echo, or at the next exchange.
    at_once: bool,
    waits: Vec<u8>,
}

impl Link for Console {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        let waits = std::mem::take(&mut self.waits);
        back.extend(&waits);
        if !out.is_empty() {
            back.extend(out);
            let said = if self.at_once { &mut *back } else { &mut self.waits };
            said.extend(self.says);
        } else if waits.is_empty() {
            std::thread::sleep(wait.min(Duration::from_millis(10)));
        }
        Ok(out.len())
    }

    fn now(&self) -> Duration {
        self.begun.elapsed()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn name(&self) -> String {
        "a console".to_owned()
    }
}

#[test]
fn a_console_that_echoes_is_told_from_a_loopback_plug() {
    for (says, at_once) in [(&b"\r\nERROR\r\n"[..], true), (b"bench login: ", false), (b"", true)] {
        let link = Console { begun: Instant::now(), says, at_once, waits: Vec::new() };
        let report =
            judge_by_plan(&System::TINY.plan(), Candidate::new("console", BoardKind::Hardware, link));
        let (headline, is_console) = (report.headline(), !says.is_empty());
        assert_eq!(
            headline.contains("the device at this port has a console"),
            is_console,
            "{says:?}: {headline}"
        );
        assert_eq!(headline.contains(SAID), !is_console, "{says:?}: {headline}");
    }
}
