//! What stands beside checks that were not made, or not for the tables that the run ended with.

use halfrow::progress::Silent;
use halfrow::result::{CheckName, Finding, Outcome, Report, SoakLength};
use halfrow::run::{AtSpeed, Plan, RunOptions, verify};
use halfrow::verdict::Verdict;
use halfrow_tests::system::{System, open};

fn found(report: &Report, name: CheckName) -> (Outcome, &Finding) {
    let check = report.checks.iter().find(|check| check.name == name).unwrap();
    (check.outcome, &check.finding)
}

/// The decoy's tables were read back before the link breaks in the upload of those to judge with.
#[test]
fn tables_that_were_not_uploaded_were_not_read_back() {
    let system = System { height: 16, radius: 40.0, ..System::TINY };
    let report = system.judge(",fault=disconnect");
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert_eq!(found(&report, CheckName::Upload).0, Outcome::Error, "{}", report.headline());
    assert_eq!(found(&report, CheckName::ReadBack), (Outcome::Skipped, &Finding::NotReached {}));
}

#[test]
fn tables_that_no_frame_used_are_not_said_to_be_right_after_it() {
    let report = System::TINY.judge(",fault=stuck-data");
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert_eq!(found(&report, CheckName::TablesAfter), (Outcome::Skipped, &Finding::TablesUnused {}));
}

/// A soak never tries the rules, whatever its verdict.
#[test]
fn a_soak_says_of_the_rules_the_same_whether_it_passes_or_fails() {
    for (board, verdict) in [("mock", Verdict::Pass), ("mock,fault=warm-bit", Verdict::Fail)] {
        let plan = Plan {
            at_speed: AtSpeed::Soak(SoakLength::Frames { frames: 4 }),
            fail_fast: false,
            ..System::TINY.plan()
        };
        let report = verify(&plan, open(board), &RunOptions::default(), &Silent).unwrap().report;
        assert_eq!(report.verdict(), verdict, "{}", report.headline());
        assert_eq!(
            found(&report, CheckName::Rules),
            (Outcome::Skipped, &Finding::RulesLeftOut {}),
            "{board}"
        );
    }
}
