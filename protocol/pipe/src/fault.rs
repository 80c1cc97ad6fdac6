//! Faults of the pipe by name: harm to bytes and packets on their way.

use std::num::NonZeroU64;
use std::time::Duration;

use crate::catalogue::{Fault, Parameter, Place, Range, Values};
use crate::chance::Occurrence;
use crate::damage::{ByteHarm, Interruption, PacketHarm, Side, Unit};
use crate::value::ValueError;

const BYTE: &str = "byte";
const PACKET: &str = "packet";
const EVERY: &str = "every";
const SIZE: &str = "size";
const RATE: &str = "rate";
const TOWARD: &str = "toward";
const SEED: &str = "seed";
const SECONDS: &str = "seconds";

/// The number of a byte or a packet, up to a terabyte.
const NUMBER: Range = Range::Whole(0, 1_000_000_000_000);

const AT_BYTE: Parameter =
    Parameter::new(BYTE, NUMBER, None, "strikes once, at the byte of this number from 0 in its direction");
const AT_PACKET: Parameter = Parameter::new(
    PACKET,
    NUMBER,
    None,
    "strikes once, at the packet of this number, a run between zero bytes",
);
const AT_EVERY: Parameter = Parameter::new(
    EVERY,
    Range::Whole(1, 1_000_000_000_000),
    None,
    "strikes behind each so many bytes of its direction",
);
/// The longest packet has 4,113 bytes between its zeros. The default strikes rows, tables and echoes, and spares the shorter
/// packets of the session and its requests.
const LEAST_SIZE: Parameter = Parameter::new(
    SIZE,
    Range::Whole(1, 4113),
    Some("100"),
    "the bytes that a packet has at least to be struck",
);
/// Among the first rows of a run: the session, the tables and the tests of the link take some twenty packets.
const AT_PACKET_40: Parameter = Parameter { default: Some("40"), ..AT_PACKET };
const RATE_OF_PACKETS: Parameter =
    Parameter::new(RATE, Range::Decimal(0.0, 1.0), None, "strikes each packet with this probability");
/// One packet in a thousand: one or two in a frame of 1080 rows.
const PACKETS_1E3: Parameter = Parameter { default: Some("1e-3"), ..RATE_OF_PACKETS };
/// About 100 strikes in 100 MB: a few frames of 1920 x 1080 samples suffer both ways, and can be repaired.
const BYTES_1E6: Parameter =
    Parameter::new(RATE, Range::Decimal(0.0, 1.0), Some("1e-6"), "strikes each byte with this probability");
const TOWARDS: Parameter = Parameter::new(
    TOWARD,
    Range::Words(&["board", "host", "both"]),
    Some("both"),
    "the direction that suffers",
);
const SEEDED: Parameter =
    Parameter::new(SEED, Range::Whole(0, u32::MAX as i64), Some("0"), "picks the random numbers");
const LASTING: Parameter =
    Parameter::new(SECONDS, Range::Decimal(0.0, 3600.0), Some("5"), "how long the stream stands still");

const OF_BYTES: &[Parameter] = &[BYTES_1E6, AT_BYTE, AT_EVERY, AT_PACKET, TOWARDS, SEEDED];

/// The faults of the pipe. One of `byte`, `every`, `packet` and `rate` may be given; otherwise the one that has a default holds.
pub const FAULTS: &[Fault<PipeFault>] = &[
    fault("flip", "one bit of a byte, or of a packet, flips", OF_BYTES, |values| {
        PipeFault::of(values, &Choice::of_bytes(ByteHarm::Flip, PacketHarm::Flip))
    }),
    fault("drop", "a byte, or a packet, gets lost", OF_BYTES, |values| {
        PipeFault::of(values, &Choice::of_bytes(ByteHarm::Drop, PacketHarm::Drop))
    }),
    fault("duplicate", "a byte, or a packet, comes twice", OF_BYTES, |values| {
        PipeFault::of(values, &Choice::of_bytes(ByteHarm::Duplicate, PacketHarm::Duplicate))
    }),
    fault(
        "reorder",
        "a packet is overtaken by the next one",
        &[PACKETS_1E3, AT_PACKET, TOWARDS, SEEDED],
        |values| PipeFault::of(values, &Choice::of_packets(None, PacketHarm::Reorder)),
    ),
    fault(
        "stall",
        "the stream stands still",
        &[AT_PACKET_40, AT_BYTE, AT_EVERY, RATE_OF_PACKETS, LASTING, TOWARDS, SEEDED],
        |values| {
            let time = Duration::from_secs_f64(values.decimal(SECONDS)?);
            PipeFault::of(values, &Choice::of_stream(Interruption::Stall(time)))
        },
    ),
    fault(
        "lose",
        "a packet that is not short gets lost",
        &[PACKETS_1E3, AT_PACKET, LEAST_SIZE, TOWARDS, SEEDED],
        |values| {
            let least = values.whole(SIZE)?;
            PipeFault::of(values, &Choice::of_packets(None, PacketHarm::Lose { least }))
        },
    ),
    fault(
        "truncate",
        "a packet loses its end",
        &[PACKETS_1E3, AT_BYTE, AT_EVERY, AT_PACKET, TOWARDS, SEEDED],
        |values| PipeFault::of(values, &Choice::of_packets(Some(ByteHarm::Truncate), PacketHarm::Truncate)),
    ),
    fault(
        "disconnect",
        "the wire breaks for good",
        &[AT_PACKET_40, AT_BYTE, AT_EVERY, RATE_OF_PACKETS, TOWARDS, SEEDED],
        |values| PipeFault::of(values, &Choice::of_stream(Interruption::Disconnect)),
    ),
];

