//! CAPABILITIES: what the board reports of its build.

use std::collections::BTreeMap;

use halfrow_protocol::message::Request;

use crate::bench::{Bench, HELLO};
use crate::frames::lean;
use crate::{Boards, Build, offered};

/// The values by tag of a board that was just switched on: the first four bytes of each as a little-endian number. Without the
/// name.
pub fn values(bench: &mut Bench) -> BTreeMap<u8, u32> {
    bench.greet(&HELLO);
    let payload = bench.done(&Request::Capabilities).payload;
    let (mut rest, mut values) = (payload.as_slice(), BTreeMap::new());
    while let [tag, length, tail @ ..] = rest {
        let (value, next) = tail.split_at(usize::from(*length));
        if *tag != 0x21 {
            let number = value.iter().take(4).rev().fold(0, |number, &byte| number << 8 | u32::from(byte));
            assert_eq!(values.insert(*tag, number), None, "tag {tag:#04x} comes twice");
        }
        rest = next;
    }
    values
}

pub(crate) fn every_board_sends_all_tags_in_their_widths(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let payload = bench.done(&Request::Capabilities).payload;
    let (mut rest, mut widths) = (payload.as_slice(), BTreeMap::new());
    while let [tag, length, tail @ ..] = rest {
        widths.insert(*tag, *length);
        rest = &tail[usize::from(*length)..];
    }
    let numbers = [2, 2, 2, 1, 1, 1, 2, 2, 1, 1, 1, 1, 1, 1, 4];
    for (tag, width) in (1..=15).zip(numbers).chain([(0x20, 1)]) {
        assert!(widths.get(&tag).is_some_and(|&told| told >= width), "tag {tag:#04x}");
    }
    // A board need not make bursts, report what entered, or take grids.
    for (tag, width) in [(0x10, 7), (0x11, 1), (0x12, 8)] {
        let told = widths.get(&tag).copied().unwrap_or(0);
        assert!(told == 0 || told >= width, "tag {tag:#04x}");
    }
}

pub(crate) fn the_build_shows(on: &dyn Boards) {
    let two = Build { row_banks_in: 2, row_banks_out: 2, ..Build::default() };
    for build in offered(on, [Build::default(), lean(), two]) {
        let values = values(&mut Bench::switched_on(on, &build));
        let Build { latency, taps, table_banks, row_banks_in, row_banks_out, .. } = build;
        let bytes = [taps, latency, table_banks, row_banks_in, row_banks_out].map(u32::from);
        assert_eq!([0x05, 0x06, 0x09, 0x0a, 0x0b].map(|tag| values[&tag]), bytes);
        assert_eq!([0x01, 0x02, 0x03, 0x08].map(|tag| values[&tag]), [1, 2048, 2048, 0]);
        assert_eq!(values[&0x04] & 7, 7, "all depths");
        assert!(values[&0x07] >= 2048 && values[&0x07].is_power_of_two(), "the ring holds a row");
        assert!(values[&0x0c] > 0 && values[&0x0d] > 0, "the datapath reads by some port");
        assert!(values[&0x0e] <= 2, "one of the page's clocks");
    }
}
