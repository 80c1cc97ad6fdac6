//! Frames that the board makes itself, sends through the core without a pause, and signs: `fpga/AT-SPEED.md`.

mod defects;
mod signer;
mod trap;

use halfrow_protocol::message::{BurstMode, BurstState, FrameRecord};

use crate::content;
use crate::core::{Entering, RowBinding};
use crate::faults::{BoardFault, Defects};
use crate::options::Options;
use crate::player::Player;
use crate::settings::Settings;
use crate::tables::{Bank, Tables};

use signer::{RowInside, Signer};

pub(crate) use defects::{BurstDefects, SlowPath, WarmBit};
pub(crate) use trap::Trapped;

/// What is fixed when a burst starts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// The burst's name.
    pub(crate) burst: u32,
    /// The seed of the content.
    pub(crate) seed: u32,
    /// The number of frame 0.
    pub(crate) first_frame: u16,
    /// Pixel clocks between two frames.
    pub(crate) frame_blanking: u16,
    /// Decides the content and the tables of each frame.
    pub(crate) mode: BurstMode,
}

/// The burst of a session.
#[derive(Debug)]
struct Burst {
    plan: Plan,
    frames: u32,
    /// Frames whose first sample has entered.
    begun: u32,
    /// The next row of the frame that is entering; none between frames.
    row: Option<u16>,
    /// Pixel clocks since the last sample entered.
    since_row: u64,
    /// Whether the next frame has had to wait for a record.
    held_back: bool,
    ended: bool,
    /// The first frame whose record the host does not have yet.
    unread: u32,
}

/// Everything that makes bursts.
#[derive(Debug)]
pub(crate) struct Bursts {
    /// The most records that are kept.
    most: usize,
    least_frame_blanking: u16,
    defects: BurstDefects,
    burst: Option<Burst>,
    signer: Signer,
    samples: Vec<u16>,
}

impl Bursts {
    pub(crate) fn new(options: &Options, fault: Option<BoardFault>) -> Self {
        let Defects { burst, player, .. } = Defects::of(fault);
        Self {
            most: options.records.into(),
            least_frame_blanking: options.least_frame_blanking,
            defects: burst,
            burst: None,
            signer: Signer::new(options.max_height, burst, player.lost_row),
            samples: Vec::new(),
        }
    }

    pub(crate) fn state(&self) -> BurstState {
        match &self.burst {
            None => BurstState::None,
            Some(burst) if burst.ended => BurstState::Ended,
            Some(_) => BurstState::UnderWay,
        }
    }

    pub(crate) fn is_under_way(&self) -> bool {
        self.state() == BurstState::UnderWay
    }

    /// Whether rows inside the core may be using the shadow bank's tables.
    pub(crate) fn uses_shadow(&self) -> bool {
        self.is_under_way() && self.burst.as_ref().is_some_and(|it| it.plan.mode == BurstMode::Alternating)
    }

    /// The name of the session's last burst, 0 for none.
    pub(crate) fn name(&self) -> u32 {
        self.burst.as_ref().map_or(0, |burst| burst.plan.burst)
    }

    /// Sets the number of frames of the last burst, which has no effect if it has ended.
    pub(crate) fn set_frames(&mut self, frames: u32) {
        if let Some(burst) = &mut self.burst {
            burst.frames = frames;
        }
    }

    /// Starts a burst. Drops all records and, in mode 3, what the trap holds.
    pub(crate) fn start(&mut self, plan: Plan, frames: u32) {
        self.signer.start(plan.mode);
        self.burst = Some(Burst {
            plan,
            frames,
            begun: 0,
            row: None,
            since_row: u64::MAX,
            held_back: false,
            ended: false,
            unread: 0,
        });
    }

    /// Ends the burst at once, without records of the frames inside, and empties the trap.
    pub(crate) fn abort(&mut self) {
        if let Some(burst) = &mut self.burst {
            burst.ended = true;
        }
        self.signer.drop_inside();
    }

    /// Forgets the burst, for a new session.
    pub(crate) fn forget(&mut self) {
        self.abort();
        self.signer.records.clear();
        self.burst = None;
    }

    /// Frees the records before `from` and returns the others; none if there can be no such record.
    pub(crate) fn records_from(&mut self, from: u32) -> Option<impl Iterator<Item = &FrameRecord>> {
        let unread = self.burst.as_ref().map_or(0, |burst| burst.unread);
        let freed = usize::try_from(from.checked_sub(unread)?).ok()?;
        if freed > self.signer.records.len() {
            return None;
        }
        self.signer.records.drain(..freed);
        if let Some(burst) = &mut self.burst {
            burst.unread = from;
        }
        Some(self.signer.records.iter())
    }

