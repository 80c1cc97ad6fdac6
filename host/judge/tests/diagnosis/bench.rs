//! A run against the mock's clocked core, in the order of a real run: the decoy generation, then the judged one, then other
//! timings.

use halfrow::compare::Comparison;
use halfrow::diagnosis::{Case, diagnose};
use halfrow::result::{Evidence, FrameReport, FrameTiming, MissingRows, Suspect};
use halfrow::tables::Generation;
use halfrow_mock::{
    BoardFault, Depth, GridShape, Node, Options, Player, RowIn, Settings, Tables, board_fault,
};
use halfrow_model::{BitDepth, Camera, Equidistant, Frame, Geometry, Interpolant, Kernel, TableSet, correct};

use crate::scenes::{Scene, scene};

/// What all runs of a test share.
pub(crate) struct Bench {
    pub(crate) geometry: Geometry,
    pub(crate) generations: [Generation; 2],
    pub(crate) ring: u16,
    /// Rows that the board has played before the run.
    pub(crate) rows_before: u16,
}

/// How rows are played: clocks between them, and a seed of gaps.
#[derive(Clone, Copy, PartialEq)]
struct Timing {
    blanking: u16,
    gap_seed: u32,
}

/// A frame of the schedule: what it shows, the index of its generation, and its timing.
type Scheduled = (Scene, usize, Timing);

const LEAST: Timing = Timing { blanking: 0, gap_seed: 0 };

/// The decoy twice, the judged tables directly after it, then two other timings.
const SCHEDULE: [Scheduled; 9] = [
    (Scene::Noise, 0, LEAST),
    (Scene::Noise, 0, LEAST),
    (Scene::Noise, 1, LEAST),
    (Scene::White, 1, LEAST),
    (Scene::RampAcross, 1, LEAST),
    (Scene::Impulses, 1, LEAST),
    (Scene::Extremes, 1, LEAST),
    (Scene::Noise, 1, Timing { blanking: 29, gap_seed: 0 }),
    (Scene::Noise, 1, Timing { blanking: 0, gap_seed: 7 }),
];

/// The index of the white frame of the schedule.
pub(crate) const WHITE: usize = 3;

/// What a run gives the diagnosis.
pub(crate) struct CaseInput {
    pub(crate) frames: Vec<FrameReport>,
    pub(crate) evidence: Vec<Evidence>,
}

impl Bench {
    /// Frames of `width` × `height` through a lens of `radius` pixels, on a board with a ring of `ring` samples.
    pub(crate) fn new(width: usize, height: usize, radius: f64, ring: u16, judged: Interpolant) -> Self {
        let geometry = Geometry::centred(width, height, BitDepth::Twelve).unwrap();
        Self::with(geometry, radius, ring, judged)
    }

    pub(crate) fn with(geometry: Geometry, radius: f64, ring: u16, judged: Interpolant) -> Self {
        let lens = Equidistant::from_radius(radius).unwrap();
        Self::of(TableSet::from_lens(geometry, &lens, None).unwrap(), ring, judged)
    }

    /// Frames that are corrected by `tables`.
    pub(crate) fn of(tables: TableSet, ring: u16, judged: Interpolant) -> Self {
        tables.check_ring(ring.into()).unwrap();
        let geometry = *tables.geometry();
        let decoy = tables.halved();
        let generations = [
            Generation { number: 1, tables: decoy, kernel: Kernel::from(Interpolant::Linear) },
            Generation { number: 2, tables, kernel: Kernel::from(judged) },
        ];
        Self { geometry, generations, ring, rows_before: 0 }
    }

    /// Runs the schedule on a board with `fault` and diagnoses what comes back.
    pub(crate) fn diagnose(&self, fault: BoardFault) -> Vec<Suspect> {
        self.judge(&self.play(Some(fault)))
    }

    /// The suspects that the diagnosis names for what was seen.
    pub(crate) fn judge(&self, seen: &CaseInput) -> Vec<Suspect> {
        diagnose(&Case {
            uploaded: &self.generations,
            ring: self.ring.into(),
            frames: &seen.frames,
            evidence: &seen.evidence,
        })
    }

