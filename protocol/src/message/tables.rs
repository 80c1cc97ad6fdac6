//! The tables. They are written into a shadow bank, read back through the ports that the datapath uses, then committed.

use alloc::vec::Vec;

use crate::Malformed;
use crate::bytes::Fields;

/// Bytes of a row factor or a grid entry on the wire: an unsigned 32-bit word that holds 25 bits.
pub const ROW_FACTOR_BYTES: usize = 4;
/// Nodes of a kernel.
pub const NODES: usize = 65;
/// Weights of a node, in the order g0, r1, g4, r5, g6.
pub const NODE_WEIGHTS: usize = 5;
/// Bytes of a node on the wire: five signed 16-bit words.
pub const NODE_BYTES: usize = 2 * NODE_WEIGHTS;

/// One of a board's tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Table {
    /// The row factors Q.
    RowFactors = 0,
    /// The kernel's nodes.
    Kernel = 1,
    /// The entries of a grid, in the memory of the row factors; only on boards with [`super::Grids`].
    Grid = 3,
}

impl Table {
    /// Bytes of one entry on the wire.
    #[must_use]
    pub const fn entry_bytes(self) -> usize {
        match self {
            Self::RowFactors | Self::Grid => ROW_FACTOR_BYTES,
            Self::Kernel => NODE_BYTES,
        }
    }

    fn read(fields: &mut Fields<'_>) -> Result<Self, Malformed> {
        match fields.u8()? {
            0 => Ok(Self::RowFactors),
            1 => Ok(Self::Kernel),
            3 => Ok(Self::Grid),
            other => Err(Malformed::Value { field: "table", value: other.into() }),
        }
    }
}

/// Which copy of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Bank {
    /// The one that is written.
    Shadow = 0,
    /// The one that rows use.
    Active = 1,
}

/// A range of a table's entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The table.
    pub table: Table,
    /// The copy.
    pub bank: Bank,
    /// The datapath's port that reads them, from 0.
    pub port: u8,
    /// The first entry.
    pub first: u16,
    /// How many.
    pub count: u16,
}

impl Span {
    /// Bytes of a span on the wire.
    pub const BYTES: usize = 7;

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        payload.extend_from_slice(&[self.table as u8, self.bank as u8, self.port]);
        payload.extend_from_slice(&self.first.to_le_bytes());
        payload.extend_from_slice(&self.count.to_le_bytes());
    }

    pub(crate) fn read(fields: &mut Fields<'_>) -> Result<Self, Malformed> {
        let table = Table::read(fields)?;
        let bank = match fields.u8()? {
            0 => Bank::Shadow,
            1 => Bank::Active,
            other => return Err(Malformed::Value { field: "bank", value: other.into() }),
        };
        Ok(Self { table, bank, port: fields.u8()?, first: fields.u16()?, count: fields.u16()? })
    }
}

/// Entries of a table with their values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entries<'a> {
    /// Where the entries are. A write goes to the shadow bank, for every port.
    pub span: Span,
    /// Their values, [`Table::entry_bytes`] each.
    pub bytes: &'a [u8],
}

impl<'a> Entries<'a> {
    /// The entries as row factors or grid entries, if that is what the table holds. The words are unchecked: the board that
    /// takes them must check their range.
    pub fn row_factors(&self) -> impl Iterator<Item = u32> + use<'a> {
        self.bytes.as_chunks::<ROW_FACTOR_BYTES>().0.iter().map(|&word| u32::from_le_bytes(word))
    }

    /// The entries as kernel nodes, if that is what the table holds.
    pub fn nodes(&self) -> impl Iterator<Item = [i16; NODE_WEIGHTS]> + use<'a> {
        self.bytes.as_chunks::<NODE_BYTES>().0.iter().map(|node| {
            let weights = node.as_chunks::<2>().0;
            core::array::from_fn(|tap| i16::from_le_bytes(weights[tap]))
        })
    }

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        self.span.write(payload);
        payload.extend_from_slice(self.bytes);
    }

    pub(crate) fn read(mut fields: Fields<'a>) -> Result<Self, Malformed> {
        let span = Span::read(&mut fields)?;
        let bytes = fields.take(usize::from(span.count) * span.table.entry_bytes())?;
        Ok(fields.end(Self { span, bytes }))
    }
}

/// How the rows of a bank use its entries (DATAPATH.md, *Datapath 2*). The numbers are unchecked: the board that takes
/// them must check them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// There is a grid row every 2^v rows; 0 for one row factor per row.
    pub v: u8,
    /// There is a grid node every 2^k columns; no meaning if v is 0.
    pub k: u8,
}

/// Makes the shadow tables the active ones, from a frame on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Commit {
    /// CRC-32 of the first H row factors, or of all entries of the grid: 4 bytes each.
    pub steps_crc: u32,
    /// CRC-32 of the kernel's 65 nodes: 10 bytes each.
    pub kernel_crc: u32,
    /// The number of the frame whose row 0 is the first to use them.
    pub first_frame: u16,
    /// The generation that the tables get, 1 to 255. It differs from the present one, so that a repeated request is
    /// recognised.
    pub generation: u8,
    /// The bank's shape; none for one row factor per row. Only for a board with [`super::Grids`]; others ignore it.
    pub shape: Option<Shape>,
}

impl Commit {
    /// Bytes of the payload, the shape included.
    pub const BYTES: usize = 13;

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        payload.extend_from_slice(&self.steps_crc.to_le_bytes());
        payload.extend_from_slice(&self.kernel_crc.to_le_bytes());
        payload.extend_from_slice(&self.first_frame.to_le_bytes());
        payload.push(self.generation);
        payload.extend(self.shape.into_iter().flat_map(|Shape { v, k }| [v, k]));
    }

    pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
        let commit = Self {
            steps_crc: fields.u32()?,
            kernel_crc: fields.u32()?,
            first_frame: fields.u16()?,
            generation: fields.u8()?,
            shape: fields.array().ok().map(|[v, k]| Shape { v, k }),
        };
        Ok(fields.end(commit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_commit_s_payload_is_as_long_as_it_says() {
        let shape = Some(Shape { v: 1, k: 5 });
        let mut payload = Vec::new();
        Commit { steps_crc: 1, kernel_crc: 2, first_frame: 3, generation: 4, shape }.write(&mut payload);
        assert_eq!(payload.len(), Commit::BYTES);
    }
}
