//! What a finding quotes of answers.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{FrameRecord, Records, Refusal};

use crate::board::Response;
use crate::result::Answer;

/// The most bytes of a reply that a finding quotes.
const QUOTED: usize = 32;
/// The fields of a record, each with its first byte (AT-SPEED.md, *Record*), from the last on.
const OF_RECORD: [(usize, &str); 8] = [
    (17, "flags"),
    (16, "generation"),
    (14, "pauses"),
    (12, "most_latency"),
    (10, "least_latency"),
    (8, "rows"),
    (4, "samples"),
    (0, "signature"),
];

/// What is quoted of an answer by itself.
pub(in crate::run) fn answer(said: &Response) -> Answer {
    match said {
        Response::Refused(refusal) => Answer::Refused { code: refusal.code as u8, detail: refusal.detail },
        Response::Replied(payload) => Answer::Replied { payload: beginning(payload) },
    }
}

/// What is quoted of the right answer to a request of `kind` and of the one that came: of two replies that begin alike, what
/// follows from the first byte that differs on; of a refusal in place of another, also the request that it names if that is wrong.
pub(super) fn answers(kind: Kind, right: &Response, found: &Response) -> (Answer, Answer) {
    if let (Response::Refused(expected), Response::Refused(came)) = (right, found)
        && expected.kind != came.kind
    {
        let &Refusal { code, kind, detail } = came;
        return (answer(right), Answer::RefusedOther { kind, code: code as u8, detail });
    }
    let (Response::Replied(expected), Response::Replied(came)) = (right, found) else {
        return (answer(right), answer(found));
    };
    let alike = expected.iter().zip(came).take_while(|(expected, came)| expected == came).count();
    if alike < QUOTED {
        return (answer(right), answer(found));
    }
    let quote = |payload: &[u8]| {
        let rest = beginning(&payload[alike..]);
        Answer::Replied { payload: format!("…{rest} from byte {alike} on{}", field(kind, alike)) }
    };
    (quote(expected), quote(came))
}

/// What is told of records from frame `first` on that `came` where others are right, if they differ in nothing but signatures.
pub(super) fn other_signatures(right: &[u8], came: &[u8], first: u32) -> Option<Answer> {
    let (right_head, right) = right.split_at_checked(Records::HEAD)?;
    let (head, came) = came.split_at_checked(Records::HEAD)?;
    let (right, came) = (right.as_chunks().0, came.as_chunks().0);
    if head != right_head || came.len() < right.len() {
        return None;
    }
    let differing = |(right, came): (&[u8; FrameRecord::BYTES], &[u8; FrameRecord::BYTES])| {
        let (right, came) = (FrameRecord::from(*right), FrameRecord::from(*came));
        let is_else_right = FrameRecord { signature: right.signature, ..came } == right;
        is_else_right.then_some(came.signature != right.signature)
    };
    let differing: Vec<_> = right.iter().zip(came).map(differing).collect::<Option<_>>()?;
    let first = (first..).zip(&differing).find_map(|(frame, differs)| differs.then_some(frame))?;
    Some(Answer::OtherSignatures { frames: differing.into_iter().filter(|differs| *differs).count(), first })
}

/// The first bytes, in hexadecimal.
fn beginning(payload: &[u8]) -> String {
    let bytes = payload.iter().take(QUOTED).map(|byte| format!("{byte:02x}"));
    bytes.chain((payload.len() > QUOTED).then(|| "…".to_owned())).collect()
}

/// The field of a reply to a request of `kind` that has this byte, in brackets; nothing where none is known.
fn field(kind: Kind, byte: usize) -> String {
    let Some(place) = byte.checked_sub(Records::HEAD).filter(|_| kind == Kind::Records) else {
        return String::new();
    };
    let (record, within) = (place / FrameRecord::BYTES, place % FrameRecord::BYTES);
    let named = OF_RECORD.iter().find(|(first, _)| *first <= within);
    named.map_or_else(String::new, |(_, name)| format!(" ({name} of record {record})"))
}

#[cfg(test)]
mod tests {
    use halfrow_protocol::message::RefusalCode;

    use super::super::rule_broken;
    use super::*;
    use crate::result::Rule;

    fn quoted(kind: Kind, expected: &[u8], came: &[u8]) -> [String; 2] {
        let said = |payload: &[u8]| Response::Replied(payload.to_vec());
        let (right, found) = answers(kind, &said(expected), &said(came));
        [right, found].map(|answer| match answer {
            Answer::Replied { payload } => payload,
            other => panic!("{other:?}"),
        })
    }

    /// WIRE.md: 10 bytes before the records; AT-SPEED.md: the flags are byte 17 of 18 of a record. 10 + 2·18 + 17 = 63.
    #[test]
    fn replies_that_begin_alike_are_quoted_from_where_they_differ_on() {
        let right = [0xab; 100];
        let mut wrong = right;
        wrong[63] = 0;
        let rest = "ab".repeat(31);
        let flags = "from byte 63 on (flags of record 2)";
        let [expected, came] = quoted(Kind::Records, &right, &wrong);
        assert_eq!(expected, format!("…ab{rest}… {flags}"));
        assert_eq!(came, format!("…00{rest}… {flags}"));
        assert_eq!(quoted(Kind::Trap, &[7; 33], &[7; 32]), ["…07 from byte 32 on", "… from byte 32 on"]);
    }

    /// AT-SPEED.md: the signature is the first 4 of 18 bytes, the number of samples follows.
    #[test]
    fn records_with_other_signatures_are_told_only_if_all_else_is_right() {
        let right = [7; 10 + 3 * 18];
        let differing = |bytes: &[usize]| {
            let mut came = right.to_vec();
            bytes.iter().for_each(|&byte| came[byte] = 0);
            other_signatures(&right, &came, 40)
        };
        assert_eq!(
            differing(&[10 + 18, 10 + 2 * 18 + 3]),
            Some(Answer::OtherSignatures { frames: 2, first: 41 })
        );
        for bytes in [&[][..], &[10 + 4], &[10, 9], &[10, 10 + 18 + 17]] {
            assert_eq!(differing(bytes), None, "{bytes:?}");
        }
        assert_eq!(other_signatures(&right, &[0; 10 + 2 * 18], 40), None);
    }

    /// WIRE.md: 11 is TABLE_READ, 12 TABLE_CRC.
    #[test]
    fn a_refusal_of_another_request_is_told_from_the_right_one() {
        let refused = |kind| Response::Refused(Refusal { code: RefusalCode::Payload, kind, detail: 0 });
        let (right, found) = answers(Kind::TableRead, &refused(0x11), &refused(0x12));
        let told = rule_broken(Rule::Payload, Kind::TableRead, right, found).sentence();
        let must = "the board must refuse TABLE_READ as `payload`, but it";
        assert!(
            told.starts_with(&format!("{must} answered with a refusal of TABLE_CRC as `payload`")),
            "{told}"
        );
    }

    #[test]
    fn replies_that_differ_early_are_quoted_from_their_beginning() {
        assert_eq!(quoted(Kind::Status, &[1, 2], &[1, 3]), ["0102", "0103"]);
        let long = "00".repeat(32);
        assert_eq!(quoted(Kind::Status, &[0; 33], &[9]), [format!("{long}…"), "09".to_owned()]);
    }
}
