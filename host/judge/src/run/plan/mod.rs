//! What a run will do. What is asked for is checked before a board is opened; the schedule then follows from the board's build
//! and, with `within`, from what its link can do.

pub(super) mod misfit;
pub(super) mod parts;
pub(super) mod patterns;
pub(super) mod prices;
mod schedule;
pub(super) mod variations;
pub(super) mod within;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use halfrow_model::{Equidistant, Frame, Geometry, Interpolant, Kernel, Phase, TableSet};
use rand_pcg::Pcg64Mcg;

use crate::frames::{Builtin, Scene};
use crate::result::{SoakLength, Variation};
use crate::run::drawn::{Weights, drawn_factors, drawn_kernel};
use crate::tables::Generation;
use parts::{Part, Selection};
use variations::{Build, Vary, varied};

/// Pixel clocks between two rows of the paper's sensor (MT9P031) at 1080p.
pub(crate) const SENSOR_BLANKING: u16 = 900;

/// The most frames that a plan can have, repetitions counted: frame numbers have 16 bits, and a run adds up to seven frames of
/// noise of its own.
pub const MOST_FRAMES: usize = (1 << 16) - 7;

/// The plan has no frames, or more than one run can number.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanLengthError {
    /// The plan names no frame, or streams each zero times. The frames that a run adds by itself would pass for those that were
    /// meant.
    #[error("the plan has no frame to stream; name at least one, and stream each at least once")]
    NoFrames,
    /// The plan has more frames than frame numbers, which have 16 bits.
    #[error(
        "{frames} frames are more than the {MOST_FRAMES} that a run can number; name fewer, or repeat them less often"
    )]
    TooManyFrames {
        /// Frames, all repetitions counted.
        frames: usize,
    },
}

/// Where a frame comes from.
#[derive(Clone, Debug)]
pub enum FrameSource {
    /// Built in, and rendered when its turn comes.
    Builtin(Builtin),
    /// Given before the board is opened: read from a file, or made by the calling program.
    File {
        /// The file, or the name in reports of a frame without one.
        path: PathBuf,
        /// The frame. It has the size and the depth of the plan's tables.
        frame: Arc<Frame>,
    },
}

impl FrameSource {
    /// Its name in reports.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Builtin(builtin) => format!("{}{builtin}", Builtin::PREFIX),
            Self::File { path, .. } => path.display().to_string(),
        }
    }
}

/// How rows are played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timing {
    /// The fewest pixel clocks between rows that the board allows.
    Least,
    /// As many pixel clocks between rows as the paper's sensor has.
    Sensor,
    /// Gaps in and between rows, drawn from this seed.
    Gaps(u32),
}

/// How long a board makes frames itself, at its full pixel clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AtSpeed {
    /// For 3 s of its clock on hardware; a few frames on any other board.
    #[default]
    Usual,
    /// Not at all.
    Off,
    /// For this time on its clock.
    For(Duration),
    /// For a soak, which may take hours. The rules are not tried after it.
    Soak(SoakLength),
}

impl AtSpeed {
    /// The length of the soak, if it is one.
    pub(crate) fn soak(self) -> Option<SoakLength> {
        match self {
            Self::Soak(length) => Some(length),
            Self::Usual | Self::Off | Self::For(_) => None,
        }
    }
}

/// From the option of a call: not given is [`AtSpeed::Usual`], 0 is [`AtSpeed::Off`].
impl From<Option<Duration>> for AtSpeed {
    fn from(asked: Option<Duration>) -> Self {
        match asked {
            None => Self::Usual,
            Some(Duration::ZERO) => Self::Off,
            Some(time) => Self::For(time),
        }
    }
}

