//! Random cases for everything that computes as DATAPATH.md says: builds, legal tables, kernels, sizes, depths, blankings and
//! gaps, with frames that follow each other under tables of their own, row factors or a grid.

mod grids;

use halfrow_mock::{BoardFault, Depth, GridShape, Node, Options, Player, RowIn, Settings, Tables};
use halfrow_model::{BitDepth, Frame, Geometry, Interpolant, Kernel, Phase, RowFactor, TableSet, correct};

use crate::dice::Dice;

pub use grids::GridNeeds;

/// The build that a case is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Build {
    /// L.
    pub latency: u8,
    /// M.
    pub ring: u16,
    /// Pixel clocks that the build needs between rows.
    pub least_blanking: u16,
    /// Whether the kernel may have outer taps.
    pub outer_taps: bool,
    /// What it needs for grids; none if it takes no grids.
    pub grids: Option<GridNeeds>,
}

impl Build {
    /// Any build that can exist, for rows of at least 64 samples.
    pub fn draw(dice: &mut Dice) -> Self {
        Self {
            latency: 4 + dice.below(29) as u8,
            ring: 64 << dice.below(3),
            least_blanking: dice.one_of(&[0, 1, 7]),
            outer_taps: true,
            // A mock's needs: its rows are ready at once.
            grids: Some(GridNeeds { entries: 2048, blanking: 0, width: 0 }),
        }
    }
}

/// A build, how its rows are played, and frames with their own tables.
#[derive(Clone, Debug)]
pub struct Case {
    /// The build, as the mock takes it.
    pub options: Options,
    /// How rows are played.
    pub settings: Settings,
    /// The frames in their order.
    pub frames: Vec<(TableSet, Kernel, Frame)>,
}

/// What came out of a case.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Played {
    /// The samples of all rows.
    pub samples: Vec<u16>,
    /// First and last latency of every row, in pixel clocks.
    pub latencies: Vec<u16>,
}

impl Case {
    /// A case of `build` with `frames` frames.
    ///
    /// # Panics
    /// Never: what is drawn is legal.
    pub fn draw(dice: &mut Dice, build: Build, frames: usize) -> Self {
        let width = draw_width(dice, build.ring.into());
        let mut height = 1 + dice.below(6);
        // Each frame of a case has one datapath or the other, so that the datapath changes between frames.
        let grids = build.grids.filter(|_| dice.below(3) != 0);
        if grids.is_some() && dice.below(4) == 0 {
            height += dice.below(30);
        }
        let depth = dice.one_of(&BitDepth::ALL);
        let centre2 = match dice.below(8) {
            0 => dice.one_of(&[0, 2 * width - 2]),
            1 | 2 => dice.below(2 * width - 1),
            _ => width - 1,
        };
        let geometry = Geometry::new(width, height, depth, centre2 as u32).unwrap();
        let options = Options {
            latency: build.latency,
            ring: Some(build.ring),
            least_blanking: build.least_blanking,
            max_width: build.ring.min(2048),
            ..Options::default()
        };
        let settings = Settings {
            width: width as u16,
            height: height as u16,
            centre2: centre2 as u16,
            depth: Depth::from_bits(depth.bits() as u8).unwrap(),
            blanking: least_blanking(build, grids, width) + dice.one_of(&[0, 0, 1, 13, 900]),
            gap_seed: dice.one_of(&[0, 1, 0x8000_0000]) ^ dice.below(2) as u32,
        };
        let mut frame = || {
            let tables = match grids.filter(|_| dice.below(3) != 0) {
                Some(needs) => grids::draw(dice, geometry, build.ring.into(), needs),
                None => draw_tables(dice, geometry, build.ring.into()),
            };
            (tables, draw_kernel(dice, build.outer_taps), draw_frame(dice, width, height, depth))
        };
        Self { options, settings, frames: (0..frames).map(|_| frame()).collect() }
    }

    /// D, the pixel clocks from a sample to its output.
    #[must_use]
    pub fn delay(&self) -> u16 {
        self.settings.width / 2 + u16::from(self.options.latency)
    }

    /// What comes out according to the model.
    ///
    /// # Panics
    /// Never: tables and frames have the same size.
    #[must_use]
    pub fn expected(&self) -> Played {
        let corrected = self.frames.iter().map(|(set, kernel, frame)| correct(set, kernel, frame).unwrap());
        let samples = corrected.flat_map(|frame| frame.samples().to_vec()).collect();
        let rows = self.frames.len() * usize::from(self.settings.height);
        Played { samples, latencies: vec![self.delay(); 2 * rows] }
    }

