//! Plans that no run can be made by.

use std::sync::Mutex;

use halfrow::progress::Silent;
use halfrow::result::{Problem, SoakLength};
use halfrow::run::{AtSpeed, MOST_FRAMES, Plan, RunOptions, verify};
use halfrow::{Event, FrameSource, Verdict};
use halfrow_tests::system::{System, open};

/// Why the mock board is not judged by `plan`, and what the run reported of its progress.
fn refused(plan: &Plan) -> (Option<String>, Vec<Event>) {
    let events = Mutex::new(Vec::new());
    let watch = |event| events.lock().unwrap().push(event);
    let ran = verify(plan, open("mock"), &RunOptions::default(), &watch);
    (ran.err().map(|misfit| Problem::of(&misfit).code), events.into_inner().unwrap())
}

#[test]
fn a_plan_whose_own_frames_would_not_be_streamed_is_refused() {
    let _alone = crate::RUNS.lock();
    let plan = System::TINIEST.plan();
    let at_speed = AtSpeed::Soak(SoakLength::Frames { frames: 4 });
    let empty = [
        plan.clone().frames([]),
        Plan { repeat: 0, ..plan.clone() },
        Plan { at_speed, ..plan.clone().frames([]) },
    ];
    for plan in empty {
        assert_eq!(refused(&plan), (Some("plan-without-frames".to_owned()), Vec::new()));
    }
    let [first, ..] = &plan.frames[..] else { panic!("{:?}", plan.frames) };
    let one = plan.clone().frames([FrameSource::clone(first)]);
    assert!(one.check_length().is_ok());
    let most = Plan { repeat: MOST_FRAMES as u32, ..one.clone() };
    assert!(most.check_length().is_ok());
    let many = Plan { repeat: MOST_FRAMES as u32 + 1, ..one };
    assert_eq!(refused(&many).0.as_deref(), Some("too-many-frames"));
}

#[test]
fn a_centre_of_built_in_frames_that_is_no_number_is_refused() {
    let _alone = crate::RUNS.lock();
    for centre in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let plan = Plan { centre_y: Some(centre), ..System::TINIEST.plan() };
        assert_eq!(refused(&plan), (Some("centre-row-not-finite".to_owned()), Vec::new()), "{centre}");
    }
    // Far outside, as for a part of a sensor.
    let plan = Plan { centre_y: Some(-1e6), ..System::TINIEST.plan() };
    let ran = verify(&plan, open("mock"), &RunOptions::default(), &Silent);
    assert_eq!(ran.unwrap().report.verdict(), Verdict::Pass);
}
