//! The states of the lanes, and what becomes of a scan, without a board.

mod chosen;
mod plugged;

use std::time::Duration;

use halfrow::Verdict;
use halfrow_station::floor::{Act, Effect, Event, Floor, Owes, Place, Rule, ScanError, Shown, Starts, Word};
use halfrow_station::plan::Plan;
use halfrow_station::plan::serial::SerialRule;
use halfrow_station::said::Said;

use crate::common::{SERIALS, guarded_plan};

const SCAN: Starts = Starts { scan: true, button: false, presence: false };
const BUTTON: Starts = Starts { scan: false, button: true, presence: false };
const PLUG: Starts = Starts { scan: false, button: false, presence: true };

/// The operator who scans.
const WEBER: &str = "weber";

/// The rule of a product whose serial numbers have a check digit as in an ISBN-10.
fn rule(product: &str, letters: &str) -> Rule {
    let plan = guarded_plan(product, letters);
    let serial: SerialRule = Plan::parse("plan.toml".as_ref(), plan).unwrap().serial;
    Rule { product: product.to_owned(), serial }
}

fn floor(starts: &[Starts], scan_then_plug: bool) -> Floor {
    let place = |(number, starts): (usize, &Starts)| Place {
        name: (number + 1).to_string(),
        starts: *starts,
        plans: vec![0, 1],
    };
    let places = starts.iter().enumerate().map(place).collect();
    Floor::new(places, vec![rule("CAM-A", "CA"), rule("CAM-B", "CB")], scan_then_plug)
}

fn at(seconds: u64) -> Duration {
    Duration::from_secs(seconds)
}

fn words(floor: &Floor) -> Vec<Word> {
    floor.lanes().iter().map(halfrow_station::floor::Lane::word).collect()
}

fn serial(number: usize) -> String {
    SERIALS[number].to_owned()
}

fn shown(verdict: Verdict) -> Shown {
    let [run, serial, record_sha256, headline] = ["r", "CA", "h", "w"].map(str::to_owned);
    let (remedy, finding, board_kind) = (None, None, None);
    let (saved_ms, is_identity_checked) = (0, true);
    Shown {
        run,
        serial,
        verdict,
        record_sha256,
        headline,
        remedy,
        finding,
        saved_ms,
        board_kind,
        is_identity_checked,
    }
}

/// A board comes or goes, and nothing else is seen at that look; returns what is to be done in its lane.
fn look(floor: &mut Floor, lane: usize, is_present: bool, now: Duration) -> Option<Effect> {
    let effects = floor.looked(&[(lane, is_present)], now);
    effects.into_iter().find_map(|(of, effect)| effect.filter(|_| of == lane))
}

fn plug(floor: &mut Floor, lane: usize) -> Option<Effect> {
    look(floor, lane, true, at(0))
}

#[test]
fn a_run_goes_from_the_scan_to_a_verdict_that_stays() {
    let mut floor = floor(&[SCAN], false);
    assert_eq!(words(&floor), [Word::Empty]);
    assert!(matches!(floor.scan(&serial(0), WEBER, at(0)), Err(ScanError::Lane(_))), "there is no board");
    assert_eq!(plug(&mut floor, 0), None);
    assert_eq!(words(&floor), [Word::Ready]);
    let begun = floor.scan(&serial(0), WEBER, at(0)).unwrap();
    let Some(Effect::Begin(accepted)) = begun.effect else { panic!("{begun:?}") };
    assert_eq!((accepted.plan, accepted.product.as_str(), accepted.serial), (0, "CAM-A", serial(0)));
    assert_eq!(words(&floor), [Word::Running]);
    assert!(floor.scan(&serial(1), WEBER, at(0)).unwrap_err().to_string().contains("is testing"), "busy");
    floor.happened(0, Event::Begun { run: "r".to_owned() });
    assert_eq!(floor.lanes()[0].run(), Some("r"));
    floor.happened(0, Event::Saving);
    assert_eq!(words(&floor), [Word::Saving]);
    let hooks = floor.happened(0, Event::Ended(shown(Verdict::Pass)));
    assert_eq!(hooks, Some(Effect::Hooks(shown(Verdict::Pass))));
    floor.scan(&serial(1), WEBER, at(0)).unwrap();
    assert_eq!(
        (words(&floor), floor.lanes()[0].shown()),
        (vec![Word::Running], None),
        "the next serial number"
    );
}

