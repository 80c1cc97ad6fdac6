//! Fuzzes the decoder and the messages for `HALFROW_FUZZ_SECONDS` (default 3), starting from the frozen vectors, with a fixed
//! seed.

// clippy.toml allows this in #[test] functions, but not in the functions that they call.
#![allow(clippy::expect_used)]

mod fuzz_body;
mod vector_file;

use std::time::{Duration, Instant};

use halfrow_protocol::Decoder;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng};

const SEED: [u8; 16] = *b"halfrow's wire 1";

/// Shows the input on a panic, so that it can become a test.
struct Input(Vec<u8>);

impl Drop for Input {
    #[allow(clippy::print_stderr)]
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("the input was {:02x?}", self.0);
        }
    }
}

/// For each vector: its bytes, and its packets in the forms that [`fuzz_body::decode`] takes, with and without a header.
fn seeds() -> Vec<Vec<u8>> {
    let mut seeds = vec![Vec::new()];
    for (_, text) in vector_file::read_all() {
        let bytes = vector_file::bytes(&text);
        let mut decoder = Decoder::new();
        let mut input = bytes.as_slice();
        while let Some(event) = decoder.next(&mut input) {
            let Ok(packet) = event else { continue };
            let length = u16::try_from(packet.payload.len()).expect("a payload of a packet").to_le_bytes();
            let header = [1, packet.header.kind, 0, 0, length[0], length[1], 0, 0, 0, 0, 0, 0];
            seeds.push([&header, packet.payload].concat());
            seeds.push([&[packet.header.kind], packet.payload].concat());
        }
        seeds.push(bytes);
    }
    seeds
}

fn seconds() -> u64 {
    std::env::var("HALFROW_FUZZ_SECONDS")
        .map_or(3, |text| text.parse().expect("HALFROW_FUZZ_SECONDS: a number"))
}

#[test]
fn no_input_breaks_a_promise_of_the_wire() {
    let seeds = seeds();
    for seed in &seeds {
        fuzz_body::decode(&Input(seed.clone()).0);
    }
    let mut random = TestRng::from_seed(RngAlgorithm::XorShift, &SEED);
    let mut below = |limit: usize| random.random_range(0..limit);
    let end = Instant::now() + Duration::from_secs(seconds());
    let mut count = seeds.len();
    while Instant::now() < end {
        let mut input = Input(seeds[below(seeds.len())].clone());
        for _ in 0..=below(8) {
            fuzz_body::mutate(&mut input.0, &mut below);
        }
        fuzz_body::decode(&input.0);
        count += 1;
    }
    println!("{count} inputs from {} seeds", seeds.len());
}

proptest! {
    #[test]
    fn any_bytes_keep_every_promise_of_the_wire(bytes in prop_oneof![
        vec(any::<u8>(), 0..9000), vec(0..6_u8, 0..200), vec(1..=255_u8, 4000..9000)
    ]) {
        fuzz_body::decode(&bytes);
    }
}
