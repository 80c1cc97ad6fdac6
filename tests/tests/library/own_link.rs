//! Links of a program's own.

use halfrow::Verdict;
use halfrow::link::{Candidate, Link, RecordingFile};
use halfrow::run::{RecordedRun, RunOptions};
use halfrow_tests::system::{System, judge_by_plan, open};
use halfrow_tests::through::Through;

/// `link`, which counts seven bytes too many, as if it also counted what it wraps the bytes in.
fn overcounting(link: Box<dyn Link>) -> Box<dyn Link> {
    Through::boxed(link, |link, sent, incoming, wait| {
        let taken = link.exchange(sent, incoming, wait)?;
        Ok(if taken == sent.len() { taken + 7 } else { taken })
    })
}

#[test]
fn a_link_that_counts_more_bytes_than_it_was_given_ends_no_run() {
    let _alone = crate::RUNS.lock();
    let plan = System::TINIEST.plan();
    let expected = judge_by_plan(&plan, open("mock"));
    let candidate = open("mock");
    let candidate = Candidate { link: overcounting(candidate.link), ..candidate };
    let report = judge_by_plan(&plan, candidate);
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert_eq!(report.link.bytes_out, expected.link.bytes_out);
}

#[test]
fn a_link_that_counts_more_bytes_than_it_was_given_can_be_recorded() {
    let _alone = crate::RUNS.lock();
    let (plan, folder) = (System::TINIEST.plan(), tempfile::tempdir().unwrap());
    let file = RecordingFile::prepare(&folder.path().join("run.rec"), false).unwrap();
    let candidate = open("mock");
    let candidate = Candidate { link: overcounting(candidate.link), ..candidate };
    let (candidate, lost) = RecordedRun::begin(&plan, &RunOptions::default(), candidate, Some(file)).unwrap();
    let report = judge_by_plan(&plan, candidate);
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(lost.get().is_none());
}
