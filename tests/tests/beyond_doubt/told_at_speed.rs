//! What is told of frames that a board makes on its own: no more than was seen of them.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use halfrow::link;
use halfrow::progress::Event;
use halfrow::report;
use halfrow::result::{
    BurstCount, Check, CheckName, Defect, Finding, MadeAs, NotExercised, Outcome, Repetition, Report,
    SoakLength, Suspect,
};
use halfrow::run::{AtSpeed, Part, Plan, RunOptions, Selection, verify};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::{FrameRecord, TrappedRow};
use halfrow_protocol::{Kind, Reply, Request};
use halfrow_tests::altered::{Altered, Passing, Toward, judge_each};
use halfrow_tests::system::{System, judge_by_plan};

/// A board of which `change` makes another first record of its burst number `which`, from 1.
fn with_record(which: usize, change: fn(&mut FrameRecord)) -> impl FnMut(Toward, Passing) -> Passing + Send {
    let (mut names, mut is_done) = (Vec::new(), false);
    move |toward, packet| {
        if let (Toward::Board, Some(Request::Burst(burst))) = (toward, packet.request())
            && !names.contains(&burst.burst)
        {
            names.push(burst.burst);
        }
        if toward == Toward::Board || names.len() != which || is_done {
            return packet;
        }
        packet.with_records(|_, records| {
            records.iter_mut().take(1).for_each(|record| {
                change(record);
                is_done = true;
            });
        })
    }
}

/// The signature says that every sample is right, so that no path has failed.
#[test]
fn a_clock_too_many_casts_no_suspicion_on_samples_that_are_right() {
    let judged = |which| judge_each(&System::TINY, with_record(which, |record| record.most_latency += 1));
    let late = |finding: &Finding| {
        matches!(finding, Finding::MiscountedAtSpeed { frame: 0, count: BurstCount::MostLatency, .. })
    };
    let burst = judged(1);
    assert!(burst.verdict() == Verdict::Fail && late(&burst.finding), "{}", burst.headline());
    let corner = judged(2);
    let is_told = matches!(&corner.finding, Finding::InCorner { found, .. } if late(found));
    assert!(corner.verdict() == Verdict::Fail && is_told, "{}", corner.headline());
    for report in [burst, corner] {
        assert!(report.suspects.is_empty(), "{:?}", report.suspects);
        let remedy = report.remedy().unwrap_or_default();
        assert!(remedy.contains("its samples are right") && remedy.contains("the output paused"), "{remedy}");
    }
}

/// docs/full-speed.md: if the row is right when streamed, the suspect is a path that fails at the full pixel clock. A row of few
/// differing samples, or one with a whole bit inverted, has other explanations as well, which the streamed frame refutes.
#[test]
fn what_the_streamed_frame_refutes_is_no_suspect() {
    for fault in ["warm-bit,after=0,row=5,bit=0", "slow-path,bit=0,one-in=1", "slow-path,bit=5,one-in=2"] {
        let report = System::TINY.judge(&format!(",fault={fault}"));
        assert!(report.headline().contains("the same frame is right"), "{fault}: {}", report.headline());
        let defects: Vec<_> = report.suspects.iter().map(|suspect| &suspect.defect).collect();
        assert!(matches!(defects[..], [Defect::OnlyAtSpeed { .. }]), "{fault}: {defects:?}");
    }
}

/// The mock is warm when the rules are tried: after frames at speed, and before the session that follows a burst, in which both
/// frames of a burst are then wrong, and a rule may be as well.
#[test]
fn signatures_alone_are_told_as_what_speed_or_a_broken_rule_makes_wrong() {
    let report = System::TINY.judge(",fault=warm-bit,after=60");
    let (headline, technician) = (report.headline(), report.technician().unwrap_or_default());
    assert_eq!(report.finding.code(), "rule-broken", "{headline}");
    let told = "it gave another signature for 2 frames, the first is frame 0, and was right in all else (rule: a greeting must";
    assert!(headline.contains(told), "{headline}");
    assert!(technician.starts_with("Switch the board off and on, "), "{technician}");
    let remedy = report.remedy().unwrap_or_default();
    assert!(remedy.starts_with("Check the timing of the datapath at this clock"), "{remedy}");
    assert!([technician, remedy].iter().all(|asked| asked.contains(" names the same rule, ")));
}

