//! Configuration and tables: written, read back through the datapath's ports, committed.

use halfrow_protocol::MAX_PAYLOAD;
use halfrow_protocol::message::{
    Bank, Commit, Configuration, Entries, NODES, RefusalCode, Request, Shape, Span, Table,
};

use super::identity::{KERNEL_PORTS, ROW_FACTOR_PORTS};
use super::{Board, Refused};
use crate::core::{GridShape, Node};
use crate::depth::Depth;
use crate::faults::{Conduct, Misread};
use crate::settings::{Settings, SettingsError};
use crate::tables::{self, Port, TableError, Tables};

impl Board {
    pub(super) fn configure(&mut self, wanted: &Configuration) -> Result<(), Refused> {
        if self.holds_rows() {
            return Err((RefusalCode::Busy, 0));
        }
        let settings = Settings {
            width: wanted.width,
            height: wanted.height,
            centre2: wanted.centre2,
            depth: Depth::from_bits(wanted.bits).ok_or((RefusalCode::Range, 5))?,
            blanking: wanted.blanking,
            gap_seed: wanted.gap_seed,
        };
        self.player.configure(settings).map_err(|error| match error {
            SettingsError::Busy => (RefusalCode::Busy, 0),
            SettingsError::Width { .. } => (RefusalCode::Range, 0),
            SettingsError::Height { .. } => (RefusalCode::Range, 1),
            SettingsError::Centre { .. } => (RefusalCode::Range, 2),
            SettingsError::Blanking { .. } => (RefusalCode::Range, 3),
            SettingsError::Depth { .. } => (RefusalCode::Range, 5),
        })?;
        self.configured = true;
        Ok(())
    }

    /// Whether a row is in an in-bank, in the core or in an out-bank.
    pub(super) fn holds_rows(&self) -> bool {
        !self.player.banks.is_empty() || self.rows.is_waiting() || self.bursts.is_under_way()
    }

    pub(super) fn write_entries(&mut self, entries: &Entries<'_>) -> Result<(), Refused> {
        let Span { table, bank, first, .. } = entries.span;
        if bank != Bank::Shadow {
            return Err((RefusalCode::Range, first));
        }
        let one_bank = self.options.table_banks == 1;
        if self.player.banks.holds_generation(self.tables.shadow_generation())
            || self.bursts.uses_shadow()
            || one_bank && self.bursts.is_under_way()
        {
            return Err((RefusalCode::Busy, 0));
        }
        let first = usize::from(first);
        let factors = || entries.row_factors().collect::<Vec<_>>();
        let written = match table {
            Table::RowFactors => self.write(Tables::write_factors, first, &factors()),
            Table::Grid => self.write(Tables::write_grid, first, &factors()),
            Table::Kernel => {
                self.tables.write_nodes(first, &entries.nodes().map(Node::from).collect::<Vec<_>>())
            }
        };
        written.map_err(|error| match error {
            TableError::NoSuchEntry { .. } => (RefusalCode::Range, entries.span.first),
            TableError::Factor { row: place, .. } | TableError::GridEntry { entry: place, .. } => {
                (RefusalCode::Range, self.named(entries.span, place))
            }
            TableError::OuterTaps { node } => (RefusalCode::Taps, self.named(entries.span, node)),
            TableError::CommitPending { .. } => (RefusalCode::Busy, 0),
        })
    }

    /// Writes row factors or grid entries by `write`.
    fn write(
        &mut self,
        write: fn(&mut Tables, usize, &[u32]) -> Result<(), TableError>,
        first: usize,
        values: &[u32],
    ) -> Result<(), TableError> {
        let written = write(&mut self.tables, first, values);
        if let Err(TableError::Factor { row: wrong, .. } | TableError::GridEntry { entry: wrong, .. }) =
            written
            && self.has(Conduct::PartialWrite)
        {
            write(&mut self.tables, first, &values[..wrong - first])?;
        }
        written
    }

    /// The detail of a refusal for the entry at `place` of the table that `span` is in.
    fn named(&self, span: Span, place: usize) -> u16 {
        let place = u16::try_from(place).unwrap_or(u16::MAX);
        if self.has(Conduct::PlaceInPacket) { place - span.first } else { place }
    }

