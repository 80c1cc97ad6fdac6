//! Boards that are plugged in: after a verdict, and after their serial number was scanned.

use halfrow::Verdict;
use halfrow_station::floor::{Act, Effect, Event, Floor, Owes, Place, ScanError, Shown, Word};
use halfrow_station::said::Said;

use super::{PLUG, SCAN, WEBER, at, floor, look, plug, rule, serial, shown, words};

/// A lane with a run under way.
fn running() -> Floor {
    let mut floor = floor(&[SCAN], false);
    plug(&mut floor, 0);
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    floor
}

/// The lane's word, the serial number in it, the verdict shown for it, and the one of the board that was there before.
fn told(floor: &Floor) -> (Word, Option<&str>, Option<Verdict>, Option<Verdict>) {
    let lane = &floor.lanes()[0];
    let verdict = |of: Option<&Shown>| of.map(|of| of.verdict);
    (lane.word(), lane.serial(), verdict(lane.shown()), verdict(lane.last()))
}

fn swap(floor: &mut Floor) {
    look(floor, 0, false, at(2));
    plug(floor, 0);
}

/// People read a verdict after they have removed its board, but it says nothing about the next one.
#[test]
fn a_verdict_stays_over_an_empty_lane_and_not_over_another_board() {
    for (verdict, word) in
        [(Verdict::Pass, Word::Pass), (Verdict::Fail, Word::Fail), (Verdict::Error, Word::Error)]
    {
        let mut floor = running();
        floor.happened(0, Event::Ended(shown(verdict)));
        let its = (word, Some("CA"), Some(verdict), None);
        assert_eq!(told(&floor), its);
        plug(&mut floor, 0);
        assert_eq!(told(&floor), its, "the board was there all the time");
        look(&mut floor, 0, false, at(2));
        assert_eq!(told(&floor), its);
        plug(&mut floor, 0);
        assert_eq!(told(&floor), (Word::Ready, None, None, Some(verdict)));
        look(&mut floor, 0, false, at(3));
        assert_eq!(told(&floor), (Word::Empty, None, None, Some(verdict)), "it does not come back");
        plug(&mut floor, 0);
        floor.scan(&serial(1), WEBER, at(4)).unwrap();
        assert_eq!(told(&floor), (Word::Running, Some(serial(1).as_str()), None, None));
    }
}

#[test]
fn a_verdict_that_comes_when_another_board_is_there_is_not_shown_over_it() {
    let unsaved = || Event::Unsaved { why: Said::of(&std::io::Error::other("full")) };
    for (before, word) in [(vec![Event::Saving], Word::Saving), (vec![unsaved(), unsaved()], Word::Unsaved)] {
        let mut floor = running();
        before.into_iter().for_each(|event| drop(floor.happened(0, event)));
        swap(&mut floor);
        assert_eq!(words(&floor), [word]);
        let hooks = floor.happened(0, Event::Ended(shown(Verdict::Pass)));
        assert_eq!(hooks, Some(Effect::Hooks(shown(Verdict::Pass))), "it holds for its own board");
        assert_eq!(told(&floor), (Word::Ready, None, None, Some(Verdict::Pass)), "{word:?}");
    }
}

/// A run that is over still writes its evidence for a while, and no run waits for its board to come back.
#[test]
fn a_board_that_is_plugged_in_before_a_run_reports_gets_no_verdict_of_it() {
    let mut floor = running();
    swap(&mut floor);
    assert_eq!(floor.lanes()[0].word(), Word::Running);
    floor.happened(0, Event::Saving);
    floor.happened(0, Event::Ended(shown(Verdict::Pass)));
    assert_eq!(told(&floor), (Word::Ready, None, None, Some(Verdict::Pass)));
}

