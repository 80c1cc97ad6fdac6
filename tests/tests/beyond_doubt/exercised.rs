//! A PASS names what it did not test, line by line: a fault there goes unseen, and a fault anywhere else does not.

use halfrow::result::{CheckName, Finding, NotExercised, SoakLength};
use halfrow::run::{AtSpeed, Build, Part, Plan, Selection, Vary};
use halfrow::verdict::Verdict;
use halfrow_model::{BitDepth, Camera, Equidistant, Geometry, GridShape};
use halfrow_tests::system::{System, judge_by_plan, open, streamed};

/// A system that uses few of the board's lines: eight address its columns, and seven are enough to tell the samples in the line
/// memory apart.
const SYSTEM: System = System { width: 160, height: 16, radius: 17.0, board: "mock", ring: 2048 };

/// The plan of `SYSTEM` with frames of 8 bits.
fn eight_bits() -> Plan {
    let plan = SYSTEM.plan();
    let centre2 = plan.tables.geometry().centre2();
    Plan { tables: plan.tables.with_settings(BitDepth::Eight, centre2).unwrap(), ..plan }
}

#[test]
fn a_stuck_address_line_goes_unseen_exactly_where_the_pass_names_it() {
    let unseen = unseen_address_lines(&streamed(SYSTEM.plan()));
    assert_eq!(unseen, [7, 8, 9, 10]);
    assert!(unseen_address_lines(&SYSTEM.plan()).is_empty());
}

/// The lines of the line memory that a PASS names. Each of them goes unseen by this plan when it is stuck, and no other does.
fn unseen_address_lines(plan: &Plan) -> Vec<usize> {
    let sound = judge_by_plan(plan, open("mock"));
    let named = |line: usize| {
        let names = |part: &NotExercised| match part {
            NotExercised::LineMemoryAddress { lines } => lines.contains(&line),
            _ => false,
        };
        sound.not_exercised.iter().any(names)
    };
    for line in 0..11 {
        for value in 0..2 {
            let fault = format!("mock,fault=stuck-address,bit={line},value={value}");
            let verdict = judge_by_plan(plan, open(&fault)).verdict();
            let expected = if named(line) { Verdict::Pass } else { Verdict::Fail };
            assert_eq!(verdict, expected, "line {line} at {value}");
        }
    }
    (0..11).filter(|&line| named(line)).collect()
}

#[test]
fn a_wrong_node_goes_unseen_exactly_where_the_pass_names_it() {
    // A lens that hardly stretches.
    let plan = streamed(System { radius: 2000.0, ..SYSTEM }.plan());
    let sound = judge_by_plan(&plan, open("mock"));
    let named = |node: usize| {
        let names = |part: &NotExercised| match part {
            NotExercised::KernelNodes { nodes } => nodes.contains(&node),
            _ => false,
        };
        sound.not_exercised.iter().any(names)
    };
    for node in [0, 1, 2, 3, 30, 31, 32, 33, 34, 62, 63, 64] {
        // A high bit of a stored weight; hidden, so that the host reads the node right.
        let fault = format!("mock,fault=kernel-word,node={node},weight=g4,bit=13,hidden=true");
        let expected = if named(node) { Verdict::Pass } else { Verdict::Fail };
        assert_eq!(
            judge_by_plan(&plan, open(&fault)).verdict(),
            expected,
            "node {node}: {:?}",
            sound.not_exercised
        );
    }
    assert!(named(3) && !named(0), "{:?}", sound.not_exercised);
}

#[test]
fn what_hides_behind_a_depth_is_named_and_found_where_the_depth_varies() {
    let stuck = "mock,fault=stuck-data,bit=9,value=0";
    let (fixed, vary) = (streamed(eight_bits()), Vary { centre: false, depth: true });
    let unseen = judge_by_plan(&fixed, open(stuck));
    assert_eq!(unseen.verdict(), Verdict::Pass);
    let bits = NotExercised::InputBits { bits: vec![8, 9, 10, 11] };
    assert!(unseen.not_exercised.contains(&bits), "{:?}", unseen.not_exercised);
    assert!(unseen.not_exercised.contains(&NotExercised::Depths { bits: vec![10, 12] }));
    let seen = judge_by_plan(&fixed.clone().varying(vary), open(stuck));
    assert_eq!((seen.verdict(), &seen.not_exercised[..]), (Verdict::Fail, &[][..]), "{}", seen.headline());
    assert_eq!(seen.suspects[0].place(), "line memory, data bit 9 stuck at 0");
    let sound = judge_by_plan(&fixed.varying(vary), open("mock"));
    assert_eq!(sound.verdict(), Verdict::Pass, "{}", sound.headline());
    assert!(!sound.not_exercised.contains(&bits));
}

/// C is 159, 1001 1111, in all frames but one, where it is 96, 0110 0000. 318, the most that it can be, has nine bits.
#[test]
fn a_stuck_bit_of_the_centre_goes_unseen_exactly_where_the_pass_names_it() {
    let plan = streamed(SYSTEM.plan()).varying(Vary { centre: true, depth: false });
    let sound = judge_by_plan(&plan, open("mock"));
    let named = NotExercised::CentreBits { bits: (8..12).collect() };
    assert!(sound.not_exercised.contains(&named), "{:?}", sound.not_exercised);
    let verdict = |bit: u32, value: u32| {
        judge_by_plan(&plan, open(&format!("mock,fault=stuck-centre,bit={bit},value={value}"))).verdict()
    };
    for bit in 0..8 {
        assert_eq!([verdict(bit, 0), verdict(bit, 1)], [Verdict::Fail; 2], "bit {bit}");
    }
    assert!((8..12).all(|bit| verdict(bit, 0) == Verdict::Pass));
}

