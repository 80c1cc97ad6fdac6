//! A link that loses packets both ways, and a host whose one remedy is to send a row again.

use halfrow_protocol::message::Request;
use proptest::prelude::*;

use crate::bench::{Bench, ReceivedPacket};
use crate::frames::{ready, row, samples_of};
use crate::{Boards, Build, cases, offered};

const ROWS: u32 = 24;
const HEIGHT: u16 = 6;
/// Rounds at the end in which nothing is lost, so that a run that is not stuck comes to its end.
const CLEAN_ROUNDS: usize = ROWS as usize * 2;

/// A host that in every round sends all missing rows that it has credit for, whether it has sent them before or not.
struct LossyHost {
    bench: Bench,
    credit: u32,
    back: [bool; ROWS as usize],
}

impl LossyHost {
    /// One round. Bit n mod 32 of `lost_out` and `lost_in` says that the n-th packet in that direction is lost.
    fn round(&mut self, lost_out: u32, lost_in: u32) {
        let arrives = |lost: u32, index: u32| lost >> (index % 32) & 1 == 0;
        let missing = (self.bench.window..self.credit.min(ROWS)).filter(|&row| !self.back[row as usize]);
        let rows: Vec<_> = missing.collect();
        let mut packets: Vec<_> =
            rows.into_iter().map(|number| self.bench.row_packet(&row(HEIGHT, number))).collect();
        packets.push(self.bench.packet(&Request::RowAck));
        let sent = (0..).zip(packets).filter(|(index, _)| arrives(lost_out, *index));
        // One at a time: if packets arrive together, what the board does with a repeated row depends on its speed.
        let heard: Vec<_> = sent.flat_map(|(_, packet)| self.bench.receive(&packet)).collect();
        for (index, packet) in (0..).zip(heard) {
            if arrives(lost_in, index) {
                self.take(&packet);
            }
        }
    }

    fn take(&mut self, packet: &ReceivedPacket) {
        let out = packet.row();
        let number = out.place.row_sequence;
        assert_eq!(samples_of(&out), row(HEIGHT, number).samples);
        assert_eq!((out.place, out.generation), (row(HEIGHT, number).place, 1));
        self.credit = self.credit.max(packet.header.window);
        self.back[number as usize] = true;
        self.bench.window = self.back.iter().take_while(|&&back| back).count() as u32;
    }
}

fn builds(on: &dyn Boards) -> Vec<Build> {
    let pairs =
        (2..6).flat_map(|row_banks_in| (2..6).map(move |row_banks_out| (row_banks_in, row_banks_out)));
    offered(
        on,
        pairs.map(|(row_banks_in, row_banks_out)| Build { row_banks_in, row_banks_out, ..Build::default() }),
    )
}

pub(crate) fn every_row_comes_back_once_played(on: &dyn Boards) {
    proptest!(cases(on, 8, concat!(env!("CARGO_MANIFEST_DIR"), "/proptest-regressions/lossy_link.txt")), |(build in prop::sample::select(builds(on)),
        losses in prop::collection::vec(any::<(u32, u32)>(), 0..60),)| {
        let bench = ready(on, &build, HEIGHT);
        let mut host = LossyHost { bench, credit: build.row_banks_in.into(), back: [false; ROWS as usize] };
        for (lost_out, lost_in) in losses {
            host.round(lost_out, lost_in);
        }
        for _ in 0..CLEAN_ROUNDS {
            host.round(0, 0);
        }
        prop_assert_eq!(host.bench.window, ROWS);
        let status = host.bench.status();
        prop_assert_eq!((status.rows_in, status.rows_out, status.refusals), (ROWS, ROWS, 0));
        prop_assert_eq!((status.least_latency, status.most_latency), (44, 44));
    });
}
