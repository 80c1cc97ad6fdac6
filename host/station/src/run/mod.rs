//! A run, from the serial number to the saved verdict.
//!
//! ```text
//!  open row ─► lane ─► record ─► evidence on the disk ─► COMMIT ─► read back ─► verdict
//!     └ recovered: a run that is found open is ERROR, cause crash, and never PASS
//! ```

mod evidence;
mod lent_board;
mod patience;
mod recovered;

use std::borrow::Cow;
use std::fs;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use halfrow::verdict::StoppedBy;

pub use recovered::{Recovered, recover, recover_run};

use crate::ids::NoRandomness;
use crate::labgrid::{AcquiredPlace, LaneBoard};
use crate::lane::supervisor::{Attendant, End, LaneReport};
use crate::lane::{LaneJob, Message, Ruling};
use crate::plan::limits::Maker;
use crate::plan::serial::{Serial, SerialError};
use crate::plan::{Plan, Selected, changed, mock};
use crate::record::{
    Attachment, Blobs, BoardSeen, Conclusion, DeviceSeen, JobClaim, PlanRecord, Record, RunCause, RunHead,
    StepRecord, SuspectRecord, judged,
};
use crate::said::{Said, Saying};
use crate::store::{Admission, Folder, SharedStore, StoreError, Stored};
use crate::{clock, ids};
use evidence::attached;

/// What to run on which board.
#[derive(Clone, Copy, Debug)]
pub struct Order<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// Its file.
    pub plan_file: &'a Path,
    /// The serial number, as it was scanned. If it is that of [the mock in this lane](crate::plan::mock), the mock is judged
    /// instead of the board.
    pub serial: &'a str,
    /// The board.
    pub board: &'a LaneBoard,
    /// The station.
    pub station: &'a str,
    /// The lane.
    pub lane: &'a str,
    /// Who starts it.
    pub operator: &'a str,
    /// The program whose command `lane` is started.
    pub program: &'a Path,
    /// Whether the run counts as production: the board is a product, and the lane was checked in this shift.
    pub counts: bool,
    /// The job that the run belongs to.
    pub job: Option<&'a JobClaim>,
    /// How long the lane may be silent, in addition to the link tests of the plan.
    pub silence: Duration,
    /// How much memory the lane may have, in MiB of addresses.
    pub memory_mib: u64,
}

/// A run whose verdict is saved.
#[derive(Debug)]
pub struct Saved {
    /// Its record.
    pub record: Record,
    /// What was read back.
    pub stored: Stored,
    /// When that was, in milliseconds since 1970, UTC.
    pub saved_ms: i64,
}

