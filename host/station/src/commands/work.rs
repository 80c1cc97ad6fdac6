//! `halfrow-station work`

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, ScopedJoinHandle};

use clap::Args;
use halfrow::Verdict;
use halfrow::verdict::StoppedBy;
use halfrow::words::plain;
use rand::{RngExt as _, rng};
use serde_json::json;

use super::Failure;
use super::beginning::{Disk, Sending, SettingsFile, Signal, plant, recovered};
use super::fetching::fetch_at_start;
use crate::console;
use crate::exit::Exit;
use crate::guard::guarded;
use crate::lane::supervisor::OWN_PROGRAM;
use crate::plan::{Again, Plan};
use crate::said::Said;
use crate::settings::Settings;
use crate::store::{Claim, PlantLink, SharedStore, Worker};
use crate::work::{JobResult, SetAside, Work, WorkError};

/// Take jobs of the plant, and judge the boards that they are about
///
/// `[work]` of the settings has the plans of the jobs that are taken, and how many are judged at once. A job is done when the plant has its run; until then job and
/// board are held, and whoever loses them ends the run. A signal ends the runs that are under way, and the program.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    /// End when there is no job for this station
    #[arg(long)]
    once: bool,
    #[command(flatten)]
    disk: Disk,
    /// Print a JSON object for each job
    #[arg(long)]
    pub(super) json: bool,
}

/// The settings do not say which jobs the station takes.
#[derive(Debug, thiserror::Error)]
#[error("the settings do not say which jobs are taken; write plans = [\"plan.toml\"] into [work]")]
pub(super) struct NoWork;

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    fetch_at_start(&arguments.settings)?;
    let settings = arguments.settings.load_without_lanes()?;
    let address = plant(&settings)?.address()?;
    let worker = worker(&settings)?;
    let signal = Signal::heed()?;
    let mut store = arguments.disk.opens(&settings.data)?;
    let (_, stuck) = recovered(&mut store)?;
    let introduction = settings.introduction(store.origin()?);
    let store = SharedStore::new(store);
    let work = Work {
        settings: &settings,
        plant: PlantLink::new(address),
        store: store.clone(),
        program: OWN_PROGRAM.into(),
        worker,
        aside: SetAside::default(),
    };
    let stop = || signal.by();
    let tries_no_more = || ended_or(&stop, arguments.once);
    let out = stuck.iter().try_for_each(|run| work.take_out(&run.line.lane, &tries_no_more));
    // The plant lends a board again as soon as it has its run, so nothing is sent before the board is out.
    if stop().is_none() {
        out?;
        let sending = Sending::begin(&settings, store, &introduction.told)?;
        let at_once = settings.work.as_ref().map_or(1, |work| work.at_once);
        // No job is over before the plant has its run, which nobody would send.
        let stop = || ended_or(&stop, sending.refuse_ended().is_err());
        work.introduce(&introduction, !arguments.once, &stop)?;
        take_jobs(&work, arguments, at_once, &stop)?;
        sending.refuse_ended()?;
    }
    Ok(signal.by().map_or(Exit::Pass, |by| halfrow::Cause::Stopped(by).into()))
}

/// Tells every hand whether its run is to end.
type Stop<'a> = &'a (dyn Fn() -> Option<StoppedBy> + Sync);

/// Who ends what goes on until `stop`, which is this program itself if it `is_over`.
fn ended_or(stop: Stop<'_>, is_over: bool) -> Option<StoppedBy> {
    stop().or_else(|| is_over.then_some(StoppedBy::Caller))
}

/// Judges `at_once` jobs at a time. When one hand cannot go on, the others finish the boards that they have, and take
/// no more.
fn take_jobs(work: &Work<'_>, arguments: &Arguments, at_once: u32, stop: Stop<'_>) -> Result<(), Failure> {
    let is_over = AtomicBool::new(false);
    let next_stop = || ended_or(stop, is_over.load(Ordering::Relaxed));
    let hand = || {
        let ended =
            guarded(|| one_by_one(work, arguments, stop, &next_stop)).map_err(Failure::error).flatten();
        is_over.fetch_or(ended.is_err(), Ordering::Relaxed);
        ended
    };
    thread::scope(|scope| {
        let hands: Vec<_> = (1..at_once)
            .map(|number| thread::Builder::new().name(format!("hand {number}")).spawn_scoped(scope, hand))
            .inspect(|begun| {
                is_over.fetch_or(begun.is_err(), Ordering::Relaxed);
            })
            .collect();
        let mut ended = hand();
        for other in hands {
            let other = other.map_err(Failure::error).map(ScopedJoinHandle::join);
            ended = ended.and(other.and_then(|joined| joined.unwrap_or(Ok(()))));
        }
        ended
    })
}

