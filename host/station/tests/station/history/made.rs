//! A store with runs that were entered the way the station enters them, but that no board was judged for.

use std::path::Path;

use halfrow::Verdict;
use halfrow_station::plan::limits::{Blame, Limit, Maker, Measurement, SAMPLES_DIFFERING};
use halfrow_station::record::{
    Attachment, BoardSeen, Conclusion, DeviceSeen, JobClaim, PlanRecord, Record, RunCause, RunHead, SCHEMA,
    StepOutcome, StepRecord, SuspectRecord, judged,
};
use halfrow_station::store::{Folder, Snapshot, Store, StoreError, Stored};
use tempfile::TempDir;

use crate::common::{PLAN, change};

/// 1 November 2026, midnight UTC.
pub(crate) const BEGIN_MS: i64 = 1_793_491_200_000;
pub(crate) const DAY_MS: i64 = 24 * HOUR_MS;
pub(crate) const HOUR_MS: i64 = 3_600_000;
pub(crate) const PRODUCT: &str = "CAM-T";
/// A plan by which the units CAT00001, good, and CAT00002, bad, check a shift.
pub(crate) const SHIFT: (&str, &str) = ("shift", "checked");

/// How a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    Pass,
    /// With these parts as suspects.
    Fail(&'static [&'static str]),
    /// The latency is beyond its limit, and nothing else is wrong.
    TooLate,
    /// In addition, five samples differ.
    TooLateAndWrong,
    Error(RunCause),
    Open,
}

/// A run to be entered.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) product: &'static str,
    pub(crate) serial: String,
    pub(crate) plan: (&'static str, &'static str),
    pub(crate) station: &'static str,
    pub(crate) lane: String,
    pub(crate) operator: String,
    pub(crate) started_ms: i64,
    pub(crate) end: End,
    /// What is attached.
    pub(crate) evidence: Vec<&'static str>,
    /// The job to which it belongs.
    pub(crate) job: Option<JobClaim>,
    /// What was seen of the board's device, and its number; none if nobody looked.
    pub(crate) device: Option<(DeviceSeen, &'static str)>,
    /// Whether it counts as production.
    pub(crate) production: bool,
}

impl Run {
    pub(crate) fn of(serial: &str, end: End) -> Self {
        let [serial, lane, operator] = [serial, "1", "weber"].map(str::to_owned);
        let station = "station 7";
        Self {
            product: PRODUCT,
            serial,
            plan: ("final", "1"),
            station,
            lane,
            operator,
            started_ms: BEGIN_MS,
            end,
            evidence: Vec::new(),
            job: None,
            device: None,
            production: true,
        }
    }

    /// The same, begun so many hours after [`BEGIN_MS`].
    pub(crate) fn at_hour(self, hour: i64) -> Self {
        Self { started_ms: BEGIN_MS + hour * HOUR_MS, ..self }
    }
}

/// A store, and what was entered into it.
pub(crate) struct Made {
    folder: TempDir,
    pub(crate) store: Store,
    entered: u32,
}

impl Made {
    pub(crate) fn new() -> Self {
        Self::at(crate::common::folder())
    }

    /// A store with what is already in this folder.
    pub(crate) fn at(folder: TempDir) -> Self {
        let store = Store::open(&Folder::new(folder.path())).unwrap();
        Self { folder, store, entered: 0 }
    }

    pub(crate) fn folder(&self) -> Folder {
        Folder::new(self.folder.path())
    }

    /// Changes the database without the program; returns how many rows the last statement changed.
    pub(crate) fn change(&self, text: &str) -> usize {
        change(self.folder.path(), text)
    }

    /// The folder and the store.
    pub(crate) fn parts(self) -> (TempDir, Store) {
        (self.folder, self.store)
    }

    /// Enters a run as the `number`-th of several stores that are viewed together.
    pub(crate) fn numbered(&mut self, number: u32, run: &Run) -> String {
        self.count_from(number);
        self.run(run)
    }

