//! Reports made by hand.

use halfrow::compare::Comparison;
use halfrow::frames::street::EdgeDeviation;
use halfrow::result::{
    Account, BoardKind, BoardReport, BurstsReport, Check, CheckName, Defect, Evidence, EvidenceReport,
    Finding, FrameReport, FrameTiming, Identity, LatencyReport, LinkReport, MissingRows, NotExercised,
    Outcome, Problem, Reading, Repetition, Report, RunReport, Schema, SoakChart, SoakDifference,
    SoakInterval, SoakLength, SoakReport, Streamed, StreetReport, Suspect, TablesReport,
};
use halfrow::verdict::Cause;
use halfrow_model::{BitDepth, Frame, Phase};

/// Two right frames of 1920 × 1080 on the mock board.
pub(crate) fn pass() -> Report {
    let frames: Vec<_> = [(1, "builtin:street"), (2, "builtin:noise")].map(equal_frame).into();
    Report {
        schema: Schema,
        cause: Cause::Equal,
        board: board(),
        finding: Finding::AllRight {
            frames: 2,
            samples: 4_147_200,
            latency: 972,
            board: BoardKind::Mock,
            reconnections: 0,
        },
        suspects: Vec::new(),
        checks: vec![
            check(CheckName::Judge, Outcome::Passed, judged()),
            check(CheckName::Frames, Outcome::Passed, Finding::FramesEqual { frames: 2, samples: 4_147_200 }),
        ],
        not_exercised: vec![NotExercised::Depths { bits: vec![8, 10] }],
        latency: Some(latency(2160)),
        soak: None,
        within: None,
        coverage: None,
        lacks: Vec::new(),
        street: Some(StreetReport { before: edges(41.237, 118.5), after: edges(0.214, 0.71) }),
        evidence: EvidenceReport::default(),
        link: link(),
        tables: tables(),
        run: run(),
        frames,
    }
}

/// A frame that was wrong at speed, and the suspects.
fn wrong_at_speed() -> (Finding, Vec<Suspect>) {
    let defect = Defect::SeenAtSpeed { row: Some(3), samples: 1, bits: vec![11], lost: None };
    let finding = Finding::DiffersAtSpeed {
        wrong: 1,
        frames: 2777,
        first: 17,
        repetition: Repetition::Trapped {
            frames: 18,
            row: 3,
            only_there: true,
            streamed: Streamed::NotTried,
            kept: None,
        },
        suspect: Some(Box::new(defect.clone())),
        others: 0,
        short: None,
    };
    (finding, vec![Suspect { defect, account: Account::Nothing, explained: 0.0 }])
}

/// Eight hours in which two frames differed and the board was away for a minute.
pub(crate) fn soaked() -> Report {
    let (finding, suspects) = wrong_at_speed();
    let (seed, generation) = (0x08d1_2e6a, 2);
    let difference = |seconds| {
        let (finding, suspects) = (finding.clone(), suspects.clone());
        SoakDifference { seconds, seed, generation, finding, suspects }
    };
    let interval = |index| SoakInterval {
        frames: if index == 100 { 0 } else { 5924 },
        wrong: u64::from(index == 62 || index == 200),
        miscounted: 0,
    };
    let soak = SoakReport {
        asked: SoakLength::Time { seconds: 28_800.0 },
        seconds: 28_800.5,
        idle_seconds: 0.0,
        bursts: 480,
        frames: 1_326_976,
        wrong: 2,
        miscounted: 0,
        paused: 0,
        held_back: 0,
        differences: vec![difference(7980.5), difference(25_700.0)],
        differing_bursts: 2,
        ended: None,
        chart: SoakChart { interval_seconds: 128.0, intervals: (0..225).map(interval).collect() },
    };
    Report {
        cause: Cause::Different,
        finding,
        suspects,
        soak: Some(soak),
        not_exercised: Vec::new(),
        ..pass()
    }
}

/// Row 3 of the second frame is wrong; the frames are 64 × 40.
pub(crate) fn fail() -> (Report, Vec<Evidence>) {
    let (input, expected) =
        (frame(|row, column| row * 64 + column), frame(|row, column| row * 64 + column + 1));
    let found = frame(|row, column| row * 64 + column + if row == 3 && column < 5 { 17 } else { 1 });
    let mut second = equal_frame((2, "frames/<script>alert(1)</script>&.pgm"));
    second.comparison = Comparison::of_frames(&expected, &found);
    second.rows = 40;
    let reading =
        Reading { uploaded: 16_000_000, read: 16_000_016, generation: 2, only: false, alike: Vec::new() };
    let defect = Defect::RowFactorBitWrong { row: 3, bit: 4, reading, above_one: false };
    let account = Account::Samples { differing: 5, explained: 5, contradicted: 0, others: 0, set_in: false };
    let finding = Finding::SamplesDiffer {
        differences: 5,
        samples: 2_076_160,
        differing_frames: 1,
        frames: 2,
        tried: None,
        others: 0,
        short: None,
        suspect: Some(Box::new(defect.clone())),
    };
    let report = Report {
        cause: Cause::Different,
        finding: finding.clone(),
        suspects: vec![Suspect { defect, account, explained: 1.0 }],
        checks: vec![
            check(CheckName::Judge, Outcome::Passed, judged()),
            check(CheckName::Frames, Outcome::Failed, finding),
            check(CheckName::Counters, Outcome::Skipped, Finding::NotReached {}),
        ],
        frames: vec![equal_frame((1, "builtin:street")), second],
        not_exercised: Vec::new(),
        ..pass()
    };
    (report, vec![Evidence { index: 1, input, found, expected, missing: MissingRows::default() }])
}