/// Judges one job after another until `next_stop` says that no more are to be begun; `stop` ends the one under way.
fn one_by_one(
    work: &Work<'_>,
    arguments: &Arguments,
    stop: Stop<'_>,
    next_stop: Stop<'_>,
) -> Result<(), Failure> {
    loop {
        let claim = if arguments.once { work.claim()? } else { work.next(next_stop)? };
        let Some(claim) = claim else { return Ok(()) };
        if next_stop().is_some() {
            work.decline(&claim);
            return Ok(());
        }
        let job = claim.job.clone();
        let tries_no_more = || ended_or(next_stop, arguments.once);
        tracing::info!("the job {job} is on the board {}", claim.lease.board);
        match work.judge(claim, stop, &tries_no_more, &mut |_| ()) {
            Ok(judged) => {
                console::tell(&if arguments.json { document(&judged) } else { text(&judged) });
                if let Some(error) = judged.not_out
                    && stop().is_none()
                {
                    return Err(error.into());
                }
                let JobResult { refused: Some(said), saved, .. } = judged else { continue };
                let error = WorkError::NotTaken { run: saved.record.run.id.clone(), said };
                if arguments.once {
                    return Err(Failure::error(error));
                }
                console::error(&Said::of(&error));
                work.until_taken(&saved.record.run.id, next_stop);
            }
            // Otherwise the store, or a file of the plan, would be tried again for ever.
            Err(error) if arguments.once && (error.is_of_store() || error.is_of_plan()) => {
                return Err(Failure::error(error));
            }
            Err(error) if error.is_of_plan() => {}
            // The next job may come to something.
            Err(error) => {
                let said = Said::of(&error);
                console::error(&format_args!("the job {job} came to no run: {said}"));
                work.settle(&error, next_stop);
            }
        }
    }
}

fn worker(settings: &Settings) -> Result<Worker, Failure> {
    let work = settings.work.as_ref().ok_or_else(|| Failure::call(NoWork))?;
    let plans = || work.plans.iter().filter_map(|place| Some(&settings.plans.get(*place)?.plan));
    let hashes = |plan: &Plan| plan.sha256.clone();
    let references = |plan: &Plan| {
        let serials = plan.production.references().into_iter();
        serials.map(|serial| format!("{} {serial}", plan.sha256)).collect::<Vec<_>>()
    };
    Ok(Worker {
        holder: format!("{} {:016x}", settings.name, rng().random::<u64>()),
        station: settings.name.clone(),
        plans: plans().map(hashes).collect(),
        once: plans().filter(|plan| plan.again != Again::Allow).map(hashes).collect(),
        references: plans().flat_map(references).collect(),
        has: work.has.clone(),
        unfit: Vec::new(),
    })
}

fn document(JobResult { claim, saved, is_sent, counts, is_superseded, .. }: &JobResult) -> String {
    let (Claim { job, lease, .. }, run, ended) = (claim, &saved.record.run, &saved.record.conclusion);
    json!({
        "job": job, "board": lease.board, "serial": run.serial, "run": run.id, "verdict": ended.verdict,
        "headline": ended.headline, "at_plant": is_sent, "counts": counts,
        "superseded": is_superseded,
    })
    .to_string()
}

fn text(JobResult { claim, saved, is_sent, is_superseded, .. }: &JobResult) -> String {
    let (Claim { job, lease, .. }, run, ended) = (claim, &saved.record.run, &saved.record.conclusion);
    let note = match (is_sent, is_superseded) {
        (false, _) => "; the plant does not have it yet",
        (true, Some(true)) => "; it does not count, for the job was cancelled or claimed again",
        (true, _) if ended.verdict == Verdict::Error => "; the job is given back",
        (true, _) if saved.record.is_of_reference() => "; it is in no yield, for its unit checks shifts",
        (true, _) => "",
    };
    plain(&format!(
        "{} {}: {} (job {job}, board {}{note})",
        ended.verdict, run.serial, ended.headline, lease.board
    ))
    .into_owned()
}