/// What a run will do. How it is done is in [`RunOptions`](crate::run::RunOptions).
#[derive(Clone, Debug)]
pub struct Plan {
    /// The tables to judge with.
    pub tables: TableSet,
    /// The kernel to judge with.
    pub kernel: Kernel,
    /// Where they came from, for people.
    pub tables_source: String,
    /// Rows outside the image circle of the lens that the tables were made for; none for tables from a file, which does
    /// not say.
    pub rows_outside_circle: Option<usize>,
    /// The lens that built-in frames are rendered through.
    pub lens: Equidistant,
    /// The row of the optical centre of built-in frames, counted from 0, which may be any finite number; the middle when not
    /// given.
    pub centre_y: Option<f64>,
    /// The Bayer phase of built-in frames.
    pub phase: Phase,
    /// The frames to stream, at least one; all repetitions counted, at most [`MOST_FRAMES`].
    pub frames: Vec<FrameSource>,
    /// How often each frame is streamed, at least once.
    pub repeat: u32,
    /// Which settings of `tables` are varied, in additional frames of noise.
    pub vary: Vary,
    /// The parts that are judged; all of them when not given.
    pub selection: Option<Selection>,
    /// How long the run may take on the link's clock; it takes the parts that find the most faults a second. None for the
    /// whole run, or the `selection`. The choice depends on the link, so a recording of such a run cannot be judged again.
    pub within: Option<Duration>,
    /// The frames that the board makes itself, at its full pixel clock.
    pub at_speed: AtSpeed,
    /// End with the first frame that differs.
    pub fail_fast: bool,
    /// The seed of noise, gaps, the link test, the rules and the frames that the board makes itself. The session's
    /// numbers do not depend on it: they are [`Provenance::session_ids`](crate::run::Provenance::session_ids).
    pub seed: u64,
}

/// Frames that follow each other without the core running empty, with the settings made before them.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Size, depth and centre of them all.
    pub geometry: Geometry,
    /// How their rows are played.
    pub timing: Timing,
    /// The generation that is committed before the first of them, and the number of the first frame that it is for.
    pub commit: Option<(u8, u16)>,
    /// The frames.
    pub frames: Vec<ScheduledFrame>,
}

impl Segment {
    /// The rows of all its frames.
    pub(crate) fn rows(&self) -> usize {
        self.frames.len() * self.geometry.height()
    }

    /// Whether its centre or depth is varied.
    pub(crate) fn is_varied(&self) -> bool {
        self.commit.is_some_and(|(generation, _)| generation >= VARIED)
    }
}

/// A frame and the generation of tables that must correct it.
#[derive(Clone, Debug)]
pub struct ScheduledFrame {
    /// Its number on the wire.
    pub number: u16,
    /// Where it comes from.
    pub source: FrameSource,
    /// The generation that must correct it.
    pub generation: u8,
    /// The part of the run that it belongs to.
    pub part: Part,
}

/// The generation of the decoy tables.
pub const DECOY: u8 = 1;
/// The generation of the tables to judge with.
pub const JUDGED: u8 = 2;
/// The first generation of the tables to judge with that has another centre or depth; more may follow.
const VARIED: u8 = 3;

impl Plan {
    /// A plan that streams each built-in frame once, as the paper's lens sees it, and judges with `tables` and `kernel`.
    #[must_use]
    pub fn new(tables: TableSet, kernel: Kernel) -> Self {
        Self {
            tables,
            kernel,
            tables_source: "tables of the calling program".to_owned(),
            rows_outside_circle: None,
            lens: Equidistant::default(),
            centre_y: None,
            phase: Phase::Grbg,
            frames: Builtin::ALL.into_iter().map(FrameSource::Builtin).collect(),
            repeat: 1,
            vary: Vary::default(),
            selection: None,
            within: None,
            at_speed: AtSpeed::Usual,
            fail_fast: false,
            seed: 1,
        }
    }

    /// The same plan with these frames.
    #[must_use]
    pub fn frames(self, frames: impl IntoIterator<Item = FrameSource>) -> Self {
        Self { frames: frames.into_iter().collect(), ..self }
    }

    /// The same plan with built-in frames as `lens` sees them.
    #[must_use]
    pub fn seen_through(self, lens: Equidistant) -> Self {
        Self { lens, ..self }
    }

    /// The same plan with frames for other centres and depths.
    #[must_use]
    pub fn varying(self, vary: Vary) -> Self {
        Self { vary, ..self }
    }

    /// The setting in which `geometry` differs from the plan's tables, if any.
    #[must_use]
    pub fn variation(&self, geometry: &Geometry) -> Option<Variation> {
        let (own, centre2, depth) = (self.tables.geometry(), geometry.centre2(), geometry.depth());
        if centre2 != own.centre2() {
            return Some(Variation::Centre { centre2 });
        }
        (depth != own.depth()).then(|| Variation::Depth { bits: depth.bits() })
    }