    /// What comes out of the mock, each frame right after the one before.
    ///
    /// # Panics
    /// If the mock refuses what is legal.
    #[must_use]
    pub fn play_on_mock(&self) -> Played {
        let no_fault: Option<BoardFault> = None;
        let mut player = Player::new(&self.options, no_fault).unwrap();
        let mut tables = Tables::new(&self.options, no_fault);
        player.configure(self.settings.clone()).unwrap();
        let mut played = Played::default();
        for (number, (set, kernel, frame)) in self.frames.iter().enumerate() {
            let entries: Vec<_> = set.entries().collect();
            match set.shape() {
                None => tables.write_factors(0, &entries).unwrap(),
                Some(_) => tables.write_grid(0, &entries).unwrap(),
            }
            let nodes: Vec<Node> = kernel.nodes().iter().map(|&node| node.into()).collect();
            tables.write_nodes(0, &nodes).unwrap();
            let shape = set.shape().and_then(|shape| GridShape::new(shape.v() as u8, shape.k() as u8));
            tables.commit_shape(number as u8 + 1, number as u16, shape).unwrap();
            for (row, input) in frame.rows().enumerate() {
                let (frame_number, last) = (number as u16, row + 1 == frame.height());
                let (row, samples) = (row as u16, input.to_vec());
                let row = RowIn { sequence: 0, frame: frame_number, row, last, samples };
                player.play(&row, &mut tables).unwrap();
                played.fetch(&mut player);
            }
        }
        player.flush();
        played.fetch(&mut player);
        played
    }
}

impl Played {
    fn fetch(&mut self, player: &mut Player) {
        while let Some(out) = player.banks.fetch() {
            self.samples.extend(out.samples);
            self.latencies.extend([out.first_latency, out.last_latency]);
        }
    }
}

/// Pixel clocks that rows of this width need between them, in a case that may have grids.
fn least_blanking(build: Build, grids: Option<GridNeeds>, width: usize) -> u16 {
    let of_grids = grids.filter(|needs| width < needs.width).map_or(0, |needs| needs.blanking);
    build.least_blanking.max(of_grids)
}

/// Columns of a row that the ring holds: mostly few, so that there can be many cases, and now and then the most.
fn draw_width(dice: &mut Dice, ring: usize) -> usize {
    match dice.below(16) {
        0 => ring.min(2048) - 2 * dice.below(2),
        _ => 64 + 2 * dice.below((ring.min(200) - 64) / 2 + 1),
    }
    .max(64)
}

/// A row factor of 1.
const ONE: u32 = RowFactor::ONE.get();

/// Row factors that the ring can serve: from the least legal one up to 2^24, and often exactly at one of these ends.
fn draw_tables(dice: &mut Dice, geometry: Geometry, ring: usize) -> TableSet {
    let least = least_factor(geometry, ring);
    let factor = |_| match dice.below(8) {
        0 => ONE,
        1 => least,
        _ => least + dice.below((ONE - least) as usize + 1) as u32,
    };
    let factors: Vec<u32> = (0..geometry.height()).map(factor).collect();
    TableSet::from_units(geometry, &factors).unwrap()
}

/// The least legal row factor. The smaller a factor, the further from its own column a row reads, so a bisection finds it.
fn least_factor(geometry: Geometry, ring: usize) -> u32 {
    let one_row = Geometry::new(geometry.width(), 1, geometry.depth(), geometry.centre2()).unwrap();
    let legal = |factor| TableSet::from_units(one_row, &[factor]).unwrap().check_ring(ring).is_ok();
    let (mut illegal, mut least) = (0, ONE);
    while least - illegal > 1 {
        let middle = illegal.midpoint(least);
        *if legal(middle) { &mut least } else { &mut illegal } = middle;
    }
    least
}

/// One of the four named kernels, or arbitrary weights.
fn draw_kernel(dice: &mut Dice, outer_taps: bool) -> Kernel {
    let any = dice.below(3) == 0;
    let named: Vec<_> = Interpolant::ALL.into_iter().map(Kernel::from).collect();
    let five = |kernel: &Kernel| kernel.nodes().iter().all(|node| (node[0], node[4]) == (0, 0));
    if !any {
        let fitting: Vec<_> = named.into_iter().filter(|kernel| outer_taps || five(kernel)).collect();
        return fitting[dice.below(fitting.len())].clone();
    }
    let weight = |dice: &mut Dice, outer: bool| {
        if outer && !outer_taps { 0 } else { dice.below(1 << 16) as u16 as i16 }
    };
    let node = |dice: &mut Dice| [true, false, false, false, true].map(|outer| weight(dice, outer));
    Kernel::from_nodes((0..65).map(|_| node(dice)).collect()).unwrap()
}

/// Noise, or only samples at both ends of the range.
fn draw_frame(dice: &mut Dice, width: usize, height: usize, depth: BitDepth) -> Frame {
    let extremes = dice.below(3) == 0;
    let samples = (0..width * height)
        .map(|_| match extremes {
            true => dice.one_of(&[0, depth.max()]),
            false => dice.below(usize::from(depth.max()) + 1) as u16,
        })
        .collect();
    Frame::new(width, depth, dice.one_of(&Phase::ALL), samples).unwrap()
}