/// Only frames at speed have such a row.
#[test]
fn a_row_that_is_lost_when_the_frame_is_streamed_is_told() {
    let report = System::TINY.judge(",fault=lost-row,row=20");
    let headline = report.headline();
    assert!(
        headline.contains("; sent row by row, row 20 of it did not come back; the suspect is"),
        "{headline}"
    );
}

/// The mock flips this bit of the row's first output.
#[test]
fn the_row_that_was_kept_is_told_with_its_samples() {
    let report = System::TINY.judge(",fault=warm-bit,after=1,row=7,bit=11");
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let told: serde_json::Value = serde_json::from_str(&report::json(&report).unwrap()).unwrap();
    let kept = &told["finding"]["parameters"]["repetition"]["kept"];
    assert_eq!(
        (&kept["differences"], kept["first"].as_array().map(Vec::len)),
        (&1.into(), Some(1)),
        "{kept}"
    );
    let sample = &kept["first"][0];
    assert_eq!((&sample["row"], &sample["column"]), (&7.into(), &0.into()), "{kept}");
    let [expected, found] = ["expected", "found"].map(|name| sample[name].as_u64().unwrap());
    assert_eq!(expected ^ found, 1 << 11, "{kept}");
    let page = report::html(&report, &[]).unwrap();
    let (_, section) = page.split_once("<h2>Row kept at speed</h2>").unwrap_or_else(|| panic!("{page}"));
    let row = format!(
        "<td class=\"number\">0</td><td class=\"number\">{expected}</td><td class=\"number\">{found}</td>"
    );
    assert!(section.starts_with("<p>Row 7 of frame ") && section.contains(&row), "{section}");
}

/// It takes another seed than it is given, and says another signature of the row that it keeps than that has.
#[test]
fn a_row_that_was_kept_under_another_signature_shows_nothing() {
    let report = judge_each(&System::TINY, |toward, mut packet| {
        if toward == Toward::Board && packet.is(Kind::Burst) {
            // WIRE.md, BURST: burst, frames, seed.
            packet.payload[8] ^= 1;
        }
        match packet.reply() {
            Some(Reply::Trap(Some(kept))) => {
                packet.saying(&Reply::Trap(Some(TrappedRow { signature: !kept.signature, ..kept })))
            }
            _ => packet,
        }
    });
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let Finding::DiffersAtSpeed { repetition, .. } = report.finding else { panic!("{}", report.headline()) };
    assert!(matches!(repetition, Repetition::NothingTrapped { .. }), "{repetition:?}");
}

/// The report on a board that keeps a row with right samples under another signature, which is why it kept it.
fn signed_otherwise() -> Report {
    judge_each(&System::TINY, move |toward, mut packet| {
        if toward == Toward::Board && packet.is(Kind::Expect) {
            // The last bytes are the signature of the last row: the board then differs in a row that is right.
            packet.payload.iter_mut().rev().take(4).for_each(|byte| *byte ^= 0xff);
        }
        match packet.reply() {
            Some(Reply::Records(_)) if toward == Toward::Host => {
                packet.with_records(|_, records| records.iter_mut().for_each(|record| record.signature ^= 1))
            }
            Some(Reply::Trap(Some(kept))) => {
                packet.saying(&Reply::Trap(Some(TrappedRow { signature: !kept.signature, ..kept })))
            }
            _ => packet,
        }
    })
}

#[test]
fn a_right_row_under_another_signature_shows_that_it_is_signed_wrongly() {
    let report = signed_otherwise();
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let Finding::DiffersAtSpeed { repetition, .. } = &report.finding else { panic!("{}", report.headline()) };
    // The row whose expected signature was spoilt.
    let row = System::TINY.height - 1;
    assert!(
        matches!(repetition, Repetition::SignedWrong { row: kept, .. } if *kept == row),
        "{repetition:?}"
    );
    assert_eq!(report.suspects[0].defect, Defect::SignatureWrong { row });
    assert!(report.headline().contains("signature is not their CRC"), "{}", report.headline());
}

