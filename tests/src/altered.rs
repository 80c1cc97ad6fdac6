//! A mock board whose packets are rewritten on their way, CRC and all: boards that make wrong statements, and links that do to
//! whole packets what no fault of the mock's wire does.

use std::convert::Infallible;
use std::fmt;
use std::time::Duration;

use halfrow::Plan;
use halfrow::link::{Candidate, WireLink};
use halfrow::result::Report;
use halfrow::target::BoardKind;
use halfrow_mock::{Board, Options};
use halfrow_pipe::{Endpoint, Pipe, PipeOptions};
use halfrow_protocol::message::{Capabilities, FrameRecord, Records, RowOut};
use halfrow_protocol::{Decoder, Encoder, Header, Kind, Packet, Reply, Request};

use crate::system::{System, judge_by_plan};

/// Which way a packet goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toward {
    /// From the host to the board.
    Board,
    /// From the board to the host.
    Host,
}

/// A packet that may be changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Passing {
    /// Its header.
    pub header: Header,
    /// Its payload.
    pub payload: Vec<u8>,
}

impl Passing {
    /// Whether it is of this kind.
    #[must_use]
    pub fn is(&self, kind: Kind) -> bool {
        self.header.kind == kind.code()
    }

    /// The reply in it, if it is one.
    #[must_use]
    pub fn reply(&self) -> Option<Reply<'_>> {
        Reply::read(&Packet { header: self.header, payload: &self.payload }).ok()
    }

    /// The request in it, if it is one.
    #[must_use]
    pub fn request(&self) -> Option<Request<'_>> {
        Request::read(&Packet { header: self.header, payload: &self.payload }).ok()
    }

    /// The same packet with another reply in it, of that reply's kind.
    #[must_use]
    pub fn saying(&self, reply: &Reply<'_>) -> Self {
        let mut payload = Vec::new();
        reply.write(&mut payload);
        Self { header: Header { kind: reply.kind().code(), ..self.header }, payload }
    }

    /// The same packet after `change` was made to its row and that row's samples, if it holds a row that comes back.
    #[must_use]
    pub fn with_row(&self, change: impl FnOnce(&mut RowOut<'_>, &mut Vec<u8>)) -> Self {
        let Some(Reply::RowOut(mut row)) = self.reply() else { return self.clone() };
        let mut packed = row.packed.to_vec();
        change(&mut row, &mut packed);
        self.saying(&Reply::RowOut(RowOut { packed: &packed, ..row }))
    }

    /// The same packet after `change`, which is given the frame of the first of them, was made to its records, if it holds some.
    #[must_use]
    pub fn with_records(&self, change: impl FnOnce(u32, &mut Vec<FrameRecord>)) -> Self {
        let Some(Reply::Records(found)) = self.reply() else { return self.clone() };
        let mut records: Vec<_> = found.records().collect();
        change(found.from, &mut records);
        let bytes: Vec<_> = records.iter().map(FrameRecord::to_bytes).collect();
        self.saying(&Reply::Records(Records { bytes: &bytes, ..found }))
    }

    /// The same packet under another sequence number.
    #[must_use]
    pub fn numbered(self, sequence: u16) -> Self {
        Self { header: Header { sequence, ..self.header }, ..self }
    }
}

/// The mock board with packets that `alter` rewrites: each becomes those that `alter` returns.
pub struct Altered<F> {
    board: Board,
    alter: F,
    from_host: Decoder,
    from_board: Decoder,
    encoder: Encoder,
    outgoing: Vec<u8>,
}

impl<F: FnMut(Toward, Passing) -> Vec<Passing>> Altered<F> {
    /// The mock board of the build `options`, with packets that `alter` rewrites.
    ///
    /// # Panics
    /// If there can be no such board.
    pub fn new(options: &Options, alter: F) -> Self {
        Self {
            board: Board::new(options, None).unwrap(),
            alter,
            from_host: Decoder::new(),
            from_board: Decoder::new(),
            encoder: Encoder::new(),
            outgoing: Vec::new(),
        }
    }

    /// The board as a candidate for a run.
    pub fn candidate(self) -> Candidate
    where
        F: Send + 'static,
    {
        let pipe = Pipe::new(self, PipeOptions::default(), None);
        Candidate::new("altered", BoardKind::Mock, WireLink::new(pipe, "an altered board", false))
    }

    fn passed(&mut self, toward: Toward, bytes: &[u8]) -> Vec<u8> {
        let decoder = if toward == Toward::Board { &mut self.from_host } else { &mut self.from_board };
        let (mut rest, mut wire) = (bytes, Vec::new());
        while let Some(packet) = decoder.next(&mut rest) {
            // A damaged packet goes nowhere.
            let Ok(Packet { header, payload }) = packet else { continue };
            for packet in (self.alter)(toward, Passing { header, payload: payload.to_vec() }) {
                let write = |payload: &mut Vec<u8>| payload.extend(&packet.payload);
                self.encoder.encode(&packet.header, write, &mut wire).unwrap();
            }
        }
        wire
    }
}

impl<F: FnMut(Toward, Passing) -> Vec<Passing>> Endpoint for Altered<F> {
    type Failure = Infallible;

    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Infallible> {
        let passed = self.passed(Toward::Board, bytes);
        self.board.receive(&passed, now);
        let said = std::mem::take(self.board.outgoing());
        let said = self.passed(Toward::Host, &said);
        self.outgoing.extend(said);
        Ok(())
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        &mut self.outgoing
    }
}

impl<F> fmt::Debug for Altered<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Altered").field("board", &self.board).finish_non_exhaustive()
    }
}

/// The report on the mock board of `system` with packets that `alter` rewrites.
#[must_use]
pub fn judge(system: &System, alter: impl FnMut(Toward, Passing) -> Vec<Passing> + Send + 'static) -> Report {
    system.judge_candidate(Altered::new(&Options::default(), alter).candidate())
}

/// Like [`judge`], where each packet becomes exactly one.
#[must_use]
pub fn judge_each(
    system: &System,
    mut alter: impl FnMut(Toward, Passing) -> Passing + Send + 'static,
) -> Report {
    judge(system, move |toward, packet| vec![alter(toward, packet)])
}

/// The report on a sound board that misstates its capabilities.
#[must_use]
pub fn judge_claims(system: &System, change: impl Fn(&mut Capabilities) + Send + 'static) -> Report {
    judge_claims_by(&system.plan(), change)
}

/// Like [`judge_claims`], by another plan.
#[must_use]
pub fn judge_claims_by(plan: &Plan, change: impl Fn(&mut Capabilities) + Send + 'static) -> Report {
    let alter = move |_, packet: Passing| match packet.reply() {
        Some(Reply::Capabilities(mut capabilities)) => {
            change(&mut capabilities);
            vec![packet.saying(&Reply::Capabilities(capabilities))]
        }
        _ => vec![packet],
    };
    judge_by_plan(plan, Altered::new(&Options::default(), alter).candidate())
}
