//! Words for a run that had to keep within a time.

use crate::result::{WithinPart, WithinReport};
use crate::words::{bytes, count, grouped, plain, span};

/// `within 5.0 s: 16 parts left out`
pub(super) fn left_out(within: &WithinReport) -> String {
    let left_out = within.parts.iter().filter(|part| part.taken == 0).count();
    format!("within {}: {} left out", span(within.seconds), count(left_out, "part"))
}

/// What was taken of a run that had to keep within a time, what was left out, and what it finds, in one sentence each without
/// a full stop.
#[must_use]
pub fn within(within: &WithinReport) -> Vec<String> {
    let rate = within
        .bytes_per_second
        .map_or_else(|| "has no speed limit".to_owned(), |rate| format!("carries {}/s", bytes(rate as u64)));
    let (expected, limit) = (span(within.expected_seconds), span(within.seconds));
    let some = |part: &WithinPart| match (part.taken, part.of) {
        (taken, of) if taken >= of => plain(&part.part).into_owned(),
        (taken, of) => format!("{} ({} of {})", plain(&part.part), grouped(taken), grouped(of)),
    };
    let list = |parts: Vec<String>| if parts.is_empty() { "nothing".to_owned() } else { parts.join(", ") };
    let taken = within.parts.iter().filter(|part| part.taken > 0).map(some).collect();
    let left_out = within.parts.iter().filter(|part| part.taken == 0);
    let left_out = left_out.map(|part| plain(&part.part).into_owned()).collect();
    let found = if within.measured {
        let (found, faults) = (grouped(within.found), grouped(within.faults));
        format!("finds {found} of {faults} single faults of the Verilog that were measured")
    } else {
        let [width, height] = within.measured_at;
        format!(
            "how many faults this selection finds was not measured; it is based on measurements at {width} x {height}"
        )
    };
    vec![
        format!("expected to take {expected} of {limit}, over a link that {rate}"),
        format!("covers {}", list(taken)),
        format!("leaves out {}", list(left_out)),
        found,
    ]
}
