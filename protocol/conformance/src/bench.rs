//! A host that sends packets, hears whole ones, and reads what comes as WIRE.md defines it.

use std::time::Duration;

use halfrow_protocol::message::{Capabilities, Hello, Refusal, RefusalCode, RowOut, Status, Welcome};
use halfrow_protocol::{Decoder, Encoder, Header, Kind, Packet, Reply, Request};

use crate::{Boards, Build, Subject};

/// The HELLO of the host that the tests play.
pub const HELLO: Hello =
    Hello { nonce: 0x600d_f00d, host: 0x0000_0a11, version_min: 1, version_max: 1, take_over: false };

/// A packet that came from the board.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceivedPacket {
    /// Its header.
    pub header: Header,
    /// Its payload.
    pub payload: Vec<u8>,
}

impl ReceivedPacket {
    /// The message that it carries.
    #[must_use]
    pub fn reply(&self) -> Reply<'_> {
        Reply::read(&Packet { header: self.header, payload: &self.payload }).unwrap()
    }

    /// The row that it carries.
    #[must_use]
    pub fn row(&self) -> RowOut<'_> {
        let Reply::RowOut(row) = self.reply() else { panic!("{self:?} is no row") };
        row
    }

    /// The reason and the detail, if the packet is a refusal.
    #[must_use]
    pub fn refusal(&self) -> Option<(RefusalCode, u16)> {
        match self.reply() {
            Reply::Refusal(Refusal { code, detail, .. }) => Some((code, detail)),
            _ => None,
        }
    }
}

/// Row sequence numbers of packets that must all be rows.
pub fn rows_of(heard: &[ReceivedPacket]) -> Vec<u32> {
    heard.iter().map(|packet| packet.row().place.row_sequence).collect()
}

/// A board, and a host at the other end of its wire.
pub struct Bench {
    board: Box<dyn Subject>,
    /// Time since the board was switched on.
    pub now: Duration,
    /// The session number that packets carry.
    pub session: u8,
    /// The window that packets carry: the row sequence number before which every row has come back.
    pub window: u32,
    sequence: u16,
}

impl Bench {
    /// A board that was just switched on.
    #[must_use]
    pub fn of(board: Box<dyn Subject>) -> Self {
        Self { board, now: Duration::ZERO, session: 0, window: 0, sequence: 0 }
    }

    /// A board of this build that was just switched on.
    #[must_use]
    pub fn switched_on(on: &dyn Boards, build: &Build) -> Self {
        assert!(on.offers(build), "no such build: {build:?}");
        Self::of(on.switched_on(build))
    }

    /// A board with the default build and an open session.
    #[must_use]
    pub fn greeted(on: &dyn Boards) -> Self {
        let mut bench = Self::switched_on(on, &Build::default());
        bench.greet(&HELLO);
        bench
    }

    /// Hands bytes to the board and returns what it sends, which must be whole packets.
    pub fn receive(&mut self, bytes: &[u8]) -> Vec<ReceivedPacket> {
        let outgoing = self.board.answer(bytes, self.now);
        assert!(outgoing.is_empty() || outgoing.starts_with(&[0]) && outgoing.ends_with(&[0]));
        let (mut decoder, mut rest, mut heard) = (Decoder::new(), outgoing.as_slice(), Vec::new());
        while let Some(packet) = decoder.next(&mut rest) {
            let Packet { header, payload } = packet.unwrap();
            heard.push(ReceivedPacket { header, payload: payload.to_vec() });
        }
        heard
    }

    /// The header of the next packet of a kind.
    pub fn header(&mut self, kind: u8) -> Header {
        self.sequence = self.sequence.wrapping_add(1);
        let session = if kind == Kind::Hello.code() { 0 } else { self.session };
        Header { kind, sequence: self.sequence, reply: false, session, window: self.window }
    }

    /// The bytes of the next packet.
    pub fn packet(&mut self, request: &Request<'_>) -> Vec<u8> {
        let header = self.header(request.kind().code());
        wire(&header, |payload| request.write(payload))
    }

    /// Sends a request and returns everything that comes back.
    pub fn say(&mut self, request: &Request<'_>) -> Vec<ReceivedPacket> {
        let packet = self.packet(request);
        self.receive(&packet)
    }

    /// Sends a packet that need not be a request and returns the one answer.
    pub fn answer(&mut self, header: &Header, payload: &[u8]) -> ReceivedPacket {
        let mut heard = self.receive(&wire(header, |to| to.extend_from_slice(payload)));
        assert_eq!(heard.len(), 1, "one answer to {header:?}: {heard:?}");
        let answer = heard.remove(0);
        assert_eq!((answer.header.reply, answer.header.sequence), (true, header.sequence));
        match answer.reply() {
            Reply::Refusal(refusal) => assert_eq!(refusal.kind, header.kind),
            _ => assert_eq!(answer.header.kind, header.kind),
        }
        answer
    }

    /// Sends a request of the session and returns the one answer.
    pub fn ask(&mut self, request: &Request<'_>) -> ReceivedPacket {
        let header = self.header(request.kind().code());
        let mut payload = Vec::new();
        request.write(&mut payload);
        self.answer(&header, &payload)
    }

    /// Sends a request that the board must carry out.
    pub fn done(&mut self, request: &Request<'_>) -> ReceivedPacket {
        let answer = self.ask(request);
        assert_eq!(answer.refusal(), None, "{request:?}");
        answer
    }

    /// Sends a request that the board must refuse. Returns the reason and the detail.
    pub fn refused(&mut self, request: &Request<'_>) -> (RefusalCode, u16) {
        let answer = self.ask(request);
        answer.refusal().unwrap_or_else(|| panic!("{request:?} is not refused: {answer:?}"))
    }

    /// Opens a session, and uses it from now on.
    pub fn greet(&mut self, hello: &Hello) -> Welcome {
        let answer = self.done(&Request::Hello(*hello));
        let Reply::Hello(welcome) = answer.reply() else { panic!("{answer:?}") };
        assert_eq!(
            answer.header.session, welcome.session,
            "the reply to HELLO is the session's first packet"
        );
        (self.session, self.window) = (welcome.session, 0);
        welcome
    }

    /// The number of a session that is not open.
    pub(crate) fn foreign(&self) -> u8 {
        following(self.session)
    }

    /// The board's capabilities.
    pub fn capabilities(&mut self) -> Capabilities {
        let answer = self.done(&Request::Capabilities);
        let Reply::Capabilities(capabilities) = answer.reply() else { panic!("{answer:?}") };
        capabilities
    }

    /// The counters.
    pub fn status(&mut self) -> Status {
        self.status_and(false)
    }

    /// The counters before they are cleared, if `clear`.
    pub(crate) fn status_and(&mut self, clear: bool) -> Status {
        let answer = self.done(&Request::Status { clear });
        let Reply::Status(status) = answer.reply() else { panic!("{answer:?}") };
        status
    }

    /// Tells the board that every row before `window` has come back, and returns what it sends.
    pub fn acknowledge(&mut self, window: u32) -> Vec<ReceivedPacket> {
        self.window = window;
        self.say(&Request::RowAck)
    }
}

/// The session number after this one.
pub(crate) fn following(session: u8) -> u8 {
    if session == 255 { 1 } else { session + 1 }
}

/// The bytes of a packet.
pub fn wire(header: &Header, payload: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut wire = Vec::new();
    Encoder::new().encode(header, payload, &mut wire).unwrap();
    wire
}
