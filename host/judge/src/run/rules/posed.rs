//! What a finding tells of the request that it is about.

use halfrow_protocol::Kind;

use super::Rules;
use crate::board::LastRequest;
use crate::result::{Asked, Field};

/// The most bytes of a request that a finding quotes.
const QUOTED: usize = 16;

/// The fields of a place, with their bytes (WIRE.md, 20).
const PLACE: &[(&str, usize)] =
    &[("row_sequence", 4), ("frame", 2), ("row", 2), ("width", 2), ("flags", 1), ("generation", 1)];
/// The fields of a span (WIRE.md, 10).
const SPAN: &[(&str, usize)] = &[("table", 1), ("bank", 1), ("port", 1), ("first", 2), ("count", 2)];

/// A request whose answer is judged.
#[derive(Clone, Debug)]
pub(in crate::run) struct Posed {
    pub(in crate::run) kind: Kind,
    /// What was sent; none if no single packet was.
    pub(in crate::run) asked: Option<Box<Asked>>,
}

impl From<Kind> for Posed {
    fn from(kind: Kind) -> Self {
        Self { kind, asked: None }
    }
}

impl From<&LastRequest> for Posed {
    fn from(last: &LastRequest) -> Self {
        let LastRequest { kind, sequence, payload } = last;
        let (fields, rest) = fields(*kind, payload);
        let quoted = rest.iter().take(QUOTED).map(|byte| format!("{byte:02x}"));
        let rest = quoted.chain((rest.len() > QUOTED).then(|| "…".to_owned())).collect();
        let asked = Asked { sequence: *sequence, bytes: payload.len(), fields, rest, pending: None };
        Self { kind: *kind, asked: Some(Box::new(asked)) }
    }
}

impl Rules<'_, '_> {
    /// The last request that was waited for.
    pub(super) fn posed(&self) -> Posed {
        let mut posed = Posed::from(self.run.board.last_request());
        posed.asked.iter_mut().for_each(|asked| asked.pending = self.pending);
        posed
    }
}

/// The fields that `payload` has room for, and what follows them.
fn fields(kind: Kind, payload: &[u8]) -> (Vec<Field>, &[u8]) {
    let mut rest = payload;
    let named = names(kind).iter().map_while(|(name, bytes)| {
        let (field, behind) = rest.split_at_checked(*bytes)?;
        rest = behind;
        let value = field.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte));
        Some(Field { name: (*name).to_owned(), value })
    });
    (named.collect(), rest)
}

/// The fields of a request, with their bytes (WIRE.md, section 3).
fn names(kind: Kind) -> &'static [(&'static str, usize)] {
    match kind {
        Kind::Hello => &[("nonce", 4), ("host", 4), ("version_min", 1), ("version_max", 1), ("take_over", 1)],
        Kind::Status => &[("clear", 1)],
        Kind::Reset => &[("level", 1), ("next_row", 4)],
        Kind::TableWrite | Kind::TableRead | Kind::TableCrc => SPAN,
        Kind::Commit => {
            &[("steps_crc", 4), ("kernel_crc", 4), ("first_frame", 2), ("generation", 1), ("v", 1), ("k", 1)]
        }
        Kind::Configure => {
            &[("width", 2), ("height", 2), ("centre2", 2), ("blanking", 2), ("gap_seed", 4), ("bits", 1)]
        }
        Kind::RowIn => PLACE,
        Kind::Burst => &[
            ("burst", 4),
            ("frames", 4),
            ("seed", 4),
            ("first_frame", 2),
            ("frame_blanking", 2),
            ("mode", 1),
        ],
        Kind::Records => &[("from", 4)],
        Kind::Expect => &[("first", 2), ("count", 2)],
        Kind::Capabilities | Kind::Echo | Kind::RowOut | Kind::RowAck | Kind::Trap | Kind::Refusal => &[],
    }
}

