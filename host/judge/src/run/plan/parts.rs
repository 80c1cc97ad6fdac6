//! The parts of a run, and selections of them.

use std::collections::BTreeMap;
use std::fmt;

use halfrow_model::Geometry;
use serde::{Deserialize, Serialize};

use super::variations::Build;
use super::{AtSpeed, FrameSource, Plan, ScheduledFrame, Segment};
use crate::board::Capabilities;
use crate::run::at_speed::{FEW_AT_SPEED, geometries_of_corners, known_bursts};
use crate::run::rules::{geometries_of_rules, rows_of_rules, tallest_of_rules};

/// A part of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// Noise that is corrected by the decoy tables.
    Decoy,
    /// The same again, directly followed by frames to judge, so that tables change between consecutive rows. A board with
    /// one bank of tables has no such part.
    Swap,
    /// The plan's frame with this index, as often as the plan repeats it.
    Judged(usize),
    /// Noise with the sensor's blanking.
    SensorBlanking,
    /// Noise with gaps in and between rows.
    Gaps,
    /// Noise with another optical centre.
    Centre,
    /// Noise with this many bits a sample.
    Depth(u32),
    /// Frames that the board makes itself at the full pixel clock.
    AtSpeed,
    /// The same at the corners of the board's settings.
    Corners,
    /// What the board must refuse, keep and end.
    Rules,
}

impl fmt::Display for Part {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Decoy => formatter.write_str("decoy"),
            Self::Swap => formatter.write_str("table change"),
            Self::Judged(place) => write!(formatter, "frame {place}"),
            Self::SensorBlanking => formatter.write_str("sensor blanking"),
            Self::Gaps => formatter.write_str("gaps"),
            Self::Centre => formatter.write_str("centre"),
            Self::Depth(bits) => write!(formatter, "{bits} bits"),
            Self::AtSpeed => formatter.write_str("at speed"),
            Self::Corners => formatter.write_str("corners"),
            Self::Rules => formatter.write_str("rules"),
        }
    }
}

/// The parts that are judged, and how much of each: rows of what is streamed, frames at speed, 1 for the corners and for
/// the rules. A streamed frame of fewer rows than the tables consists of its first ones; with a grid it is whole. A part
/// that the run does not have, such as a frame after the plan's last, adds nothing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<(Part, usize)>", into = "Vec<(Part, usize)>")]
pub struct Selection(BTreeMap<Part, usize>);

impl From<Vec<(Part, usize)>> for Selection {
    fn from(parts: Vec<(Part, usize)>) -> Self {
        parts.into_iter().fold(Self::least(), |selection, (part, amount)| selection.with(part, amount))
    }
}

impl From<Selection> for Vec<(Part, usize)> {
    fn from(selection: Selection) -> Self {
        selection.0.into_iter().collect()
    }
}

impl Selection {
    /// The least that gives a verdict: one row of the first frame to judge. It also brings the tables into effect,
    /// without which a board makes no frames itself.
    #[must_use]
    pub fn least() -> Self {
        Self(BTreeMap::from([(Part::Judged(0), 1)]))
    }

    /// How much of `part` is selected; 0 when it is not.
    #[must_use]
    pub fn amount(&self, part: Part) -> usize {
        self.0.get(&part).copied().unwrap_or_default()
    }

    /// The same selection with at least `amount` of `part`, and with what the part needs: a change of tables follows a
    /// frame with the decoy and precedes as many rows to judge, and corners follow a few frames at speed.
    #[must_use]
    pub fn with(&self, part: Part, amount: usize) -> Self {
        let mut parts = self.0.clone();
        let mut raise = |part, least: usize| {
            let had = parts.entry(part).or_default();
            *had = least.max(*had);
            *had
        };
        if amount > 0 {
            raise(part, amount);
        }
        let (judged, swapped) = (raise(Part::Judged(0), 1), self.amount(Part::Swap));
        if part == Part::Swap || swapped > 0 {
            raise(Part::Decoy, 1);
            // The same height for both, because the core runs empty between two heights.
            let together = raise(Part::Swap, judged);
            raise(Part::Judged(0), together);
        }
        if part == Part::Corners {
            raise(Part::AtSpeed, FEW_AT_SPEED as usize);
        }
        Self(parts)
    }

    /// A selection of all of every part of `parts`.
    #[must_use]
    pub fn all(parts: impl IntoIterator<Item = Part>) -> Self {
        parts.into_iter().fold(Self::least(), |selection, part| selection.with(part, usize::MAX))
    }

    /// The same selection with whole frames of everything that is streamed.
    fn of_whole_frames(&self) -> Self {
        let whole = |(&part, &amount): (&Part, &usize)| {
            let is_streamed = amount > 0 && !matches!(part, Part::AtSpeed | Part::Corners | Part::Rules);
            (part, if is_streamed { usize::MAX } else { amount })
        };
        Self(self.0.iter().map(whole).collect())
    }