/// A lens so weak that the low bits of the centre change no sample, and one so weak that none does.
#[test]
fn a_centre_that_changes_nothing_was_not_exercised() {
    let vary = Vary { centre: true, depth: false };
    for (radius, some_show) in [(3000.0, true), (1e6, false)] {
        let plan = streamed(System { radius, ..SYSTEM }.plan()).varying(vary);
        let sound = judge_by_plan(&plan, open("mock"));
        let named = sound.not_exercised.iter().find_map(|part| match part {
            NotExercised::CentreBits { bits } => Some(bits),
            _ => None,
        });
        let named = named.unwrap();
        let is_seen = |bit: usize, value: u32| {
            let fault = format!("mock,fault=stuck-centre,bit={bit},value={value}");
            judge_by_plan(&plan, open(&fault)).verdict() == Verdict::Fail
        };
        for bit in 0..9 {
            assert_eq!(named.contains(&bit), !(is_seen(bit, 0) && is_seen(bit, 1)), "bit {bit} of {radius}");
        }
        let ignoring = judge_by_plan(&plan, open("mock,fault=centre-ignored")).verdict();
        assert_eq!(ignoring, if some_show { Verdict::Fail } else { Verdict::Pass }, "{radius}: {named:?}");
        assert_eq!(named.len() < 12, some_show, "{radius}: {named:?}");
    }
}

#[test]
fn a_board_that_ignores_the_centre_is_found_where_the_centre_varies() {
    let (plan, ignoring) = (streamed(SYSTEM.plan()), "mock,fault=centre-ignored");
    let unseen = judge_by_plan(&plan, open(ignoring));
    assert_eq!(unseen.verdict(), Verdict::Pass);
    assert!(unseen.not_exercised.contains(&NotExercised::OneCentre { centre2: 159 }));
    let varying = plan.varying(Vary { centre: true, depth: false });
    let seen = judge_by_plan(&varying, open(ignoring));
    assert_eq!(seen.verdict(), Verdict::Fail, "{}", seen.headline());
    let differing: Vec<_> = seen
        .frames
        .iter()
        .filter(|frame| frame.comparison.differences > 0)
        .map(|frame| frame.variation)
        .collect();
    assert!(matches!(differing[..], [Some(_)]), "{differing:?}");
    assert_eq!(judge_by_plan(&varying, open("mock")).verdict(), Verdict::Pass);
}

/// The board makes its clock with its PLL, and names 1 Hz, at which 6 frames of (64·8 + 8) clocks take 52 minutes.
#[test]
fn a_clock_that_a_soak_does_not_measure_is_named_and_tells_no_time() {
    let soak = AtSpeed::Soak(SoakLength::Frames { frames: 6 });
    let plan = Plan { at_speed: soak, fail_fast: false, ..System::TINY.plan() };
    let report = judge_by_plan(&plan, open("mock,fault=wrong-clock-claim"));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(report.not_exercised.contains(&NotExercised::UnseenClock { clock_hz: 1 }), "{report:?}");
    let at_speed = report.checks.iter().find(|check| check.name == CheckName::AtSpeed).unwrap();
    let Finding::EqualAtSpeed(equal) = at_speed.finding else { panic!("{}", at_speed.detail()) };
    assert_eq!((equal.frames, equal.clock_hz, equal.seconds), (6, 1, None));
}

/// The plan of a grid whose rows are so narrow that they need blanking.
fn through_narrow_grid() -> Plan {
    let geometry = Geometry::centred(64, 16, BitDepth::Twelve).unwrap();
    let lens = Equidistant::from_radius(60.0).unwrap();
    let camera = Camera::new(geometry, lens.into(), (31.5, 7.5), 180.0).unwrap();
    let tables = camera.grid_by_formula(GridShape::new(2, 5).unwrap());
    Plan::new(tables, System::TINY.plan().kernel).seen_through(lens)
}

/// No bank changes in a burst of one frame, and behind a weak lens the tables of both banks make the same samples.
#[test]
fn a_late_change_of_tables_goes_unseen_exactly_where_the_pass_names_it() {
    let without_corners = |plan: Plan| {
        let parts = plan.parts(&Build::full(2048)).into_iter().filter(|part| *part != Part::Corners);
        Plan { selection: Some(Selection::all(parts)), ..plan }
    };
    let (strong, weak) = (System::TINY, System { radius: 100_000.0, ..System::TINY });
    let soaked = |plan: Plan, frames| Plan { at_speed: AtSpeed::Soak(SoakLength::Frames { frames }), ..plan };
    let cases = [
        (soaked(strong.plan(), 1), true),
        (soaked(strong.plan(), 2), false),
        (soaked(weak.plan(), 20), true),
        (soaked(through_narrow_grid(), 2), false),
        (strong.plan(), false),
        (without_corners(strong.plan()), false),
        (weak.plan(), false),
        (without_corners(weak.plan()), true),
    ];
    for (place, (plan, is_unseen)) in cases.into_iter().enumerate() {
        let sound = judge_by_plan(&plan, open("mock"));
        assert_eq!(sound.verdict(), Verdict::Pass, "{place}: {}", sound.headline());
        let names_it = sound.not_exercised.contains(&NotExercised::TableChangeAtSpeed {});
        assert_eq!(names_it, is_unseen, "{place}: {:?}", sound.not_exercised);
        let late = judge_by_plan(&plan, open("mock,fault=late-swap"));
        assert_eq!(late.verdict() == Verdict::Pass, is_unseen, "{place}: {}", late.headline());
    }
}