const fn fault(
    name: &'static str,
    what: &'static str,
    parameters: &'static [Parameter],
    make: fn(&Values) -> Result<PipeFault, ValueError>,
) -> Fault<PipeFault> {
    Fault::new(name, Place::Pipe, what, parameters, make)
}

/// A fault of the pipe. Each direction has its own count of bytes and packets, and its own random numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PipeFault {
    pub(crate) harm: Harm,
    pub(crate) occurrence: Occurrence,
    toward: Toward,
    seed: u32,
}

/// What happens, and to what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Harm {
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

impl PipeFault {
    fn of(values: &Values, choice: &Choice) -> Result<Self, ValueError> {
        let (harm, occurrence) = choice.place(values)?;
        Ok(Self {
            harm,
            occurrence,
            toward: values.choice(TOWARD, &[Toward::Board, Toward::Host, Toward::Both])?,
            seed: values.whole(SEED)?,
        })
    }

    /// Whether bytes towards `side` suffer.
    pub(crate) fn concerns(&self, side: Side) -> bool {
        match self.toward {
            Toward::Board => side == Side::Board,
            Toward::Host => side == Side::Host,
            Toward::Both => true,
        }
    }

    /// A seed of its own for each direction.
    pub(crate) fn seed(&self, side: Side) -> u64 {
        2 * u64::from(self.seed) + u64::from(side == Side::Host)
    }
}

/// What a fault does, depending on how its place is given.
struct Choice {
    /// None if the fault cannot strike at a byte.
    at_byte: Option<Harm>,
    at_packet: Harm,
    at_rate: Harm,
}

impl Choice {
    fn of_bytes(byte: ByteHarm, packet: PacketHarm) -> Self {
        let (byte, packet) = (Harm::Bytes(byte), Harm::Packets(packet));
        Self { at_byte: Some(byte), at_packet: packet, at_rate: byte }
    }

    fn of_packets(byte: Option<ByteHarm>, packet: PacketHarm) -> Self {
        let packet = Harm::Packets(packet);
        Self { at_byte: byte.map(Harm::Bytes), at_packet: packet, at_rate: packet }
    }

    fn of_stream(interruption: Interruption) -> Self {
        let byte = Harm::Interrupted(Unit::Byte, interruption);
        let packet = Harm::Interrupted(Unit::Packet, interruption);
        Self { at_byte: Some(byte), at_packet: packet, at_rate: packet }
    }

    /// Harm and occurrence of the place that was given, or else of the one that has a default.
    fn place(&self, values: &Values) -> Result<(Harm, Occurrence), ValueError> {
        let places = [
            (BYTE, self.at_byte),
            (EVERY, self.at_byte),
            (PACKET, Some(self.at_packet)),
            (RATE, Some(self.at_rate)),
        ];
        let given: Vec<_> = places.into_iter().filter(|(key, _)| values.is_given(key)).collect();
        match *given {
            [] => self.default_place(values),
            [(key, harm)] => occurrence(values, key, harm),
            [(first, _), (second, _), ..] => Err(ValueError::TwoPlaces { first, second }),
        }
    }

    fn default_place(&self, values: &Values) -> Result<(Harm, Occurrence), ValueError> {
        occurrence(values, RATE, Some(self.at_rate))
            .or_else(|_| occurrence(values, PACKET, Some(self.at_packet)))
    }
}

/// What happens, and when, if `key` gives the place.
fn occurrence(
    values: &Values,
    key: &'static str,
    harm: Option<Harm>,
) -> Result<(Harm, Occurrence), ValueError> {
    let occurrence = match key {
        RATE => Occurrence::Rate(values.decimal(key)?),
        EVERY => {
            let every = NonZeroU64::new(values.whole(key)?).ok_or(ValueError::Missing { key })?;
            Occurrence::Every(every)
        }
        _ => Occurrence::At(values.whole(key)?),
    };
    Ok((harm.ok_or(ValueError::Missing { key })?, occurrence))
}
