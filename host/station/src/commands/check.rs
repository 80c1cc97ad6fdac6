//! `halfrow-station check`

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use crate::check;
use crate::console;
use crate::exit::Exit;
use crate::store::Folder;

/// Read everything that the station has kept, and say what is not as it was written
///
/// Every hash is computed anew, and the database is made anew from the records, in memory, and compared. Exit codes: 0
/// all is as it was written, 3 something is not.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The station's folder
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let checked = check::check(&Folder::new(&arguments.data))?;
    let mut lines: Vec<_> = checked.faults.iter().map(|fault| format!("fault: {fault}")).collect();
    if checked.open > 0 {
        lines.push(format!("{} runs are open; the next start of the station closes them", checked.open));
    }
    if checked.pruned > 0 {
        lines.push(format!("{} pieces of evidence were removed since they were old", checked.pruned));
    }
    let (runs, evidence, faults) = (checked.runs, checked.evidence, checked.faults.len());
    lines.push(format!("{runs} runs and {evidence} pieces of evidence were read, {faults} faults found"));
    console::tell(&lines.join("\n"));
    Ok(if faults == 0 { Exit::Pass } else { Exit::Error })
}
