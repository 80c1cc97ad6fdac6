//! Runs that are found open when the station starts: the program or the computer ended in the middle of them.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::Path;

use halfrow::files::written_aside::{folder_of, sync_folder};

use crate::clock;
use crate::history::unit::{UnitRun, run_of};
use crate::kept::{Spool, spools};
use crate::lane::Message;
use crate::lane::supervisor::{EVENTS, kill_left_behind, left_behind};
use crate::plan::Production;
use crate::record::{
    BlobError, Conclusion, JobClaim, PlanRecord, Record, RunCause, RunHead, StepRecord, made_within,
};
use crate::said::Saying;
use crate::store::{Folder, InLane, OpenRun, SharedStore, Snapshot, Store, StoreError, Stored};

use super::evidence::{attached_as_can_be, has_unread};
use super::{RunError, Saved, Stage, Watch, save};

/// The claim of the job that a run belongs to, in the run's spool: the row of an open run does not have it.
const CLAIM: &str = "claim.json";

/// Keeps `claim` for whoever closes the run if this process, or the computer, ends in the middle of it.
pub(super) fn note_claim(spool: &Path, claim: Option<&JobClaim>) {
    let Some(claim) = claim else { return };
    let write = || {
        made_within(spool)?;
        let mut file = File::create(spool.join(CLAIM))?;
        file.write_all(&serde_json::to_vec(claim)?)?;
        file.sync_all()?;
        sync_folder(spool)?;
        sync_folder(folder_of(spool))
    };
    if let Err(error) = write() {
        tracing::warn!("if this run is broken off, its record will not name its job {}: {error}", claim.id);
    }
}

/// What becomes of a run that the store did not enter. If its row is there all the same, because the folder was away just after it
/// was written, the run is settled like one whose result could not be saved.
pub(super) fn not_entered(
    store: &SharedStore,
    head: &RunHead,
    error: StoreError,
    watch: &mut dyn Watch,
) -> RunError {
    let source = Box::new(error);
    if store.with(Store::open_runs).is_ok_and(|open| open.iter().any(|open| open.run.id == head.id)) {
        watch.hear(Stage::Begun(head));
        return RunError::Unsaved { run: head.id.clone(), source };
    }
    drop_claim(&store.folder().spool(&head.id));
    RunError::NotBegun(source)
}

/// Removes the claim of a run that was not begun.
fn drop_claim(spool: &Path) {
    // What is left of it belongs to no run, and is never read.
    let _ = fs::remove_file(spool.join(CLAIM)).and_then(|()| fs::remove_dir(spool));
}

fn noted_claim(spool: &Path) -> Option<JobClaim> {
    serde_json::from_slice(&fs::read(spool.join(CLAIM)).ok()?).ok()
}

/// What a start of the station finds of earlier ones.
#[derive(Debug)]
pub struct Recovered {
    /// The runs that were open, and are closed.
    pub closed: Vec<Saved>,
    /// Why another one is still open, if one is: its lane stays blocked.
    pub unclosed: Option<RunError>,
    /// If none is: the runs whose lanes' processes cannot be killed, and may still have their boards, or why they are not known.
    pub stuck: Result<Vec<UnitRun>, StoreError>,
}

/// Closes every open run as ERROR, cause crash, with what its lane wrote down. The verdict that it was heading for does not
/// count: to test a board again costs a minute, a wrong PASS costs more.
///
/// # Errors
/// [`StoreError`] when the open runs are not known.
pub fn recover(store: &mut Store) -> Result<Recovered, StoreError> {
    let open = store.open_runs()?;
    if !open.is_empty() {
        store.folder().blobs().clear();
    }
    let folder = store.folder().clone();
    let why = |tries| Saying::StationEnded { tries };
    let mut recovered = Recovered { closed: Vec::new(), unclosed: None, stuck: Ok(Vec::new()) };
    for open in open {
        match closed(&folder, open, why, |record| store.finish(record, 0)) {
            Ok(saved) => recovered.closed.push(saved),
            Err(error) => recovered.unclosed = recovered.unclosed.or(Some(error)),
        }
    }
    if recovered.unclosed.is_none() {
        recovered.stuck = stuck(&folder).inspect(|_| clear(store));
    }
    Ok(recovered)
}