    /// The frames of the schedule as a board with `fault` gives them. Frames of the same timing follow each other without
    /// a pause.
    pub(crate) fn play(&self, fault: Option<BoardFault>) -> CaseInput {
        let options = Options { ring: Some(self.ring), max_width: self.width(), ..Options::default() };
        let mut player = Player::new(&options, fault).unwrap();
        let mut tables = Tables::new(&options, fault);
        self.play_before(&mut player, &mut tables);
        let sound = self.sound_frames();
        let mut found: Vec<_> = sound.iter().map(|(_, input, _)| vec![0; input.samples().len()]).collect();
        for (number, (_, input, _)) in sound.iter().enumerate() {
            let timing = SCHEDULE[number].2;
            if number < 2 || SCHEDULE[number - 1].2 != timing {
                player.flush();
                fetch(&mut player, &mut found);
                self.upload(&mut tables, number);
                player.configure(self.settings(timing)).unwrap();
            }
            play(&mut player, &mut tables, number as u16, input, &mut found);
        }
        player.flush();
        fetch(&mut player, &mut found);
        let mut seen = CaseInput { frames: Vec::new(), evidence: Vec::new() };
        for ((generation, input, expected), samples) in sound.into_iter().zip(found) {
            let found = Frame::new(input.width(), input.depth(), input.phase(), samples).unwrap();
            seen.take(generation, input, expected, found);
        }
        seen
    }

    /// Every frame of the schedule: its generation, what goes in, and what must come out.
    pub(crate) fn sound_frames(&self) -> Vec<(u8, Frame, Frame)> {
        (1..)
            .zip(SCHEDULE)
            .map(|(seed, (shown, generation, _))| {
                let Generation { number, tables, kernel } = &self.generations[generation];
                let input = scene(shown, &self.geometry, seed);
                let expected = correct(tables, kernel, &input).unwrap();
                (*number, input, expected)
            })
            .collect()
    }

    /// Plays `rows_before` rows, so that the ring's count does not begin at 0.
    fn play_before(&self, player: &mut Player, tables: &mut Tables) {
        player.configure(self.settings(LEAST)).unwrap();
        for row in 0..self.rows_before {
            let samples = vec![0; self.geometry.width()];
            player.play(&RowIn { sequence: 0, frame: u16::MAX, row, last: true, samples }, tables).unwrap();
            player.flush();
            player.banks.fetch();
        }
    }

    fn width(&self) -> u16 {
        self.geometry.width() as u16
    }

    /// Commits the decoy for frame 0, and the judged tables for frame 2 while frame 1 is still to come.
    fn upload(&self, tables: &mut Tables, number: usize) {
        let (generation, first_frame) = match number {
            0 => (&self.generations[0], 0),
            1 => (&self.generations[1], 2),
            _ => return,
        };
        let nodes: Vec<_> = generation.kernel.nodes().iter().copied().map(Node::from).collect();
        let entries: Vec<_> = generation.tables.entries().collect();
        let shape =
            generation.tables.shape().map(|shape| GridShape::new(shape.v() as u8, shape.k() as u8).unwrap());
        match shape {
            None => tables.write_factors(0, &entries).unwrap(),
            Some(_) => tables.write_grid(0, &entries).unwrap(),
        }
        tables.write_nodes(0, &nodes).unwrap();
        tables.commit_shape(generation.number, first_frame, shape).unwrap();
    }

    fn settings(&self, timing: Timing) -> Settings {
        Settings {
            width: self.width(),
            height: self.geometry.height() as u16,
            centre2: self.geometry.centre2() as u16,
            depth: Depth::from_bits(self.geometry.depth().bits() as u8).unwrap(),
            blanking: timing.blanking,
            gap_seed: timing.gap_seed,
        }
    }
}

impl CaseInput {
    /// Adds a frame, and keeps its samples if it differs.
    pub(crate) fn take(&mut self, generation: u8, input: Frame, expected: Frame, found: Frame) {
        let comparison = Comparison::of_frames(&expected, &found);
        let differs = comparison.differences > 0;
        self.frames.push(FrameReport {
            name: "scene".to_owned(),
            number: self.frames.len() as u16,
            sha256: String::new(),
            phase: input.phase(),
            generation,
            timing: FrameTiming::LeastBlanking { clocks: 0 },
            variation: None,
            first_rows: None,
            seconds: 0.0,
            rows: input.height(),
            missing: MissingRows::default(),
            comparison,
        });
        if differs {
            let index = self.frames.len() - 1;
            self.evidence.push(Evidence { index, input, found, expected, missing: MissingRows::default() });
        }
    }