#[test]
fn a_board_that_is_plugged_into_a_lane_that_is_out_or_owes_a_check_gets_no_verdict_of_another() {
    let mut out = running();
    out.happened(0, Event::Ended(shown(Verdict::Pass)));
    out.act(0, Act::Out, WEBER).unwrap();
    swap(&mut out);
    assert_eq!(told(&out), (Word::Out, None, None, Some(Verdict::Pass)));
    out.act(0, Act::In, WEBER).unwrap();
    assert_eq!(told(&out), (Word::Ready, None, None, Some(Verdict::Pass)));
    let mut owes = running();
    owes.happened(0, Event::Ended(shown(Verdict::Pass)));
    let why = Said::of(&std::io::Error::other("the shift is over"));
    let owed = Owes { plan: 0, serial: Some(serial(1)), why: why.clone() };
    owes.happened(0, Event::Owes(Some(owed)));
    swap(&mut owes);
    assert_eq!(told(&owes), (Word::Out, None, None, Some(Verdict::Pass)));
    assert_eq!(owes.lanes()[0].note(), Some(&why));
}

#[test]
fn a_number_that_was_scanned_first_goes_to_the_board_that_is_plugged_in() {
    let mut floor = floor(&[PLUG, PLUG], true);
    plug(&mut floor, 0);
    floor.scan(&serial(0), WEBER, at(10)).unwrap();
    let instead = floor.scan(&serial(1), WEBER, at(20)).unwrap();
    assert!(instead.said.to_string().ends_with(&format!("instead of {}", serial(0))), "{instead:?}");
    assert_eq!(look(&mut floor, 1, true, at(80)), None, "another one may have come with it");
    let begun = floor.looked(&[], at(81));
    assert!(
        matches!(&begun[..], [(1, Some(Effect::Begin(accepted)))] if accepted.serial == serial(1)),
        "{begun:?}"
    );
    assert_eq!(words(&floor), [Word::Ready, Word::Running]);
}

/// The operator may still name a lane while the number waits for a plug.
#[test]
fn a_number_that_a_lane_was_given_waits_for_no_other_board() {
    let mut floor = floor(&[SCAN, SCAN], true);
    plug(&mut floor, 0);
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    floor.scan("HR:LANE:1", WEBER, at(1)).unwrap();
    assert_eq!(floor.scan(&serial(1), WEBER, at(2)).unwrap().lane, Some(0));
    assert_eq!(floor.pending(at(2)), Some(serial(0).as_str()), "another one waits still");
    floor.happened(0, Event::Ended(shown(Verdict::Pass)));
    floor.scan("HR:LANE:1", WEBER, at(4)).unwrap();
    assert_eq!(floor.scan(&serial(0), WEBER, at(5)).unwrap().lane, Some(0));
    assert_eq!(floor.pending(at(5)), None);
    floor.happened(0, Event::Ended(shown(Verdict::Pass)));
    assert_eq!(look(&mut floor, 1, true, at(7)), None);
    assert_eq!(floor.looked(&[], at(8)), []);
    assert_eq!(words(&floor), [Word::Pass, Word::Ready]);
}

/// Nobody knows which of them was plugged in first, also if they are seen one look after the other.
#[test]
fn a_number_goes_to_none_of_the_boards_that_come_together() {
    for looks in [[&[(0, true), (1, true)][..], &[]], [&[(0, true)], &[(1, true)]]] {
        let mut floor = floor(&[PLUG, SCAN, SCAN], true);
        floor.scan(&serial(0), WEBER, at(0)).unwrap();
        let effects: Vec<_> = looks.iter().flat_map(|changes| floor.looked(changes, at(1))).collect();
        assert_eq!(effects, [(0, None), (1, None)]);
        assert_eq!(
            (words(&floor), floor.pending(at(1))),
            (vec![Word::Ready, Word::Ready, Word::Empty], None)
        );
        for lane in &floor.lanes()[..2] {
            let note = lane.note().map(ToString::to_string).unwrap_or_default();
            assert!(note.contains(&serial(0)) && note.contains("boards came into the lanes 1, 2"), "{note}");
        }
        assert_eq!(look(&mut floor, 2, true, at(2)), None);
        assert_eq!(floor.looked(&[], at(3)), [], "it waits no more");
        assert!(floor.scan_for(1, &serial(0), WEBER, at(3)).unwrap().effect.is_some());
    }
}