/// The board never answered.
pub(crate) fn error() -> Report {
    Report {
        cause: Cause::Station,
        board: BoardReport {
            kind: BoardKind::Hardware,
            target: "serial:/dev/ttyUSB1".to_owned(),
            identity: None,
        },
        finding: silent(),
        checks: vec![
            check(CheckName::Identity, Outcome::Error, silent()),
            check(CheckName::Frames, Outcome::Skipped, Finding::NotReached {}),
        ],
        frames: Vec::new(),
        not_exercised: Vec::new(),
        latency: None,
        street: None,
        ..pass()
    }
}

/// A frame of 64 × 40, 12 bits.
pub(crate) fn frame(sample: impl Fn(usize, usize) -> usize) -> Frame {
    sized_frame(64, 40, sample)
}

pub(crate) fn sized_frame(width: usize, height: usize, sample: impl Fn(usize, usize) -> usize) -> Frame {
    let samples = (0..width * height).map(|place| (sample(place / width, place % width) & 0xfff) as u16);
    Frame::new(width, BitDepth::Twelve, Phase::Grbg, samples.collect()).unwrap()
}

fn silent() -> Finding {
    let problem = Problem::new("no-answer", "no answer within 2 s");
    Problem { remedy: Some("Check cable and power.".to_owned()), ..problem }.into()
}

fn judged() -> Finding {
    Finding::GoldenSamplesFound { samples: 4_147_328, path: "scalar".to_owned() }
}

fn check(name: CheckName, outcome: Outcome, finding: Finding) -> Check {
    Check { name, outcome, finding, seconds: 0.125 }
}

pub(crate) fn equal_frame((number, name): (u16, &str)) -> FrameReport {
    FrameReport {
        name: name.to_owned(),
        number,
        sha256: "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08".to_owned(),
        phase: Phase::Grbg,
        generation: 2,
        timing: FrameTiming::LeastBlanking { clocks: 0 },
        variation: None,
        first_rows: None,
        comparison: Comparison { samples: 1920 * 1080, ..Comparison::new(1920, 1080) },
        rows: 1080,
        missing: MissingRows::default(),
        seconds: 0.75,
    }
}

fn board() -> BoardReport {
    let identity = Identity {
        name: "mock".to_owned(),
        serial: "000000000000002a".to_owned(),
        build: "0badcafe".to_owned(),
        protocol: 1,
        datapath: 1,
        max_width: 2592,
        max_height: 2048,
        depths: vec![8, 10, 12],
        taps: 7,
        latency: 12,
        ring: 4096,
        least_blanking: 0,
        table_banks: 2,
        row_banks_in: 4,
        row_banks_out: 4,
        clock_hz: 0,
        bursts: Some(BurstsReport { content: 1, records: 64, least_frame_blanking: 0, trap: true }),
        entered: true,
        grids: None,
    };
    BoardReport { kind: BoardKind::Mock, target: "mock,fault=flip".to_owned(), identity: Some(identity) }
}

/// Of 1920 columns: D = 960 + 12.
pub(crate) fn latency(rows: usize) -> LatencyReport {
    LatencyReport { claimed: 972, limit: 992, least: 972, most: 972, rows, wrong_rows: 0 }
}

fn edges(mean_px: f64, max_px: f64) -> EdgeDeviation {
    EdgeDeviation { edges: 9, mean_px, max_px }
}

fn link() -> LinkReport {
    LinkReport {
        name: "mock".to_owned(),
        bytes_out: 6_300_000,
        bytes_in: 6_400_000,
        packets_out: 2200,
        packets_in: 2240,
        retry_limit: 30,
        round_trip_us: Some(8),
        seconds: 0.5,
        ..LinkReport::default()
    }
}

fn tables() -> TablesReport {
    TablesReport {
        source: "equidistant lens, R = 1106.697 px, hermite".to_owned(),
        width: 1920,
        height: 1080,
        bits: 12,
        centre2: 1919,
        rows_outside_circle: Some(0),
        tables_crc32: "5f5a7553".to_owned(),
        kernel_crc32: "16e29b0f".to_owned(),
    }
}

fn run() -> RunReport {
    RunReport {
        version: "0.1.0".to_owned(),
        commit: "252ffed".to_owned(),
        arguments: ["halfrow", "verify", "--frame", "my frames/a.pgm"].map(str::to_owned).into(),
        seed: 7,
        started: "2026-11-21T02:03:04Z".to_owned(),
        ended: "2026-11-21T02:03:06Z".to_owned(),
        seconds: 1.94,
        host: "bench-3".to_owned(),
        operator: Some("Ada Weber".to_owned()),
        files: Vec::new(),
    }
}
