//! Words for what the rules of the wire have shown.

use halfrow_protocol::Kind;
use halfrow_protocol::message::RefusalCode;

use super::at_speed::CHECK_TIMING;
use crate::result::{Answer, Asked, Field, RowPart, RowsTried, Rule};
use crate::words::{count, differ_of, grouped};

/// What to do about any broken rule but one that only signatures show.
const REMEDY: &str = "Check how the board decodes and carries out requests against protocol/WIRE.md, and its decoder with \
                      protocol/vectors.";

/// What to do about a broken rule. Signatures alone may also be wrong because of a path that fails at speed now and then.
pub(super) fn remedy(found: Option<&Answer>) -> String {
    if let Some(Answer::OtherSignatures { .. }) = found {
        return format!(
            "{CHECK_TIMING} If each of three runs names the same rule, check instead how the board carries out requests; \
             protocol/WIRE.md has the rules."
        );
    }
    REMEDY.to_owned()
}

/// How many of the samples differ, in the rows that a rule was tried with.
pub(super) fn samples_differ((differences, samples): (usize, usize), rows: &RowsTried) -> String {
    let &RowsTried { width, height } = rows;
    let differ = differ_of(differences, samples, "sample");
    format!("{differ} in rows that the rules were tried with ({width} x {height})")
}

/// What the board must do, and what it did, and to which request.
pub(super) fn broken(
    rule: Rule,
    (request, asked): (&str, Option<&Asked>),
    right: &Answer,
    found: &Answer,
) -> String {
    let did = match (right, found) {
        (Answer::Refused { .. }, Answer::Replied { payload }) if !payload.is_empty() => {
            format!("accepted it and answered with {payload}")
        }
        (Answer::Nothing {}, Answer::Replied { payload }) if payload.is_empty() => {
            "answered it with an empty reply".to_owned()
        }
        _ => did(found),
    };
    let asked = asked.map(|asked| format!(", where {}", as_sent(request, asked))).unwrap_or_default();
    format!("the board must {}, but it {did} (rule: {}){asked}", must(right, request), rule.meaning())
}

/// `ROW_IN had sequence 513 and 108 bytes: row_sequence 12, frame 4661, row 0, width 64, flags 0, generation 0, then 00000000…`
fn as_sent(request: &str, asked: &Asked) -> String {
    let Asked { sequence, bytes, fields, rest, pending } = asked;
    let then = if fields.is_empty() { "" } else { "then " };
    let named = fields.iter().map(|Field { name, value }| format!("{name} {value}"));
    let told: Vec<_> = named.chain((!rest.is_empty()).then(|| format!("{then}{rest}"))).collect();
    let told = if told.is_empty() { String::new() } else { format!(": {}", told.join(", ")) };
    let pending =
        pending.map(|frame| format!(", and a commit was pending for frame {frame}")).unwrap_or_default();
    format!("{request} had sequence {sequence} and {}{told}{pending}", count(*bytes, "byte"))
}

fn must(right: &Answer, request: &str) -> String {
    match right {
        Answer::Refused { code, detail } => {
            format!("refuse {request} as {}", refusal(*code, *detail))
        }
        Answer::RefusedOther { kind, code, detail } => {
            format!("answer {request} with {}", of_other(*kind, *code, *detail))
        }
        Answer::Replied { payload } if payload.is_empty() => format!("carry out {request}"),
        Answer::Replied { payload } => format!("answer {request} with {payload}"),
        Answer::Credit { rows } => format!("give credit for {} after {request}", count(*rows, "row")),
        Answer::Session { number } => format!("answer {request} with session {number}"),
        Answer::Taken {} => format!("take {request}"),
        Answer::Burst { ended, records } => {
            let state = if *ended { "that has ended" } else { "under way" };
            format!("answer {request} with a burst {state} and {}", count(*records, "record"))
        }
        Answer::Row { row, frame } => format!("return row {row} of frame {frame} as it is made"),
        Answer::OtherRow { .. } => format!("answer {request} with another row"),
        Answer::OtherSignatures { .. } => format!("answer {request} with other signatures"),
        Answer::Twice {} => format!("answer {request} twice"),
        Answer::Nothing {} => format!("leave {request} unanswered"),
    }
}

fn did(found: &Answer) -> String {
    match found {
        Answer::Refused { code, detail } => format!("refused it as {}", refusal(*code, *detail)),
        Answer::RefusedOther { kind, code, detail } => {
            format!("answered with {}", of_other(*kind, *code, *detail))
        }
        Answer::Replied { payload } if payload.is_empty() => "carried it out".to_owned(),
        Answer::Replied { payload } => format!("answered with {payload}"),
        Answer::Credit { rows } => format!("gave credit for {rows}"),
        Answer::Session { number } => format!("answered with session {number}"),
        Answer::Taken {} => "took it without an answer".to_owned(),
        Answer::Burst { ended, records } => {
            let state = if *ended { "that has ended" } else { "under way" };
            format!("answered with one {state} and {}", count(*records, "record"))
        }
        Answer::Row { row, frame } => format!("returned row {row} of frame {frame}"),
        Answer::OtherRow { differs } => other_row(differs),
        Answer::OtherSignatures { frames, first } => format!(
            "gave another signature for {}, the first is frame {}, and was right in all else",
            count(*frames, "frame"),
            grouped(*first)
        ),
        Answer::Twice {} => "did so twice".to_owned(),
        Answer::Nothing {} => "did not".to_owned(),
    }
}