#[test]
fn every_verdict_has_its_word() {
    for (verdict, word) in
        [(Verdict::Pass, Word::Pass), (Verdict::Fail, Word::Fail), (Verdict::Error, Word::Error)]
    {
        let mut floor = floor(&[SCAN], false);
        plug(&mut floor, 0);
        floor.scan(&serial(0), WEBER, at(0)).unwrap();
        floor.happened(0, Event::Ended(shown(verdict)));
        assert_eq!(words(&floor), [word]);
    }
}

#[test]
fn what_is_not_saved_blocks_its_lane_until_it_is_known() {
    let mut floor = floor(&[SCAN, SCAN], false);
    plug(&mut floor, 0);
    floor.scan("HR:LANE:1", WEBER, at(0)).unwrap();
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    floor.happened(0, Event::Begun { run: "r".to_owned() });
    floor.happened(0, Event::Saving);
    let full = || Event::Unsaved { why: Said::of(&std::io::Error::other("full")) };
    let recover = Some(Effect::Recover { run: "r".to_owned() });
    assert_eq!(floor.happened(0, full()), recover);
    assert_eq!((words(&floor)[0], floor.lanes()[0].shown()), (Word::Unsaved, None));
    floor.scan("HR:LANE:1", WEBER, at(0)).unwrap();
    assert!(floor.scan(&serial(1), WEBER, at(0)).unwrap_err().to_string().contains("is not saved"));
    assert!(floor.scan("HR:OUT", WEBER, at(0)).is_err());
    assert_eq!(floor.happened(0, full()), recover, "it is tried again");
    floor.happened(0, Event::Ended(shown(Verdict::Error)));
    assert_eq!(words(&floor)[0], Word::Error);
}

#[test]
fn a_lane_whose_process_cannot_be_killed_is_out() {
    let mut floor = floor(&[SCAN], false);
    plug(&mut floor, 0);
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    floor.happened(0, Event::Ended(shown(Verdict::Error)));
    floor.happened(0, Event::Stuck);
    assert_eq!(words(&floor), [Word::Out]);
    assert!(floor.scan(&serial(1), WEBER, at(0)).unwrap_err().to_string().contains("restart the computer"));
    floor.scan("HR:IN", WEBER, at(0)).unwrap();
    assert_eq!(words(&floor), [Word::Error]);
}

/// This is known before the result is, which may wait for the disk or for the plant.
#[test]
fn a_lane_whose_process_cannot_be_killed_is_out_whatever_comes_of_its_result() {
    let unsaved = || Event::Unsaved { why: Said::of(&std::io::Error::other("full")) };
    let settled: [&[Event]; 2] = [&[], &[unsaved(), unsaved()]];
    for before in settled {
        let mut floor = floor(&[SCAN], false);
        plug(&mut floor, 0);
        floor.scan(&serial(0), WEBER, at(0)).unwrap();
        floor.happened(0, Event::Begun { run: "r".to_owned() });
        floor.happened(0, Event::Stuck);
        assert_eq!(words(&floor), [Word::Running], "until it is settled");
        floor.happened(0, Event::Saving);
        for event in before {
            floor.happened(0, event.clone());
            assert_eq!(words(&floor), [Word::Unsaved]);
        }
        let hooks = floor.happened(0, Event::Ended(shown(Verdict::Error)));
        assert_eq!(hooks, Some(Effect::Hooks(shown(Verdict::Error))));
        assert_eq!(words(&floor), [Word::Out], "{before:?}");
        floor.scan("HR:IN", WEBER, at(0)).unwrap();
        floor.scan(&serial(1), WEBER, at(0)).unwrap();
        floor.happened(0, Event::Ended(shown(Verdict::Pass)));
        assert_eq!(words(&floor), [Word::Pass], "whoever put it back has seen to it");
    }
}