    /// Makes the next run the `number`-th.
    pub(crate) fn count_from(&mut self, number: u32) {
        self.entered = number - 1;
    }

    /// Closes the store and returns its folder, to which another program may write from now on.
    pub(crate) fn closed(self) -> TempDir {
        self.folder
    }

    pub(crate) fn now(&self) -> Snapshot {
        Snapshot::take(&self.folder()).unwrap()
    }

    /// Enters a run and returns its id.
    pub(crate) fn run(&mut self, run: &Run) -> String {
        let (head, plan) = self.begin(run);
        let id = head.id.clone();
        if run.end != End::Open {
            self.finish(run, head, plan);
        }
        id
    }

    /// Enters a run of this id.
    pub(crate) fn run_as(&mut self, id: String, run: &Run) {
        let plan = plan(run);
        let head = self.store.begin(RunHead { id, ..self.head(run) }, &plan).unwrap();
        self.finish(run, head, plan);
    }

    /// Begins a run.
    pub(crate) fn begin(&mut self, run: &Run) -> (RunHead, PlanRecord) {
        self.try_begin(run).unwrap()
    }

    /// Like [`Self::begin`], if the store accepts the run.
    pub(crate) fn try_begin(&mut self, run: &Run) -> Result<(RunHead, PlanRecord), StoreError> {
        self.entered += 1;
        let plan = plan(run);
        Ok((self.store.begin(self.head(run), &plan)?, plan))
    }

    /// Ends a run.
    pub(crate) fn finish(&mut self, run: &Run, head: RunHead, plan: PlanRecord) {
        self.try_finish(run, head, plan).unwrap();
    }

    /// Like [`Self::finish`], if the store accepts the record.
    pub(crate) fn try_finish(
        &mut self,
        run: &Run,
        head: RunHead,
        plan: PlanRecord,
    ) -> Result<Stored, StoreError> {
        let attachments = self.attached(run);
        self.store.finish(&Record { attachments, ..record(head, plan, run) }, 2)
    }

    fn attached(&self, run: &Run) -> Vec<Attachment> {
        let attached = |bytes: &&str| Attachment {
            name: format!("{bytes}.txt"),
            sha256: self.folder().blobs().put(bytes.as_bytes()).unwrap(),
            bytes: bytes.len() as u64,
            media_type: "text/plain".to_owned(),
        };
        run.evidence.iter().map(attached).collect()
    }

    fn head(&self, run: &Run) -> RunHead {
        RunHead {
            id: id(run.started_ms, self.entered),
            station: run.station.to_owned(),
            lane: run.lane.clone(),
            unit_id: id(run.started_ms, 1_000_000 + self.entered),
            product: run.product.to_owned(),
            serial: run.serial.clone(),
            variant: String::new(),
            operator: run.operator.clone(),
            target: "usb:1-2.3".to_owned(),
            fence: 0,
            started_ms: run.started_ms,
            job: run.job.clone(),
        }
    }
}

impl AsRef<Path> for Made {
    fn as_ref(&self) -> &Path {
        self.folder.path()
    }
}

/// The `number`-th id of this millisecond.
pub(crate) fn id(ms: i64, number: u32) -> String {
    let mut random = [0; 10];
    random[..4].copy_from_slice(&number.to_be_bytes());
    uuid::Builder::from_unix_timestamp_millis(ms.unsigned_abs(), &random).into_uuid().to_string()
}

fn plan(Run { plan: (name, version), product, .. }: &Run) -> PlanRecord {
    let text = match (*name, *version) {
        SHIFT => {
            PLAN.replace("[tables]", "[shift]\ngood = \"CAT00001\"\nbad = \"CAT00002\"\nhours = 8\n[tables]")
        }
        (name, version) if *product == PRODUCT => format!("schema = 1 # {name} {version}\n"),
        (name, version) => format!("schema = 1 # {product} {name} {version}\n"),
    };
    // The station computes the hash of a plan without files the same way.
    let sha256 = halfrow::result::sha256([text.as_bytes()]);
    let [name, version] = [name, version].map(|text| (*text).to_owned());
    PlanRecord { sha256, name, version, text, files: None }
}

