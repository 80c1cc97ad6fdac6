//! Tables that must be refused, and entries at places all over a table.

use std::collections::BTreeSet;
use std::ops::Range;

use halfrow_model::RowFactor;
use halfrow_protocol::message::{Bank, Entries, NODE_BYTES, NODES, RefusalCode, Request, Span, Table};

use super::{FIRST_FACTOR, Rules, payload};
use crate::board::{Board, TablePort};
use crate::result::{CheckName, Rule};
use crate::run::findings::{During, End};
use crate::tables::Generation;

const NODE_COUNT: u16 = NODES as u16;
/// A row factor, and a grid entry, that is right and that the small tables have nowhere.
pub(super) const RIGHT: u32 = 1;
/// Where entries are tried to be written: not where a place in the packet and one in the table have the same number.
pub(super) const PLACE: u16 = 1;

impl Rules<'_, '_> {
    pub(super) fn tables(&mut self) -> Result<(), End> {
        self.upload(0)?;
        self.spans()?;
        self.entries()?;
        self.sums(Rule::Entry, 0)?;
        self.addresses()
    }

    /// Writes the small tables at `place` into the shadow bank.
    pub(super) fn upload(&mut self, place: usize) -> Result<(), End> {
        let Generation { tables, kernel, .. } = &self.small.tables[place];
        self.run.board.upload(tables, kernel).during(CheckName::Rules)
    }

    /// Every port must read the small tables at `place` in the shadow bank.
    pub(super) fn sums(&mut self, rule: Rule, place: usize) -> Result<(), End> {
        let Generation { tables, kernel, .. } = &self.small.tables[place];
        let (row_factors, nodes) = (tables.to_bytes(), kernel.to_bytes());
        self.sums_of(rule, Bank::Shadow, &row_factors, &nodes)
    }

    /// Every port must read these entries in `bank`, from the first one on.
    pub(super) fn sums_of(
        &mut self,
        rule: Rule,
        bank: Bank,
        row_factors: &[u8],
        nodes: &[u8],
    ) -> Result<(), End> {
        for TablePort { table, port } in self.run.board.table_ports(Table::RowFactors) {
            let bytes = if table == Table::Kernel { nodes } else { row_factors };
            let count = (bytes.len() / table.entry_bytes()) as u16;
            let request = Request::TableCrc(Span { table, bank, port, first: 0, count });
            self.replied(rule, &request, crc32fast::hash(bytes).to_le_bytes().to_vec())?;
        }
        Ok(())
    }

    fn entries_of(&self, table: Table) -> u16 {
        match table {
            Table::Kernel => NODE_COUNT,
            Table::RowFactors => self.capabilities.max_height,
            Table::Grid => self.known_grids().map_or(0, |grids| grids.entries),
        }
    }

    /// Every table that the board has.
    fn each_table(&self) -> Vec<Table> {
        let grid = self.known_grids().map(|_| Table::Grid);
        [Table::RowFactors, Table::Kernel].into_iter().chain(grid).collect()
    }

    /// Spans past the end, of ports that do not exist, into the active bank, and of more than a packet holds.
    fn spans(&mut self) -> Result<(), End> {
        for table in self.each_table() {
            let entries = self.entries_of(table);
            let shadow = Span { table, bank: Bank::Shadow, port: 0, first: 0, count: 1 };
            let ports = match table {
                Table::RowFactors | Table::Grid => self.capabilities.step_ports,
                Table::Kernel => self.capabilities.kernel_ports,
            };
            let bits = (0..u16::BITS).map(|bit| 1_u16 << bit);
            let beyond = bits.clone().filter(|&first| first >= entries).map(|first| Span { first, ..shadow });
            let long = bits.filter(|&count| count > entries).map(|count| Span { count, ..shadow });
            let ends = [(entries - 1, 2), (entries, 1), (2, entries - 1), (u16::MAX, u16::MAX)];
            let ends = ends.map(|(first, count)| Span { first, count, ..shadow });
            let no_port = Span { first: 3, port: ports, ..shadow };
            for span in beyond.chain(long).chain(ends).chain([no_port]) {
                let request = Request::TableCrc(span);
                self.refused(Rule::Span, &request, RefusalCode::Range, span.first)?;
            }
            let first = Span { first: 1, bank: Bank::Active, ..shadow };
            for span in [first, Span { first: entries - 1, count: 2, ..shadow }] {
                let bytes = vec![1; usize::from(span.count) * table.entry_bytes()];
                let request = Request::TableWrite(Entries { span, bytes: &bytes });
                self.refused(Rule::Span, &request, RefusalCode::Range, span.first)?;
            }
            let most = Board::entries_at_once(table) as u16;
            if most < entries {
                let first = u16::from(most + 1 < entries);
                let request = Request::TableRead(Span { first, count: most + 1, ..shadow });
                self.refused(Rule::Span, &request, RefusalCode::Range, first)?;
            }
        }
        Ok(())
    }