/// A board whose lane has its number already is not meant.
#[test]
fn a_number_goes_to_the_only_board_without_one_of_those_that_come_together() {
    let mut floor = floor(&[PLUG, PLUG, SCAN], true);
    plug(&mut floor, 2);
    floor.scan_for(0, &serial(1), WEBER, at(0)).unwrap();
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    let begun = floor.looked(&[(0, true), (1, true), (2, false)], at(1));
    let serials: Vec<_> = begun
        .into_iter()
        .chain(floor.looked(&[], at(2)))
        .map(|(lane, effect)| match effect {
            Some(Effect::Begin(of)) => (lane, of.serial),
            other => (lane, format!("{other:?}")),
        })
        .collect();
    let none = || "None".to_owned();
    assert_eq!(serials, [(0, serial(1)), (1, none()), (2, none()), (1, serial(0))]);
}

/// The mock needs no fixture, and the board in the lane stays unjudged.
#[test]
fn the_verdict_on_the_mock_is_shown_over_no_board_and_lights_no_lamp() {
    for verdict in [Verdict::Pass, Verdict::Fail] {
        let mut floor = running();
        let mock = Shown { serial: "HR:MOCK:1".to_owned(), ..shown(verdict) };
        assert_eq!(floor.happened(0, Event::Ended(mock)), None, "no hook");
        assert_eq!(told(&floor), (Word::Ready, None, None, Some(verdict)));
    }
    let mut floor = running();
    let mock = Shown { serial: "HR:MOCK:1".to_owned(), ..shown(Verdict::Error) };
    assert_eq!(floor.happened(0, Event::Ended(mock.clone())), Some(Effect::Hooks(mock)));
    assert_eq!(floor.lanes()[0].word(), Word::Error, "whose reason people are to see");
}

#[test]
fn a_number_waits_a_minute_for_its_board() {
    for (seconds, word) in [(60, Word::Running), (61, Word::Ready)] {
        let mut floor = floor(&[SCAN, SCAN], true);
        floor.scan(&serial(0), WEBER, at(0)).unwrap();
        look(&mut floor, 0, true, at(seconds));
        floor.looked(&[], at(seconds + 1));
        assert_eq!(words(&floor)[0], word);
    }
}

#[test]
fn a_board_that_was_there_already_takes_no_number() {
    let mut floor = floor(&[SCAN, SCAN], true);
    plug(&mut floor, 0);
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    assert_eq!(plug(&mut floor, 0), None);
    assert_eq!(floor.looked(&[], at(1)), []);
    assert_eq!(words(&floor), [Word::Ready, Word::Empty]);
}