/// `returned it with 3 wrong samples (the first, in column 5, is 17 instead of 16) and generation 3 instead of 2`
fn other_row(differs: &[RowPart]) -> String {
    let told: Vec<_> = differs.iter().map(|part| row_part(*part)).collect();
    match told.split_last() {
        None => "returned another".to_owned(),
        Some((only, [])) => format!("returned it with {only}"),
        Some((last, others)) => format!("returned it with {} and {last}", others.join(", ")),
    }
}

fn row_part(part: RowPart) -> String {
    match part {
        RowPart::Samples { differing, column, found, right } => format!(
            "{} (the first, in column {column}, is {found} instead of {right})",
            count(differing, "wrong sample")
        ),
        RowPart::FirstLatency { found, right } => {
            format!("a latency of {found} pixel clocks instead of {right} for its first sample")
        }
        RowPart::LastLatency { found, right } => {
            format!("a latency of {found} pixel clocks instead of {right} for its last sample")
        }
        RowPart::Generation { found, right } => format!("generation {found} instead of {right}"),
        RowPart::Pauses { found, right } => format!("pauses of {found} board clocks instead of {right}"),
        RowPart::Repeats { found, right } => format!("a count of {found} repeats instead of {right}"),
        RowPart::Entered { found: Some(found), right } => {
            format!("{found:08x} instead of {right:08x} as the CRC of the samples that entered the core")
        }
        RowPart::Entered { found: None, .. } => "no CRC of the samples that entered the core".to_owned(),
    }
}

/// A refusal's name, and its detail if it has one.
fn refusal(code: u8, detail: u16) -> String {
    match detail {
        0 => format!("`{}`", reason(code)),
        _ => format!("`{}`, detail {detail}", reason(code)),
    }
}

/// A refusal of a request of kind `kind`.
fn of_other(kind: u8, code: u8, detail: u16) -> String {
    let request = Kind::from_code(kind).map_or_else(|| format!("kind {kind:02x}"), |kind| kind.to_string());
    format!("a refusal of {request} as {}", refusal(code, detail))
}

/// The refusal's name in WIRE.md, section 6.
fn reason(code: u8) -> String {
    RefusalCode::from_code(code).map_or_else(|| format!("code {code}"), |reason| reason.name().to_owned())
}

impl Rule {
    /// The rule as a clause.
    #[must_use]
    #[expect(clippy::too_many_lines, reason = "one line a rule")]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Payload => "a request cut short, or with a field without meaning, must be refused",
            Self::Kind => "a packet whose kind is not a request must be refused",
            Self::Skipped => {
                "bytes after a request's fields, and unused bits of a row's place, must be ignored"
            }
            Self::Configuration => "a configuration must be set as it is, or refused without effect",
            Self::Span => "a span outside a table must be refused",
            Self::Entry => "a table entry out of range must be refused, and nothing of its packet written",
            Self::Address => "an entry must be written where it belongs, to every port, and read from there",
            Self::Damage => "a damaged packet must have no effect",
            Self::Once => "each request must have one answer, and most had two",
            Self::Unanswered => "an acknowledgement of rows must never be answered",
            Self::Session => "a packet of another session must have no effect",
            Self::Held => {
                "a board must be held for 10 s after its holder's last packet, but can be taken over"
            }
            Self::NewSession => "a greeting must open the next session, which keeps only tables and settings",
            Self::RefusalSession => {
                "a refusal must carry the session of its request, which is 0 for a greeting"
            }
            Self::Closed => "RESET must close a session at level 1 only, and drop tables at level 2 only",
            Self::CommitCrc => "a commit whose CRC does not match the tables must be refused",
            Self::Generation => "a commit of active or pending tables must be answered, generation 0 refused",
            Self::Shape => "a commit of a grid that the board cannot have must be refused",
            Self::NoGrid => "a commit with v = 0 must be of row factors, whatever its k",
            Self::CommitFrame => "a commit must take effect with its frame, not before, and swap the banks",
            Self::Pending => "nothing may change the tables of a pending commit",
            Self::Forgotten => "RESET must forget a pending commit",
            Self::RowPlace => "a row out of place must be refused",
            Self::Window => "after RESET the window must be next_row plus row_banks_in",
            Self::Credit => "a row beyond the window must be refused",
            Self::Inside => "what must not be done while rows are inside or kept must be refused",
            Self::Rows => "rows must come back in place, whatever was refused between them",
            Self::Samples => "samples beyond their depth must be counted, and go in as they are",
            Self::Again => "a row must be sent again when asked for, until it is acknowledged",
            Self::Banks => {
                "the board must keep row_banks_out rows until they are acknowledged, and make no more"
            }
            Self::Wide => "rows of the greatest width must come back right",
            Self::RowNumber => "rows must keep their numbers, however large these are",
            Self::Burst => "an impossible burst must be refused, and no other",
            Self::UnderWay => "what must not be done while a burst is under way must be refused",
            Self::Records => "records must be kept until the host has them, and sent again when asked for",
            Self::Ended => "a burst must end where it is told to",
            Self::Cut => "RESET must end a burst wherever it is",
            Self::Repeated => "every frame must repeat the first, in a burst that asks for it",
            Self::Trap => "the first row whose signature is not the expected one must be kept",
            Self::NotReady => "a board without configuration or tables must not be ready",
            Self::PowerUp => "RESET must leave the tables as they are at power-up",
        }
    }
}
