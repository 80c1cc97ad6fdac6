//! AT-SPEED.md: what the frames of a burst hold, and what is recorded of them.

use halfrow_protocol::message::{
    Burst, BurstMode, BurstState, Configuration, FrameRecord, Records, RefusalCode, Request,
};

use crate::at_speed::{
    CONTENTS, ENDLESS, FRAME, HEIGHT, ONE, RecordsReply, activate, golden_tables, ready, ready_with,
};
use crate::frames::{configuration, lean};
use crate::material::{factors, hermite, keys};
use crate::uploads::TableSet;
use crate::{Boards, Build};

/// The record of the page's frame of four rows, made by a board of latency L.
fn golden_record(latency: u8) -> FrameRecord {
    let delay = 32 + u16::from(latency);
    FrameRecord {
        signature: FRAME,
        samples: 256,
        rows: HEIGHT,
        least_latency: delay,
        most_latency: delay,
        pauses: 0,
        generation: 1,
        held_back: false,
    }
}

pub(crate) fn the_golden_frame_is_signed_and_counted(on: &dyn Boards) {
    for build in [Build::default(), lean()] {
        let Some((mut bench, _)) = ready_with(on, &build, configuration(HEIGHT), &golden_tables()) else {
            continue;
        };
        assert_eq!(bench.signed(&ONE), [golden_record(build.latency)]);
    }
}

pub(crate) fn golden_frames_of_other_shapes_are_signed(on: &dyn Boards) {
    let shape =
        |width, height, bits, centre2| Configuration { width, bits, centre2, ..configuration(height) };
    let (keys, hermite) = (keys(), hermite());
    for (configuration, kernel, seed, first_frame, signature) in [
        (shape(64, 16, 10, 100), &keys, u32::MAX, u16::MAX, 0xe20a_ee2d),
        (shape(66, 33, 8, 0), &hermite, 0x1234_5678, 1, 0xf4d5_c8b9),
    ] {
        let tables = TableSet::new(&factors(configuration.height, 1106.697), kernel);
        let Some((mut bench, _)) = ready_with(on, &Build::default(), configuration, &tables) else { return };
        let records = bench.signed(&Burst { seed, first_frame, ..ONE });
        assert_eq!(records[0].signature, signature, "{configuration:?}");
        assert_eq!(records[0].samples, u32::from(configuration.width) * u32::from(configuration.height));
    }
}

pub(crate) fn frames_are_numbered_modulo_2_16_and_a_repeating_burst_has_one(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    let of = |records: Vec<FrameRecord>| records.iter().map(|record| record.signature).collect::<Vec<_>>();
    let fresh = of(bench.signed(&Burst { burst: 1, frames: 2, first_frame: u16::MAX, ..ONE }));
    assert_eq!((fresh.len(), fresh[1]), (2, FRAME), "frame 65535 is followed by frame 0");
    assert_ne!(fresh[0], FRAME);
    let repeating = Burst { burst: 2, frames: 2, mode: BurstMode::Repeating, ..ONE };
    assert_eq!(of(bench.signed(&repeating)), [FRAME; 2]);
    let other = of(bench.signed(&Burst { burst: 3, first_frame: u16::MAX, ..repeating }));
    assert_eq!(other, [fresh[0]; 2]);
    let other = of(bench.signed(&Burst { burst: 4, seed: 2, ..ONE }));
    assert_ne!(other, [FRAME]);
}

/// The shadow tables change no sample, so that the content comes out.
pub(crate) fn every_second_frame_of_an_alternating_burst_is_the_shadows(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    TableSet::unstretched(HEIGHT).upload(&mut bench);
    let bytes: Vec<u8> = CONTENTS.iter().flat_map(|crc| crc.to_le_bytes()).collect();
    let unchanged = crc32fast::hash(&bytes);
    let alternating =
        Burst { mode: BurstMode::Alternating, frame_blanking: bursts.least_frame_blanking, ..ONE };
    let made = |record: FrameRecord| (record.signature, record.generation);
    let even = bench.signed(&alternating);
    assert_eq!(made(even[0]), (FRAME, 1));
    let odd = bench.signed(&Burst { burst: 2, frames: 2, first_frame: u16::MAX, ..alternating });
    assert_eq!((made(odd[1]), odd[0].generation), ((unchanged, 0), 1));
    assert_eq!(bench.status().generation, 1);
    assert_eq!(
        made(bench.signed(&Burst { burst: 3, ..ONE })[0]),
        (FRAME, 1),
        "the active ones are as before"
    );
    // After this commit the golden tables, once generation 1, are in the shadow bank, where their generation is 0.
    bench.done(&TableSet::unstretched(HEIGHT).commit(2, 1));
    activate(&mut bench, &configuration(HEIGHT), 1);
    let both = bench.signed(&Burst { burst: 4, frames: 2, first_frame: u16::MAX, ..alternating });
    assert_eq!((made(both[1]), both[0].generation), ((FRAME, 0), 2));
}

