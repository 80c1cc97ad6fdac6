//! The board behind the wire: packets in, packets out, as `protocol/WIRE.md` says.

mod bursts;
mod identity;
mod pieces;
mod rows;
mod session;
mod setup;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::convert::Infallible;
use std::time::Duration;

use halfrow_pipe::Endpoint;
use halfrow_protocol::message::{
    Entries, Malformed, Refusal, RefusalCode, Reply, Request, ResetLevel, Status,
};
use halfrow_protocol::{Damage, Decoder, Encoder, Header, Kind, Packet};

use crate::burst::Bursts;
use crate::faults::{BoardFault, Conduct, Misread};
use crate::options::{OptionError, Options};
use crate::player::Player;
use crate::tables::Tables;

use bursts::CLOCKS_A_PACKET;
use pieces::Pieces;
use rows::RowBanks;
use session::Session;

pub(crate) use identity::WrongClaims;

/// The reason why a request is refused, and its detail.
type Refused = (RefusalCode, u16);

/// A board. It takes no time of its own: everything that can be done is done when bytes arrive.
#[derive(Debug)]
pub struct Board {
    options: Options,
    fault: Option<BoardFault>,
    decoder: Decoder,
    incoming: Pieces,
    encoder: Encoder,
    outgoing: Vec<u8>,
    session: Session,
    tables: Tables,
    player: Player,
    configured: bool,
    rows: RowBanks,
    bursts: Bursts,
    /// Pixel clocks that a burst advances with every packet.
    clocks_a_packet: u64,
    status: Status,
}

impl Board {
    /// A board of the build `options`, just switched on.
    ///
    /// # Errors
    /// If the options do not describe a build that can exist.
    pub fn new(options: &Options, fault: Option<BoardFault>) -> Result<Self, OptionError> {
        Ok(Self {
            options: options.clone(),
            fault,
            decoder: Decoder::new(),
            incoming: Pieces::default(),
            encoder: Encoder::new(),
            outgoing: Vec::new(),
            session: Session::default(),
            tables: Tables::new(options, fault),
            player: Player::new(options, fault)?,
            configured: false,
            rows: RowBanks::new(options.row_banks_in),
            bursts: Bursts::new(options, fault),
            clocks_a_packet: CLOCKS_A_PACKET,
            status: Status::default(),
        })
    }

    /// Takes bytes that arrive together from the host, at the time `now` since the board was switched on. The rest of a frame's
    /// last row leaves only after all of them, so that the next frame may enter meanwhile if it is among them.
    pub fn receive(&mut self, bytes: &[u8], now: Duration) {
        self.end_silence(now);
        let mut decoder = std::mem::take(&mut self.decoder);
        let mut bytes = Cow::Borrowed(bytes);
        if self.has(Conduct::ZeroUnread) {
            self.incoming.without_zeros(bytes.to_mut());
        }
        let mut bytes = &*bytes;
        while let Some(packet) = decoder.next(&mut bytes) {
            match packet {
                Ok(packet) if self.misreads(Misread::LongRuns) && has_long_run(packet.payload) => {
                    self.damaged();
                }
                Ok(packet) => self.packet(&packet, now),
                Err(Damage::Crc) => self.damaged(),
                Err(_) => count(&mut self.status.framing_errors),
            }
            self.play();
        }
        self.decoder = decoder;
        self.flush();
    }

    /// Bytes that wait to be sent to the host.
    pub fn outgoing(&mut self) -> &mut Vec<u8> {
        &mut self.outgoing
    }

    fn packet(&mut self, packet: &Packet<'_>, now: Duration) {
        let header = packet.header;
        count(&mut self.status.packets);
        if header.kind != Kind::Hello.code() {
            if !self.session.is_open(header.session) && !self.has(Conduct::AnySession) {
                return self.turn_away(&header);
            }
            self.session.heard(now);
            let frees_all = header.kind == Kind::RowAck.code() && self.has(Conduct::GreedyAck);
            self.acknowledge(if frees_all { u32::MAX } else { header.window });
        }
        let done = match Request::read(packet) {
            _ if !self.knows(header.kind) => Err((RefusalCode::Kind, 0)),
            Ok(request) if !self.has_table(&request) => Err((RefusalCode::Payload, 0)),
            Ok(request) => self.carry_out(&header, &request, now),
            Err(Malformed::Kind(_)) => Err((RefusalCode::Kind, 0)),
            Err(_) => Err((RefusalCode::Payload, 0)),
        };
        if let Err(refused) = done {
            self.refuse(&header, refused);
        }
        self.go_on();
    }