/// The runs that are over, and whose lanes' processes are there all the same.
fn stuck(folder: &Folder) -> Result<Vec<UnitRun>, StoreError> {
    let path = folder.spools();
    let listed = || fs::read_dir(&path)?.collect::<io::Result<Vec<_>>>();
    let spools = listed().map_err(|source| BlobError::Folder { path: path.clone(), source })?;
    let stuck = spools.into_iter().filter_map(|spool| Some((left_behind(&spool.path())?, spool)));
    let of_rows = |(process, spool): (u32, fs::DirEntry)| {
        let row = run_of(&Snapshot::take(folder)?, &spool.file_name().to_string_lossy())?;
        row.ok_or_else(|| StoreError::UnknownProcess { spool: spool.path(), process })
    };
    stuck.map(of_rows).collect()
}

/// Whether the spool of a run that is over is still needed: by the next start, which has to know of the lane's process, or by
/// somebody who can read what this station could not.
pub(super) fn is_needed(spool: &Path) -> bool {
    left_behind(spool).is_some() || has_unread(spool)
}

/// Settles a run whose result could not be saved, once the store works again: as ERROR, cause crash, or as the store has it if
/// everything had reached the disk and only could not be read back. The store is locked only for moments.
///
/// # Errors
/// [`RunError`] when the store does not work yet, or does not know the run.
pub fn recover_run(store: &SharedStore, run: &str) -> Result<Saved, RunError> {
    let unsaved = |source| RunError::Unsaved { run: run.to_owned(), source: Box::new(source) };
    let open = store.with(Store::open_runs).map_err(unsaved)?;
    if let Some(open) = open.into_iter().find(|open| open.run.id == run) {
        let why = |tries| Saying::SavedTooLate { tries };
        return closed(store.folder(), open, why, |record| store.with(|store| store.finish(record, 0)));
    }
    let (stored, record) = store.with(|store| store.settled(run)).map_err(unsaved)?;
    Ok(Saved { record, stored, saved_ms: clock::now_ms() })
}

/// Removes the spools of runs that ended after their result was saved and before they could do so, unless they are needed, and
/// spools that are a day old and that no row names.
fn clear(store: &mut Store) {
    let spools = match spools(store) {
        Ok(spools) => spools,
        Err(error) => return tracing::warn!("what earlier runs left stays where it is: {error}"),
    };
    let may_go = |spool: &Spool| spool.is_old || spool.is_over && !is_needed(&spool.path);
    for Spool { name, path, is_old, .. } in spools.into_iter().filter(may_go) {
        match fs::remove_dir_all(&path) {
            Ok(()) if is_old => tracing::warn!("{} was removed: no row names the run {name}", path.display()),
            Ok(()) => {}
            Err(error) => {
                tracing::warn!("{} cannot be removed: {error}; it is not needed any more", path.display());
            }
        }
    }
}

/// Closes a run by `finish`, like [`save`].
fn closed(
    folder: &Folder,
    open: OpenRun,
    why: impl Fn(usize) -> Saying,
    finish: impl FnOnce(&Record) -> Result<Stored, StoreError>,
) -> Result<Saved, RunError> {
    let OpenRun { run, plan_sha256, plan: [name, version, text] } = open;
    let spool = folder.spool(&run.id);
    let run = RunHead { job: noted_claim(&spool), ..run };
    kill_left_behind(&spool);
    let steps = told(&spool);
    let conclusion = Conclusion::error(RunCause::Crash, why(steps.len()));
    let counted = counts(folder, &run, &plan_sha256, &text);
    let unsaved = |source| RunError::Unsaved { run: run.id.clone(), source: Box::new(source) };
    let counts = counted.map_err(unsaved)?;
    let plan = PlanRecord { sha256: plan_sha256, name, version, text, files: None };
    let record = Record::of(run, plan, steps, conclusion, counts);
    save(folder, record, attached_as_can_be, finish)
}

/// Whether the run could count as production when it began.
fn counts(folder: &Folder, run: &RunHead, plan_sha256: &str, text: &str) -> Result<bool, StoreError> {
    let RunHead { station, lane, product, serial, started_ms, .. } = run;
    let Some(production) = Production::of_text(text) else { return Ok(false) };
    let place = InLane { station, lane, plan_sha256, product, production: &production };
    folder.counts(&place, serial, *started_ms)
}

/// The steps that the lane reported, as far as they were written down.
fn told(spool: &Path) -> Vec<StepRecord> {
    let events = fs::read(spool.join(EVENTS)).unwrap_or_default();
    let lines = events.split(|&byte| byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok());
    let mut steps: Vec<StepRecord> = Vec::new();
    for message in lines {
        if let Message::Ended { step } = message
            && !steps.iter().any(|known| (known.seq, known.attempt) == (step.seq, step.attempt))
        {
            steps.push(*step);
        }
    }
    steps
}