pub(crate) fn neither_blanking_nor_a_gap_seed_changes_a_record(on: &dyn Boards) {
    for (blanking, gap_seed) in [(0, 0), (7, 0), (1000, 0), (3, 0xdead_beef)] {
        let configuration = Configuration { blanking, gap_seed, ..configuration(HEIGHT) };
        let Some((mut bench, bursts)) = ready_with(on, &Build::default(), configuration, &golden_tables())
        else {
            return;
        };
        for (burst, frame_blanking) in (1..).zip([bursts.least_frame_blanking, 43, 44, 45, u16::MAX]) {
            let frame_blanking = frame_blanking.max(bursts.least_frame_blanking);
            let records = bench.signed(&Burst { burst, frame_blanking, frames: 2, ..ENDLESS });
            assert_eq!(records, [golden_record(12); 2], "{configuration:?}, {frame_blanking}");
        }
    }
}

pub(crate) fn records_stay_until_the_host_says_that_it_has_them(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    assert_eq!(bench.signed(&Burst { frames: 2, ..ONE }).len(), 2);
    let both = bench.records(0);
    assert_eq!(bench.records(0), both, "asking drops nothing");
    assert_eq!(bench.records(1).records, both.records[1..]);
    assert_eq!(bench.refused(&Request::Records { from: 0 }), (RefusalCode::Range, 0));
    assert_eq!(bench.records(1).records, both.records[1..], "what is refused drops nothing");
    assert_eq!(bench.refused(&Request::Records { from: 3 }), (RefusalCode::Range, 0));
    assert_eq!(bench.records(2).records, []);
}

pub(crate) fn without_a_burst_there_are_no_records(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    assert_eq!(bench.records(0), RecordsReply { burst: 0, state: BurstState::None, records: vec![] });
    assert_eq!(bench.refused(&Request::Records { from: 1 }), (RefusalCode::Range, 0));
}

pub(crate) fn another_burst_drops_the_records_of_the_one_before(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    bench.signed(&Burst { frames: 2, ..ONE });
    bench.records(1);
    let records = bench.signed(&Burst { burst: 9, seed: 7, ..ONE });
    assert_eq!(records.len(), 1);
    assert_ne!(records[0].signature, FRAME);
}

/// The board makes as many frames as it has records without the host. The next frame waits for the host, and its record says
/// so. If a board keeps more records than fit into a packet, the test cannot see when it waits.
pub(crate) fn a_frame_without_a_free_record_is_held_back_and_says_so(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    let kept = usize::from(bursts.records);
    if kept > Records::MOST {
        return;
    }
    bench.done(&Request::Burst(ENDLESS));
    let told = bench.records_when(0, |told| told.records.len() == kept);
    assert_eq!(told.state, BurstState::UnderWay);
    assert!(told.records.iter().all(|&record| record == golden_record(12)), "{told:?}");
    let told = bench.records_when(1, |told| told.records.len() == kept);
    let (last, others) = told.records.split_last().unwrap();
    assert_eq!(*last, FrameRecord { held_back: true, ..golden_record(12) });
    assert!(others.iter().all(|&record| record == golden_record(12)), "{told:?}");
}

pub(crate) fn a_burst_without_frames_has_ended_when_it_starts(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    assert_eq!(bench.signed(&Burst { frames: 0, ..ONE }), []);
    assert_eq!(bench.status().core_busy, 0);
}

pub(crate) fn a_request_that_is_repeated_starts_nothing_twice(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    let two = Burst { frames: 2, ..ONE };
    bench.done(&Request::Burst(two));
    assert_eq!(bench.signed(&two).len(), 2);
    for frames in [2, 5, 0, Burst::ENDLESS] {
        assert_eq!(bench.signed(&Burst { frames, ..two }).len(), 2, "what has ended goes on for no request");
    }
}

pub(crate) fn a_burst_may_be_made_longer_or_ended_while_it_is_under_way(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    let kept = u32::from(bursts.records);
    bench.done(&Request::Burst(ENDLESS));
    bench.records_when(0, |told| told.records.len() >= 2);
    // Only the id and the number of frames count.
    bench.done(&Request::Burst(Burst { frames: kept + 2, seed: 99, frame_blanking: 0, ..ENDLESS }));
    let (mut records, mut more) = (Vec::new(), true);
    while more {
        let told = bench.records_when(records.len() as u32, |told| {
            told.state == BurstState::Ended || !told.records.is_empty()
        });
        more = !told.records.is_empty();
        records.extend(told.records);
    }
    assert_eq!(records.len() as u32, kept + 2);
    assert!(records.iter().all(|record| record.signature == FRAME));
    bench.done(&Request::Burst(Burst { burst: 2, ..ENDLESS }));
    let begun = bench.records_when(0, |told| told.records.len() >= 2).records.len();
    bench.done(&Request::Burst(Burst { burst: 2, frames: 0, ..ENDLESS }));
    let told = bench.records_when(0, |told| told.state == BurstState::Ended);
    assert!((begun..=usize::from(bursts.records)).contains(&told.records.len()));
    assert!(told.records.iter().all(|record| record.signature == FRAME), "the frame under way is made");
}
