//! Words for what the rules of the wire have shown.

use halfrow_protocol::message::RefusalCode;

use crate::result::{Answer, Finding, Rule};
use crate::words::count;

/// What to do about any broken rule.
pub(super) const REMEDY: &str = "Check how the board decodes requests, and try it with the conformance tests; \
                                 protocol/WIRE.md says what it must refuse.";

/// The sentence of a finding on rules, if it is one.
pub(super) fn sentence(finding: &Finding) -> Option<String> {
    Some(match finding {
        Finding::RulesKept { requests } => {
            format!("{} answered as the wire's rules say", count(*requests, "request"))
        }
        Finding::RulesLeftOut {} => "left out of this run".to_owned(),
        Finding::RuleBroken { rule, request, right, found } => {
            format!("the board must {}, but it {} ({})", must(right, request), did(found), meaning(*rule))
        }
        _ => return None,
    })
}

fn must(right: &Answer, request: &str) -> String {
    match right {
        Answer::Refused { code, detail } => {
            format!("refuse {request} as `{}`, detail {detail}", reason(*code))
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
        Answer::OtherRow {} => format!("answer {request} with another row"),
        Answer::Twice {} => format!("answer {request} twice"),
        Answer::Nothing {} => format!("leave {request} unanswered"),
    }
}

fn did(found: &Answer) -> String {
    match found {
        Answer::Refused { code, detail } => format!("refused as `{}`, detail {detail}", reason(*code)),
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
        Answer::OtherRow {} => "returned another".to_owned(),
        Answer::Twice {} => "did so twice".to_owned(),
        Answer::Nothing {} => "did not".to_owned(),
    }
}

/// The refusal's name in WIRE.md, section 6.
fn reason(code: u8) -> String {
    RefusalCode::from_code(code).map_or_else(|| format!("code {code}"), |reason| reason.name().to_owned())
}

/// The rule as a clause.
pub(super) fn meaning(rule: Rule) -> &'static str {
    match rule {
        Rule::Payload => "a request is cut short or has a field without meaning",
        Rule::Kind => "the kind is no request",
        Rule::Skipped => "what follows the fields, or means nothing in a row's place, is ignored",
        Rule::Configuration => "a configuration is set as it is, or refused without effect",
        Rule::Span => "a span that is in no table",
        Rule::Entry => "a table's entry out of range",
        Rule::Address => "entries keep to their places",
        Rule::Damage => "a damaged packet has no effect",
        Rule::Once => "each request has one answer, and most had two",
        Rule::Session => "a packet of another session has no effect",
        Rule::Held => "a board is held for 10 s after its holder's last packet",
        Rule::NewSession => "a greeting opens the next session, which keeps nothing but tables and settings",
        Rule::Closed => "RESET closes a session with level 1 alone, and drops tables with level 2 alone",
        Rule::CommitCrc => "a commit with another CRC than the tables have",
        Rule::Generation => "which generations a commit may name",
        Rule::Shape => "a grid that the board cannot have is refused",
        Rule::CommitFrame => "a commit takes effect with its frame",
        Rule::Pending => "a commit is pending",
        Rule::Forgotten => "RESET forgets a pending commit",
        Rule::RowPlace => "a row out of place",
        Rule::Window => "the window is as far ahead as row_banks_in says",
        Rule::Credit => "a row beyond the window",
        Rule::Inside => "rows are inside the core, or kept for the host",
        Rule::Rows => "rows come back in place",
        Rule::Samples => "samples beyond their depth go in as they are",
        Rule::Again => "a row is sent again until it is acknowledged",
        Rule::Banks => "row_banks_out rows are kept until they are acknowledged, and no more are made",
        Rule::Wide => "rows of the greatest width",
        Rule::RowNumber => "numbers of rows",
        Rule::Burst => "what a burst can be",
        Rule::UnderWay => "a burst is under way",
        Rule::Records => "records are kept until the host has them",
        Rule::Ended => "a burst ends where it is told to",
        Rule::Cut => "RESET ends a burst",
        Rule::Repeated => "a burst repeats its first frame",
        Rule::Trap => "the first row with another signature than expected is kept",
        Rule::NotReady => "a board without configuration or tables",
        Rule::PowerUp => "RESET leaves tables as they are at power-up",
    }
}
