//! CAPABILITIES: what the board says of its build, and what a lying one says.

use std::collections::BTreeMap;

use halfrow_mock::{BoardFault, Depth, Options, TapCount};
use halfrow_protocol::message::Request;

use crate::bench::{Bench, HELLO};

/// The values by their tags, little endian; the name left out.
fn values(options: &Options, fault: Option<BoardFault>) -> BTreeMap<u8, u32> {
    let mut bench = Bench::switched_on(options, fault);
    bench.greet(&HELLO);
    let payload = bench.done(&Request::Capabilities).payload;
    let (mut rest, mut values) = (payload.as_slice(), BTreeMap::new());
    while let [tag, length, tail @ ..] = rest {
        let (value, next) = tail.split_at(usize::from(*length));
        if *tag != 0x21 {
            let number = value.iter().rev().fold(0, |number, &byte| number << 8 | u32::from(byte));
            assert_eq!(values.insert(*tag, number), None, "tag {tag:#04x} comes twice");
        }
        rest = next;
    }
    values
}

#[test]
fn every_board_sends_all_tags_in_their_widths() {
    let mut bench = Bench::greeted();
    let payload = bench.done(&Request::Capabilities).payload;
    let (mut rest, mut widths) = (payload.as_slice(), BTreeMap::new());
    while let [tag, length, tail @ ..] = rest {
        widths.insert(*tag, *length);
        rest = &tail[usize::from(*length)..];
    }
    let name = widths.remove(&0x21).unwrap();
    assert!(name > 0);
    let numbers = [2, 2, 2, 1, 1, 1, 2, 2, 1, 1, 1, 1, 1, 1, 4];
    assert_eq!(widths, (1..=15).zip(numbers).chain([(0x20, 1)]).collect());
}

#[test]
fn the_default_build_is_a_mock_of_datapath_1() {
    let values = values(&Options::default(), None);
    assert_eq!((values[&0x01], values[&0x20], values[&0x0e]), (1, 3, 0));
    assert_eq!((values[&0x0c], values[&0x0d]), (1, 2), "one port for factors, two for nodes");
}

#[test]
fn the_options_of_the_build_show() {
    let options = Options {
        latency: 17,
        ring: Some(4096),
        least_blanking: 300,
        row_banks_in: 5,
        row_banks_out: 6,
        taps: TapCount::Five,
        max_width: 1920,
        max_height: 1080,
        depths: vec![Depth::Eight, Depth::Twelve],
        pixel_clock: 74_250_000,
        ..Options::default()
    };
    let values = values(&options, None);
    let shown: Vec<_> = [2, 3, 4, 5, 6, 7, 8, 0x0a, 0x0b, 0x0f].iter().map(|tag| values[tag]).collect();
    assert_eq!(shown, [1920, 1080, 0b101, 5, 17, 4096, 300, 5, 6, 74_250_000]);
}

#[test]
fn every_depth_has_its_bit_however_often_it_is_listed() {
    for (depth, bit) in [(Depth::Eight, 1), (Depth::Ten, 2), (Depth::Twelve, 4)] {
        let options = Options { depths: vec![depth; 70], ..Options::default() };
        assert_eq!(values(&options, None)[&4], bit);
    }
    assert_eq!(values(&Options::default(), None)[&4], 7);
}

#[test]
fn a_board_may_lie_about_its_latency() {
    let honest = values(&Options::default(), None);
    let lying = values(&Options::default(), Some(BoardFault::WrongLatencyClaim));
    assert_eq!((honest[&6], lying[&6]), (12, 13));
    assert!(honest.keys().all(|tag| *tag == 6 || honest[tag] == lying[tag]));
}

#[test]
fn a_board_may_claim_another_datapath() {
    let honest = values(&Options::default(), None);
    let lying = values(&Options::default(), Some(BoardFault::WrongDatapath));
    assert_ne!(lying[&1], 1);
    assert!(honest.keys().all(|tag| *tag == 1 || honest[tag] == lying[tag]));
}
