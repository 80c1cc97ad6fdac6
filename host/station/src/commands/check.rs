//! `halfrow-station check`

use std::path::PathBuf;

use clap::Args;
use halfrow::result::Problem;
use halfrow::words::{count, plain_lines, verb};
use serde_json::json;

use super::progress::teller;
use super::{Failure, document};
use crate::check::{self, Checked, Fault};
use crate::codes;
use crate::console;
use crate::exit::Exit;
use crate::said::Said;
use crate::store::Folder;

/// Read everything that the station has kept, and say what is not as it was written
///
/// Every hash is computed again, and a second database is made from the records and compared with the first. Exit codes: 0
/// all is as it was written, 3 something is not.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The station's folder
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let checked = check::check(&Folder::new(&arguments.data), &mut teller())?;
    tell(&checked, arguments.json)
}

/// Prints what was found; the exit code says whether all is as it was written.
pub(super) fn tell(checked: &Checked, is_json: bool) -> Result<Exit, Failure> {
    let exit = if checked.faults.is_empty() { Exit::Pass } else { Exit::Error };
    console::tell(&if is_json { document(checked, exit)? } else { text(checked) });
    Ok(exit)
}

fn document(checked: &Checked, exit: Exit) -> Result<String, Failure> {
    let Checked { runs, open, evidence, pruned, unread, superseded, faults } = checked;
    let superseded: Vec<_> = superseded.iter().map(|note| Problem::by(note, codes::known)).collect();
    let faults: Vec<_> = faults.iter().map(|fault| Problem::by(fault, codes::known)).collect();
    let rest = json!({
        "runs": runs, "open": open, "evidence": evidence, "pruned": pruned, "unread": unread, "superseded": superseded,
        "faults": faults
    });
    document::text("check", exit, None, rest)
}

/// A line for each fault, and one before those of the tables if they may only follow from the others.
fn faults(Checked { unread, faults, .. }: &Checked) -> Vec<String> {
    let mut lines: Vec<_> = faults.iter().map(|fault| format!("fault: {}", Said::of(fault))).collect();
    if let (1.., Some(place)) = (*unread, faults.iter().position(Fault::is_of_table)) {
        let (records, them) = (count(*unread, "record"), if *unread == 1 { "it" } else { "them" });
        let note = format!(
            "note: the faults below may all follow from the {records} that cannot be read; mend {them} first, and check again"
        );
        lines.insert(place, note);
    }
    lines
}

fn text(checked: &Checked) -> String {
    let mut lines = faults(checked);
    lines.extend(checked.superseded.iter().map(|note| format!("note: {note}")));
    if checked.open > 0 {
        let (runs, are) = (count(checked.open, "run"), verb(checked.open, "are"));
        lines.push(format!("{runs} {are} open; the next start of the station closes what is open"));
    }
    if checked.pruned > 0 {
        let (pieces, were) = (count(checked.pruned, "piece"), verb(checked.pruned, "were"));
        lines.push(format!("{pieces} of evidence {were} removed because of age"));
    }
    let (runs, pieces) = (count(checked.runs, "run"), count(checked.evidence, "piece"));
    let faults = count(checked.faults.len(), "fault");
    lines.push(format!("{runs} and {pieces} of evidence were read, {faults} found"));
    plain_lines(lines)
}