#[cfg(test)]
mod tests {
    use halfrow_protocol::message::{
        Bank, Burst, BurstMode, Commit, Configuration, Entries, Expect, Hello, Request, Reset, ResetLevel,
        RowIn, RowPlace, Shape, Span, Table,
    };

    use super::*;

    fn asked(kind: Kind, payload: &[u8]) -> Asked {
        let last = LastRequest { kind, sequence: 513, payload: payload.to_vec() };
        *Posed::from(&last).asked.unwrap()
    }

    fn named(asked: &Asked) -> Vec<(&str, u32)> {
        asked.fields.iter().map(|Field { name, value }| (&**name, *value)).collect()
    }

    /// WIRE.md: a place is row_sequence, frame, row, width, flags and generation, least significant byte first.
    #[test]
    fn the_fields_of_a_row_are_told_and_the_first_bytes_behind_them() {
        let place = [5, 1, 0, 0, 0x34, 0x12, 3, 0, 64, 0, 1, 0x96];
        let asked = asked(Kind::RowIn, &[&place[..], &[0xa1; 17]].concat());
        assert_eq!((asked.sequence, asked.bytes), (513, 29));
        assert_eq!(asked.rest, format!("{}…", "a1".repeat(16)));
        let fields = [
            ("row_sequence", 261),
            ("frame", 4660),
            ("row", 3),
            ("width", 64),
            ("flags", 1),
            ("generation", 150),
        ];
        assert_eq!(named(&asked), fields);
    }

    #[test]
    fn of_a_request_that_is_cut_short_the_whole_fields_are_told() {
        let short = asked(Kind::Reset, &[2, 0xff, 0, 0]);
        assert_eq!((named(&short), &*short.rest), (vec![("level", 2)], "ff0000"));
        let whole = asked(Kind::Reset, &[2, 0xfe, 0xff, 0, 0]);
        assert_eq!((named(&whole), &*whole.rest), (vec![("level", 2), ("next_row", 65534)], ""));
        let echo = asked(Kind::Echo, &[1, 2, 0x30]);
        assert_eq!((named(&echo), &*echo.rest), (vec![], "010230"));
    }

    /// Whatever the protocol writes of its own accord has a name here.
    #[test]
    fn no_byte_of_a_whole_request_is_without_a_name() {
        let span = Span { table: Table::Kernel, bank: Bank::Shadow, port: 2, first: 3, count: 0 };
        let place = RowPlace { row_sequence: 1, frame: 2, row: 3, width: 64, last: true };
        let shape = Some(Shape { v: 4, k: 5 });
        let frames = Burst {
            burst: 1,
            frames: 2,
            seed: 3,
            first_frame: 4,
            frame_blanking: 5,
            mode: BurstMode::Alternating,
        };
        let geometry =
            Configuration { width: 64, height: 16, centre2: 64, blanking: 8, gap_seed: 9, bits: 10 };
        for request in [
            Request::Hello(Hello { nonce: 1, host: 2, version_min: 3, version_max: 4, take_over: true }),
            Request::Capabilities,
            Request::Status { clear: true },
            Request::Reset(Reset { level: ResetLevel::Session, next_row: 7 }),
            Request::Echo(&[]),
            Request::TableWrite(Entries { span, bytes: &[] }),
            Request::TableRead(span),
            Request::TableCrc(span),
            Request::Commit(Commit { steps_crc: 1, kernel_crc: 2, first_frame: 3, generation: 4, shape }),
            Request::Configure(geometry),
            Request::RowIn(RowIn { place, packed: &[] }),
            Request::RowAck,
            Request::Burst(frames),
            Request::Records { from: 6 },
            Request::Expect(Expect { first: 7, bytes: &[] }),
            Request::Trap,
        ] {
            let mut payload = Vec::new();
            request.write(&mut payload);
            let (named, rest) = fields(request.kind(), &payload);
            assert!(rest.is_empty(), "{request:?}: {named:?}, then {rest:?}");
        }
    }
}
