//! Rows in the wrong place, rows made with other tables, and what no known defect explains.

use std::collections::BTreeMap;

use super::{LOGIC, REPORT, TIMING, Words};
use crate::result::{Defect, Extent, MadeWith, RowSource, StaleFrames};
use crate::words::{count, grouped};

/// The most bits that are named when all differences are in them alone.
const FEW_BITS: usize = 2;

pub(super) fn stale(rows: &[usize], frames: &[StaleFrames]) -> Words {
    let rows = if rows.is_empty() { String::new() } else { format!("{} of ", numbered("row", rows)) };
    let mut alike: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for StaleFrames { frame, committed, made_with } in frames {
        let manner: Vec<_> = made_with.iter().map(|made| made_with_words(*made, *committed)).collect();
        alike.entry(manner.join(" or ")).or_default().push(usize::from(*frame));
    }
    let clauses: Vec<_> = alike
        .iter()
        .map(|(manner, numbers)| format!("{rows}{} made {manner}", numbered("frame", numbers)))
        .collect();
    Words {
        part: "stale tables",
        place: "the choice of the table bank".to_owned(),
        defect: clauses.join(", and "),
        designer: "Check when the switch of table banks takes effect, and which bank the datapath reads."
            .to_owned(),
        technician: TIMING,
    }
}

/// "with the tables of generation 1 instead of 2"
fn made_with_words(made: MadeWith, own: u8) -> String {
    match (made.factors, made.kernel) {
        (None, None) => "as it went in".to_owned(),
        (None, _) => "without stretching it".to_owned(),
        (Some(factors), None) if factors == own => "without a kernel".to_owned(),
        (Some(factors), None) => {
            format!("with the factors of generation {factors} instead of {own} and without a kernel")
        }
        (Some(factors), Some(kernel)) if factors == kernel => {
            format!("with the tables of generation {factors} instead of {own}")
        }
        (Some(factors), Some(kernel)) if factors == own => {
            format!("with the kernel of generation {kernel} instead of {own}")
        }
        (Some(factors), Some(kernel)) if kernel == own => {
            format!("with the factors of generation {factors} instead of {own}")
        }
        (Some(factors), Some(kernel)) => {
            format!("with the factors of generation {factors} and the kernel of {kernel} instead of {own}")
        }
    }
}

/// Ascending numbers, as in "0 to 3, 7" and "6 and 7".
pub(super) fn list(numbers: &[usize]) -> String {
    if let [one, other] = numbers {
        return format!("{one} and {other}");
    }
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let words: Vec<_> = runs
        .map(|run| match run {
            [one, other] => format!("{one}, {other}"),
            [first, .., last] => format!("{first} to {last}"),
            one => one.iter().map(usize::to_string).collect(),
        })
        .collect();
    words.join(", ")
}

/// `bit 7`, `bits 0 to 3, 7`
pub(super) fn bits(numbers: &[u32]) -> String {
    numbered("bit", &numbers.iter().map(|&bit| bit as usize).collect::<Vec<_>>())
}

/// The same for other numbered things, in ascending order.
pub(super) fn numbered(what: &str, numbers: &[usize]) -> String {
    named(what, numbers.len(), &list(numbers))
}

/// The same for things whose names are already joined.
pub(super) fn named(what: &str, count: usize, names: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{what}{ending} {names}")
}

pub(super) fn exchanged(source: RowSource, mostly: bool) -> Words {
    let name = |rows: isize| match rows {
        0 => "the same row".to_owned(),
        -1 => "the row above".to_owned(),
        1 => "the row below".to_owned(),
        rows if rows < 0 => format!("the row {} above", -rows),
        rows => format!("the row {rows} below"),
    };
    let most = if mostly { "rows holding other rows, mostly" } else { "rows holding" };
    let defect = match source {
        RowSource::Output { frames: 0, rows } => format!("{most} {}", name(rows)),
        RowSource::Output { frames, rows } => {
            let when = if frames < 0 { "earlier" } else { "later" };
            let frames = count(frames.unsigned_abs(), "frame");
            format!("{most} {} from {frames} {when}", name(rows))
        }
        RowSource::Input { rows } => format!("{most} {}, made with their own factor", name(rows)),
    };
    Words {
        part: "row bank",
        place: "the row banks".to_owned(),
        defect,
        designer: "Check the numbers of the row banks that are filled, played and fetched.".to_owned(),
        technician: TIMING,
    }
}