/// An observer of a run, who may stop it.
pub trait Watch {
    /// Who wants the run to end, if somebody does.
    fn stop(&self) -> Option<StoppedBy>;
    /// Why it should end, where that says more than who wants it.
    fn why(&self) -> Option<Said> {
        None
    }
    /// Is called whenever the run reaches a stage.
    fn hear(&mut self, stage: Stage<'_>);
}

/// How far a run has come.
#[derive(Clone, Copy, Debug)]
pub enum Stage<'a> {
    /// It is in the store, and its lane starts.
    Begun(&'a RunHead),
    /// It waits for the place of labgrid of this name.
    AwaitsPlace(&'a str),
    /// Its lane reported something.
    Told(&'a Message),
    /// Its lane has ended, and its result is being saved.
    Saving {
        /// Whether the lane's process had to be killed because it was silent or took too long.
        was_killed: bool,
        /// Whether it could not even be killed: it may still have the board.
        is_stuck: bool,
    },
}

/// A run without a verdict.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The serial number is none of the product's. Nothing was begun.
    #[error(transparent)]
    Serial(#[from] SerialError),
    /// The run could not be entered into the database, and the board was not touched.
    #[error("the run was not begun, and the board not touched")]
    NotBegun(#[source] Box<StoreError>),
    /// The same.
    #[error(transparent)]
    NoRandomness(#[from] NoRandomness),
    /// A file that the plan names is another one than when the plan was read. Nothing was begun: each board would be an ERROR, and
    /// none of them is to blame.
    #[error(transparent)]
    PlanFile(#[from] Saying),
    /// The run is over, but its result could not be saved, so there is none. Most often the disk is full: `halfrow-station prune` makes
    /// room while the station is stopped, as the handbook's page on storage says.
    #[error(
        "the result of run {run} could not be saved, so there is none; test the board again when this is put right"
    )]
    Unsaved {
        /// The run.
        run: String,
        /// Why.
        source: Box<StoreError>,
    },
}

/// Carries out the order, watched by `watch`. The store is locked only for moments.
///
/// # Errors
/// [`RunError`] when there is no verdict that may be shown.
pub fn run(store: &SharedStore, order: &Order<'_>, watch: &mut dyn Watch) -> Result<Saved, RunError> {
    refuse_changed(order)?;
    let started_ms = clock::now_ms();
    let not_begun = |error| RunError::NotBegun(Box::new(error));
    let id = store.with(|store| store.new_id(started_ms)).map_err(not_begun)?;
    let Subject { serial, selected, target } = Subject::of(order, ids::seed(id))?;
    let head = RunHead {
        id: id.to_string(),
        station: order.station.to_owned(),
        lane: order.lane.to_owned(),
        unit_id: ids::new(started_ms)?.to_string(),
        product: order.plan.product.clone(),
        serial: serial.text,
        variant: serial.variant,
        operator: order.operator.to_owned(),
        target,
        fence: 0,
        started_ms,
        job: order.job.cloned(),
    };
    let planned = plan_record(order.plan);
    let spool = store.folder().spool(&head.id);
    // Whoever finds the run open finds its claim, too.
    recovered::note_claim(&spool, head.job.as_ref());
    let entered = store.with(|store| store.begin(head.clone(), &planned));
    let head = entered.map_err(|error| recovered::not_entered(store, &head, error, watch))?;
    watch.hear(Stage::Begun(&head));
    let begun = Instant::now();
    let job = job(&head, order, ids::seed(id), &spool);
    let mut attending = Attending { store, run: &head, watch, device: DeviceSeen::NotChecked, place: None };
    let (heard, lost) =
        lent_board::supervised(order, job, &spool, patience::of(order.silence, &selected), &mut attending);
    let (device, is_stuck) = (attending.device, matches!(heard.end, End::Stuck(_)));
    let was_killed = is_stuck || matches!(heard.end, End::Killed(_));
    attending.watch.hear(Stage::Saving { was_killed, is_stuck });
    let why = attending.watch.why().or(lost);
    let mut record = record(head, planned, order, &selected, (heard, device), begun.elapsed());
    record.conclusion = record.conclusion.stopped_since(why);
    let steps = selected.steps.len() as u32;
    let finish = |record: &_| store.with(|store| store.finish(record, steps));
    save(store.folder(), record, attached, finish)
}

/// Refuses a plan of which a file is another one than when it was read.
fn refuse_changed(order: &Order<'_>) -> Result<(), Saying> {
    match changed(order.plan_file, &order.plan.files) {
        Some(file) => Err(Saying::PlanFileOther { file: file.to_owned() }),
        None => Ok(()),
    }
}

/// What is judged.
struct Subject<'a> {
    serial: Serial,
    selected: Cow<'a, Selected>,
    target: String,
}

impl<'a> Subject<'a> {
    /// The board of the order, or the mock with a fault that is drawn by `seed`. No limits apply to the mock: they are about real
    /// boards, and its clock and link, which are not real, could only miss them.
    fn of(order: &Order<'a>, seed: u64) -> Result<Self, SerialError> {
        if !mock::is_mock(order.serial) {
            let (serial, selected) = order.plan.select(order.serial)?;
            let selected = Cow::Borrowed(selected);
            return Ok(Self { serial, selected, target: order.board.to_string() });
        }
        let selected = order.plan.variant("");
        let target = mock::target(seed, selected);
        let serial = Serial { text: order.serial.to_owned(), variant: String::new() };
        let selected = Selected { limits: Vec::new(), ..selected.clone() };
        Ok(Self { serial, selected: Cow::Owned(selected), target })
    }
}

/// The job that is handed to the lane.
fn job(head: &RunHead, order: &Order<'_>, seed: u64, spool: &Path) -> LaneJob {
    LaneJob {
        run: head.id.clone(),
        target: head.target.clone(),
        plan: order.plan_file.to_owned(),
        text: order.plan.text.clone(),
        sha256: order.plan.sha256.clone(),
        variant: head.variant.clone(),
        seed,
        is_mock: mock::is_mock(&head.serial),
        spool: spool.to_owned(),
        memory_mib: order.memory_mib,
    }
}

/// Attends to the lane of a run: decides by the store whether a device may have the serial number.
struct Attending<'a> {
    store: &'a SharedStore,
    run: &'a RunHead,
    watch: &'a mut dyn Watch,
    device: DeviceSeen,
    /// The place that is held for it, without which it ends.
    place: Option<AcquiredPlace>,
}

impl Attendant for Attending<'_> {
    fn stop(&mut self) -> Option<StoppedBy> {
        self.watch.stop().or_else(|| self.place.as_mut()?.lost().map(|_| StoppedBy::Caller))
    }

    fn hear(&mut self, message: &Message) {
        self.watch.hear(Stage::Told(message));
    }

    fn rule(&mut self, board: &BoardSeen) -> Ruling {
        let Some(device) = &board.device else {
            return Ruling::Untold { why: Saying::DeviceUnsaid.into() };
        };
        match self.store.with(|store| store.admit(self.run, device)) {
            Ok(Admission::New) => {
                self.device = DeviceSeen::New;
                Ruling::New
            }
            Ok(Admission::Known) => {
                self.device = DeviceSeen::Known;
                Ruling::Known
            }
            Ok(Admission::Refused { why }) => Ruling::Refused { why },
            Err(error) => Ruling::Untold { why: Said::of(&error) },
        }
    }
}

fn plan_record(plan: &Plan) -> PlanRecord {
    PlanRecord {
        sha256: plan.sha256.clone(),
        name: plan.name.clone(),
        version: plan.version.clone(),
        text: plan.text.clone(),
        files: Some(plan.files.clone()),
    }
}

fn record(
    run: RunHead,
    plan: PlanRecord,
    order: &Order<'_>,
    selected: &Selected,
    (heard, device): (LaneReport, DeviceSeen),
    took: Duration,
) -> Record {
    let LaneReport { steps, took: stepped, end } = heard;
    let stepped = [("run.seconds", stepped.map(|took| took.as_secs_f64()))];
    // Without any step there was nothing to measure, and how the lane ended says more.
    let measurements =
        if steps.is_empty() { Vec::new() } else { judged(Maker::Run, &stepped, &selected.limits) };
    let conclusion = Conclusion::of(selected.steps.len() as u32, &steps, &measurements, of_lane(end))
        .note_unchecked_identity(device);
    let suspects = if conclusion.disbelieves_steps() { Vec::new() } else { last_suspects(&steps) };
    let reached = steps.last().map_or(0, |step| step.seq);
    let mut record = Record {
        seconds: Some(took.as_secs_f64()),
        device,
        suspects,
        measurements,
        ..Record::of(run, plan, steps, conclusion, order.counts)
    };
    let rest = selected.steps.iter().zip(1..).filter(|(_, seq)| *seq > reached);
    record.steps.extend(rest.map(|(step, seq)| StepRecord::skipped(seq, step, record.ended_ms)));
    record
}

/// The conclusion that follows from the lane's end alone.
fn of_lane(end: End) -> Option<Conclusion> {
    match end {
        End::Done => None,
        End::Refused(why) => Some(Conclusion::error(RunCause::Station, why)),
        End::Stopped(by) => Some(Conclusion::stopped(by)),
        End::Died(why) | End::Killed(why) | End::Stuck(why) => Some(Conclusion::error(RunCause::Crash, why)),
    }
}

/// The suspects of the last step that has some.
fn last_suspects(steps: &[StepRecord]) -> Vec<SuspectRecord> {
    let mut of_steps = steps.iter().rev().map(|step| &step.suspects);
    of_steps.find(|some| !some.is_empty()).cloned().unwrap_or_default()
}

/// Saves the record by `finish`, and removes the spool if it is not needed any more. Unless the run is a PASS, what the lane wrote
/// down is attached by `attach`; it is on the disk before `finish`, the only part that needs the store.
fn save(
    folder: &Folder,
    mut record: Record,
    attach: impl FnOnce(&Blobs, &Path) -> Result<Vec<Attachment>, StoreError>,
    finish: impl FnOnce(&Record) -> Result<Stored, StoreError>,
) -> Result<Saved, RunError> {
    let spool = folder.spool(&record.run.id);
    let run = record.run.id.clone();
    let saved = || {
        // What the lane wrote down is there, too.
        folder.refuse_gone()?;
        if record.conclusion.verdict != halfrow::Verdict::Pass {
            record.attachments = attach(&folder.blobs(), &spool)?;
        }
        finish(&record)
    };
    let stored = saved().map_err(|source| RunError::Unsaved { run, source: Box::new(source) })?;
    let saved_ms = clock::now_ms();
    // A lane that was not started wrote nothing down.
    if !recovered::is_needed(&spool)
        && let Err(error) = fs::remove_dir_all(&spool)
        && error.kind() != io::ErrorKind::NotFound
    {
        tracing::warn!("{} cannot be removed: {error}; it is not needed any more", spool.display());
    }
    Ok(Saved { record, stored, saved_ms })
}
