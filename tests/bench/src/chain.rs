//! Everything that a host does to a frame, row by row on one core: pack, encode, decode, unpack, correct, compare.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;

use halfrow_model::{Corrector, Frame, Interpolant, Kernel, ModelPath, TableSet, correct};
use halfrow_protocol::message::{RowIn, RowPlace};
use halfrow_protocol::{Decoder, Encoder, Header, Kind, Request, samples};

use crate::Benchmark;
use crate::scene::{HEIGHT, batch, tables};

/// Buffers that are reused from row to row.
#[derive(Default)]
struct Chain {
    encoder: Encoder,
    decoder: Decoder,
    wire: Vec<u8>,
    received: Vec<u16>,
    corrected: Vec<u16>,
}

/// The chain with each path of the model, and without the model, over a batch of frames.
pub(crate) fn benchmarks() -> Result<Vec<Benchmark>, Box<dyn Error>> {
    let (tables, kernel) = (Arc::new(tables(HEIGHT)?), Kernel::from(Interpolant::Hermite));
    let frames = Arc::new(batch()?);
    let corrected = frames.iter().map(|frame| correct(&tables, &kernel, frame));
    let corrected = Arc::new(corrected.collect::<Result<Vec<_>, _>>()?);
    let mut benchmarks = vec![chain("codec".to_owned(), &tables, [&frames, &frames], None)?];
    for path in ModelPath::available().filter(|&path| path != ModelPath::Reference) {
        let corrector = Corrector::new(path, &kernel)?;
        benchmarks.push(chain(format!("chain {path}"), &tables, [&frames, &corrected], Some(corrector))?);
    }
    Ok(benchmarks)
}

/// The benchmark that must turn `inputs` into `expected`.
fn chain(
    name: String,
    tables: &Arc<TableSet>,
    [inputs, expected]: [&Arc<Vec<Frame>>; 2],
    mut corrector: Option<Corrector>,
) -> Result<Benchmark, Box<dyn Error>> {
    let mut chain = Chain::default();
    let (tables, inputs, expected) = (Arc::clone(tables), Arc::clone(inputs), Arc::clone(expected));
    let mut frames_are_right = move || {
        let mut frames = inputs.iter().zip(expected.iter());
        frames.all(|(input, expected)| chain.frame(&tables, input, expected, corrector.as_mut()))
    };
    if !frames_are_right() {
        return Err(format!("the {name} ends in other frames").into());
    }
    Ok(Benchmark { name, run: Box::new(move || assert!(black_box(frames_are_right()))) })
}

impl Chain {
    /// Whether the frame that comes out is `expected`.
    fn frame(
        &mut self,
        tables: &TableSet,
        frame: &Frame,
        expected: &Frame,
        mut corrector: Option<&mut Corrector>,
    ) -> bool {
        let rows = frame.rows().zip(expected.rows());
        rows.enumerate().fold(true, |right, (index, (row, expected))| {
            self.row(index, black_box(row));
            let found = match corrector.as_deref_mut() {
                None => &self.received,
                Some(corrector) => {
                    self.corrected.resize(row.len(), 0);
                    corrector.correct_row_of(tables, index, &self.received, &mut self.corrected);
                    &self.corrected
                }
            };
            right & (found == expected)
        })
    }

    /// Sends a row through the wire, and receives it.
    fn row(&mut self, index: usize, row: &[u16]) {
        let place = RowPlace { row: index as u16, width: row.len() as u16, ..RowPlace::default() };
        let header = Header { kind: Kind::RowIn.code(), sequence: index as u16, ..Header::default() };
        self.wire.clear();
        let write = |payload: &mut Vec<u8>| RowIn::write_samples(&place, row, payload);
        let _ = self.encoder.encode(&header, write, &mut self.wire);
        let mut bytes = self.wire.as_slice();
        self.received.clear();
        while let Some(Ok(packet)) = self.decoder.next(&mut bytes) {
            if let Ok(Request::RowIn(row)) = Request::read(&packet) {
                self.received.resize(row.place.width.into(), 0);
                samples::unpack(row.packed, &mut self.received);
            }
        }
    }
}
