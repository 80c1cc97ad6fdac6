//! The Verilog against model and mock, the core alone and the whole board: every sample and every latency.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use halfrow::link::{Link, WireLink};
use halfrow_mock::{Depth, Settings};
use halfrow_model::{Equidistant, Frame, Geometry, Interpolant, Kernel, TableSet};
use halfrow_pipe::{Endpoint, Pipe, PipeOptions};
use halfrow_sim::{Board, Core, CoreBuild, Front};
use halfrow_tests::cases::{Build, Case, Played};
use halfrow_tests::dice::Dice;
use halfrow_tests::photographs::{self, filled};
use halfrow_tests::simulated_core;
use halfrow_tests::whole_board::{self, WholeBoard};

/// Plays so many cases on each build of the core.
#[allow(clippy::print_stdout)]
fn cores_agree(cases: u64) {
    let mut counts = BTreeMap::new();
    for core_build in CoreBuild::ALL {
        let mut core = Core::new(core_build, 1);
        let (mut samples, mut rows) = (0, 0);
        for seed in 0..cases {
            let mut dice = Dice::new(seed);
            let case = Case::draw(&mut dice, simulated_core::build(core_build), 3);
            let played = simulated_core::play(&mut core, &case, &mut dice);
            let expected = case.expected();
            assert!(played == expected, "{core_build:?}, case {seed}: {}", difference(&played, &expected));
            assert!(case.play_on_mock() == expected, "the mock on case {seed}");
            samples += played.samples.len();
            rows += played.latencies.len() / 2;
        }
        counts.insert(format!("{core_build:?}"), (cases, rows, samples));
    }
    println!("model, mock and Verilog agree; cases, rows, samples: {counts:?}");
}

fn link<B: Endpoint<Failure: Send + Sync> + Send + 'static>(board: B) -> Box<dyn Link> {
    Box::new(WireLink::new(Pipe::new(board, PipeOptions::default(), None), "the board", false))
}

/// Plays a case on a simulated board, and on a mock of the same build.
fn board_agrees(verilog: &mut WholeBoard, case: &Case, name: &str) -> Played {
    let mut mock = WholeBoard::open(link(halfrow_mock::Board::new(&case.options, None).unwrap()));
    let (played, expected) = (verilog.play(case), whole_board::expected(case));
    assert!(played == expected, "{name}: {}", difference(&played, &expected));
    assert!(mock.play(case) == expected, "the mock on {name}");
    played
}

/// Plays so many cases on a simulated board, all in one session.
#[allow(clippy::print_stdout)]
fn boards_agree(front: Front, cases: u64) {
    let mut verilog = WholeBoard::open(link(Board::new(front, 1)));
    let build = verilog.build();
    let (mut samples, mut rows) = (0, 0);
    for seed in 0..cases {
        let case = Case::draw(&mut Dice::new(seed), build, 2);
        let played = board_agrees(&mut verilog, &case, &format!("{front:?}, case {seed}"));
        samples += played.samples.len();
        rows += played.latencies.len() / 2;
    }
    println!("model, mock and {front:?} agree: {cases} cases, {rows} rows, {samples} samples");
}

/// Two photographs at the paper's size, the second under other tables and another kernel.
fn photograph_case(build: Build, first: Frame, second: Frame, geometry: Geometry) -> Case {
    let tables = TableSet::from_lens(geometry, &Equidistant::default(), None).unwrap();
    let reversed: Vec<_> = tables.units().rev().collect();
    let narrower: Vec<_> = reversed.iter().map(|units| units - units / 16).collect();
    let narrower = TableSet::from_units(geometry, &narrower).unwrap();
    let [hermite, keys] = [Interpolant::Hermite, Interpolant::Keys].map(Kernel::from);
    let drawn = Case::draw(&mut Dice::new(0), build, 0);
    let settings = Settings {
        width: geometry.width() as u16,
        height: geometry.height() as u16,
        centre2: geometry.centre2() as u16,
        depth: Depth::Twelve,
        blanking: 0,
        gap_seed: 0,
    };
    Case { settings, frames: vec![(tables, hermite, first), (narrower, keys, second)], ..drawn }
}

fn difference(found: &Played, expected: &Played) -> String {
    let first = |a: &[u16], b: &[u16]| a.iter().zip(b).position(|(a, b)| a != b);
    format!(
        "{} of {} samples, the first that differs is {:?}; {} of {} latencies, {:?}",
        found.samples.len(),
        expected.samples.len(),
        first(&found.samples, &expected.samples),
        found.latencies.len(),
        expected.latencies.len(),
        first(&found.latencies, &expected.latencies),
    )
}

#[test]
fn model_mock_and_verilog_agree_on_every_sample_and_every_latency() {
    cores_agree(1500);
}

#[test]
fn whole_boards_agree_through_their_bytes() {
    boards_agree(Front::Bytes, 400);
}

#[test]
fn whole_boards_agree_through_a_uart_s_pins() {
    boards_agree(Front::Uart, 10);
}

#[test]
fn whole_boards_agree_through_a_fifo_s_pins() {
    boards_agree(Front::Fifo, 30);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn model_mock_and_verilog_agree_on_many_more_cases() {
    cores_agree(30_000);
    boards_agree(Front::Bytes, 10_000);
    boards_agree(Front::Fifo, 1_000);
    boards_agree(Front::Uart, 200);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn model_mock_and_verilog_agree_on_photographs() {
    let (paths, geometry) = (photographs::paths(), Geometry::default());
    assert!(!paths.is_empty(), "no photographs: set HALFROW_IMAGES to a folder with PNG files");
    let mut verilog = WholeBoard::open(link(Board::new(Front::Bytes, 1)));
    for pair in paths.chunks(2) {
        let [first, second] = [pair.first(), pair.last()].map(|path| filled(path.unwrap(), &geometry));
        let case = photograph_case(verilog.build(), first, second, geometry);
        board_agrees(&mut verilog, &case, &format!("{pair:?}"));
    }
    println!("model, mock and Verilog agree: {} photographs of 1920 x 1080", paths.len());
}
