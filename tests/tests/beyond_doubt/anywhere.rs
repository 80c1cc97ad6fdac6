//! Links that break anywhere in a run, once or again and again: a sound board that comes back passes.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use halfrow::link::{Candidate, Link, LinkError};
use halfrow::result::Report;
use halfrow::run::{Plan, Vary};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::Request;
use halfrow_protocol::message::{Bank, Span};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::{System, judge_reconnecting, open, streamed};
use halfrow_tests::through::Through;

use crate::conduct::passes;
use crate::stale_packets::cut_when_told;

/// A link to a sound board that breaks when so many bytes have been sent.
fn breaking(behind: u64) -> Box<dyn Link> {
    let mut sent = 0;
    Through::boxed(open("mock").link, move |link, out, back, wait| {
        if sent >= behind {
            return Err(LinkError::Closed { link: link.name(), at: link.now() });
        }
        // No more than that.
        let most = usize::try_from(behind - sent).unwrap_or(usize::MAX).min(out.len());
        let taken = link.exchange(&out[..most], back, wait)?;
        sent += taken as u64;
        Ok(taken)
    })
}

/// The report by `plan` on a board over such a link, which comes back over links that break as `again` says.
fn judged(plan: &Plan, behind: u64, again: u64) -> Report {
    let reopen = Box::new(move || Ok(breaking(again)));
    let candidate = Candidate { link: breaking(behind), reopen: Some(reopen), ..open("mock") };
    judge_reconnecting(plan, Some(LIMIT), candidate)
}

#[test]
fn a_sound_board_that_comes_back_passes_wherever_the_link_has_broken() {
    let plan = System { height: 16, ..System::TINY }.plan().varying(Vary { centre: true, depth: true });
    // No divisors of what a frame or a session takes.
    for (plan, parts) in [(streamed(plan.clone()), 61), (plan, 23)] {
        let sound = judged(&plan, u64::MAX, u64::MAX);
        passes(&sound);
        let all = sound.link.bytes_out;
        for part in 0..parts {
            let behind = all * part / parts;
            let report = judged(&plan, behind, u64::MAX);
            assert_eq!(report.verdict(), Verdict::Pass, "{behind} of {all}: {}", report.headline());
            assert_eq!(report.link.reconnections.len(), 1, "{behind} of {all}");
        }
    }
}

/// Each time that the tables in use are to be read: before others take their place, and behind the last frame.
#[test]
fn a_sound_board_that_comes_back_passes_where_the_link_breaks_between_frames() {
    let plan = System { height: 16, ..System::TINY }.plan().varying(Vary { centre: true, depth: true });
    let plan = streamed(plan);
    for which in 0..12 {
        let (is_cut, mut asked) = (Arc::new(AtomicBool::new(false)), 0);
        let cut = Arc::clone(&is_cut);
        let alter = move |toward, packet: Passing| {
            if let (Toward::Board, Some(Request::TableCrc(Span { bank: Bank::Active, .. }))) =
                (toward, packet.request())
            {
                cut.fetch_or(asked == which, Ordering::Relaxed);
                asked += 1;
            }
            vec![packet]
        };
        let candidate = Altered::new(&Options::default(), alter).candidate();
        let link = cut_when_told(candidate.link, is_cut);
        let candidate = Candidate { link, reopen: Some(Box::new(|| Ok(open("mock").link))), ..candidate };
        let report = judge_reconnecting(&plan, Some(LIMIT), candidate);
        passes(&report);
        assert_eq!(report.link.reconnections.len(), 1, "{which}");
    }
}

/// The echoes that test a link have more bytes than it carries each time.
#[test]
fn a_contact_that_is_loose_ends_the_run() {
    let report = judged(&System::TINY.plan(), 3000, 3000);
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    assert_eq!(report.link.reconnections.len(), 16);
}