/// The first lane accepts no number, each time for another reason.
fn taking_nothing() -> [(&'static str, Floor); 5] {
    let [mut out, mut owes, mut running] = [(); 3].map(|()| floor(&[SCAN, SCAN], true));
    out.act(0, Act::Out, WEBER).unwrap();
    let why = Said::of(&std::io::Error::other("the shift is over"));
    owes.happened(0, Event::Owes(Some(Owes { plan: 0, serial: Some(serial(1)), why: why.clone() })));
    plug(&mut running, 0);
    running.scan_for(0, &serial(1), WEBER, at(0)).unwrap();
    look(&mut running, 0, false, at(0));
    let mut unsaved = running.clone();
    unsaved.happened(0, Event::Unsaved { why });
    let place = |name: &str, plans| Place { name: name.to_owned(), starts: SCAN, plans };
    let places = vec![place("1", vec![1]), place("2", vec![0, 1])];
    let other = Floor::new(places, vec![rule("CAM-A", "CA"), rule("CAM-B", "CB")], true);
    [
        ("is out of service", out),
        ("the shift is over", owes),
        ("is testing", running),
        ("is not saved", unsaved),
        ("no serial number of this product", other),
    ]
}

/// The number belongs to the board that was plugged in: no other board is tested under it.
#[test]
fn a_number_whose_board_came_to_a_lane_that_does_not_take_it_waits_for_no_other() {
    for (why, mut floor) in taking_nothing() {
        floor.scan(&serial(0), WEBER, at(1)).unwrap();
        assert_eq!(look(&mut floor, 0, true, at(2)), None, "{why}");
        assert_eq!(floor.looked(&[], at(2)), [], "{why}");
        let noted = |floor: &Floor| floor.lanes()[0].note().map(ToString::to_string).unwrap_or_default();
        let note = noted(&floor);
        assert!(note.contains(&serial(0)) && note.contains(why), "{why}: {note}");
        assert_eq!(floor.pending(at(2)), None, "{why}");
        assert_eq!(look(&mut floor, 1, true, at(3)), None, "{why}");
        assert_eq!(floor.looked(&[], at(3)), [], "{why}");
        assert_eq!(words(&floor)[1], Word::Ready, "{why}");
        look(&mut floor, 0, false, at(4));
        assert!(!noted(&floor).contains(&serial(0)), "{why}: it goes with its board");
    }
}

/// docs/station-lanes.md says of OUT and UNSAVED that their reason is there. After a verdict the label is still to be scanned again.
#[test]
fn a_number_that_was_not_given_does_not_hide_why_its_lane_is_out_or_saved_nothing() {
    let noted = |floor: &Floor| floor.lanes()[0].note().map(ToString::to_string).unwrap_or_default();
    let full = || Event::Unsaved { why: Said::of(&std::io::Error::other("the disk is full")) };
    let [_, (_, mut owes), (_, mut running), ..] = taking_nothing();
    for floor in [&mut owes, &mut running] {
        floor.scan(&serial(0), WEBER, at(1)).unwrap();
        look(floor, 0, true, at(2));
        floor.looked(&[], at(2));
        assert!(noted(floor).contains(&serial(0)), "{}", noted(floor));
    }
    owes.act(0, Act::Out, WEBER).unwrap();
    assert_eq!((words(&owes)[0], noted(&owes).as_str()), (Word::Out, "taken out by hand"));
    let mut ended = running.clone();
    ended.happened(0, Event::Ended(shown(Verdict::Pass)));
    assert!(noted(&ended).contains(&serial(0)), "{}", noted(&ended));
    running.happened(0, full());
    assert_eq!((words(&running)[0], noted(&running).as_str()), (Word::Unsaved, "the disk is full"));
    // The next board comes while it is tried again to save the result.
    look(&mut running, 0, false, at(4));
    running.scan(&serial(2), WEBER, at(5)).unwrap();
    look(&mut running, 0, true, at(6));
    running.looked(&[], at(6));
    running.happened(0, full());
    assert!(noted(&running).contains(&serial(2)), "{}", noted(&running));
}

/// The shift is to be checked, and the unit that checks it could not be tested.
#[test]
fn why_a_run_was_not_begun_is_kept_beside_what_its_lane_owes_until_the_next_scan() {
    let mut floor = floor(&[SCAN], false);
    plug(&mut floor, 0);
    let said = |text: &str| Said::of(&std::io::Error::other(text.to_owned()));
    let owes = Owes { plan: 0, serial: Some(serial(0)), why: said("the good unit first") };
    floor.happened(0, Event::Owes(Some(owes)));
    floor.scan(&serial(0), WEBER, at(1)).unwrap();
    floor.happened(0, Event::NotBegun { why: said("the disk is full") });
    let told = |floor: &Floor| {
        let lane = &floor.lanes()[0];
        [lane.note(), lane.refused()].map(|said| said.map(ToString::to_string).unwrap_or_default())
    };
    assert_eq!(
        (words(&floor)[0], told(&floor)),
        (Word::Out, ["the good unit first", "the disk is full"].map(str::to_owned))
    );
    floor.scan(&serial(0), WEBER, at(3)).unwrap();
    floor.happened(0, Event::Ended(shown(Verdict::Error)));
    assert_eq!(told(&floor)[1], "");
    floor.happened(0, Event::Owes(None));
    floor.scan(&serial(1), WEBER, at(6)).unwrap();
    floor.happened(0, Event::NotBegun { why: said("the disk is full") });
    assert_eq!(told(&floor), ["the disk is full", ""], "once and not twice");
}

/// Each lane has a plan of its own for the same product, and the station a third one for jobs.
#[test]
fn a_number_waits_for_its_board_if_one_lane_takes_it_whatever_other_lanes_have() {
    let place = |name: &str, plans| Place { name: name.to_owned(), starts: SCAN, plans };
    let places = vec![place("1", vec![0]), place("2", vec![1]), place("3", vec![3])];
    let rules = vec![rule("CAM-A", "CA"), rule("CAM-A", "CA"), rule("CAM-A", "CA"), rule("CAM-B", "CB")];
    let mut floor = Floor::new(places, rules, true);
    assert_eq!(floor.scan(&serial(0), WEBER, at(10)).unwrap().lane, None);
    look(&mut floor, 1, true, at(11));
    let begun = floor.looked(&[], at(12));
    assert!(matches!(&begun[..], [(1, Some(Effect::Begin(of)))] if of.plan == 1), "{begun:?}");
    let elsewhere = floor.scan(&serial(0), WEBER, at(13)).unwrap_err();
    assert_eq!(elsewhere, ScanError::Elsewhere { serial: serial(0), lane: "2".to_owned() });
    let no_lanes = floor.scan(&serial(1).replace("CA", "CC"), WEBER, at(14)).unwrap_err();
    assert!(matches!(no_lanes, ScanError::Serial(_)), "{no_lanes:?}");
    floor.scan(&serial(1), WEBER, at(15)).unwrap();
    look(&mut floor, 2, true, at(16));
    assert_eq!(floor.looked(&[], at(17)), [], "the lane has no plan for it");
    assert!(floor.lanes()[2].note().unwrap().to_string().contains("and is not tested"));
}

/// What one lane judges says nothing of another product with the same number.
#[test]
fn a_number_waits_though_a_lane_judges_that_of_another_product() {
    let place = |name: &str, plans| Place { name: name.to_owned(), starts: SCAN, plans };
    let places = vec![place("1", vec![0]), place("2", vec![1])];
    let mut floor = Floor::new(places, vec![rule("CAM-A", "CA"), rule("CAM-B", "CA")], true);
    floor.scan(&serial(0), WEBER, at(10)).unwrap();
    look(&mut floor, 0, true, at(11));
    assert_eq!(floor.looked(&[], at(12)).len(), 1);
    assert_eq!(floor.scan(&serial(0), WEBER, at(13)).unwrap().lane, None);
    look(&mut floor, 1, true, at(14));
    let begun = floor.looked(&[], at(15));
    assert!(matches!(&begun[..], [(1, Some(Effect::Begin(of)))] if of.plan == 1), "{begun:?}");
    assert!(matches!(floor.scan(&serial(0), WEBER, at(16)), Err(ScanError::Elsewhere { .. })));
}

/// A lane that could not tell which plan is meant does not keep a number from waiting for it in vain.
#[test]
fn a_number_that_no_lane_takes_does_not_wait() {
    let place = |name: &str, plans| Place { name: name.to_owned(), starts: SCAN, plans };
    let places = vec![place("1", vec![0, 1]), place("2", vec![2])];
    let rules = vec![rule("CAM-A", "CA"), rule("CAM-B", "C[AB]"), rule("CAM-C", "CC")];
    let mut floor = Floor::new(places, rules, true);
    assert!(matches!(floor.scan(&serial(0), WEBER, at(0)), Err(ScanError::Ambiguous { .. })));
}
