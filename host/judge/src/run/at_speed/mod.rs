//! Frames that the board makes itself, at the full pixel clock (AT-SPEED.md).
//!
//! Streamed frames are played a row at a time, since no link carries a video. A burst is played without a pause: the
//! board makes its frames and signs them, and the signatures are judged.

mod burst;
mod clock;
mod content_wrong;
mod corners;
mod grids;
mod predicted;
mod price;
mod records_late;
mod repeated;
mod soak;
mod streamed;
mod tables_late;
mod watched;

use std::time::Duration;

use halfrow_model::Geometry;
use halfrow_protocol::message::Capabilities;

use super::findings::exercised::Exercised;
use super::findings::levels::Levels;
use super::findings::{During, End};
use super::frames::observations::Observations;
use super::plan::parts::Part;
use super::plan::{AtSpeed, DECOY, JUDGED, Segment};
use super::steps::Run;
use crate::board::{Bank, Bursts, Datapath, RowTiming};
use crate::progress::{Event, JudgedAtSpeed, Step};
use crate::reference::correct;
use crate::result::{CheckName, ClockSeen, Corner, EqualAtSpeed, Finding, NoBurst, NotExercised};
use crate::tables::{Generation, datapath_of};
use burst::{BurstPlan, datapath_of_all};
pub(super) use burst::{USUAL_CLOCK, content};
pub(super) use price::{clock_hz, most_frames, price_of_corners, price_of_frames};
pub(super) use repeated::MadeRows;
use watched::{BurstSeen, EndsEarly};

pub(super) use corners::geometries_of_corners;
pub(super) use predicted::signer;

/// The content id that the model makes (AT-SPEED.md).
pub(super) const CONTENT: u16 = 1;
/// How long a burst takes on hardware by default, on the board's clock.
const USUAL: Duration = Duration::from_secs(3);
/// The frames of a burst on any other board by default.
pub(crate) const FEW_AT_SPEED: u32 = 3;
/// The draw of the first corner's content, far from the draws of a soak.
const FIRST_CORNER: u32 = 1 << 31;

/// No frames, at a clock that is not named.
const NONE: EqualAtSpeed = EqualAtSpeed {
    frames: 0,
    clock_hz: 0,
    seen: ClockSeen { least_hz: None, most_hz: None },
    seconds: None,
    held_back: 0,
    corners: 0,
};

/// The bursts that a board makes, or why there are none that this program knows.
pub(super) fn known_bursts(capabilities: &Capabilities) -> Result<Bursts, NoBurst> {
    match capabilities.bursts {
        None => Err(NoBurst::BoardMakesNone {}),
        Some(bursts) if bursts.content != CONTENT => {
            Err(NoBurst::ContentUnknown { content: bursts.content, known: CONTENT })
        }
        Some(bursts) => Ok(bursts),
    }
}

