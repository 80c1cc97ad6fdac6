//! Model and mock, which share no arithmetic, on the same rows: random legal tables, kernels, sizes, depths, builds, blankings
//! and gaps, with another frame, other tables and another kernel close behind.

#![allow(clippy::unwrap_used, reason = "clippy.toml allows it in tests, but not in their helpers")]

use halfrow_mock::{BoardFault, Depth, Node, Options, Player, RowIn, Settings, Tables};
use halfrow_model::{BitDepth, Frame, Geometry, Interpolant, Kernel, Phase, STEP_ONE, TableSet, correct};
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

struct Draw(Pcg64Mcg);

impl Draw {
    /// A number from `low` to `high`, both included.
    fn number(&mut self, low: usize, high: usize) -> usize {
        low + self.0.next_u64() as usize % (high - low + 1)
    }

    fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.number(0, of.len() - 1)]
    }
}

/// A case: a build, the way its rows are played, and two frames with tables of their own.
struct Case {
    options: Options,
    settings: Settings,
    frames: [(TableSet, Kernel, Frame); 2],
}

fn draw_case(seed: u64) -> Case {
    let mut draw = Draw(Pcg64Mcg::new(u128::from(seed)));
    let width = 2 * draw.number(32, 100);
    let depth = draw.one_of(&BitDepth::ALL);
    let ring = width.next_power_of_two() << draw.number(0, 1);
    let options = Options {
        latency: draw.number(4, 32) as u8,
        ring: Some(ring as u16),
        least_blanking: draw.one_of(&[0, 1, 7]),
        max_width: width as u16,
        ..Options::default()
    };
    let height = draw.number(1, 6);
    let centre2 = if draw.number(0, 2) == 0 { draw.number(0, 2 * width - 2) } else { width - 1 };
    let geometry = Geometry::new(width, height, depth, centre2 as u32).unwrap();
    let settings = Settings {
        width: width as u16,
        height: height as u16,
        centre2: centre2 as u16,
        depth: Depth::from_bits(depth.bits() as u8).unwrap(),
        blanking: options.least_blanking + draw.one_of(&[0, 0, 1, 13, 900]),
        gap_seed: draw.one_of(&[0, 1, 0x8000_0000]) ^ draw.number(0, 1) as u32,
    };
    let mut frame = || {
        let (tables, kernel) = (draw_tables(&mut draw, geometry, ring), draw_kernel(&mut draw));
        (tables, kernel, draw_frame(&mut draw, width, height, depth))
    };
    let frames = [frame(), frame()];
    Case { options, settings, frames }
}

/// Row factors that the ring can serve: drawn from one up to 2^24, and again where they reach too far.
fn draw_tables(draw: &mut Draw, geometry: Geometry, ring: usize) -> TableSet {
    let mut steps = Vec::new();
    while steps.len() < geometry.height() {
        let step = draw.number(1, STEP_ONE as usize) as u32;
        let step = if draw.number(0, 7) == 0 { STEP_ONE } else { step };
        let one_row = Geometry::new(geometry.width(), 1, geometry.depth(), geometry.centre2()).unwrap();
        if TableSet::new(one_row, vec![step]).unwrap().check_ring(ring).is_ok() {
            steps.push(step);
        }
    }
    TableSet::new(geometry, steps).unwrap()
}

/// One of the four kernels, or any weights at all.
fn draw_kernel(draw: &mut Draw) -> Kernel {
    match draw.number(0, 5) {
        named @ 0..4 => Kernel::from(Interpolant::ALL[named]),
        _ => {
            Kernel::from_nodes((0..65).map(|_| [(); 5].map(|()| draw.0.next_u32() as i16)).collect()).unwrap()
        }
    }
}

/// Noise, or samples at both ends of the range alone.
fn draw_frame(draw: &mut Draw, width: usize, height: usize, depth: BitDepth) -> Frame {
    let extremes = draw.number(0, 2) == 0;
    let samples = (0..width * height)
        .map(|_| match extremes {
            true => draw.one_of(&[0, depth.max()]),
            false => draw.0.next_u32() as u16 & depth.max(),
        })
        .collect();
    Frame::new(width, depth, draw.one_of(&Phase::ALL), samples).unwrap()
}

/// What the mock gives for both frames, one close behind the other, and the latencies of every row.
fn play(case: &Case) -> (Vec<u16>, Vec<u16>) {
    let no_fault: Option<BoardFault> = None;
    let mut player = Player::new(&case.options, no_fault).unwrap();
    let mut tables = Tables::new(&case.options, no_fault);
    player.configure(case.settings.clone()).unwrap();
    let (mut samples, mut latencies) = (Vec::new(), Vec::new());
    for (number, (set, kernel, frame)) in case.frames.iter().enumerate() {
        tables.write_factors(0, set.steps()).unwrap();
        let nodes: Vec<Node> = kernel.nodes().iter().map(|&node| node.into()).collect();
        tables.write_nodes(0, &nodes).unwrap();
        tables.commit(number as u8 + 1, number as u16).unwrap();
        for (row, input) in frame.rows().enumerate() {
            let last = row + 1 == frame.height();
            let samples_in = input.to_vec();
            let row_in =
                RowIn { sequence: 0, frame: number as u16, row: row as u16, last, samples: samples_in };
            player.play(&row_in, &mut tables).unwrap();
            while let Some(out) = player.banks.fetch() {
                samples.extend(out.samples);
                latencies.extend([out.first_latency, out.last_latency]);
            }
        }
    }
    player.flush();
    while let Some(out) = player.banks.fetch() {
        samples.extend(out.samples);
        latencies.extend([out.first_latency, out.last_latency]);
    }
    (samples, latencies)
}

#[test]
fn model_and_mock_agree_on_every_sample_and_every_latency() {
    let cases =
        std::env::var("HALFROW_EQUALITY_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(4000);
    let (mut samples, mut rows) = (0, 0);
    for seed in 0..cases {
        let case = draw_case(seed);
        let expected: Vec<u16> = case
            .frames
            .iter()
            .flat_map(|(tables, kernel, frame)| correct(tables, kernel, frame).unwrap().samples().to_vec())
            .collect();
        let (found, latencies) = play(&case);
        assert_eq!(found, expected, "case {seed}");
        let claimed = case.settings.width / 2 + u16::from(case.options.latency);
        assert!(latencies.iter().all(|&latency| latency == claimed), "case {seed}: {latencies:?}");
        samples += found.len();
        rows += latencies.len() / 2;
    }
    println!("model and mock: {cases} cases, {rows} rows, {samples} samples, all equal");
}
