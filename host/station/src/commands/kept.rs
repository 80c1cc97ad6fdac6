//! `halfrow-station backup`, `restore` and `prune`

use std::path::PathBuf;

use clap::Args;
use halfrow::words::{count, plain_lines, verb};
use halfrow_program::number::counted;
use serde_json::json;

use super::looking::Data;
use super::progress::teller;
use super::why::{at_station, person};
use super::{Failure, document, tell, tell_lines};
use crate::console;
use crate::exit::Exit;
use crate::kept::{self, Copied, CopyError, Pruned, Unnamed};
use crate::said::Said;
use crate::store::Folder;

/// Copy all that the station has kept to a new folder, while runs go on
///
/// The copy is checked as `restore` checks it. Exit codes: 0 it can be restored, 2 there are no results, or the folder is not
/// empty, 3 it was not made, or is kept and has faults or lacks evidence, 4 another copy is being made there.
#[derive(Debug, Args)]
pub(super) struct Backup {
    /// The folder, which must be new or empty
    to: PathBuf,
    #[command(flatten)]
    data: Data,
}

pub(super) fn backup(arguments: &Backup) -> Result<Exit, Failure> {
    let copied = kept::backup(&arguments.data.folder(), &arguments.to, &mut teller())?;
    let faults: Vec<_> = match kept::faults(&Folder::new(&arguments.to), &mut teller()) {
        Ok(faults) => faults.iter().map(|fault| Said::of(fault).to_string()).collect(),
        Err(error) => vec![Said::of(&error).to_string()],
    };
    let to = arguments.to.display();
    let (runs, pieces) = (count(copied.runs, "run"), count(copied.evidence, "piece"));
    let mut told = format!("{runs} and {pieces} of evidence are in {to}{}", with_unknown(&copied));
    let left_out = &copied.left_out;
    if !left_out.is_empty() {
        told += &format!("; without {} that no row names", count(left_out.len(), "piece"));
    }
    if !faults.is_empty() {
        told += &format!(
            "; `restore` refuses it for {}, and `halfrow-station check` says whether the station has them, too",
            count(faults.len(), "fault")
        );
    }
    let mut lines: Vec<_> = faults.iter().chain(left_out).map(|fault| format!("fault: {fault}")).collect();
    if lines.is_empty() {
        return Ok(tell(&told));
    }
    lines.push(told);
    console::tell(&plain_lines(&lines));
    Ok(Exit::Error)
}

/// Make a station's folder from a backup, when all of it is as it was written
#[derive(Debug, Args)]
pub(super) struct Restore {
    /// The folder of the backup
    from: PathBuf,
    /// The station's folder, which must be new or empty
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
}

pub(super) fn restore(arguments: &Restore) -> Result<Exit, Failure> {
    let copied = kept::restore(&Folder::new(&arguments.from), &arguments.data, &mut teller())?;
    let (runs, pieces) = (count(copied.runs, "run"), count(copied.evidence, "piece"));
    Ok(tell(&format!("{runs} and {pieces} of evidence were read back{}", with_unknown(&copied))))
}

/// What a copy has beyond what its rows name.
fn with_unknown(Copied { unknown, .. }: &Copied) -> String {
    if *unknown == 0 {
        return String::new();
    }
    let records = count(*unknown, "record");
    format!("; with them {records} of runs that no row names, which `halfrow-station check` tells")
}

/// Remove evidence that no row names, and that of old runs; records and rows are kept for ever
///
/// Evidence that no row names was left by runs that ended before their row was written. It is removed when it is a day old.
#[derive(Debug, Args)]
pub(super) struct Prune {
    #[command(flatten)]
    data: Data,
    /// Remove the evidence of runs that ended longer ago, too; 1 or more
    #[arg(long, value_name = "DAYS", value_parser = counted::<u32>(1, None))]
    older_than: Option<u32>,
    /// Your name, which the audit keeps
    #[arg(long, value_name = "NAME", value_parser = person)]
    operator: String,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

/// Most often nothing is without a row, and whoever makes room on a full disk has to ask for more.
const HOW_TO_REMOVE_MORE: &str = "; with --older-than DAYS the evidence of earlier runs is removed, too";

pub(super) fn prune(arguments: &Prune) -> Result<Exit, Failure> {
    let Prune { data, older_than, operator, json } = arguments;
    let folder = data.folder();
    let older = older_than.map(|days| format!(" --older-than {days}")).unwrap_or_default();
    let mut store = at_station(&folder, operator, &format!("prune {}{older}", folder.path().display()))?;
    let old = match older_than {
        Some(days) => {
            let before_ms = store.days_ago_ms(*days)?;
            kept::prune(&mut store, before_ms, operator)?
        }
        None => Pruned::default(),
    };
    let unnamed = kept::prune_unnamed(&mut store, operator)?;
    if *json {
        let old = json!({ "pieces": old.pieces, "bytes": old.bytes });
        let Unnamed { pieces, spools, bytes } = unnamed;
        let unnamed = json!({ "pieces": pieces, "spools": spools, "bytes": bytes });
        let rest = json!({ "old": old, "unnamed": unnamed });
        return Ok(tell_lines(document::text("prune", Exit::Pass, None, rest)?.lines()));
    }
    let Pruned { pieces, bytes } = old;
    let evidence = format!("{} of evidence {} removed", count(pieces, "piece"), verb(pieces, "were"));
    let by_age = older_than.map(|_| format!("{evidence}, {}; ", count(bytes, "byte")));
    let Unnamed { pieces, spools, bytes } = unnamed;
    let is_vain = older_than.is_none() && pieces + spools == 0;
    let hint = if is_vain { HOW_TO_REMOVE_MORE } else { "" };
    Ok(tell(&format!(
        "{}{} and {} that no row names were removed, {}; every record is kept{hint}",
        by_age.unwrap_or_default(),
        count(pieces, "piece"),
        count(spools, "spool"),
        count(bytes, "byte")
    )))
}

impl From<CopyError> for Failure {
    fn from(error: CopyError) -> Self {
        match error {
            CopyError::Exists { .. } => Self::call(error),
            CopyError::UnderWay { .. } => Self::of(Exit::Busy, error),
            CopyError::Store(error) => error.into(),
            error => Self::error(error),
        }
    }
}
