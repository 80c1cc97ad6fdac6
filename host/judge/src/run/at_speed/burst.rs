//! The plan of a burst.

use std::collections::BTreeSet;
use std::time::Duration;

use halfrow_model::{BitDepth, Content, Geometry, MIN_WIDTH};
use halfrow_protocol::message::{Burst, BurstMode};

use super::price::clock_hz;
use crate::board::{Bursts, Capabilities, Datapath, frame_blanking, frame_clocks, row_blanking};
use crate::tables::{Generation, datapath_of};

/// The pixel clock, in hertz, that is assumed for a board that names none: that of the paper's sensor.
pub(in crate::run) const USUAL_CLOCK: u32 = 96_000_000;
/// 2^64 / golden ratio: spreads the seeds of runs over all seeds of bursts.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
/// The longest time between two looks at the records, so that a run can be stopped without delay.
pub(super) const LONGEST_LOOK: Duration = Duration::from_millis(250);
/// The shortest time, which leaves a link time for other things.
const SHORTEST_LOOK: Duration = Duration::from_millis(10);
/// The least time that a frame is waited for.
const PATIENCE: Duration = Duration::from_secs(5);
/// A frame is waited for at least as long as this many frames take.
const PATIENT_FRAMES: u32 = 20;
/// The longest that a frame is waited for, however slow a clock the board claims.
const LONGEST_PATIENCE: Duration = Duration::from_secs(300);

/// The plan of a burst.
#[derive(Clone, Copy, Debug)]
pub(super) struct BurstPlan {
    /// The number of its frames.
    pub(super) frames: u32,
    /// Which content and which tables each frame has.
    pub(super) mode: BurstMode,
    seed: u32,
    first_frame: u16,
    bursts: Bursts,
    /// Pixel clocks between two frames.
    frame_blanking: u16,
    /// Pixel clocks from the first sample of one frame to that of the next.
    clocks: u64,
    clock_hz: u32,
    /// W·H.
    pub(super) samples: u32,
    /// H.
    pub(super) rows: u16,
    /// D, in pixel clocks.
    pub(super) latency: u16,
}

impl BurstPlan {
    /// A burst with no frames yet, whose frames have the size of `geometry`, each with new content. The greater `datapath` of
    /// the tables in both banks decides how far its rows are apart.
    pub(super) fn new(
        geometry: &Geometry,
        capabilities: &Capabilities,
        bursts: Bursts,
        datapath: Datapath,
    ) -> Self {
        let (width, height) = (geometry.width(), geometry.height());
        let blanking = row_blanking(capabilities, width, datapath);
        let frame_blanking = frame_blanking(capabilities, bursts, width, datapath);
        Self {
            frames: 0,
            mode: BurstMode::Fresh,
            seed: 0,
            first_frame: 0,
            bursts,
            frame_blanking,
            clocks: frame_clocks((width, height), blanking, frame_blanking),
            clock_hz: clock_hz(capabilities),
            samples: (width * height) as u32,
            rows: height as u16,
            latency: width as u16 / 2 + u16::from(capabilities.latency),
        }
    }

    /// The same with the seed that is draw number `draw` from the run's `seed`.
    pub(super) fn drawn(self, seed: u64, draw: u32) -> Self {
        let drawn = seed.wrapping_add(1 + u64::from(draw)).wrapping_mul(GOLDEN) >> 32;
        Self { seed: telling_seed(drawn as u32), ..self }
    }

    /// The same, made with `tables` by turns.
    pub(super) fn made_with(self, tables: &[Generation]) -> Self {
        let mode = if tables.len() > 1 { BurstMode::Alternating } else { BurstMode::Fresh };
        Self { mode, ..self }
    }

    /// The same with `frames` frames.
    pub(super) fn of_frames(self, frames: u32) -> Self {
        Self { frames, ..self }
    }

    /// A burst of `frames` frames, all with the content of frame `n`, with the trap set.
    pub(super) fn trapping(&self, n: u32, frames: u32) -> Self {
        Self { frames, mode: BurstMode::Trapped, first_frame: self.content(n).frame, ..*self }
    }

    /// The request that starts it with the name `burst`.
    pub(super) fn request(&self, burst: u32) -> Burst {
        Burst {
            burst,
            frames: self.frames,
            seed: self.seed,
            first_frame: self.first_frame,
            frame_blanking: self.frame_blanking,
            mode: self.mode,
        }
    }

    /// The content of frame `n`.
    pub(super) fn content(&self, n: u32) -> Content {
        content(&self.request(0), n)
    }

    /// Whether frame `n` is made with the tables of the other bank.
    pub(super) fn is_of_shadow(&self, n: u32) -> bool {
        self.mode == BurstMode::Alternating && n % 2 == 1
    }

    /// Pixel clocks of `frames` frames, including the blanking before another one.
    pub(super) fn clocks_of(&self, frames: u32) -> u64 {
        self.clocks * u64::from(frames)
    }

    /// Records that the board keeps.
    pub(super) fn records(&self) -> u32 {
        self.bursts.records.into()
    }

    /// The seed from which content is drawn.
    pub(super) fn seed(&self) -> u32 {
        self.seed
    }

    /// Whether the board has a trap, which keeps a row that differs.
    pub(super) fn has_trap(&self) -> bool {
        self.bursts.trap
    }