    /// What this selection streams of a whole schedule.
    pub(crate) fn cut(&self, schedule: Vec<Segment>) -> Vec<Segment> {
        let (mut active, mut streamed) = (None, Vec::new());
        for Segment { geometry, timing, frames, .. } in schedule {
            let rows = |frame: &ScheduledFrame| self.amount(frame.part).min(geometry.height());
            let selected = frames.into_iter().filter(|frame| rows(frame) > 0);
            for frames in runs(selected, rows) {
                let generation = frames.last().map(|last| last.generation);
                let first = frames.iter().find(|frame| Some(frame.generation) == generation);
                let commit = first.filter(|_| generation != active).map(|it| (it.generation, it.number));
                active = generation;
                let geometry = of_height(&geometry, frames.first().map_or(0, rows));
                streamed.push(Segment { geometry, timing, commit, frames });
            }
        }
        streamed
    }
}

/// `frames` split into runs with the same number of rows.
fn runs(
    frames: impl Iterator<Item = ScheduledFrame>,
    rows: impl Fn(&ScheduledFrame) -> usize,
) -> Vec<Vec<ScheduledFrame>> {
    let mut runs: Vec<Vec<ScheduledFrame>> = Vec::new();
    for frame in frames {
        match runs.last_mut() {
            Some(run) if run.last().map(&rows) == Some(rows(&frame)) => run.push(frame),
            _ => runs.push(vec![frame]),
        }
    }
    runs
}

/// `geometry` with another number of rows, if frames can have that many.
pub(crate) fn of_height(geometry: &Geometry, rows: usize) -> Geometry {
    let other = Geometry::new(geometry.width(), rows, geometry.depth(), geometry.centre2());
    other.unwrap_or(*geometry)
}

/// Every part of a run with this whole schedule, in order.
pub(crate) fn parts_of(schedule: &[Segment]) -> Vec<Part> {
    let frames = schedule.iter().flat_map(|segment| &segment.frames);
    let mut parts: Vec<Part> = Vec::new();
    for part in frames.map(|frame| frame.part).chain([Part::AtSpeed, Part::Corners, Part::Rules]) {
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts
}

impl Plan {
    /// Every part of a run on a board of this build, in the order of its schedule.
    #[must_use]
    pub fn parts(&self, build: &Build) -> Vec<Part> {
        parts_of(&self.whole_schedule(build))
    }

    /// `selection` as it can be streamed. A grid is uploaded whole, and for frames of fewer rows its entries would be at other
    /// places, so with a grid frames are whole.
    pub(crate) fn streamable(&self, selection: &Selection) -> Selection {
        if self.tables.shape().is_some() { selection.of_whole_frames() } else { selection.clone() }
    }

    /// The name of a part for people; for a frame of the plan, the frame's name.
    #[must_use]
    pub fn name_of(&self, part: Part) -> String {
        let source = match part {
            Part::Judged(place) => self.frames.get(place).map(FrameSource::name),
            _ => None,
        };
        source.unwrap_or_else(|| part.to_string())
    }

    /// Whether the rules are tried; a soak never does.
    pub(crate) fn tries_rules(&self) -> bool {
        self.at_speed.soak().is_none() && self.amount(Part::Rules) > 0
    }

    /// Rows of the frames that a board with `capabilities` is given for the rules, and of those among them that are as wide as
    /// it takes; none if the rules are not tried.
    #[must_use]
    pub fn rows_of_rules(&self, capabilities: &Capabilities) -> Option<(usize, usize)> {
        self.tries_rules().then(|| rows_of_rules(capabilities))
    }

    /// Rows of the tallest frame that a board with `capabilities` makes of its own, at speed or for the rules; none if it makes
    /// none.
    #[must_use]
    pub fn tallest_made(&self, capabilities: &Capabilities) -> Option<usize> {
        let bursts = known_bursts(capabilities).ok()?;
        let usual = (self.at_speed != AtSpeed::Off).then(|| self.tables.geometry().height());
        let corner = self.corners(capabilities).iter().map(Geometry::height).max();
        let of_rules = self.tries_rules().then(|| tallest_of_rules(capabilities, bursts.trap));
        [usual, corner, of_rules].into_iter().flatten().max()
    }

    /// Sizes, depths and centres of the rows that a board with `capabilities` plays, streamed or made of its own.
    #[must_use]
    pub fn geometries(&self, capabilities: &Capabilities) -> Vec<Geometry> {
        let streamed = self.schedule(&Build::of(capabilities)).into_iter().map(|segment| segment.geometry);
        let rules = self.tries_rules().then(|| geometries_of_rules(capabilities, self.seed, self.phase));
        let others = self.corners(capabilities).into_iter().chain(rules.unwrap_or_default());
        [*self.tables.geometry()].into_iter().chain(streamed).chain(others).collect()
    }

    /// The geometries of the corners that are judged on a board with `capabilities`.
    fn corners(&self, capabilities: &Capabilities) -> Vec<Geometry> {
        let at_speed = self.at_speed != AtSpeed::Off && self.at_speed.soak().is_none();
        let is_judged = at_speed && self.amount(Part::Corners) > 0 && known_bursts(capabilities).is_ok();
        if is_judged { geometries_of_corners(capabilities, self.seed) } else { Vec::new() }
    }

    /// How much of `part` is to be judged; all of it when the plan has no selection.
    pub(crate) fn amount(&self, part: Part) -> usize {
        self.selection.as_ref().map_or(usize::MAX, |selection| selection.amount(part))
    }
}
