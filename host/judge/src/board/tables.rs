//! Tables on their way to the board, and read back as its datapath sees them.

use halfrow_model::{Kernel, TableSet};
use halfrow_protocol::MAX_PAYLOAD;
use halfrow_protocol::message::{Bank, Commit, Entries, NODES, Reply, Request, Shape, Span, Table};

use super::deadlines::Step;
use super::{Board, BoardError};

/// One of the ports through which the datapath reads its tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TablePort {
    /// The table.
    pub(crate) table: Table,
    /// The port's number.
    pub(crate) port: u8,
}

/// The CRC of a table as one port reads it, and the one that it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ReadBack {
    /// The port.
    pub(crate) port: TablePort,
    /// The CRC-32 of what was uploaded.
    pub(crate) expected: u32,
    /// The CRC-32 of what the port reads.
    pub(crate) found: u32,
}

impl ReadBack {
    /// Whether the datapath gets what was uploaded.
    #[must_use]
    pub(crate) fn agrees(&self) -> bool {
        self.expected == self.found
    }
}

impl Board {
    /// Every port through which the datapath reads tables. `rows` says what the row table holds: row factors or a grid.
    pub(crate) fn table_ports(&self, rows: Table) -> Vec<TablePort> {
        let ports = |table, count| (0..count).map(move |port| TablePort { table, port });
        ports(rows, self.capabilities.step_ports)
            .chain(ports(Table::Kernel, self.capabilities.kernel_ports))
            .collect()
    }

    /// Writes row factors or a grid, and the kernel's nodes, into the shadow bank.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub fn upload(&mut self, tables: &TableSet, kernel: &Kernel) -> Result<(), BoardError> {
        self.write(table_of(tables), &tables.to_bytes())?;
        if tables.shape().is_none() {
            self.shapes[1] = None;
        }
        self.write(Table::Kernel, &kernel.to_bytes())
    }

    /// Entries of a table that fit into one packet.
    #[must_use]
    pub(crate) const fn entries_at_once(table: Table) -> usize {
        (MAX_PAYLOAD - Span::BYTES) / table.entry_bytes()
    }

    /// Writes entries, in wire format, into the shadow bank from its first entry on.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub fn write(&mut self, table: Table, bytes: &[u8]) -> Result<(), BoardError> {
        let at_once = Self::entries_at_once(table);
        for (index, bytes) in bytes.chunks(at_once * table.entry_bytes()).enumerate() {
            let span = Span {
                table,
                bank: Bank::Shadow,
                port: 0,
                first: (index * at_once) as u16,
                count: (bytes.len() / table.entry_bytes()) as u16,
            };
            let request = Request::TableWrite(Entries { span, bytes });
            self.conversation
                .request(&request, Step::Request, |reply| matches!(reply, Reply::TableWrite).then_some(()))?;
        }
        Ok(())
    }

    /// The CRCs of both tables through every port, up to the first that disagrees.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn read_back(
        &mut self,
        bank: Bank,
        tables: &TableSet,
        kernel: &Kernel,
    ) -> Result<Vec<ReadBack>, BoardError> {
        let entries = (tables.entries().len() as u16, crc32fast::hash(&tables.to_bytes()));
        let nodes = (NODES as u16, crc32fast::hash(&kernel.to_bytes()));
        let mut read = Vec::new();
        for port in self.table_ports(table_of(tables)) {
            let (count, expected) = match port.table {
                Table::RowFactors | Table::Grid => entries,
                Table::Kernel => nodes,
            };
            let span = Span { table: port.table, bank, port: port.port, first: 0, count };
            let request = Request::TableCrc(span);
            let found = self.conversation.request(&request, Step::Request, |reply| match reply {
                Reply::TableCrc(crc) => Some(crc),
                _ => None,
            })?;
            let port = ReadBack { port, expected, found };
            let agrees = port.agrees();
            read.push(port);
            if !agrees {
                break;
            }
        }
        Ok(read)
    }

    /// The bytes of the first entries of a table as a port reads them.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn read_entries(
        &mut self,
        bank: Bank,
        port: TablePort,
        entries: usize,
    ) -> Result<Vec<u8>, BoardError> {
        let at_once = Self::entries_at_once(port.table);
        let mut bytes = Vec::new();
        for first in (0..entries).step_by(at_once) {
            let count = at_once.min(entries - first);
            let span =
                Span { table: port.table, bank, port: port.port, first: first as u16, count: count as u16 };
            let read =
                self.conversation.request(&Request::TableRead(span), Step::Request, |reply| match reply {
                    Reply::TableRead(entries) if entries.span == span => Some(entries.bytes.to_vec()),
                    _ => None,
                })?;
            bytes.extend(read);
        }
        Ok(bytes)
    }

    /// Makes the shadow tables the active ones from row 0 of `first_frame` on, under `generation`.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses because a port reads something else, or does not answer.
    pub fn commit(
        &mut self,
        tables: &TableSet,
        kernel: &Kernel,
        first_frame: u16,
        generation: u8,
    ) -> Result<(), BoardError> {
        let commit = Commit {
            steps_crc: crc32fast::hash(&tables.to_bytes()),
            kernel_crc: crc32fast::hash(&kernel.to_bytes()),
            first_frame,
            generation,
            shape: tables.shape().map(|shape| Shape { v: shape.v() as u8, k: shape.k() as u8 }),
        };
        self.conversation.request(&Request::Commit(commit), Step::Request, |reply| match reply {
            Reply::Commit { generation: named } if named == generation => Some(()),
            _ => None,
        })?;
        self.shapes = [tables.shape(), self.shapes[0]];
        Ok(())
    }

    /// Whether rows can be made with `tables` once they are written into the bank that was not committed last: a grid gets its
    /// shape only from a commit.
    #[must_use]
    pub(crate) fn knows_shape_of(&self, tables: &TableSet) -> bool {
        tables.shape().is_none_or(|shape| self.shapes[1] == Some(shape))
    }
}

/// Which table these tables are, apart from the kernel.
fn table_of(tables: &TableSet) -> Table {
    if tables.shape().is_some() { Table::Grid } else { Table::RowFactors }
}
