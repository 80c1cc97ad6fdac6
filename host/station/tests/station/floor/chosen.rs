//! Lanes that are chosen by their barcode.

use halfrow_station::floor::{ScanError, Word};

use super::{SCAN, WEBER, at, floor, plug, serial, words};

#[test]
fn a_scan_goes_to_the_lane_that_was_scanned_and_never_to_a_guess() {
    let mut floor = floor(&[SCAN, SCAN, SCAN], false);
    (0..3).for_each(|lane| assert_eq!(plug(&mut floor, lane), None));
    assert_eq!(floor.scan(&serial(0), WEBER, at(0)), Err(ScanError::WhichLane { lanes: 3 }));
    assert!(matches!(floor.scan("HR:LANE:4", WEBER, at(0)), Err(ScanError::NoLane { .. })));
    floor.scan("HR:LANE:2", WEBER, at(0)).unwrap();
    assert_eq!(floor.scan(&serial(0), WEBER, at(0)).unwrap().lane, Some(1));
    assert_eq!(words(&floor), [Word::Ready, Word::Running, Word::Ready]);
    assert_eq!(floor.scan(&serial(1), WEBER, at(0)), Err(ScanError::WhichLane { lanes: 3 }), "once");
    floor.scan("HR:LANE:3", WEBER, at(0)).unwrap();
    let elsewhere = floor.scan(&serial(0), WEBER, at(0)).unwrap_err();
    assert_eq!(elsewhere, ScanError::Elsewhere { serial: serial(0), lane: "2".to_owned() });
    // A misread label does not use up the choice of the lane.
    assert!(floor.scan("CA0131103629", WEBER, at(0)).is_err());
    assert_eq!(floor.scan(&serial(1), WEBER, at(0)).unwrap().lane, Some(2));
}

/// The next person's label, after lunch, is for the board in another lane.
#[test]
fn a_lane_stays_chosen_for_fifteen_seconds_and_what_comes_later_goes_to_no_other_lane() {
    for scan_then_plug in [false, true] {
        for (seconds, is_taken) in [(15, true), (16, false)] {
            for (scan, word) in [(serial(0), Word::Running), ("HR:OUT".to_owned(), Word::Out)] {
                let mut floor = floor(&[SCAN, SCAN], scan_then_plug);
                (0..2).for_each(|lane| assert_eq!(plug(&mut floor, lane), None));
                floor.scan("HR:LANE:2", WEBER, at(100)).unwrap();
                let later = at(100 + seconds);
                let answer = floor.scan(&scan, WEBER, later);
                let is_over = Err(ScanError::ChoiceOver { lane: "2".to_owned(), seconds: 15 });
                assert!(if is_taken { answer.is_ok() } else { answer == is_over }, "{answer:?}");
                let after = if is_taken { word } else { Word::Ready };
                assert_eq!((words(&floor), floor.pending(later)), (vec![Word::Ready, after], None));
            }
        }
    }
}

#[test]
fn a_choice_is_over_once_and_lasts_no_longer_for_a_misread_label() {
    let mut floor = floor(&[SCAN, SCAN], true);
    (0..2).for_each(|lane| assert_eq!(plug(&mut floor, lane), None));
    floor.scan("HR:LANE:1", WEBER, at(0)).unwrap();
    assert!(matches!(floor.scan("CA0131103629", WEBER, at(10)), Err(ScanError::Serial(_))));
    assert!(matches!(floor.scan(&serial(0), WEBER, at(20)), Err(ScanError::ChoiceOver { .. })));
    assert_eq!(floor.scan(&serial(0), WEBER, at(21)).unwrap().lane, None, "it waits for its board");
    floor.scan("HR:LANE:1", WEBER, at(30)).unwrap();
    floor.scan("HR:LANE:2", WEBER, at(50)).unwrap();
    assert_eq!(floor.scan(&serial(1), WEBER, at(55)).unwrap().lane, Some(1), "another choice");
    let mut one = super::floor(&[SCAN], false);
    plug(&mut one, 0);
    one.scan("HR:LANE:1", WEBER, at(0)).unwrap();
    assert_eq!(one.scan(&serial(0), WEBER, at(60)).unwrap().lane, Some(0), "there is no other");
}

/// Two people scan at the same time: one of them on a page that has chosen its lane.
#[test]
fn a_barcode_of_a_lane_is_obeyed_wherever_it_was_scanned() {
    let mut floor = floor(&[SCAN, SCAN, SCAN], false);
    (0..3).for_each(|lane| assert_eq!(plug(&mut floor, lane), None));
    floor.scan_for(0, "HR:LANE:2", WEBER, at(0)).unwrap();
    assert_eq!(floor.scan_for(0, &serial(0), WEBER, at(0)).unwrap().lane, Some(0));
    assert_eq!(floor.scan(&serial(1), WEBER, at(0)).unwrap().lane, Some(1), "the lane that was scanned");
}
