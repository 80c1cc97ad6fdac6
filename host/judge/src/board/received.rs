//! What came over a link on which a board does not answer, and what that suggests.

use halfrow_protocol::Damage;
use halfrow_protocol::message::Status;

use crate::words::count;

/// What came over a link since it was opened.
#[derive(Clone, Copy, Debug, Default)]
pub struct Received {
    /// Bytes, whatever they were.
    pub bytes: u64,
    /// Whole packets.
    pub packets: u64,
    /// Requests that were answered.
    pub answered: u64,
    /// Packets that came damaged since the session began.
    pub damaged: u64,
    /// Before the session, what was stuffed like a packet and had a wrong CRC.
    pub wrong_crc: u32,
    /// Before the session, what had a right CRC and another length than its header says.
    pub wrong_length: u32,
    /// Before the session, what was no packet at all.
    pub unframed: u32,
    /// Whether nothing is sent unless the board's end drives CTS.
    pub waits_for_cts: bool,
}

impl Received {
    /// Counts what came `damage`d before the session.
    pub(super) fn note(&mut self, damage: Damage) {
        let count = match damage {
            Damage::Crc => &mut self.wrong_crc,
            Damage::Length => &mut self.wrong_length,
            Damage::Stuffing | Damage::Size | Damage::Version(_) => &mut self.unframed,
        };
        *count = count.saturating_add(1);
    }
}

/// What a board's counters say of a request that it does not answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Had {
    /// It came.
    Counted,
    /// It did not come.
    NotCounted,
    /// Nothing: it was the request for these counters.
    Unknown,
}

impl Had {
    /// By the counters `before` and `after` one more try.
    pub(super) fn between(before: Option<Status>, after: Option<Status>) -> Self {
        // The try, and the request for the second counters.
        match before.zip(after).map(|(before, after)| after.packets.wrapping_sub(before.packets)) {
            Some(2) => Self::Counted,
            Some(_) => Self::NotCounted,
            None => Self::Unknown,
        }
    }
}

/// What to check where one request alone is not answered.
pub(super) fn suspect_of_one(had: Had) -> String {
    let (counts, part) = match had {
        Had::Counted => ("and it counts a further try as received, ", "answers it"),
        Had::NotCounted => ("and it does not count a further try as received, ", "takes it in"),
        Had::Unknown => ("", "takes it in and answers it"),
    };
    format!(
        "the board answered others at once, nothing came damaged, {counts}which no poor cable does; check how the board {part}, and \
         whether something on the way swallows certain bytes or lengths, as software flow control does"
    )
}

/// What to check where nothing was ever heard.
const UNHEARD: &str =
    "; check that the board is powered and loaded, and that the target's rate is the board's";

/// What silence suggests: the board if nothing was ever heard from it, otherwise the connection to it.
pub(super) fn suspect(heard: Received) -> String {
    match heard {
        Received { bytes: 0, waits_for_cts: true, .. } => {
            "; check that the board is powered and loaded, that the target's rate is the board's, and that the board drives CTS \
             (a ULX3S does not, and needs flow=none)"
                .into()
        }
        Received { bytes: 0, .. } => UNHEARD.into(),
        Received { packets: 0, damaged: 0, wrong_length: 1.., bytes, .. } => format!(
            ", though {} came, with packets among them whose CRC is right and whose length is not what their header says: the \
             length counts the payload alone; check the board's packets against protocol/WIRE.md, section 1",
            count(bytes, "byte")
        ),
        Received { packets: 0, damaged: 0, bytes, wrong_crc, unframed, .. } if wrong_crc > 1 + unframed => format!(
            ", though {} came, {wrong_crc} times stuffed like a packet, but with another CRC-32; check that the target's rate \
             is the board's, and over which bytes and in which order the board computes and sends the CRC (protocol/WIRE.md, \
             section 1)",
            count(bytes, "byte")
        ),
        Received { packets: 0, damaged: 0, bytes, .. } => format!(
            ", though {} came, with no packet among them; check that the target's rate is the board's, and that the \
             device at this port is a halfrow board",
            count(bytes, "byte")
        ),
        Received { damaged: 0, answered: 0, packets, .. } => format!(
            ", though {} came, none of them the reply: they are of another session or for another host; check that nobody else \
             uses this board, and that its reply has the sequence number and the nonce of the HELLO that it answers \
             (protocol/WIRE.md, section 3)",
            count(packets, "whole packet")
        ),
        Received { damaged: 0, .. } => {
            ", though the board had answered before; check the cable, its connectors and the rate, and that \
                   the board still has power"
                .into()
        }
        Received { damaged, .. } => format!(
            ", and {} came damaged: the link loses what is sent over it; check the cable, its \
             connectors and the rate",
            count(damaged, "packet")
        ),
    }
}