/// The record of a run that ended.
pub(crate) fn record(run: RunHead, plan: PlanRecord, made: &Run) -> Record {
    let verify = verify(&run, made.end);
    let mut board = verify.board.clone();
    if let (Some(board), Some((_, device))) = (&mut board, made.device) {
        board.device = Some(device.to_owned());
    }
    let identity = step(&run, 1, "identity", (StepOutcome::Passed, RunCause::None, 0));
    let verdict = match verify.outcome {
        StepOutcome::Passed => Verdict::Pass,
        StepOutcome::Failed => Verdict::Fail,
        _ => Verdict::Error,
    };
    Record {
        schema: SCHEMA,
        ended_ms: run.started_ms + 1500,
        seconds: Some(1.5),
        conclusion: Conclusion {
            verdict,
            cause: verify.cause,
            exit_code: verify.exit_code,
            headline: format!("it is {verdict}, \"as\" made"),
            remedy: None,
            finding: None,
        },
        plan,
        production: made.production,
        marginal: false,
        device: made.device.map_or(DeviceSeen::NotChecked, |(seen, _)| seen),
        board,
        suspects: verify.suspects.clone(),
        steps: vec![identity, verify],
        measurements: judged(Maker::Run, &[("run.seconds", Some(1.5))], &[]),
        attachments: Vec::new(),
        program: "halfrow 0".to_owned(),
        run,
    }
}

/// The step that decides how a run ends.
fn verify(run: &RunHead, end: End) -> StepRecord {
    let came = match end {
        End::Pass => (StepOutcome::Passed, RunCause::None, 0),
        End::Fail(_) | End::TooLate | End::TooLateAndWrong => (StepOutcome::Failed, RunCause::Board, 1),
        End::Error(cause) => (StepOutcome::Error, cause, 3),
        End::Open => panic!("an open run has no record"),
    };
    let measurement = Measurement::named("latency.clocks").unwrap();
    let limit = Limit { measurement, least: None, most: Some(1004.0), blames: Blame::Board };
    let is_late = matches!(end, End::TooLate | End::TooLateAndWrong);
    let clocks = if is_late { 1005.5 } else { 1004.0 };
    let differing = if matches!(end, End::Fail(_) | End::TooLateAndWrong) { 5.0 } else { 0.0 };
    let values = [("latency.clocks", Some(clocks)), (SAMPLES_DIFFERING, Some(differing))];
    StepRecord {
        measurements: judged(Maker::Verify, &values, &[limit]),
        suspects: suspects(end),
        ..step(run, 2, "verify", came)
    }
}

/// A step of a run, on hardware.
pub(crate) fn step(run: &RunHead, seq: u32, name: &str, came: (StepOutcome, RunCause, u8)) -> StepRecord {
    let (outcome, cause, exit_code) = came;
    let board = BoardSeen {
        kind: "hardware".to_owned(),
        name: "cam".to_owned(),
        device: Some("0123456789abcdef".to_owned()),
        build: "99bff58a".to_owned(),
    };
    StepRecord {
        seq,
        attempt: 1,
        name: name.to_owned(),
        kind: name.to_owned(),
        outcome,
        cause,
        exit_code,
        started_ms: run.started_ms + 500 * i64::from(seq - 1),
        ended_ms: run.started_ms + 500 * i64::from(seq),
        detail: format!("{name} \"{outcome}\", <{cause}>"),
        finding: None,
        remedy: None,
        measurements: Vec::new(),
        suspects: Vec::new(),
        board: Some(board),
        evidence: None,
    }
}

fn suspects(end: End) -> Vec<SuspectRecord> {
    let End::Fail(parts) = end else { return Vec::new() };
    let suspect = |part: &&str| SuspectRecord {
        part: (*part).to_owned(),
        place: "bit 3".to_owned(),
        explained: 0.75,
        technician: "Look at it.".to_owned(),
    };
    parts.iter().map(suspect).collect()
}
