//! Cases played on the Verilog core alone, by a player that demands of it all that a board may demand: the tables of the next
//! frame are written while this one plays, a row is announced at any time that is allowed, and the enable comes and goes.

use std::collections::VecDeque;

use halfrow_sim::{Core, CoreBuild, CoreInputs, CoreOutputs};

use halfrow_tests::cases::{Build, Case, Played};
use halfrow_tests::dice::Dice;

/// The build of this core, for which cases are drawn.
#[must_use]
pub(crate) fn build(core: CoreBuild) -> Build {
    Build {
        latency: core.latency(),
        ring: core.ring(),
        least_blanking: 0,
        outer_taps: core.has_outer_taps(),
        grids: None,
    }
}

/// The core, with what goes in and what has come out.
struct Bench<'a> {
    core: &'a mut Core,
    case: &'a Case,
    dice: &'a mut Dice,
    /// Table entries still to be written, one a clock.
    writes: VecDeque<CoreInputs>,
    /// Frames whose tables are written or in that queue.
    tables: usize,
    /// Rows that were announced; and whether the last of them may start.
    announced: usize,
    prepared: bool,
    pixel_clock: u64,
    /// The pixel clocks at which the rows that are inside entered.
    entered: VecDeque<u64>,
    /// Outputs so far of the row that is leaving.
    left: u64,
    played: Played,
}

/// What the core outputs for `case`.
///
/// # Panics
/// When it flags a row, marks a row's ends wrongly, or is not ready for a row in time.
pub(crate) fn play(core: &mut Core, case: &Case, dice: &mut Dice) -> Played {
    let mut bench = Bench::reset(core, case, dice);
    let frames = case.frames.iter().flat_map(|(_, _, frame)| frame.rows());
    for (row, samples) in frames.enumerate() {
        bench.begin(row);
        let announce = 1 + bench.dice.below(samples.len());
        for (column, &sample) in samples.iter().enumerate() {
            bench.pause();
            bench.enter(sample, column == 0, column == announce && bench.may_announce(row + 1));
        }
        let in_time = bench.announced > row + 1 && announce <= samples.len() / 2 + 1;
        assert!(!in_time || bench.prepared, "row {} was announced at column {announce}", row + 1);
        bench.blank();
    }
    for _ in 0..case.delay() {
        bench.clock(BLANK);
    }
    bench.played
}

/// Only time passes; with [`BLANK`], pixel clocks pass, too.
const STILL: CoreInputs = CoreInputs {
    rst: false,
    enable: false,
    depth: 0,
    prepare: false,
    prepare_bank: false,
    in_valid: false,
    in_start: false,
    step_write: false,
    node_write: false,
    table_bank: false,
    width: 0,
    centre2: 0,
    prepare_row: 0,
    in_sample: 0,
    table_entry: 0,
    table_data: [0; 3],
};
const BLANK: CoreInputs = CoreInputs { enable: true, ..STILL };

impl<'a> Bench<'a> {
    fn reset(core: &'a mut Core, case: &'a Case, dice: &'a mut Dice) -> Self {
        core.clock(&CoreInputs { rst: true, ..STILL });
        Self {
            core,
            case,
            dice,
            writes: VecDeque::new(),
            tables: 0,
            announced: 0,
            prepared: false,
            pixel_clock: 0,
            entered: VecDeque::new(),
            left: 0,
            played: Played::default(),
        }
    }

    fn height(&self) -> usize {
        self.case.settings.height.into()
    }