    /// Sets the expected signatures of the rows from `first` on, as far as such rows exist.
    pub(crate) fn expect(&mut self, first: u16, signatures: impl Iterator<Item = u32>) {
        let rows = self.signer.trap.expected.iter_mut().skip(first.into());
        rows.zip(signatures).for_each(|(row, signature)| *row = signature);
    }

    /// The trapped row, if there is one.
    pub(crate) fn trapped(&self) -> Option<&Trapped> {
        self.signer.trap.kept.as_ref()
    }

    /// Advances a burst that is under way: by about `clocks` pixel clocks, up to the end of a row, or until it ends or waits
    /// for a record.
    pub(crate) fn run(&mut self, player: &mut Player, tables: &mut Tables, clocks: u64) {
        let end = player.now().saturating_add(clocks);
        while let Some(burst) = self.burst.as_mut().filter(|burst| !burst.ended)
            && player.now() < end
        {
            let wanted = burst.begun < burst.frames;
            if let Some(row) = burst.row {
                self.play(row, player, tables);
            } else if wanted && ((burst.begun - burst.unread) as usize) < self.most {
                let blanking = u64::from(burst.plan.frame_blanking).saturating_sub(burst.since_row);
                self.signer.begin_frame(burst.begun, burst.held_back);
                (burst.row, burst.held_back) = (Some(0), false);
                burst.begun += 1;
                self.blank(player, blanking);
            } else {
                burst.ended = !wanted;
                self.rest(player, wanted, end);
                break;
            }
        }
    }

    /// Plays a row of the frame under way, after its blanking.
    fn play(&mut self, row: u16, player: &mut Player, tables: &mut Tables) {
        let settings = player.settings().clone();
        let Settings { width, height, depth, blanking, .. } = settings;
        let centre2 = player.centre2();
        if row > 0 {
            self.blank(player, blanking.into());
        }
        let Some(burst) = &mut self.burst else { return };
        let frame = burst.begun - 1;
        let least_blanking = self.least_frame_blanking.max(tables.claimed_blanking(width));
        let (intended, taken) = burst.banks(frame, row, self.defects, least_blanking);
        let bound = tables.bind_from(taken, row, &settings);
        let generation = match (intended, taken) {
            (Bank::Shadow, _) => 0,
            (Bank::Active, Bank::Active) => bound.generation,
            // A late change is denied.
            (Bank::Active, Bank::Shadow) => tables.generation(),
        };
        let ends_frame = row + 1 == height;
        burst.row = (!ends_frame).then_some(row + 1);
        burst.since_row = 0;
        self.samples.resize(width.into(), 0);
        content::fill(&mut self.samples, depth, burst.plan.seed, burst.plan.number(frame), row);
        let first_in = player.now();
        let last_in = first_in + u64::from(width) - 1;
        let follows = row > 0 || frame > 0;
        self.signer.enter(RowInside { first_in, last_in, row, width, follows, ends_frame }, generation);
        let binding = RowBinding { width, centre2, depth, values: bound.values, kernel: bound.kernel };
        let mut begins = Some(&binding);
        for &sample in &self.samples {
            let (leaving, now) = player.clock(Some(Entering { sample, begins: begins.take() }));
            if let Some(leaving) = leaving {
                self.signer.collect(leaving, now);
            }
        }
    }

    /// Lets the rest of the last frame leave. If another one is `wanted`, which has no free record, its blanking passes too, until
    /// about `end`: only then is it held back.
    fn rest(&mut self, player: &mut Player, wanted: bool, end: u64) {
        let since_row = |burst: &Option<Burst>| burst.as_ref().map_or(u64::MAX, |burst| burst.since_row);
        let rest = u64::from(player.delay()).saturating_sub(since_row(&self.burst));
        self.blank(player, rest);
        let blanking = self.burst.as_ref().map_or(0, |burst| burst.plan.frame_blanking);
        let blanking = u64::from(blanking).saturating_sub(since_row(&self.burst));
        let passes = if wanted { blanking.min(end.saturating_sub(player.now())) } else { 0 };
        self.blank(player, passes);
        if let Some(burst) = &mut self.burst {
            burst.held_back = wanted && passes == blanking;
        }
    }