#[test]
fn a_lane_starts_as_its_settings_say() {
    let mut button = floor(&[BUTTON], false);
    plug(&mut button, 0);
    assert!(button.scan("HR:START", WEBER, at(0)).is_err(), "no serial number");
    assert_eq!(button.scan(&serial(0), WEBER, at(0)).unwrap().effect, None);
    assert_eq!(words(&button), [Word::Waiting]);
    assert!(matches!(button.scan("HR:START", WEBER, at(0)).unwrap().effect, Some(Effect::Begin(_))));
    let mut gone = floor(&[BUTTON], false);
    plug(&mut gone, 0);
    gone.scan(&serial(0), WEBER, at(0)).unwrap();
    look(&mut gone, 0, false, at(0));
    assert_eq!(words(&gone), [Word::Empty], "the number goes with its board");
    let mut plugged = floor(&[PLUG], false);
    assert_eq!(plugged.scan(&serial(0), WEBER, at(0)).unwrap().effect, None);
    assert_eq!(words(&plugged), [Word::Waiting]);
    assert!(plugged.scan("HR:START", WEBER, at(0)).is_err(), "it has no button");
    assert!(matches!(plug(&mut plugged, 0), Some(Effect::Begin(_))));
}

fn begun_by(effect: Option<Effect>) -> String {
    match effect {
        Some(Effect::Begin(accepted)) => accepted.operator,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_run_is_that_of_whoever_scanned_its_number_or_pressed_its_button() {
    let mut plugged = floor(&[PLUG, SCAN], false);
    plugged.scan_for(0, &serial(0), WEBER, at(0)).unwrap();
    plug(&mut plugged, 1);
    assert_eq!(begun_by(plugged.scan_for(1, &serial(1), "braun", at(1)).unwrap().effect), "braun");
    assert_eq!(begun_by(plug(&mut plugged, 0)), WEBER);
    let mut first = floor(&[SCAN, SCAN], true);
    plug(&mut first, 1);
    first.scan(&serial(0), WEBER, at(0)).unwrap();
    assert_eq!(begun_by(first.scan_for(1, &serial(1), "braun", at(1)).unwrap().effect), "braun");
    plug(&mut first, 0);
    assert_eq!(begun_by(first.looked(&[], at(2)).remove(0).1), WEBER);
    let mut button = floor(&[BUTTON], false);
    plug(&mut button, 0);
    button.scan(&serial(0), WEBER, at(0)).unwrap();
    assert_eq!(begun_by(button.act(0, Act::Start, "braun").unwrap().effect), "braun");
}

#[test]
fn a_run_is_stopped_and_a_waiting_number_forgotten() {
    let mut floor = floor(&[Starts { button: true, ..SCAN }], false);
    assert!(floor.scan("HR:ABORT", WEBER, at(0)).is_err(), "nothing is under way");
    plug(&mut floor, 0);
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    assert_eq!(floor.act(0, Act::Abort, WEBER).unwrap().effect, Some(Effect::Stop));
    assert_eq!(words(&floor), [Word::Running], "until it has ended");
    let mut waits = self::floor(&[BUTTON], false);
    plug(&mut waits, 0);
    waits.scan(&serial(0), WEBER, at(0)).unwrap();
    let forgotten = waits.scan("HR:ABORT", WEBER, at(0)).unwrap().said;
    let said = format!("lane 1 has forgotten {}; scan its label again", serial(0));
    assert_eq!((words(&waits), forgotten.to_string()), (vec![Word::Ready], said));
}

/// An old page shows a run that is over, and a fresh one a run that ends while its button is pressed.
#[test]
fn a_button_aborts_what_its_page_showed_and_nothing_else() {
    let mut floor = floor(&[SCAN], false);
    plug(&mut floor, 0);
    let press = |floor: &mut Floor, of: &str| {
        floor.press(0, Act::Abort, of, WEBER).map(|did| did.effect).map_err(Box::new)
    };
    assert!(matches!(*press(&mut floor, "run 0").unwrap_err(), ScanError::Lane(_)), "nothing is under way");
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    assert_eq!(press(&mut floor, &serial(0)), Ok(Some(Effect::Stop)), "it is not in the store yet");
    floor.happened(0, Event::Begun { run: "run 1".to_owned() });
    for other in ["run 0", "", &serial(1)] {
        assert_eq!(press(&mut floor, other), Err(Box::new(ScanError::Late)), "{other}");
    }
    for shown in ["run 1", &serial(0)] {
        assert_eq!(press(&mut floor, shown), Ok(Some(Effect::Stop)), "{shown}");
    }
    assert_eq!(floor.scan("HR:ABORT", WEBER, at(0)).unwrap().effect, Some(Effect::Stop));
}

#[test]
fn a_product_chooses_its_plan() {
    let mut floor = floor(&[SCAN], false);
    plug(&mut floor, 0);
    let begun = floor.scan(&SERIALS[0].replace("CA", "CB"), WEBER, at(0)).unwrap();
    assert!(matches!(begun.effect, Some(Effect::Begin(accepted)) if accepted.plan == 1));
    let place = Place { name: "1".to_owned(), starts: SCAN, plans: vec![0, 1] };
    let mut both = Floor::new(vec![place], vec![rule("CAM-A", "CA"), rule("CAM-B", "C[AB]")], false);
    plug(&mut both, 0);
    assert!(matches!(both.scan(&serial(0), WEBER, at(0)), Err(ScanError::Ambiguous { .. })));
}

/// Misread labels of twelve kinds, made from a right one. The label of another board is refused where its number is known
/// (runs/identity.rs, lanes/refused.rs).
fn misread(right: &str, other: &str, place: usize) -> Vec<(&'static str, String)> {
    let digits = 2..right.len() - 1;
    let at = digits.start + place % (digits.len() - 1);
    let (head, tail) = right.split_at(at);
    let (digit, rest) = tail.split_at(1);
    let changed = (digit.parse::<u32>().unwrap() + 1 + (place / 8) as u32 % 9) % 10;
    let check = if right.ends_with('X') { "0" } else { "X" };
    let swapped = format!("{head}{}{digit}{}", &rest[..1], &rest[1..]);
    let lower = right.to_lowercase();
    vec![
        ("a digit is missing", format!("{head}{rest}")),
        ("a digit is doubled", format!("{head}{digit}{digit}{rest}")),
        ("a digit is changed", format!("{head}{changed}{rest}")),
        ("neighbours are exchanged", swapped),
        ("the check digit is wrong", format!("{}{check}", &right[..right.len() - 1])),
        ("lower case", lower),
        ("a control character", format!("{head}\u{1d}{tail}")),
        ("a blank before", format!(" {right}")),
        ("a blank behind", format!("{right} ")),
        ("two labels run together", format!("{right}{other}")),
        ("another product", right.replacen("CA", "CD", 1)),
        ("half a label", head.to_owned()),
    ]
}

/// The lane's shift ends while a serial number waits for the button: the run does not start any more.
#[test]
fn what_waits_is_forgotten_when_its_lane_owes_a_check() {
    let mut floor = floor(&[BUTTON], false);
    plug(&mut floor, 0);
    floor.scan(&serial(0), WEBER, at(0)).unwrap();
    assert_eq!(floor.lanes()[0].can(), [Act::Start, Act::Abort, Act::Out]);
    let owes =
        Owes { plan: 0, serial: Some(serial(1)), why: Said::of(&std::io::Error::other("the shift is over")) };
    floor.happened(0, Event::Owes(Some(owes)));
    assert_eq!(words(&floor), [Word::Out]);
    assert_eq!(floor.lanes()[0].can(), [Act::Out], "it is in service already, and nothing waits");
    assert!(floor.act(0, Act::Start, WEBER).is_err());
    assert_eq!(look(&mut floor, 0, true, at(1)), None);
    floor.scan(&serial(1), WEBER, at(2)).unwrap();
    assert_eq!(words(&floor), [Word::Waiting], "what is owed may wait");
    let begun = floor.act(0, Act::Start, WEBER).unwrap().effect;
    assert!(matches!(begun, Some(Effect::Begin(of)) if of.serial == serial(1)));
    assert_eq!(floor.lanes()[0].can(), [Act::Abort]);
}

/// The lane's shift ends while a board is tested, or right after its verdict.
#[test]
fn a_verdict_stays_though_its_lane_owes_a_check() {
    let why = Said::of(&std::io::Error::other("the shift is over"));
    let owed = || Event::Owes(Some(Owes { plan: 0, serial: Some(serial(1)), why: why.clone() }));
    for (verdict, word) in
        [(Verdict::Pass, Word::Pass), (Verdict::Fail, Word::Fail), (Verdict::Error, Word::Error)]
    {
        for (events, when) in [
            ([owed(), Event::Ended(shown(verdict))], "while it is tested"),
            ([Event::Ended(shown(verdict)), owed()], "behind its verdict"),
        ] {
            let mut floor = floor(&[SCAN], false);
            plug(&mut floor, 0);
            floor.scan(&serial(0), WEBER, at(0)).unwrap();
            events.into_iter().for_each(|event| drop(floor.happened(0, event)));
            assert_eq!((words(&floor)[0], floor.lanes()[0].note()), (word, Some(&why)), "{when}");
            let refused = floor.scan(&serial(2), WEBER, at(2)).unwrap_err().to_string();
            assert!(refused.contains("the shift is over"), "{refused}");
            assert_eq!((words(&floor)[0], floor.lanes()[0].shown()), (word, Some(&shown(verdict))), "{when}");
            floor.scan(&serial(1), WEBER, at(3)).unwrap();
            assert_eq!((words(&floor)[0], floor.lanes()[0].shown()), (Word::Running, None), "{when}");
        }
    }
}

#[test]
fn the_mock_is_judged_where_it_is_owed_without_a_board_and_nowhere_else() {
    let mut floor = floor(&[SCAN, BUTTON], false);
    assert!(floor.scan("HR:MOCK", WEBER, at(0)).is_err(), "no lane is named");
    let refused = floor.scan_for(0, "HR:MOCK", WEBER, at(0)).unwrap_err().to_string();
    assert!(refused.contains("no check by a mock board"), "{refused}");
    assert!(floor.scan_for(0, "HR:MOCK:1", WEBER, at(0)).is_err(), "its serial number is no barcode");
    for lane in 0..2 {
        let serial = Some(format!("HR:MOCK:{}", lane + 1));
        let owes =
            Owes { plan: 1, serial: serial.clone(), why: Said::of(&std::io::Error::other("the mock first")) };
        floor.happened(lane, Event::Owes(Some(owes)));
        let begun = floor.scan_for(lane, "HR:MOCK", WEBER, at(0)).unwrap().effect;
        let Some(Effect::Begin(of)) = begun else { panic!("{begun:?}") };
        assert_eq!((of.plan, of.product.as_str(), Some(of.serial)), (1, "CAM-B", serial));
    }
}

/// Tries every kind `times` times; the right label, scanned after each, is accepted every time.
fn misreads(times: usize) {
    let (mut refused, mut taken) = (0, 0);
    for place in 0..times {
        let (right, other) = (serial(place % SERIALS.len()), serial((place + 1) % SERIALS.len()));
        for (class, wrong) in misread(&right, &other, place) {
            let mut floor = floor(&[SCAN], false);
            plug(&mut floor, 0);
            // Exchanging two equal neighbours changes nothing.
            if wrong != right {
                let error = floor.scan(&wrong, WEBER, at(0));
                assert!(matches!(error, Err(ScanError::Serial(_))), "{class}: {wrong:?}: {error:?}");
                assert_eq!(words(&floor), [Word::Ready], "{class}");
                refused += 1;
            }
            assert!(floor.scan(&right, WEBER, at(0)).unwrap().effect.is_some(), "{right}");
            taken += 1;
        }
    }
    assert!(taken == 12 * times && refused >= 11 * times, "{refused} of {taken}");
}

#[test]
fn no_misread_label_begins_a_run_and_every_right_one_does() {
    misreads(9);
}

#[test]
#[ignore = "for scripts/soak"]
fn no_misread_label_begins_a_run_at_any_place() {
    misreads(100);
}