    /// Row factors out of range, after a right entry and before one, and weights of taps that do not exist.
    fn entries(&mut self) -> Result<(), End> {
        let one = RowFactor::ONE.get();
        let beyond = (RowFactor::BITS..u32::BITS).map(|bit| 1 << bit);
        for wrong in [0, one + 1, one | 1 << 12].into_iter().chain(beyond.filter(|&value| value > one)) {
            // A table of one row has no room for two.
            let lists = if self.capabilities.max_height > 1 {
                vec![(1, vec![RIGHT, wrong]), (0, vec![wrong, RIGHT])]
            } else {
                vec![(0, vec![wrong])]
            };
            for (place, entries) in lists {
                let bytes: Vec<u8> = entries.iter().flat_map(|entry| entry.to_le_bytes()).collect();
                let count = entries.len() as u16;
                let first = PLACE.min(self.capabilities.max_height - count);
                let span = Span { first, count, ..FIRST_FACTOR };
                let request = Request::TableWrite(Entries { span, bytes: &bytes });
                self.refused(Rule::Entry, &request, RefusalCode::Range, first + place)?;
            }
        }
        if self.known_grids().is_some() {
            self.grid_entries()?;
        }
        if self.capabilities.taps < 7 { self.outer_taps() } else { Ok(()) }
    }

    fn outer_taps(&mut self) -> Result<(), End> {
        let first = 7;
        let span = Span { table: Table::Kernel, bank: Bank::Shadow, port: 0, first, count: 2 };
        for (node, outer) in [(0, 0), (0, NODE_BYTES - 1), (1, 0), (1, NODE_BYTES - 1)] {
            let mut bytes = [0; 2 * NODE_BYTES];
            bytes[node * NODE_BYTES + outer] = 1;
            let request = Request::TableWrite(Entries { span, bytes: &bytes });
            self.refused(Rule::Entry, &request, RefusalCode::Taps, first + node as u16)?;
        }
        Ok(())
    }

    /// Writes a different entry at each place whose address has one bit set, then reads each back and asks for its CRC.
    fn addresses(&mut self) -> Result<(), End> {
        let mut places = Vec::new();
        // Row factors and the first entries of a grid are the same memory.
        let grid = self.known_grids().map(|_| Table::Grid);
        for (table, from) in [(Some(Table::RowFactors), 0), (grid, self.capabilities.max_height)] {
            let Some(table) = table else { continue };
            places.extend(places_in(from..self.entries_of(table)).into_iter().map(|first| (table, first)));
        }
        places.extend(places_in(0..NODE_COUNT).into_iter().map(|first| (Table::Kernel, first)));
        let span = |table, first| Span { table, first, ..FIRST_FACTOR };
        for &(table, first) in &places {
            // A write goes to every port, whichever it names.
            let span = Span { port: u8::MAX, ..span(table, first) };
            let request = Request::TableWrite(Entries { span, bytes: &entry(table, first) });
            self.replied(Rule::Address, &request, Vec::new())?;
        }
        for (table, first) in places {
            let (span, bytes) = (span(table, first), entry(table, first));
            let reply = payload(&Request::TableWrite(Entries { span, bytes: &bytes }));
            self.replied(Rule::Address, &Request::TableRead(span), reply)?;
            let sum = crc32fast::hash(&bytes).to_le_bytes().to_vec();
            self.replied(Rule::Address, &Request::TableCrc(span), sum)?;
        }
        Ok(())
    }
}

/// The first and the last of `entries`, and those whose address has one bit set.
fn places_in(entries: Range<u16>) -> BTreeSet<u16> {
    let bits = (0..u16::BITS).map(|bit| 1 << bit);
    bits.chain([entries.start, entries.end - 1]).filter(|place| entries.contains(place)).collect()
}

/// The entry for `place`, different from that of any other place.
fn entry(table: Table, place: u16) -> Vec<u8> {
    let value = (u32::from(place) + 1).to_le_bytes();
    if table != Table::Kernel {
        return value.to_vec();
    }
    // The weight of an inner tap, which every board has.
    let mut node = vec![0; NODE_BYTES];
    node[2..4].copy_from_slice(&value[..2]);
    node
}
