//! Boards that make frames on their own, for the tests of `fpga/AT-SPEED.md`. Other boards are tested only by the test for such
//! boards in `burst_refusals`.

use std::time::Duration;

use halfrow_protocol::message::{
    Burst, BurstMode, BurstState, Bursts, Configuration, FrameRecord, Reply, Request, Reset, ResetLevel,
    RowPlace,
};

use crate::bench::{Bench, HELLO};
use crate::frames::{Row, configuration};
use crate::material::{GOLDEN_FACTOR, hermite, noise_row};
use crate::uploads::TableSet;
use crate::{Boards, Build, offered};

/// The row signatures of the page's frame of four rows: 64 columns, 12 bits, seed 1, frame 0, made with [`golden_tables`].
pub const ROWS: [u32; 4] = [0x3b58_4a0c, 0xa0a8_5d70, 0x068e_af3c, 0x4f53_a7e2];

/// The CRC-32 of the content of these rows, which is also their signature if the tables change no sample.
pub(crate) const CONTENTS: [u32; 4] = [0x3f30_8f73, 0x1470_85ad, 0x4de3_0b33, 0x4f53_a7e2];

/// The signature of the page's frame of four rows.
pub const FRAME: u32 = 0xc40b_35b2;

/// How many rows that frame has.
pub const HEIGHT: u16 = 4;

/// The tables of that frame: the golden factor in each row, and Hermite's kernel.
#[must_use]
pub fn golden_tables() -> TableSet {
    TableSet::new(&[GOLDEN_FACTOR; HEIGHT as usize], &hermite())
}

/// A burst of that one frame.
pub const ONE: Burst =
    Burst { burst: 0xb0, frames: 1, seed: 1, first_frame: 0, frame_blanking: 2000, mode: BurstMode::Fresh };

/// A burst of the golden frame, over and over, until it is ended.
pub const ENDLESS: Burst = Burst { frames: Burst::ENDLESS, mode: BurstMode::Repeating, ..ONE };

/// The board's support for bursts; none if it makes none with the page's content.
pub(crate) fn bursts_of(bench: &mut Bench) -> Option<Bursts> {
    bench.capabilities().bursts.filter(|bursts| bursts.content == 1)
}

/// A board of this build, configured and empty, with these tables active as generation 1. None if the build is not offered or
/// makes no bursts.
pub fn ready_with(
    on: &dyn Boards,
    build: &Build,
    configuration: Configuration,
    tables: &TableSet,
) -> Option<(Bench, Bursts)> {
    let build = offered(on, [build.clone()]).pop()?;
    let mut bench = Bench::switched_on(on, &build);
    bench.greet(&HELLO);
    let bursts = bursts_of(&mut bench)?;
    make_ready(&mut bench, configuration, tables);
    Some((bench, bursts))
}

/// Configures an empty board, and makes these tables the active ones as generation 1, unless that generation is already active.
pub(crate) fn make_ready(bench: &mut Bench, configuration: Configuration, tables: &TableSet) {
    bench.done(&Request::Configure(configuration));
    tables.upload(bench);
    bench.done(&tables.commit(1, 0));
    activate(bench, &configuration, 0);
}

/// Like [`ready_with`], for the golden frame on the default build.
pub fn ready(on: &dyn Boards) -> Option<(Bench, Bursts)> {
    ready_with(on, &Build::default(), configuration(HEIGHT), &golden_tables())
}

/// Lets a commit for `frame` take effect, and empties the core.
pub fn activate(bench: &mut Bench, configuration: &Configuration, frame: u16) {
    let &Configuration { width, height, .. } = configuration;
    let place = RowPlace { row_sequence: 0, frame, row: 0, width, last: height == 1 };
    bench.send(&Row { place, samples: noise_row(0, width) });
    bench.done(&Request::Reset(Reset { level: ResetLevel::Rows, next_row: 0 }));
    bench.window = 0;
}

/// A board's answer to RECORDS.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordsReply {
    /// The burst.
    pub burst: u32,
    /// How far it has come.
    pub state: BurstState,
    /// The records, from the requested frame on.
    pub records: Vec<FrameRecord>,
}

impl Bench {
    /// The records from a frame on. The board drops those before it.
    pub fn records(&mut self, from: u32) -> RecordsReply {
        let answer = self.done(&Request::Records { from });
        let Reply::Records(records) = answer.reply() else { panic!("{answer:?}") };
        assert_eq!(records.from, from);
        RecordsReply { burst: records.burst, state: records.state, records: records.records().collect() }
    }

    /// Like [`Self::records`], asked until `enough` holds for the answer.
    pub fn records_when(&mut self, from: u32, enough: impl Fn(&RecordsReply) -> bool) -> RecordsReply {
        for _ in 0..3000 {
            let told = self.records(from);
            if enough(&told) {
                return told;
            }
            self.now += Duration::from_millis(1);
        }
        panic!("what is waited for from frame {from} on does not come: {:?}", self.records(from));
    }

    /// Makes a burst, waits until it ends, and returns its records, all of which the board must be able to keep.
    pub fn signed(&mut self, burst: &Burst) -> Vec<FrameRecord> {
        self.done(&Request::Burst(*burst));
        let told = self.records_when(0, |told| told.state == BurstState::Ended);
        assert_eq!(told.burst, burst.burst);
        told.records
    }
}
