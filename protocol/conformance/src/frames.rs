//! Frames of the specification's samples, 64 columns wide, and boards that are ready for them.

use halfrow_protocol::message::{Configuration, Request, RowIn, RowOut, RowPlace};
use halfrow_protocol::samples;

use crate::material::noise_row;
use crate::uploads::TableSet;
use crate::{Bench, Boards, Build, HELLO, ReceivedPacket};

/// Columns of a row.
pub const WIDTH: u16 = 64;

/// A row on its way to the board.
#[derive(Clone, Debug)]
pub struct Row {
    /// Where it belongs.
    pub place: RowPlace,
    /// Its samples.
    pub samples: Vec<u16>,
}

/// The row with this number in frames of `height` rows, the first of which is frame 0.
pub fn row(height: u16, row_sequence: u32) -> Row {
    let frame = (row_sequence / u32::from(height)) as u16;
    let row = (row_sequence % u32::from(height)) as u16;
    let place = RowPlace { row_sequence, frame, row, width: WIDTH, last: row + 1 == height };
    // Limited, because the formula multiplies by the width.
    Row { place, samples: noise_row(row_sequence % 10_000, WIDTH) }
}

/// The samples of a row that came back.
pub fn samples_of(row: &RowOut<'_>) -> Vec<u16> {
    let mut unpacked = vec![0; row.place.width.into()];
    samples::unpack(row.packed, &mut unpacked);
    unpacked
}

/// A configuration for 12-bit rows with the centre in the middle.
pub fn configuration(height: u16) -> Configuration {
    Configuration { width: WIDTH, height, centre2: WIDTH - 1, blanking: 0, gap_seed: 0, bits: 12 }
}

/// A build with five taps and one bank of tables.
#[must_use]
pub fn lean() -> Build {
    Build { taps: 5, latency: 11, table_banks: 1, ..Build::default() }
}

/// A board of this build that is ready for frames of `height` rows, with tables that change no sample.
#[must_use]
pub fn ready(on: &dyn Boards, build: &Build, height: u16) -> Bench {
    let mut bench = Bench::switched_on(on, build);
    bench.greet(&HELLO);
    make_ready(&mut bench, height);
    bench
}

/// Like [`ready`]; none if the build is not offered.
#[must_use]
pub(crate) fn ready_if_offered(on: &dyn Boards, build: &Build, height: u16) -> Option<Bench> {
    on.offers(build).then(|| ready(on, build, height))
}

/// Configures for frames of `height` rows and commits tables that change no sample as generation 1, for frame 0.
pub fn make_ready(bench: &mut Bench, height: u16) {
    let tables = TableSet::unstretched(height);
    bench.done(&Request::Configure(configuration(height)));
    tables.upload(bench);
    bench.done(&tables.commit(1, 0));
}

impl Bench {
    /// The bytes of a ROW_IN.
    pub fn row_packet(&mut self, row: &Row) -> Vec<u8> {
        let mut packed = Vec::new();
        samples::pack(&row.samples, &mut packed);
        self.packet(&Request::RowIn(RowIn { place: row.place, packed: &packed }))
    }

    /// Sends a row and returns everything that comes back.
    pub fn send(&mut self, row: &Row) -> Vec<ReceivedPacket> {
        let packet = self.row_packet(row);
        self.receive(&packet)
    }

    /// Sends the rows with these numbers, one packet at a time, and returns everything that comes back.
    pub fn send_all(&mut self, height: u16, numbers: impl IntoIterator<Item = u32>) -> Vec<ReceivedPacket> {
        numbers.into_iter().flat_map(|number| self.send(&row(height, number))).collect()
    }
}
