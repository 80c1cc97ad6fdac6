//! Pages of many or large frames: what they show, and how long they get.

use halfrow::compare::Comparison;
use halfrow::result::{Evidence, MissingRows, Report};

use crate::html::page;
use crate::made;

/// A report of sixteen frames of noise, which does not compress, with as many rows as charts can have.
fn noise() -> (Report, Vec<Evidence>) {
    let mut state = 1_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as usize
    };
    let samples: Vec<usize> = (0..3 * 640 * 2048).map(|_| noise()).collect();
    let frame = |which: usize| {
        made::sized_frame(640, 2048, |row, column| samples[(which * 2048 + row) * 640 + column])
    };
    let (input, expected, found) = (frame(0), frame(1), frame(2));
    let (mut report, _) = made::fail();
    report.frames = (0..16).map(|number| made::equal_frame((number, "builtin:noise"))).collect();
    for frame in &mut report.frames {
        frame.comparison = Comparison::of_frames(&expected, &found);
    }
    let kept = |index| Evidence {
        index,
        input: input.clone(),
        found: found.clone(),
        expected: expected.clone(),
        missing: MissingRows::default(),
    };
    (report, (0..16).map(kept).collect())
}

#[test]
fn sixteen_frames_of_noise_stay_under_four_megabytes_and_all_are_shown() {
    let (report, evidence) = noise();
    let page = page(&report, &evidence);
    assert!(page.len() < 4_000_000, "{} bytes", page.len());
    assert_eq!(
        page.matches("Input (rendered for viewing)").count(),
        32,
        "a caption and a description for each"
    );
    assert!(!page.contains("left out"));
}

/// The first frame that differs is the one that people look at.
#[test]
fn of_many_frames_the_first_that_differ_keep_their_maps_and_what_is_left_out_is_said() {
    let frame = |sample| made::sized_frame(64, 16, |_, _| sample);
    let (input, right, wrong) = (frame(100), frame(200), frame(201));
    let (mut report, _) = made::fail();
    report.frames = (0..3000).map(|number| made::equal_frame((number, "builtin:grey"))).collect();
    let mut evidence: Vec<_> = (0..3000)
        .map(|index| Evidence {
            index,
            input: input.clone(),
            found: right.clone(),
            expected: right.clone(),
            missing: MissingRows::default(),
        })
        .collect();
    for index in [0, 2, 2999] {
        report.frames[index].comparison = Comparison::of_frames(&right, &wrong);
        evidence[index].found = wrong.clone();
    }
    let page = page(&report, &evidence);
    assert!(page.len() < 4_000_000, "{} bytes", page.len());
    assert_eq!(page.matches("Where it differs").count(), 3);
    assert_eq!(page.matches("<section class=\"frame\">").count(), 400);
    assert!(page.contains("And 2,600 more frames that were kept."));
}

/// Each of them has a map, charts and crops, whose markup is longer than their pictures.
#[test]
fn hundreds_of_small_frames_that_all_differ_stay_under_four_megabytes() {
    let frame = |factor| made::sized_frame(64, 16, |row, column| (row * 64 + column) * factor);
    let (input, right, wrong) = (frame(2741), frame(1873), frame(3307));
    let (mut report, _) = made::fail();
    report.frames = (0..400).map(|number| made::equal_frame((number, "builtin:noise"))).collect();
    for frame in &mut report.frames {
        frame.comparison = Comparison::of_frames(&right, &wrong);
    }
    let kept = |index| Evidence {
        index,
        input: input.clone(),
        found: wrong.clone(),
        expected: right.clone(),
        missing: MissingRows::default(),
    };
    let page = page(&report, &(0..400).map(kept).collect::<Vec<_>>());
    assert!(page.len() < 4_000_000, "{} bytes", page.len());
    assert_eq!(page.matches("<section class=\"frame\">").count(), 400);
    assert!(page.contains("Map and crops: left out"));
}

#[test]
fn a_pass_stays_under_two_megabytes() {
    let (_, mut evidence) = noise();
    let mut report = made::pass();
    report.frames = (0..400).map(|number| made::equal_frame((number, "builtin:noise"))).collect();
    report.not_exercised = halfrow::result::examples::not_exercised();
    for kept in &mut evidence {
        kept.expected = kept.found.clone();
    }
    let page = page(&report, &evidence);
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
    assert_eq!(
        page.matches("Input (rendered for viewing)").count(),
        32,
        "a caption and a description for each"
    );
}
