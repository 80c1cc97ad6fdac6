//! Words for rows with another latency than the board claims.

use crate::result::LateRows;
use crate::words::{count, grouped, verb};

/// The sentence of such a finding.
pub(super) fn sentence(late: &LateRows) -> String {
    let LateRows { rows, of_rows, row, frame, first, last, claimed, .. } = late;
    let how_many = match late.are_some() {
        true => format!("{} of {}", grouped(*rows), count(*of_rows, "row")),
        false => count(*rows, "row"),
    };
    let has = verb(*rows, "have");
    let which = if late.are_one_row() { format!(", all row {row}") } else { String::new() };
    let took = match first == last {
        true => format!("took {first}"),
        false => format!("took {first} for its first sample and {last} for its last"),
    };
    format!(
        "{how_many} {has} another latency than the {claimed} pixel clocks that the board claims{which}: row {row} of \
         frame {frame} {took}"
    )
}

/// What the designer should do about it.
pub(super) fn remedy(is_of_one_row: bool) -> &'static str {
    if is_of_one_row {
        "Check the enable and the row player: the depth of the pipeline is right, as the other rows show."
    } else {
        "Check the depth of the pipeline behind the line memory, and the L that the capabilities advertise."
    }
}