    /// How many frames fit into `time` on the board's clock, but at least one for each bank of tables.
    pub(super) fn frames_in(&self, time: Duration) -> u32 {
        let frames = time.as_secs_f64() * f64::from(self.clock_hz) / self.clocks as f64;
        // The greatest number means a burst without an end.
        (frames as u32).clamp(2, u32::MAX - 1)
    }

    /// How long `frames` take on the board's clock, in seconds.
    pub(super) fn seconds(&self, frames: u32) -> f64 {
        f64::from(frames) * self.clocks as f64 / f64::from(self.clock_hz)
    }

    /// The same as a [`Duration`].
    pub(super) fn time_of(&self, frames: u32) -> Duration {
        Duration::from_secs_f64(self.seconds(frames))
    }

    /// How long to wait for more records when `left` frames are to come: until half of the board's records are filled.
    pub(super) fn look_again_in(&self, left: u32) -> Duration {
        let frames = left.min(u32::from(self.bursts.records / 2)).max(1);
        self.time_of(1).saturating_mul(frames).clamp(SHORTEST_LOOK, LONGEST_LOOK)
    }

    /// How long to wait for a record before the burst counts as stalled.
    pub(super) fn patience(&self) -> Duration {
        self.time_of(1).saturating_mul(PATIENT_FRAMES).clamp(PATIENCE, LONGEST_PATIENCE)
    }
}

/// The datapath for which the rows of a burst must be far enough apart that is made with `tables` by turns.
pub(super) fn datapath_of_all(tables: &[Generation]) -> Datapath {
    let has_grid = tables.iter().any(|generation| datapath_of(&generation.tables) == Datapath::Grids);
    if has_grid { Datapath::Grids } else { Datapath::RowFactors }
}

/// The content of frame `n` of `burst` (AT-SPEED.md).
pub(in crate::run) fn content(burst: &Burst, n: u32) -> Content {
    let own = matches!(burst.mode, BurstMode::Fresh | BurstMode::Alternating);
    let frame = burst.first_frame.wrapping_add(if own { n as u16 } else { 0 });
    Content { seed: burst.seed, frame }
}

/// Of `drawn` and its three neighbours, each of which has another kind of content in row 0, the one whose row 0 is noise,
/// in all of the first 32 frames: a toggle that is constant in each colour would hide tables that change a row late.
fn telling_seed(drawn: u32) -> u32 {
    let levels = |seed: &u32| {
        let mut row = [0; MIN_WIDTH];
        Content { seed: *seed, frame: 0 }.row(0, BitDepth::Twelve, &mut row);
        BTreeSet::from(row).len()
    };
    (0..4).map(|low| drawn ^ low).max_by_key(levels).unwrap_or(drawn)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(clock_hz: u32) -> BurstPlan {
        BurstPlan {
            frames: 3,
            mode: BurstMode::Alternating,
            seed: 1,
            first_frame: 0xfffe,
            bursts: Bursts { content: 1, records: 64, least_frame_blanking: 100, trap: true },
            frame_blanking: 100,
            clocks: 1920 * 1080 + 100,
            clock_hz,
            samples: 1920 * 1080,
            rows: 1080,
            latency: 972,
        }
    }

    /// 96 MHz / 2,073,700 clocks are 46.29 frames a second, of 21.6 ms each.
    #[test]
    fn a_time_on_the_boards_clock_is_a_number_of_frames() {
        let plan = plan(96_000_000);
        let frames = |seconds| plan.frames_in(Duration::from_secs_f64(seconds));
        assert_eq!([frames(3.0), frames(1.0), frames(0.001), frames(1e9)], [138, 46, 2, u32::MAX - 1]);
        assert_eq!((plan.seconds(138) * 100.0).round(), 298.0);
    }

    #[test]
    fn records_are_looked_for_before_the_board_has_no_room_for_more() {
        let look = |clock_hz, left| plan(clock_hz).look_again_in(left).as_millis();
        // 32 frames would be 691 ms.
        assert_eq!([1000, 3].map(|left| look(96_000_000, left)), [250, 64]);
        assert_eq!(look(1_000_000_000, 1), 10);
        assert_eq!(plan(96_000_000).patience(), Duration::from_secs(5));
        // 1 MHz: 2.07 s a frame.
        assert_eq!(plan(1_000_000).patience().as_secs(), 41);
        // 24 days a frame.
        assert_eq!(plan(1).patience(), Duration::from_secs(300));
    }

    /// Of 64 draws from 4096 levels about 63 are different. Steps have about five levels, the other kinds two.
    #[test]
    fn row_0_is_noise_wherever_a_usual_burst_changes_tables() {
        for drawn in (0..=u32::MAX).step_by(1 << 22) {
            let seed = telling_seed(drawn);
            for frame in 0..32 {
                let mut row = [0; MIN_WIDTH];
                Content { seed, frame }.row(0, BitDepth::Twelve, &mut row);
                assert!(BTreeSet::from(row).len() > 48, "{drawn:08x}, frame {frame}");
            }
        }
    }

    #[test]
    fn frames_are_numbered_modulo_2_to_the_16_and_repeat_where_they_should() {
        let plan = plan(0);
        let numbers = |plan: &BurstPlan| [0, 1, 2, 3].map(|n| plan.content(n).frame);
        assert_eq!(numbers(&plan), [0xfffe, 0xffff, 0, 1]);
        assert_eq!([0, 1, 2].map(|n| plan.is_of_shadow(n)), [false, true, false]);
        let again = plan.trapping(3, 8);
        assert_eq!(numbers(&again), [1; 4]);
        assert!(!again.is_of_shadow(1));
    }
}