    /// Queues the next frame's tables once the frame that used their bank has left.
    fn queue_tables(&mut self) {
        let left = self.played.latencies.len() / 2;
        let Some((set, kernel, _)) = self.case.frames.get(self.tables) else { return };
        if left < self.tables.saturating_sub(1) * self.height() {
            return;
        }
        let table_bank = self.tables % 2 == 1;
        let row_factors = (0..).zip(set.entries()).map(|(table_entry, units)| CoreInputs {
            step_write: true,
            table_entry,
            table_data: [units, 0, 0],
            ..STILL
        });
        let nodes = (0..).zip(kernel.nodes()).map(|(table_entry, node)| {
            let [g0, r1, g4, r5, g6] = node.map(|word| u32::from(word as u16));
            let table_data = [g0 | r1 << 16, g4 | r5 << 16, g6];
            CoreInputs { node_write: true, table_entry, table_data, ..STILL }
        });
        self.writes.extend(row_factors.chain(nodes).map(|write| CoreInputs { table_bank, ..write }));
        self.tables += 1;
    }

    /// One clock of the core. `pixel` says what happens on its pixel inputs.
    fn clock(&mut self, pixel: CoreInputs) {
        self.queue_tables();
        let write = self.writes.pop_front().unwrap_or(STILL);
        let settings = &self.case.settings;
        let inputs = CoreInputs {
            width: settings.width,
            centre2: settings.centre2,
            depth: (settings.depth.bits() - 8) / 2,
            step_write: write.step_write,
            node_write: write.node_write,
            table_bank: write.table_bank,
            table_entry: write.table_entry,
            table_data: write.table_data,
            ..pixel
        };
        let outputs = self.core.clock(&inputs);
        assert!(!outputs.row_short && !outputs.row_long && !outputs.row_unprepared, "{outputs:?}");
        self.prepared = outputs.prepared && !pixel.prepare;
        if pixel.enable {
            if pixel.in_start {
                self.entered.push_back(self.pixel_clock);
            }
            if outputs.out_valid {
                self.collect(&outputs);
            }
            self.pixel_clock += 1;
        }
    }

    fn collect(&mut self, outputs: &CoreOutputs) {
        let (first, last) = (self.left == 0, self.left + 1 == u64::from(self.case.settings.width));
        assert_eq!((outputs.out_start, outputs.out_last), (first, last), "column {}", self.left);
        let entered = *self.entered.front().unwrap();
        if first || last {
            self.played.latencies.push((self.pixel_clock - entered - self.left) as u16);
        }
        self.left += 1;
        if last {
            self.entered.pop_front();
            self.left = 0;
        }
        self.played.samples.push(outputs.out_sample);
    }

    /// Whether everything that row `row` needs is written, and the row is the next to be announced.
    fn may_announce(&self, row: usize) -> bool {
        self.announced == row && self.tables > row / self.height() && self.writes.is_empty()
    }

    fn announcement(&self, row: usize) -> CoreInputs {
        let (frame, row) = (row / self.height(), row % self.height());
        CoreInputs { prepare: true, prepare_row: row as u16, prepare_bank: frame % 2 == 1, ..STILL }
    }

    /// Waits until row `row` may start. While its tables wait for a frame to leave, pixel clocks pass.
    fn begin(&mut self, row: usize) {
        while self.announced == row {
            if self.may_announce(row) {
                self.clock(self.announcement(row));
                self.announced += 1;
            } else {
                self.clock(if self.tables > row / self.height() { STILL } else { BLANK });
            }
        }
        let ready = self.prepared
            || (0..100).any(|_| {
                self.clock(STILL);
                self.prepared
            });
        assert!(ready, "row {row} is not prepared");
    }

    fn enter(&mut self, in_sample: u16, in_start: bool, announce: bool) {
        let announcement = if announce { self.announcement(self.announced) } else { STILL };
        self.announced += usize::from(announce);
        self.clock(CoreInputs { enable: true, in_valid: true, in_start, in_sample, ..announcement });
    }

    /// Takes the enable away, before about every eighth sample.
    fn pause(&mut self) {
        while self.case.settings.gap_seed != 0 && self.dice.below(8) == 0 {
            self.clock(STILL);
        }
    }

    fn blank(&mut self) {
        let extra = if self.case.settings.gap_seed == 0 { 0 } else { self.dice.below(16) };
        for _ in 0..usize::from(self.case.settings.blanking) + extra {
            self.clock(BLANK);
        }
    }
}
