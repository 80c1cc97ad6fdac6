//! What is said of a board whose packets are stuffed like packets and are none.

use halfrow::link::Candidate;
use halfrow::progress::Silent;
use halfrow::result::Report;
use halfrow::run::{RunOptions, verify};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::{MAGIC, Refusal, RefusalCode};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing};
use halfrow_tests::system::System;
use halfrow_tests::through::Through;

/// The report on a board of whose packets `change` makes others, bytes before a zero.
fn with_bytes(change: fn(&mut Vec<u8>)) -> Report {
    let candidate = Altered::new(&Options::default(), |_, packet: Passing| vec![packet]).candidate();
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        let mut came = Vec::new();
        let taken = link.exchange(out, &mut came, wait)?;
        for packet in came.split_inclusive(|&byte| byte == 0) {
            let mut packet = packet.to_vec();
            if packet.len() > 8 {
                change(&mut packet);
            }
            back.extend(packet);
        }
        Ok(taken)
    });
    System::TINY.judge_candidate(Candidate { link, ..candidate })
}

/// Where another byte has come into the answer to a greeting, its CRC is that of other bytes.
#[test]
fn packets_under_another_crc_are_not_called_noise() {
    let report = with_bytes(|packet| {
        if let Some(magic) = packet.windows(MAGIC.len()).position(|bytes| bytes == MAGIC) {
            packet[magic] ^= 1;
        }
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let told = "times stuffed like a packet, but with another CRC-32; check that the target's rate";
    assert!(report.headline().contains(told), "{}", report.headline());
}

/// At another rate nothing looks like a packet.
#[test]
fn bytes_that_are_no_packets_are_not_said_to_be_any() {
    let report = with_bytes(|packet| packet[0] = 0xf0);
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert!(report.headline().contains("with no packet among them"), "{}", report.headline());
}

/// A board that is held refuses whoever does not take it over, and this one refuses whoever does.
#[test]
fn nobody_is_advised_to_do_what_was_just_refused() {
    for (take_over, told) in [
        (false, "or take the board over"),
        (true, "the board was told to let this one take it over and refuses"),
    ] {
        let held = Refusal { code: RefusalCode::Held, kind: Kind::Hello.code(), detail: 100 };
        let board = Altered::new(&Options::default(), move |_, packet| match packet.reply() {
            Some(Reply::Hello(_)) => vec![packet.saying(&Reply::Refusal(held))],
            _ => vec![packet],
        });
        let options = RunOptions { take_over, ..RunOptions::default() };
        let finished = verify(&System::TINY.plan(), board.candidate(), &options, &Silent);
        let report = finished.unwrap().report;
        assert_eq!(report.cause, Cause::Busy, "{}", report.headline());
        assert!(report.headline().contains(told), "{}", report.headline());
        assert!(report.headline().contains("of which 10.0 s are left"), "{}", report.headline());
    }
}