pub(super) fn shifted(columns: isize) -> Words {
    let side = if columns < 0 { "left" } else { "right" };
    Words {
        part: "row shift",
        place: format!(
            "corrected rows, shifted by {} to the {side}",
            count(columns.unsigned_abs(), "column")
        ),
        defect: "every row shifted by that much".to_owned(),
        designer: "Check on which pixel clock the capture of a corrected row begins.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn lost(rows: usize, first: usize) -> Words {
    Words {
        part: "lost rows",
        place: match rows {
            1 => format!("row {first} on its way out"),
            count => format!("{count} rows on their way out, the first row {first}"),
        },
        defect: "whole rows lost, which stay black".to_owned(),
        designer: "Check that every row's samples reach their bank before it is fetched.".to_owned(),
        technician: TIMING,
    }
}

pub(super) fn unknown(defect: &Defect) -> Words {
    let maps = if is_unstreamed(defect) { super::NO_MAPS } else { super::MAPS };
    let hint = hint(defect).map_or_else(String::new, |hint| format!("{hint} "));
    Words {
        part: "unknown",
        place: "an unknown part".to_owned(),
        defect: format!("no known defect explains most of the differences: {}", clauses(defect).join(", ")),
        designer: format!("{hint}{maps} {}", super::OF_NEW_DESIGN),
        technician: REPORT,
    }
}

/// What the places of the differences have in common, for the designer.
fn hint(defect: &Defect) -> Option<String> {
    let Defect::NoneKnown { rows, columns, bits: numbers, .. } = defect else { return None };
    // A single sample, always the same: no line that others share.
    if let (Some(Extent::One { .. }), Some(Extent::One { .. })) = (rows, columns) {
        return None;
    }
    if let [bit] = numbers[..] {
        return Some(format!("Check what carries bit {bit} alone: a line that fails at times."));
    }
    let of = |name: &str, extent: &Extent| match extent {
        Extent::One { at } => Some(format!("what only {name} {at} meets: a beginning, the middle or an end")),
        Extent::Even { .. } => Some(format!("what only even {name}s use, such as one of two lanes or banks")),
        Extent::Odd { .. } => Some(format!("what only odd {name}s use, such as one of two lanes or banks")),
        Extent::Every {} | Extent::From { .. } | Extent::Between { .. } | Extent::Some { .. } => None,
    };
    let columns = columns.as_ref().and_then(|columns| of("column", columns));
    let told = columns.or_else(|| rows.as_ref().and_then(|rows| of("row", rows)))?;
    Some(format!("Check {told}."))
}

fn is_unstreamed(defect: &Defect) -> bool {
    matches!(defect, Defect::NoneKnown { unstreamed: true, .. })
}

fn clauses(defect: &Defect) -> Vec<String> {
    let Defect::NoneKnown { frames, of_frames, .. } = defect else { return Vec::new() };
    // A row that was not streamed is the one that a trap kept, of a single frame.
    let within = format!("in {} of {}", grouped(*frames), count(*of_frames, "frame"));
    where_and_how(defect).into_iter().chain((!is_unstreamed(defect)).then_some(within)).collect()
}

/// Where differences lie in their frames, and how large they are.
pub(super) fn where_and_how(defect: &Defect) -> Vec<String> {
    let Defect::NoneKnown { rows, columns, least, most, bright, bits, .. } = defect else {
        return Vec::new();
    };
    let sizes = least.zip(*most).map(|(least, most)| match (least, most) {
        (-1, 1) => "off by one either way".to_owned(),
        _ if least == most => format!("all off by {least:+}"),
        _ => format!("off by {least:+} to {most:+}"),
    });
    let bright = bright.map(|bright| {
        let which = if bright { "of half the range and above" } else { "below half the range" };
        format!("only in samples {which}")
    });
    [
        rows.map(|rows| extent("row", rows)),
        columns.map(|columns| extent("column", columns)),
        sizes,
        bright,
        bits_alone(bits),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The bits, if they are so few that single lines may be the cause.
fn bits_alone(numbers: &[u32]) -> Option<String> {
    (1..=FEW_BITS).contains(&numbers.len()).then(|| format!("{} alone", bits(numbers)))
}

fn extent(name: &str, extent: Extent) -> String {
    match extent {
        Extent::One { at } => format!("all in {name} {at}"),
        Extent::Every {} => format!("in every {name}"),
        Extent::From { first } => format!("in every {name} from {first} on"),
        Extent::Between { first, last } => format!("in {name}s {first} to {last}"),
        Extent::Even { count } => format!("in {count} {name}s, all even"),
        Extent::Odd { count } => format!("in {count} {name}s, all odd"),
        Extent::Some { count, total, first, last } => {
            format!("in {count} of {total} {name}s, {first} to {last}")
        }
    }
}
