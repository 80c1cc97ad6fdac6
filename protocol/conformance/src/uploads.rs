//! Tables on their way to the board and back.

use halfrow_protocol::message::{
    Bank, Commit, Entries, ROW_FACTOR_BYTES, Reply, Request, Shape, Span, Table,
};

use crate::bench::Bench;
use crate::frames::configuration;
use crate::material::{GOLDEN_FACTOR, Nodes, UNSTRETCHED, hermite};

/// Row factors in one packet.
const FACTORS: usize = 1000;

/// Row factors or a grid, and a kernel, as a host uploads them.
#[derive(Clone)]
pub struct TableSet {
    factors: Vec<u8>,
    nodes: Vec<u8>,
    shape: Option<Shape>,
}

impl TableSet {
    /// These factors, one per row, and this kernel.
    #[must_use]
    pub fn new(factors: &[u32], kernel: &Nodes) -> Self {
        Self {
            factors: factors.iter().flat_map(|factor| factor.to_le_bytes()).collect(),
            nodes: kernel.iter().flatten().flat_map(|weight| weight.to_le_bytes()).collect(),
            shape: None,
        }
    }

    /// The entries of a grid of this shape, and this kernel.
    #[must_use]
    pub fn grid(shape: Shape, entries: &[u32], kernel: &Nodes) -> Self {
        Self { shape: Some(shape), ..Self::new(entries, kernel) }
    }

    /// Tables that change no sample.
    pub fn unstretched(height: u16) -> Self {
        Self::new(&vec![UNSTRETCHED; height.into()], &hermite())
    }

    /// Writes both into the shadow bank.
    pub fn upload(&self, bench: &mut Bench) {
        let table = if self.shape.is_some() { Table::Grid } else { Table::RowFactors };
        for (factors, first) in self.factors.chunks(FACTORS * ROW_FACTOR_BYTES).zip((0..).step_by(FACTORS)) {
            bench.done(&write(table, first, factors));
        }
        bench.done(&write(Table::Kernel, 0, &self.nodes));
    }

    /// The request that commits them.
    #[must_use]
    pub fn commit(&self, generation: u8, first_frame: u16) -> Request<'static> {
        let steps_crc = crc32fast::hash(&self.factors);
        let kernel_crc = crc32fast::hash(&self.nodes);
        Request::Commit(Commit { steps_crc, kernel_crc, first_frame, generation, shape: self.shape })
    }
}

/// A write of whole entries into the shadow bank, from the entry `first` on.
pub fn write(table: Table, first: u16, bytes: &[u8]) -> Request<'_> {
    let count = (bytes.len() / table.entry_bytes()) as u16;
    Request::TableWrite(Entries { span: Span { table, bank: Bank::Shadow, port: 0, first, count }, bytes })
}

/// Entries of a bank as a port reads them.
pub fn span(table: Table, bank: Bank, port: u8, first: u16, count: u16) -> Span {
    Span { table, bank, port, first, count }
}

/// Writes a golden factor, a kernel and what `also` writes into both banks. Between the two, a frame of one row makes the first
/// bank the active one.
pub(crate) fn write_both_banks(bench: &mut Bench, also: impl Fn(&mut Bench)) {
    let tables = TableSet::new(&[GOLDEN_FACTOR], &hermite());
    bench.done(&Request::Configure(configuration(1)));
    for is_active in [false, true] {
        tables.upload(bench);
        also(bench);
        if !is_active {
            bench.done(&tables.commit(1, 0));
            bench.send_all(1, [0]);
        }
    }
}

impl Bench {
    /// The bytes of entries.
    pub fn read(&mut self, span: Span) -> Vec<u8> {
        let answer = self.done(&Request::TableRead(span));
        let Reply::TableRead(entries) = answer.reply() else { panic!("{answer:?}") };
        entries.bytes.to_vec()
    }

    /// The CRC-32 of entries as the board computes it.
    pub fn crc(&mut self, span: Span) -> u32 {
        let answer = self.done(&Request::TableCrc(span));
        let Reply::TableCrc(crc) = answer.reply() else { panic!("{answer:?}") };
        crc
    }
}
