//! Faults of the wire by name: bytes and packets that suffer on their way.

use std::num::NonZeroU64;
use std::time::Duration;

use super::chance::Occurrence;
use super::damage::{ByteHarm, Interruption, PacketHarm, Side, Unit};
use super::value::{Decimal, WireValueError, take};
use crate::faults::Parameters;
use crate::value::{Limits, parse_word};

/// Some hundred strikes in 100 MB: a few frames of 1920 x 1080 samples both ways suffer, and can be repaired.
const BYTE_RATE: Occurrence = Occurrence::Rate(1e-6);
/// One packet in a thousand: one or two of a frame of 1080 rows.
const PACKET_RATE: Occurrence = Occurrence::Rate(1e-3);
/// Among the first rows of a run: the session, the tables and the tests of the link take some twenty packets.
const ONE_PACKET: Occurrence = Occurrence::At(40);

const BYTE: Limits = Limits::new("byte", 0, 1_000_000_000_000);
const PACKET: Limits = Limits::new("packet", 0, 1_000_000_000_000);
/// Fewer would leave no packet whole.
const EVERY: Limits = Limits::new("every", 1, 1_000_000_000_000);
/// Bytes of a packet as it is on the wire, between its zeros; the longest has 4,113.
const SIZE: Limits = Limits::new("size", 1, 4113);
/// The first packets that are longer than those of the session and its requests: rows, tables and echoes.
const LONG: usize = 100;
const RATE: Decimal = Decimal::new("rate", 0.0, 1.0);
const SEED: Limits = Limits::new("seed", 0, u32::MAX as i64);
const SECONDS: Decimal = Decimal::new("seconds", 0.0, 3600.0);
const TOWARD: &str = "toward";
const TOWARDS: [(&str, Toward); 3] =
    [("board", Toward::Board), ("host", Toward::Host), ("both", Toward::Both)];

/// A fault of the wire that cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WireFaultError {
    /// No wire fault has this name.
    #[error("no wire fault is called {name}; choose a name from the list of faults")]
    Unknown {
        /// The name that was given.
        name: String,
    },
    /// A parameter of the fault is wrong.
    #[error("a parameter of fault={fault} cannot be used; correct it or leave it out")]
    Parameter {
        /// The fault's name.
        fault: String,
        /// What is wrong.
        #[source]
        source: WireValueError,
    },
}

/// A fault of the wire. The two directions count their bytes and packets, and throw their dice, each on its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WireFault {
    pub(super) harm: Harm,
    pub(super) occurrence: Occurrence,
    toward: Toward,
    seed: u32,
}

/// What happens, and to what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Harm {
    Bytes(ByteHarm),
    Packets(PacketHarm),
    /// The stream is interrupted before the byte or the packet.
    Interrupted(Unit, Interruption),
}

/// The direction that suffers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Toward {
    Board,
    Host,
    Both,
}

impl WireFault {
    /// The wire fault called `name`. Takes its own parameters out of `parameters` and leaves the others there.
    ///
    /// Where it strikes is said by one of `byte` (number of the byte in its direction, from 0), `packet` (number of the
    /// packet, a non-empty run between zero bytes), `every` (behind each so many bytes) and `rate` (probability, 0 to 1);
    /// `reorder` and `lose` have no `byte` and no `every`. `rate` means each byte for `flip`, `drop` and `duplicate`, and
    /// each packet for the others. `toward` is `board`, `host` or `both`; `seed` picks the random numbers. `stall` lasts
    /// for `seconds`; `lose` counts packets of at least `size` bytes only.
    ///
    /// # Errors
    /// If no wire fault has this name, one of its parameters is out of range, or two of them say where it strikes.
    pub fn from_name(name: &str, parameters: &mut Parameters) -> Result<Self, WireFaultError> {
        Self::read(name, parameters)
            .map_err(|source| WireFaultError::Parameter { fault: name.to_owned(), source })?
            .ok_or_else(|| WireFaultError::Unknown { name: name.to_owned() })
    }

    fn read(name: &str, from: &mut Parameters) -> Result<Option<Self>, WireValueError> {
        let Some(choice) = Choice::of(name, from)? else { return Ok(None) };
        let (harm, occurrence) = choice.place(from)?;
        Ok(Some(Self {
            harm,
            occurrence,
            toward: take(from, TOWARD, |text| parse_word(TOWARD, text, &TOWARDS))?.unwrap_or(Toward::Both),
            seed: take(from, SEED.key(), |text| SEED.parse(text))?.unwrap_or(0),
        }))
    }