impl Run<'_> {
    /// Judges a burst, and returns what was exercised. If the board goes away meanwhile, it is brought back to where it was after
    /// `last`.
    pub(super) fn at_speed(
        &mut self,
        last: Option<&Segment>,
        seen: &mut Observations,
    ) -> Result<Exercised, End> {
        let bursts = match self.bursts() {
            Ok(bursts) => bursts,
            Err(reason) => {
                self.findings.checks.skipped(CheckName::AtSpeed, Finding::NothingAtSpeed { reason });
                let left = [NotExercised::FullSpeed {}].into_iter().chain(self.clock_unseen()).collect();
                return Ok(Exercised { left, ..Exercised::default() });
            }
        };
        self.progress.step(Step::AtSpeed);
        self.persist(last, |run| run.judge_burst(bursts, seen))
    }

    /// The bursts that this run judges, or why it judges none.
    fn bursts(&self) -> Result<Bursts, NoBurst> {
        match self.plan.amount(Part::AtSpeed) {
            0 => Err(NoBurst::LeftOut {}),
            _ if self.plan.at_speed == AtSpeed::Off => Err(NoBurst::NotAskedFor {}),
            _ => known_bursts(&self.board.capabilities),
        }
    }

    fn judge_burst(&mut self, bursts: Bursts, seen: &mut Observations) -> Result<Exercised, End> {
        self.set(self.plan.tables.geometry(), datapath_of(&self.plan.tables))?;
        let tables = self.tables_at_speed(seen)?;
        let plan = self.burst_plan(bursts, &tables);
        let watched = self.judge_frames(&plan, &tables)?;
        let clock = self.judge_clock(&plan, &tables, &watched)?;
        let changes = tables_late::would_show(&plan, &tables, watched.frames);
        let mut exercised = Exercised { left: untested(changes, watched.paused > 0), ..Exercised::default() };
        exercised.left.extend(self.clock_not_exercised(clock));
        let corners = match self.plan.amount(Part::Corners) {
            0 => 0,
            _ => self.judge_corners(bursts, &mut exercised, seen)?,
        };
        if watched.paused == 0 {
            exercised.whole = [JUDGED, DECOY].into_iter().take(tables.len()).collect();
        }
        let BurstSeen { frames, paused, held_back, .. } = watched;
        let clock_hz = self.board.capabilities.clock_hz;
        let seconds = (clock_hz > 0 && clock.allows(clock_hz)).then(|| plan.seconds(frames));
        let (frames, held_back) = (u64::from(frames), u64::from(held_back));
        self.note_right(
            paused.into(),
            EqualAtSpeed { frames, seen: clock, seconds, held_back, corners, ..NONE },
        );
        Ok(exercised)
    }

    fn set(&mut self, geometry: &Geometry, datapath: Datapath) -> Result<(), End> {
        self.board.configure(geometry, RowTiming::default(), datapath).during(CheckName::AtSpeed)
    }

    /// Puts the tables of `generation` into the bank that is not active.
    fn put_aside(&mut self, generation: &Generation) -> Result<(), End> {
        self.board.upload(&generation.tables, &generation.kernel).during(CheckName::AtSpeed)?;
        self.check_read_back(CheckName::AtSpeed, Bank::Shadow, generation).map(drop)
    }

    /// Has the board make the burst. A wrong frame or a wrong count ends the run.
    fn judge_frames(&mut self, plan: &BurstPlan, tables: &[Generation]) -> Result<BurstSeen, End> {
        let (ends_early, progress) = (EndsEarly { when_wrong: self.plan.fail_fast, at: None }, self.progress);
        let mut told = |watched: &BurstSeen, _| {
            progress.event(Event::AtSpeed(JudgedAtSpeed { frames: watched.frames, of: plan.frames }));
        };
        let (watched, ended) = self.watch(plan, tables, ends_early, &mut told);
        // What came under the board's own CRC is valid, however the burst ended.
        if watched.wrong > 0 {
            return Err(self.wrong_at_speed(plan, tables, &watched));
        }
        if let Some(miscount) = watched.miscount {
            return Err(End::failed(CheckName::AtSpeed, miscount.finding));
        }
        ended.map(|()| watched)
    }

    /// Judges frames in each corner of the board's settings, and returns the number of corners.
    fn judge_corners(
        &mut self,
        bursts: Bursts,
        exercised: &mut Exercised,
        seen: &mut Observations,
    ) -> Result<u32, End> {
        let capabilities = self.board.capabilities.clone();
        let corners = corners::corners(&capabilities, self.plan.seed);
        for (place, tables) in (0..).zip(&corners) {
            let Some(active) = tables.first().map(|active| &active.tables) else { continue };
            let in_corner =
                |end: End| end.failed_as(|found| Finding::InCorner { corner: Corner::from(active), found });
            self.upload_corner(tables).map_err(in_corner)?;
            let datapath = datapath_of_all(tables);
            let plan = BurstPlan::new(active.geometry(), &capabilities, bursts, datapath)
                .drawn(self.plan.seed, FIRST_CORNER + place)
                .made_with(tables)
                .of_frames(2);
            let watched = self.judge_frames(&plan, tables).map_err(in_corner)?;
            if watched.paused == 0 {
                if tables_late::would_show(&plan, tables, watched.frames) {
                    exercised.left.retain(|part| *part != NotExercised::TableChangeAtSpeed {});
                }
                self.note_shown(&plan, tables, seen);
                exercised.corners.extend_from_slice(tables);
            }
        }
        Ok(corners.len() as u32)
    }

    /// Notes what the frames of `plan` show, one for each bank.
    fn note_shown(&self, plan: &BurstPlan, tables: &[Generation], seen: &mut Observations) {
        for (n, generation) in (0..).zip(tables) {
            let input = plan.content(n).frame(generation.tables.geometry(), self.plan.phase);
            if let Ok(expected) = correct(&generation.tables, &generation.kernel, &input) {
                let Generation { tables, kernel, .. } = generation;
                let centre = Levels::of_centre(tables, kernel, &input, &expected, seen.shown.centre);
                seen.shown.note(&input, &expected, centre);
            }
        }
    }

    /// Makes the first of `tables` active, and puts the second into the other bank.
    fn upload_corner(&mut self, tables: &[Generation]) -> Result<(), End> {
        let datapath = datapath_of_all(tables);
        for (place, generation) in tables.iter().enumerate() {
            self.set(generation.tables.geometry(), datapath)?;
            self.put_aside(generation)?;
            // In a frame of another height the entries of a grid are at other places.
            let rows = if generation.tables.shape().is_some() { usize::MAX } else { 1 };
            let first_rows = generation.upper(rows.min(generation.tables.geometry().height()));
            if let Some(first_rows) = first_rows.filter(|_| place == 0) {
                self.set(first_rows.tables.geometry(), datapath)?;
                self.activate(&first_rows)?;
            }
        }
        tables.first().map_or(Ok(()), |active| self.set(active.tables.geometry(), datapath))
    }

    /// The tables with which frames are made by turns: the active ones, which have the factors and the kernel to judge
    /// with whatever setting was varied, and those of the other bank, which are the decoy's.
    fn tables_at_speed(&mut self, seen: &Observations) -> Result<Vec<Generation>, End> {
        let number = seen.frames.last().map_or(0, |frame| frame.generation);
        let active =
            Generation { number, tables: self.plan.tables.clone(), kernel: self.plan.kernel.clone() };
        let decoy = self.generation(DECOY);
        let can_have = |decoy: &Generation| {
            self.board.capabilities.table_banks > 1 && self.board.knows_shape_of(&decoy.tables)
        };
        let Some(decoy) = decoy.filter(can_have) else {
            return Ok(vec![active]);
        };
        self.put_aside(&decoy)?;
        Ok(vec![active, decoy])
    }

    fn burst_plan(&self, bursts: Bursts, tables: &[Generation]) -> BurstPlan {
        let usual = price::usual_burst(self.plan, &self.board.capabilities, bursts).made_with(tables);
        let most = u32::try_from(self.plan.amount(Part::AtSpeed)).unwrap_or(u32::MAX);
        usual.of_frames(usual.frames.min(most.max(2)))
    }

    /// Notes that all frames are right, of which `paused` had pauses.
    fn note_right(&mut self, paused: u64, right: EqualAtSpeed) {
        let (clock_hz, frames) = (self.board.capabilities.clock_hz, right.frames);
        let equal = Finding::EqualAtSpeed(EqualAtSpeed { clock_hz, ..right });
        match paused {
            0 => self.findings.checks.passed(CheckName::AtSpeed, equal),
            _ => self.findings.checks.skipped(CheckName::AtSpeed, Finding::PausedAtSpeed { frames, paused }),
        }
    }
}

/// What bursts did not exercise at the full pixel clock, by whether a late change of tables would have shown in them and whether frames
/// had pauses.
fn untested(change_would_show: bool, paused: bool) -> Vec<NotExercised> {
    if paused {
        return vec![NotExercised::FullSpeed {}];
    }
    if change_would_show { Vec::new() } else { vec![NotExercised::TableChangeAtSpeed {}] }
}