/// The report on a board whose records of a burst each hold the signature of the frame before.
fn with_signatures_of_frames_before() -> Report {
    let mut last = (0, 0);
    judge_each(&System::TINY, move |_, packet| {
        packet.with_records(|from, records| {
            for (n, record) in (from..).zip(records) {
                let own = record.signature;
                if n > 0 && last.0 == n - 1 {
                    record.signature = last.1;
                }
                last = (n, own);
            }
        })
    })
}

#[test]
fn records_of_the_frames_before_are_known_by_their_signatures() {
    let report = with_signatures_of_frames_before();
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert_eq!(report.suspects[0].defect, Defect::RecordsLate {}, "{}", report.headline());
}

/// Content is a function of the seed, so a board that is given another makes what one makes that keeps only a part of it.
#[test]
fn a_row_of_another_content_that_is_corrected_rightly_is_no_matter_of_timing() {
    let report = judge_each(&System::TINY, |toward, mut packet| {
        if toward == Toward::Board && packet.is(Kind::Burst) {
            // WIRE.md, BURST: the upper half of the seed.
            packet.payload[10..12].fill(0);
        }
        packet
    });
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let [Suspect { defect: Defect::ContentWrong { made, .. }, .. }] = &report.suspects[..] else {
        panic!("{:?}", report.suspects)
    };
    assert_eq!(*made, MadeAs::SeedOf { bits: 16 });
    assert!(report.headline().contains("the generator of the content at speed"), "{}", report.headline());
}

/// What a PASS by the first row of a frame and by three frames at speed, with or without a pause in one of them, leaves of the table.
fn unused_lines(pauses: bool) -> (Report, bool) {
    let change = if pauses { |record: &mut FrameRecord| record.pauses = 7 } else { |_: &mut FrameRecord| {} };
    let mut alter = with_record(1, change);
    let selection = Selection::least().with(Part::AtSpeed, 3);
    let plan =
        Plan { selection: Some(selection), fail_fast: false, ..System { height: 16, ..System::TINY }.plan() };
    let board = Altered::new(&Options::default(), move |toward, packet| vec![alter(toward, packet)]);
    let report = judge_by_plan(&plan, board.candidate());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let is_unused =
        |part: &NotExercised| matches!(part, NotExercised::RowTableAddress { lines } if lines.contains(&0));
    let is_told = report.not_exercised.iter().any(is_unused);
    (report, is_told)
}

#[test]
fn frames_with_pauses_put_nothing_to_the_test_that_streamed_rows_did_not() {
    let (report, unused) = unused_lines(false);
    assert!(!unused, "{:?}", report.not_exercised);
    let (report, unused) = unused_lines(true);
    assert!(unused, "{:?}", report.not_exercised);
}

/// The report on a soak of 3000 frames in which `change` makes another first record of the second burst.
fn soaked_with_record(change: fn(&mut FrameRecord)) -> Report {
    let mut alter = with_record(2, change);
    // Bursts of a minute have 1153 frames: (64·8 + 8) clocks each.
    let slow = Options { pixel_clock: 10_000, ..Options::default() };
    let board = Altered::new(&slow, move |toward, packet| vec![alter(toward, packet)]);
    let soak = AtSpeed::Soak(SoakLength::Frames { frames: 3000 });
    let report =
        judge_by_plan(&Plan { at_speed: soak, fail_fast: false, ..System::TINY.plan() }, board.candidate());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    report
}

fn at_speed(report: &Report) -> &Check {
    report.checks.iter().find(|check| check.name == CheckName::AtSpeed).unwrap()
}