    /// Lets pixel clocks pass without a sample.
    fn blank(&mut self, player: &mut Player, clocks: u64) {
        for _ in 0..clocks {
            if let (Some(leaving), now) = player.clock(None) {
                self.signer.collect(leaving, now);
            }
        }
        if let Some(burst) = &mut self.burst {
            burst.since_row = burst.since_row.saturating_add(clocks);
        }
    }
}

impl Burst {
    /// The bank that a row of a frame should be made with, and the one that it is made with.
    fn banks(&self, frame: u32, row: u16, defects: BurstDefects, least_blanking: u16) -> (Bank, Bank) {
        let Plan { mode, frame_blanking, .. } = self.plan;
        let bank = |frame: u32| match mode {
            BurstMode::Alternating if !frame.is_multiple_of(2) => Bank::Shadow,
            _ => Bank::Active,
        };
        let is_late = defects.late_swap && row == 0 && frame > 0 && frame_blanking <= least_blanking;
        (bank(frame), bank(if is_late { frame - 1 } else { frame }))
    }
}

impl Plan {
    /// The frame's number, which decides its content.
    fn number(&self, frame: u32) -> u16 {
        match self.mode {
            BurstMode::Fresh | BurstMode::Alternating => self.first_frame.wrapping_add(frame as u16),
            BurstMode::Repeating | BurstMode::Trapped => self.first_frame,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::depth::Depth;

    /// Pixel clocks of a burst of three frames of four rows of 64 samples. The last sample leaves the core 44 clocks after it
    /// entered.
    fn clocks(blanking: u16, frame_blanking: u16) -> u64 {
        let options = Options::default();
        let (mut player, mut tables) = (Player::new(&options, None).unwrap(), Tables::new(&options, None));
        let settings =
            Settings { width: 64, height: 4, centre2: 63, depth: Depth::Eight, blanking, gap_seed: 5 };
        player.configure(settings).unwrap();
        let mut bursts = Bursts::new(&options, None);
        bursts.start(Plan { burst: 1, seed: 1, first_frame: 0, frame_blanking, mode: BurstMode::Fresh }, 3);
        bursts.run(&mut player, &mut tables, u64::MAX);
        assert_eq!((bursts.state(), bursts.signer.records.len()), (BurstState::Ended, 3));
        player.now()
    }

    /// Whether each of three frames was held back, and the pixel clocks of all, if the record of the first is freed when the blanking
    /// of the third, 1000 pixel clocks, has passed for `waited`. There are two records.
    fn held_back(waited: u64) -> (Vec<bool>, u64) {
        let options = Options { records: 2, ..Options::default() };
        let (mut player, mut tables) = (Player::new(&options, None).unwrap(), Tables::new(&options, None));
        let settings =
            Settings { width: 64, height: 4, centre2: 63, depth: Depth::Eight, blanking: 0, gap_seed: 0 };
        player.configure(settings).unwrap();
        let mut bursts = Bursts::new(&options, None);
        let plan = Plan { burst: 1, seed: 1, first_frame: 0, frame_blanking: 1000, mode: BurstMode::Fresh };
        bursts.start(plan, 3);
        bursts.run(&mut player, &mut tables, 256 + 1000 + 256 + waited);
        let first: Vec<_> = bursts.records_from(0).unwrap().map(|record| record.held_back).collect();
        let others = bursts.records_from(1).unwrap().count();
        bursts.run(&mut player, &mut tables, u64::MAX);
        assert_eq!((first.len(), others, bursts.state()), (2, 1, BurstState::Ended));
        let all = bursts.records_from(1).unwrap().map(|record| record.held_back);
        (first.into_iter().take(1).chain(all).collect(), player.now())
    }

    /// By AT-SPEED.md, Time.
    #[test]
    fn a_frame_is_held_back_only_if_no_record_is_free_when_its_blanking_has_passed() {
        let clocks = 3 * 256 + 2 * 1000 + 44;
        assert_eq!(held_back(500), (vec![false; 3], clocks));
        assert_eq!(held_back(999), (vec![false; 3], clocks));
        assert_eq!(held_back(1000), (vec![false, false, true], clocks));
    }

    /// Neither blanking is visible from outside, where a frame shows only its samples and latencies.
    #[test]
    fn between_rows_and_frames_pass_exactly_their_blankings() {
        assert_eq!(clocks(0, 8), 3 * 4 * 64 + 2 * 8 + 44);
        assert_eq!(clocks(7, 8), 3 * (4 * 64 + 3 * 7) + 2 * 8 + 44);
        assert_eq!(clocks(7, 1000), 3 * (4 * 64 + 3 * 7) + 2 * 1000 + 44);
    }
}