    fn damaged(&mut self) {
        count(&mut self.status.crc_errors);
        if self.has(Conduct::DamagedAck) {
            self.acknowledge(u32::MAX);
        }
    }

    /// Whether the board has this fault.
    fn has(&self, conduct: Conduct) -> bool {
        self.fault == Some(BoardFault::Conduct(conduct))
    }

    /// Whether a sentence was misread in this way.
    fn misreads(&self, misread: Misread) -> bool {
        self.fault == Some(BoardFault::Misread(misread))
    }

    /// Counts a packet of a session that is not open, and refuses it.
    fn turn_away(&mut self, header: &Header) {
        count(&mut self.status.foreign_packets);
        if header.kind != Kind::RowAck.code() || self.has(Conduct::AckRefused) {
            self.refuse(header, (RefusalCode::Session, 0));
        }
    }

    fn carry_out(&mut self, header: &Header, request: &Request<'_>, now: Duration) -> Result<(), Refused> {
        let read;
        let reply = match request {
            Request::Hello(hello) => Reply::Hello(self.greet(hello, now)?),
            Request::Capabilities => Reply::Capabilities(self.capabilities()),
            Request::Status { clear } => Reply::Status(self.report(*clear)),
            Request::Reset(reset) => {
                self.reset(reset);
                Reply::Reset
            }
            Request::Echo(bytes) => Reply::Echo(bytes),
            Request::TableWrite(entries) => {
                self.write_entries(entries)?;
                Reply::TableWrite
            }
            Request::TableRead(span) => {
                read = self.read_packet(span)?;
                Reply::TableRead(Entries { span: *span, bytes: &read })
            }
            Request::TableCrc(span) => Reply::TableCrc(crc32fast::hash(&self.read_entries(span)?)),
            Request::Commit(commit) => {
                self.commit(commit)?;
                Reply::Commit { generation: commit.generation }
            }
            Request::Configure(configuration) => {
                self.configure(configuration)?;
                Reply::Configure
            }
            Request::RowIn(row) => return self.row_in(row),
            Request::RowAck => return Ok(()),
            Request::Burst(_) | Request::Records { .. } | Request::Expect(_) | Request::Trap => {
                return self.carry_out_at_speed(header, request);
            }
        };
        self.answer(header, self.session.number(), &reply);
        if matches!(request, Request::Reset(reset) if reset.level == ResetLevel::Session) {
            self.close_session();
        }
        Ok(())
    }

    fn answer(&mut self, request: &Header, session: u8, reply: &Reply<'_>) {
        let header = Header {
            kind: reply.kind().code(),
            sequence: request.sequence,
            reply: true,
            session,
            window: self.window(),
        };
        self.send(&header, reply);
    }

    /// Refuses with the request's own session number, so that a host of another session can tell that it is meant.
    fn refuse(&mut self, request: &Header, (code, detail): Refused) {
        count(&mut self.status.refusals);
        let refusal = Reply::Refusal(Refusal { code, kind: request.kind, detail });
        self.answer(request, request.session, &refusal);
    }

    fn send(&mut self, header: &Header, reply: &Reply<'_>) {
        let before = self.outgoing.len();
        // Nothing that a board says is longer than a packet. What could not be encoded would be left unsaid.
        let _ = self.encoder.encode(header, |payload| reply.write(payload), &mut self.outgoing);
        if self.has(Conduct::ZeroUnsent) {
            let mut packet = self.outgoing.split_off(before);
            Pieces::default().without_zeros(&mut packet);
            self.outgoing.append(&mut packet);
        }
    }
}

impl Endpoint for Board {
    type Failure = Infallible;

    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Infallible> {
        Self::receive(self, bytes, now);
        Ok(())
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        self.outgoing()
    }
}

/// Counts one more, up to the counter's limit.
fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}

/// Whether there is no zero in 254 bytes of `payload`, whose stuffing then has a code that no zero follows.
fn has_long_run(payload: &[u8]) -> bool {
    payload.split(|&byte| byte == 0).any(|run| run.len() >= 254)
}
