//! Words for why a defect is suspected.

use super::words;
use crate::result::{Account, Defect, TableWord, TableWords};
use crate::words::{count, grouped, verb};

/// The evidence for a defect, in one sentence without a full stop.
#[must_use]
pub fn evidence(defect: &Defect, account: &Account) -> String {
    if let Some(read) = read_back(defect) {
        return read;
    }
    let defect = words(defect).defect;
    match *account {
        Account::Samples { differing, explained, contradicted, others, set_in } => {
            let onset =
                if set_in { "; it began during the run, because earlier rows came back right" } else { "" };
            format!("with {defect}, {}{onset}", samples(differing, explained, contradicted, others))
        }
        Account::Words { wrong, explained, others } => {
            let unsure = if others > 0 {
                "; other lines would have the same effect, so this is not certain"
            } else {
                ""
            };
            let wrong = count(wrong, "wrong word");
            format!(
                "with {defect}, {} of the {wrong} {} explained, and no others change{unsure}",
                grouped(explained),
                verb(explained, "are")
            )
        }
        Account::Signatures { wrong, explained } => {
            let share = match (explained, wrong) {
                (1, 1) => "the one wrong frame".to_owned(),
                _ => format!("{} of the {}", grouped(explained), count(wrong, "wrong frame")),
            };
            format!("with {defect}, the model reproduces the signatures of {share} examined")
        }
        Account::Nothing => defect,
    }
}

/// What was read of a table where nothing is known to have made it so.
fn read_back(defect: &Defect) -> Option<String> {
    if let Defect::TableLengthWrong { uploaded, read, .. } = defect {
        let were = verb(*uploaded, "were");
        return Some(format!(
            "{} {were} uploaded and {} came back",
            count(*uploaded, "entry"),
            grouped(*read)
        ));
    }
    if let Defect::TableWordWrong(TableWord { uploaded, read, wrong, .. })
    | Defect::GridEntryReadsWrong { uploaded, read, wrong, .. } = defect
    {
        return Some(word(*read, *uploaded, *wrong));
    }
    let Defect::TableWordsWrong(TableWords { entry, weight, uploaded, read, wrong, .. }) = defect else {
        return None;
    };
    let weight = weight.as_ref().map_or_else(String::new, |weight| format!(", weight {weight}"));
    Some(format!("in entry {entry}{weight}, {}", word(*read, *uploaded, *wrong)))
}

fn word(read: i64, uploaded: i64, wrong: usize) -> String {
    let first = if wrong == 1 {
        String::new()
    } else {
        format!("; it is the first of {} wrong words, which no single line explains", grouped(wrong))
    };
    format!("{read} was read where {uploaded} was uploaded{first}")
}

/// What the model computes with the defect, as the rest of a sentence. `others` is how many more defects explain everything.
fn samples(differing: usize, explained: usize, contradicted: usize, others: usize) -> String {
    if explained < differing || contradicted > 0 {
        let rest = match contradicted {
            0 => String::new(),
            1 => ", but would change one that is right".to_owned(),
            more => format!(", but would change {} that are right", grouped(more)),
        };
        let share = match (explained, differing) {
            (1, 1) => "the one differing sample".to_owned(),
            _ => format!("{} of the {}", grouped(explained), count(differing, "differing sample")),
        };
        return format!("the model reproduces {share} examined{rest}");
    }
    let all = match differing {
        1 => {
            "the model reproduces the one differing sample examined exactly, and changes no others".to_owned()
        }
        more => {
            let all = grouped(more);
            format!(
                "the model reproduces all {all} differing samples examined exactly, and changes no others"
            )
        }
    };
    match others {
        0 => all,
        1 => format!("{all}; so does one other defect, so this is not certain"),
        _ => format!("{all}; so do {others} other defects, so this is not certain"),
    }
}
