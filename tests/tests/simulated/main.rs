//! The Verilog compared with model and mock, the core alone and the whole board: every sample and every latency.

// clippy.toml allows these inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used, clippy::panic)]

mod core;
mod whole_board;

use std::collections::BTreeMap;

use halfrow::link::{Link, WireLink};
use halfrow_mock::{Depth, Settings};
use halfrow_model::{Camera, Equidistant, Frame, Geometry, GridShape, Interpolant, Kernel, TableSet};
use halfrow_pipe::{Endpoint, Pipe, PipeOptions};
use halfrow_sim::{Board, Core, CoreBuild, Front};
use halfrow_tests::cases::{Build, Case, Played};
use halfrow_tests::dice::Dice;
use halfrow_tests::photographs::{self, filled};
use whole_board::WholeBoard;

/// Plays `cases` cases on each build of the core.
#[allow(clippy::print_stdout)]
fn cores_agree(cases: u64) {
    let mut counts = BTreeMap::new();
    for core_build in CoreBuild::ALL {
        let mut core = Core::new(core_build, 1);
        let (mut samples, mut rows) = (0, 0);
        for seed in 0..cases {
            let mut dice = Dice::new(seed);
            let case = Case::draw(&mut dice, core::build(core_build), 3);
            let played = core::play(&mut core, &case, &mut dice);
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

/// Plays `cases` cases on a simulated board, all in one session.
#[allow(clippy::print_stdout)]
fn boards_agree(front: Front, cases: u64) {
    let mut verilog = WholeBoard::open(link(Board::new(front, 1)));
    let build = verilog.build();
    let (mut samples, mut rows) = (0, 0);
    let (mut grids, mut changes) = (0, 0);
    for seed in 0..cases {
        let case = Case::draw(&mut Dice::new(seed), build, 2);
        let has_grid: Vec<_> = case.frames.iter().map(|(tables, ..)| tables.shape().is_some()).collect();
        grids += has_grid.iter().filter(|&&has_grid| has_grid).count();
        changes += usize::from(has_grid[0] != has_grid[1]);
        let played = board_agrees(&mut verilog, &case, &format!("{front:?}, case {seed}"));
        samples += played.samples.len();
        rows += played.latencies.len() / 2;
    }
    // On average, nine frames in ten cases (of two frames each) have a grid, and in three of ten cases the datapath changes.
    assert!(build.grids.is_none() || grids >= cases as usize / 2 && changes >= (cases as usize).div_ceil(10));
    println!(
        "model, mock and {front:?} agree: {cases} cases, {rows} rows, {samples} samples; {grids} frames behind a grid, and in \
         {changes} cases another datapath from one frame to the next"
    );
}

/// Two sets of tables for photographs at the paper's size: row factors of its lens, and others that reach further.
fn row_factors(geometry: Geometry) -> [TableSet; 2] {
    let tables = TableSet::from_lens(geometry, &Equidistant::default(), None).unwrap();
    let reversed: Vec<_> = tables.entries().rev().collect();
    let narrower: Vec<_> = reversed.iter().map(|units| units - units / 16).collect();
    let narrower = TableSet::from_units(geometry, &narrower).unwrap();
    [tables, narrower]
}

/// Two grids likewise: of the paper's lens, and of a lens with a smaller radius whose grid has another shape.
fn grids(geometry: Geometry) -> [TableSet; 2] {
    let middle = ((geometry.width() - 1) as f64 / 2.0, (geometry.height() - 1) as f64 / 2.0);
    let paper = Equidistant::default();
    let shorter = Equidistant::from_radius(0.9 * paper.radius()).unwrap();
    [(paper, 5, 6), (shorter, 6, 5)].map(|(lens, v, k)| {
        let camera = Camera::new(geometry, lens.into(), middle, 180.0).unwrap();
        let grid = camera.fitted_grid(GridShape::new(v, k).unwrap());
        assert_eq!(grid.check_ring(geometry.width().next_power_of_two()), Ok(()));
        grid
    })
}

/// Two photographs, the second under other tables and another kernel.
fn photograph_case(build: Build, frames: [Frame; 2], [tables, others]: [TableSet; 2]) -> Case {
    let ([first, second], geometry) = (frames, *tables.geometry());
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
    Case { settings, frames: vec![(tables, hermite, first), (others, keys, second)], ..drawn }
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
    boards_agree(Front::Bytes, 100);
}

#[test]
fn whole_boards_agree_through_a_uart_s_pins() {
    boards_agree(Front::Uart, 4);
}

#[test]
fn whole_boards_agree_through_a_fifo_s_pins() {
    boards_agree(Front::Fifo, 12);
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
    photographs_agree("row factors", &row_factors(Geometry::default()));
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn model_mock_and_verilog_agree_on_photographs_behind_grids() {
    photographs_agree("grids", &grids(Geometry::default()));
}

/// Two photographs at a time, as frames of the paper's size; the first of each pair is played once more before the second.
#[allow(clippy::print_stdout)]
fn photographs_agree(what: &str, tables: &[TableSet; 2]) {
    let paths = photographs::paths();
    assert!(!paths.is_empty(), "no photographs: set HALFROW_IMAGES to a folder with PNG files");
    let geometry = *tables[0].geometry();
    let mut verilog = WholeBoard::open(link(Board::new(Front::Bytes, 1)));
    let mut samples = 0;
    for pair in paths.chunks(2) {
        let frames = [pair.first(), pair.last()].map(|path| filled(path.unwrap(), &geometry));
        let case = photograph_case(verilog.build(), frames, tables.clone());
        samples += board_agrees(&mut verilog, &case, &format!("{pair:?}")).samples.len();
    }
    println!(
        "model, mock and Verilog agree by {what}: {} photographs of {} x {}, {samples} samples",
        paths.len(),
        geometry.width(),
        geometry.height()
    );
}