    /// Whether bytes towards `side` suffer.
    pub(super) fn concerns(&self, side: Side) -> bool {
        match self.toward {
            Toward::Board => side == Side::Board,
            Toward::Host => side == Side::Host,
            Toward::Both => true,
        }
    }

    /// A seed of its own for each direction.
    pub(super) fn seed(&self, side: Side) -> u64 {
        2 * u64::from(self.seed) + u64::from(side == Side::Host)
    }
}

/// What a fault does, depending on how its place is given.
struct Choice {
    at_byte: Option<Harm>,
    at_packet: Harm,
    at_rate: Harm,
    default: (Harm, Occurrence),
}

impl Choice {
    /// The fault called `name`, if it is one of the wire.
    fn of(name: &str, from: &mut Parameters) -> Result<Option<Self>, WireValueError> {
        Ok(Some(match name {
            "flip" => Self::of_bytes(ByteHarm::Flip, PacketHarm::Flip),
            "drop" => Self::of_bytes(ByteHarm::Drop, PacketHarm::Drop),
            "duplicate" => Self::of_bytes(ByteHarm::Duplicate, PacketHarm::Duplicate),
            "reorder" => Self::of_packets(None, PacketHarm::Reorder),
            "lose" => {
                let least = take(from, SIZE.key(), |text| SIZE.parse(text))?.unwrap_or(LONG);
                Self::of_packets(None, PacketHarm::Lose { least })
            }
            "truncate" => Self::of_packets(Some(ByteHarm::Truncate), PacketHarm::Truncate),
            "stall" => {
                let seconds = take(from, SECONDS.key(), |text| SECONDS.parse(text))?.unwrap_or(5.0);
                Self::of_stream(Interruption::Stall(Duration::from_secs_f64(seconds)))
            }
            "disconnect" => Self::of_stream(Interruption::Disconnect),
            _ => return Ok(None),
        }))
    }

    fn of_bytes(byte: ByteHarm, packet: PacketHarm) -> Self {
        let (byte, packet) = (Harm::Bytes(byte), Harm::Packets(packet));
        Self { at_byte: Some(byte), at_packet: packet, at_rate: byte, default: (byte, BYTE_RATE) }
    }

    fn of_packets(byte: Option<ByteHarm>, packet: PacketHarm) -> Self {
        let packet = Harm::Packets(packet);
        let at_byte = byte.map(Harm::Bytes);
        Self { at_byte, at_packet: packet, at_rate: packet, default: (packet, PACKET_RATE) }
    }

    fn of_stream(interruption: Interruption) -> Self {
        let byte = Harm::Interrupted(Unit::Byte, interruption);
        let packet = Harm::Interrupted(Unit::Packet, interruption);
        Self { at_byte: Some(byte), at_packet: packet, at_rate: packet, default: (packet, ONE_PACKET) }
    }

    /// The place that the parameters name.
    fn place(&self, from: &mut Parameters) -> Result<(Harm, Occurrence), WireValueError> {
        let mut places = Vec::new();
        if let Some(harm) = self.at_byte
            && let Some(number) = take(from, BYTE.key(), |text| BYTE.parse(text))?
        {
            places.push((BYTE.key(), harm, Occurrence::At(number)));
        }
        if let Some(harm) = self.at_byte
            && let Some(number) = take(from, EVERY.key(), |text| EVERY.parse(text))?
        {
            places.push((
                EVERY.key(),
                harm,
                NonZeroU64::new(number).map_or(Occurrence::At(0), Occurrence::Every),
            ));
        }
        if let Some(number) = take(from, PACKET.key(), |text| PACKET.parse(text))? {
            places.push((PACKET.key(), self.at_packet, Occurrence::At(number)));
        }
        if let Some(rate) = take(from, RATE.key(), |text| RATE.parse(text))? {
            places.push((RATE.key(), self.at_rate, Occurrence::Rate(rate)));
        }
        match *places {
            [] => Ok(self.default),
            [(_, harm, occurrence)] => Ok((harm, occurrence)),
            [(first, ..), (second, ..), ..] => Err(WireValueError::TwoPlaces { first, second }),
        }
    }
}