    /// Checks that there are frames, and that all of them can be numbered.
    ///
    /// # Errors
    /// [`PlanLengthError`] when there are none, or too many.
    pub fn check_length(&self) -> Result<(), PlanLengthError> {
        match self.frames.len().saturating_mul(self.repeat as usize) {
            0 => Err(PlanLengthError::NoFrames),
            1..=MOST_FRAMES => Ok(()),
            frames => Err(PlanLengthError::TooManyFrames { frames }),
        }
    }

    /// The tables that a run uploads to a board of this build, in order, each with its geometry. The first are a decoy,
    /// which differs in every row that is stretched, so that a board that goes on using it is caught. For a few grids no
    /// decoy is possible.
    #[must_use]
    pub fn generations(&self, build: &Build) -> Vec<Generation> {
        let judged = Generation { number: JUDGED, tables: self.tables.clone(), kernel: self.kernel.clone() };
        self.decoy(build).into_iter().chain([judged]).chain(self.varied(build)).collect()
    }

    /// The decoy: tables with half the stretch. Row factors half way to 1 reach half as far, so the ring's limits hold.
    /// In a grid rounding may bring a row that begins or ends at the frame's edge beyond it; then there is no decoy.
    ///
    /// A board without bursts shows the whole range of weights, sums and factors in the decoy alone, which is drawn then.
    pub(crate) fn decoy(&self, build: &Build) -> Option<Generation> {
        if !build.bursts
            && let Some(drawn) = self.drawn_decoy(build)
        {
            return Some(drawn);
        }
        let tables = self.tables.halved();
        let fits = tables.shape().is_none() || tables.check_ring(build.ring).is_ok();
        fits.then(|| Generation { number: DECOY, tables, kernel: self.decoy_kernel(build.taps) })
    }

    /// Random factors up to what the ring allows, and a random kernel with weights at both ends of their range.
    fn drawn_decoy(&self, build: &Build) -> Option<Generation> {
        let mut draws = Pcg64Mcg::new(u128::from(self.seed) | 1 << 68);
        let kernel = drawn_kernel(build.taps, Weights::Wild, &mut draws)?;
        let tables = match self.tables.shape() {
            None => drawn_factors(*self.tables.geometry(), build.ring, &mut draws)?,
            Some(_) => Some(self.tables.halved()).filter(|tables| tables.check_ring(build.ring).is_ok())?,
        };
        Some(Generation { number: DECOY, tables, kernel })
    }

    /// The tables to judge with, with another centre and with other depths.
    pub(crate) fn varied(&self, build: &Build) -> impl Iterator<Item = Generation> {
        let tables = varied(&self.tables, self.vary, build).into_iter().zip(VARIED..);
        tables.map(|(tables, number)| Generation { number, tables, kernel: self.kernel.clone() })
    }

    /// A kernel other than the one to judge with. It weighs every tap of the board, because the one to judge with may leave out
    /// some, and a dead tap among these would go unseen.
    fn decoy_kernel(&self, taps: u8) -> Kernel {
        let hermite = Kernel::from(Interpolant::Hermite);
        let mut nodes = hermite.nodes().to_vec();
        if taps >= 7 {
            let keys = Kernel::from(Interpolant::Keys);
            let weights = nodes.as_flattened_mut().iter_mut().zip(keys.nodes().as_flattened());
            weights.for_each(|(weight, &keys)| *weight = i16::midpoint(*weight, keys));
        }
        match Kernel::from_nodes(nodes) {
            Ok(kernel) if kernel != self.kernel => kernel,
            _ => Kernel::from(Interpolant::Linear),
        }
    }

    /// The scene from which built-in frames are rendered; `draw` is added to the seed.
    #[must_use]
    pub fn scene(&self, draw: u64) -> Scene {
        Scene {
            geometry: *self.tables.geometry(),
            centre_y: self.centre_y,
            phase: self.phase,
            lens: self.lens,
            seed: self.seed.wrapping_add(draw),
        }
    }
}