#[test]
fn a_soak_with_a_pause_was_none_at_full_speed() {
    let report = soaked_with_record(|record| record.pauses = 7);
    let check = at_speed(&report);
    assert_eq!(check.outcome, Outcome::Skipped, "{}", check.detail());
    assert!(
        matches!(check.finding, Finding::PausedAtSpeed { frames: 3000, paused: 1 }),
        "{}",
        check.detail()
    );
    assert!(report.not_exercised.contains(&NotExercised::FullSpeed {}));
}

#[test]
fn a_soak_says_how_many_of_its_frames_waited_for_the_host() {
    let waited = |change| {
        let report = soaked_with_record(change);
        let waited = report.soak.as_ref().unwrap().held_back;
        let said = at_speed(&report).detail();
        assert!(waited == 0 || said.contains(&format!("; {waited} of them waited until")), "{said}");
        waited
    };
    // The first frame of a burst waits for none.
    assert_eq!(waited(|record| record.held_back = true), waited(|_| {}) + 1);
}

/// Only a burst with the trap set keeps a row of what does not happen again, and the first one has none.
#[test]
fn a_soak_suspects_what_a_later_burst_has_shown_of_a_row() {
    let target = "mock,pixel-clock=10000,fault=slow-path,one-in=300000".parse().unwrap();
    let soak = AtSpeed::Soak(SoakLength::Frames { frames: 4000 });
    let plan = Plan { at_speed: soak, fail_fast: false, ..System::TINY.plan() };
    let report = judge_by_plan(&plan, link::open(&target).unwrap());
    let names_row = |suspects: &[Suspect]| {
        suspects.iter().any(|it| matches!(it.defect, Defect::SeenAtSpeed { row: Some(_), .. }))
    };
    let [first, later @ ..] = &report.soak.as_ref().unwrap().differences[..] else { panic!("it differs") };
    assert!(first.seconds < 60.0 && !names_row(&first.suspects), "{first:?}");
    let shown = later.iter().find(|later| names_row(&later.suspects)).unwrap();
    assert_eq!(report.suspects, shown.suspects, "{}", report.headline());
}

/// A board closes a session in which it hears nothing for 10 s (AT-SPEED.md, *Ends*), and a slow host may take 60 ms for a frame.
#[test]
fn a_host_that_has_many_records_to_judge_does_not_fall_silent() {
    let asked = Arc::new(Mutex::new(Vec::new()));
    let seen = Arc::clone(&asked);
    let options = Options { records: 1024, ..Options::default() };
    let board = Altered::new(&options, move |toward, packet: Passing| {
        if let (Toward::Board, Some(Request::Records { from })) = (toward, packet.request()) {
            seen.lock().unwrap().push(from);
        }
        vec![packet]
    });
    // At 96 MHz they are 369 frames of 520 clocks, and a reply has room for 226 records.
    let selection = Some(Selection::least().with(Part::AtSpeed, 1000));
    let at_speed = AtSpeed::For(Duration::from_millis(2));
    let report = judge_by_plan(&Plan { at_speed, selection, ..System::TINY.plan() }, board.candidate());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let asked = asked.lock().unwrap();
    let most = asked.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).max();
    assert!(most.is_some_and(|most| most <= 100), "{asked:?}");
}

/// Every frame of this board has a row that pauses for a clock, which its record says and its signature does not.
#[test]
fn frames_with_wrong_counts_are_told_as_wrong_while_they_are_judged() {
    let told_wrong = AtomicU64::new(0);
    let told = |event: Event| {
        if let Event::Soaked(soaked) = event {
            told_wrong.store(soaked.wrong, Ordering::Relaxed);
        }
    };
    let at_speed = AtSpeed::Soak(SoakLength::Frames { frames: 100 });
    let plan = Plan { at_speed, fail_fast: false, ..System::TINY.plan() };
    let board = link::open(&"mock,fault=hidden-pause".parse().unwrap()).unwrap();
    let report = verify(&plan, board, &RunOptions::default(), &told).unwrap().report;
    assert_eq!(report.soak.unwrap().miscounted, 100);
    assert_eq!(told_wrong.into_inner(), 100);
}