    /// The bytes of entries for a reply, as the datapath's port reads them, if they fit a packet.
    pub(super) fn read_packet(&self, span: &Span) -> Result<Vec<u8>, Refused> {
        let bytes = self.read_entries(span)?;
        let fits = Span::BYTES + bytes.len() <= MAX_PAYLOAD;
        let first = if self.has(Conduct::UnnamedRead) { 0 } else { span.first };
        if fits { Ok(bytes) } else { Err((RefusalCode::Range, first)) }
    }

    /// The bytes of entries as the datapath's port reads them.
    pub(super) fn read_entries(&self, span: &Span) -> Result<Vec<u8>, Refused> {
        let Span { table, bank, port, first, count } = *span;
        if self.is_busy() {
            return Err((RefusalCode::Busy, 0));
        }
        let (ports, entries) = match table {
            Table::RowFactors => (ROW_FACTOR_PORTS, usize::from(self.options.max_height)),
            Table::Grid => (ROW_FACTOR_PORTS, usize::from(self.options.bank_entries())),
            Table::Kernel => (KERNEL_PORTS, NODES),
        };
        let (start, end) = (usize::from(first), usize::from(first) + usize::from(count));
        if port >= ports || end > entries {
            return Err((RefusalCode::Range, first));
        }
        let bank = match bank {
            Bank::Shadow => tables::Bank::Shadow,
            Bank::Active => tables::Bank::Active,
        };
        let mut bytes: Vec<u8> = match table {
            Table::RowFactors | Table::Grid => (start..end)
                .filter_map(|index| self.tables.entry(bank, index, Port::ReadBack))
                .flat_map(u32::to_le_bytes)
                .collect(),
            Table::Kernel => {
                let kernel = self.tables.kernel(bank, Port::ReadBack);
                let nodes = kernel.nodes.iter().take(end).skip(start);
                nodes.flat_map(Node::words).flat_map(i16::to_le_bytes).collect()
            }
        };
        if self.misreads(Misread::ReversedEntries) {
            let word = if table == Table::Kernel { 2 } else { 4 };
            bytes.chunks_exact_mut(word).for_each(<[u8]>::reverse);
        }
        Ok(bytes)
    }

    pub(super) fn commit(&mut self, commit: &Commit) -> Result<(), Refused> {
        if self.tables.has_generation(commit.generation) {
            return Ok(());
        }
        if !self.configured {
            return Err((RefusalCode::NotReady, 0));
        }
        if commit.generation == 0 {
            return Err((RefusalCode::Range, 0));
        }
        let shape = self.shape(commit)?;
        if self.is_busy() || self.tables.has_commit() {
            return Err((RefusalCode::Busy, 0));
        }
        let &Settings { width, height, .. } = self.player.settings();
        let (rows, count) = shape.map_or((Table::RowFactors, height), |shape| {
            (Table::Grid, u16::try_from(shape.entries(width, height)).unwrap_or(u16::MAX))
        });
        for (table, ports, count, crc) in [
            (rows, ROW_FACTOR_PORTS, count, commit.steps_crc),
            (Table::Kernel, KERNEL_PORTS, NODES as u16, commit.kernel_crc),
        ] {
            for port in 0..ports {
                let span = Span { table, bank: Bank::Shadow, port, first: 0, count };
                if !self.tables.is_unchecked() && crc32fast::hash(&self.read_entries(&span)?) != crc {
                    return Err((RefusalCode::TableCrc, table as u16));
                }
            }
        }
        let committed = self.tables.commit_shape(commit.generation, commit.first_frame, shape);
        committed.map_err(|_| (RefusalCode::Busy, 0))
    }

    /// The shape of the committed grid, if it is a grid. A board without grids ignores the shape.
    fn shape(&self, commit: &Commit) -> Result<Option<GridShape>, Refused> {
        let Some(Shape { v, k }) = commit.shape.filter(|shape| self.options.datapath2 && shape.v > 0) else {
            return Ok(None);
        };
        if v > GridShape::MOST_V {
            return Err((RefusalCode::Range, 1));
        }
        let &Settings { width, height, .. } = self.player.settings();
        let fits = |shape: &GridShape| shape.entries(width, height) <= self.options.bank_entries().into();
        GridShape::new(v, k).filter(fits).map(Some).ok_or((RefusalCode::Range, 2))
    }

    /// Whether the board has the table that a request concerns.
    pub(super) fn has_table(&self, request: &Request<'_>) -> bool {
        let table = match request {
            Request::TableWrite(entries) => entries.span.table,
            Request::TableRead(span) | Request::TableCrc(span) => span.table,
            _ => return true,
        };
        table != Table::Grid || self.options.datapath2
    }
}