    /// Keeps the frames that do not differ too. `sound` are the same frames of a board without a fault.
    pub(crate) fn keep_all(&mut self, sound: Vec<(u8, Frame, Frame)>) {
        let kept: Vec<_> = self.evidence.iter().map(|evidence| evidence.index).collect();
        for (index, (_, input, expected)) in sound.into_iter().enumerate() {
            if !kept.contains(&index) {
                let found = expected.clone();
                self.evidence.push(Evidence {
                    index,
                    input,
                    found,
                    expected,
                    missing: MissingRows::default(),
                });
            }
        }
    }

    /// The samples that differ, in all frames.
    pub(crate) fn differences(&self) -> usize {
        self.frames.iter().map(|frame| frame.comparison.differences).sum()
    }
}

/// Plays one frame.
fn play(player: &mut Player, tables: &mut Tables, number: u16, input: &Frame, found: &mut [Vec<u16>]) {
    for (row, samples) in input.rows().enumerate() {
        let last = row + 1 == input.height();
        let row = RowIn { sequence: 0, frame: number, row: row as u16, last, samples: samples.to_vec() };
        player.play(&row, tables).unwrap();
        fetch(player, found);
    }
}

/// Fetches what came back. Rows that never come back stay black.
fn fetch(player: &mut Player, found: &mut [Vec<u16>]) {
    while let Some(out) = player.banks.fetch() {
        let width = out.samples.len();
        found[usize::from(out.name.frame)][usize::from(out.name.row) * width..][..width]
            .copy_from_slice(&out.samples);
    }
}

/// The fault that a target string like `stuck-data,bit=5` asks for.
pub(crate) fn fault(text: &str) -> BoardFault {
    let mut words = text.split(',');
    let mut options = vec![("fault", words.next().unwrap())];
    options.extend(words.map(|word| word.split_once('=').unwrap()));
    board_fault(&options).unwrap().unwrap()
}

/// Small frames in a ring of a single row.
pub(crate) fn narrow() -> Bench {
    Bench::new(128, 16, 20.0, 128, Interpolant::Hermite)
}

/// Frames whose width is no power of two, in a ring longer than a row.
pub(crate) fn wide() -> Bench {
    Bench::new(192, 24, 13.0, 256, Interpolant::Hermite)
}

/// Frames of 8 bits whose optical centre is not in the middle, through a seven-tap kernel.
pub(crate) fn off_centre() -> Bench {
    let geometry = Geometry::new(192, 24, BitDepth::Eight, 150).unwrap();
    Bench::with(geometry, 30.0, 256, Interpolant::Keys)
}

/// Frames that are corrected with a grid of 7 nodes and 8 grid rows.
pub(crate) fn grid() -> Bench {
    let geometry = Geometry::centred(192, 24, BitDepth::Twelve).unwrap();
    gridded(geometry, Interpolant::Hermite)
}

/// The same in 8 bits, with the optical centre at column 75 and a seven-tap kernel.
pub(crate) fn off_centre_grid() -> Bench {
    let geometry = Geometry::new(192, 24, BitDepth::Eight, 150).unwrap();
    gridded(geometry, Interpolant::Keys)
}

fn gridded(geometry: Geometry, judged: Interpolant) -> Bench {
    let lens = Equidistant::from_radius(130.0).unwrap();
    let centre = (f64::from(geometry.centre2()) / 2.0, 11.5);
    let camera = Camera::new(geometry, lens.into(), centre, 180.0).unwrap();
    let shape = halfrow_model::GridShape::new(2, 5).unwrap();
    Bench::of(camera.grid_by_formula(shape), 256, judged)
}

/// Whether the suspect is the part at `place`, or several bits of one word among which its bit is.
pub(crate) fn is_told(suspect: &Suspect, place: &str) -> bool {
    let told = suspect.place();
    let several = told.split_once(", one of bits ").zip(place.split_once(", bit "));
    several.map_or(told == place, |((word, bits), (own, bit))| {
        let bit: u32 = bit.parse().unwrap();
        let bits = bits.replace(" and ", ", ");
        let mut runs = bits.split(", ").map(|run| run.split_once(" to ").unwrap_or((run, run)));
        word == own
            && runs.any(|(first, last)| (first.parse().unwrap()..=last.parse().unwrap()).contains(&bit))
    })
}

/// Asserts that the fault is explained by the part at `place`, completely and by nothing else.
pub(crate) fn assert_named(bench: &Bench, text: &str, place: &str) {
    let suspects = bench.diagnose(fault(text));
    let places: Vec<_> = suspects.iter().map(Suspect::place).collect();
    assert_eq!(places, [place], "{text}: {suspects:#?}");
    assert_eq!(suspects[0].explained, 1.0, "{text}: {suspects:#?}");
}
