//! `halfrow-station work`

use clap::Args;
use halfrow::Verdict;
use rand::{RngExt as _, rng};
use serde_json::json;

use super::beginning::{Disk, SettingsFile, Signal, recovered, sinks};
use super::plant::plant;
use super::publish::fetch_at_start;
use super::{Failure, print};
use crate::console;
use crate::exit::Exit;
use crate::outbox::Outbox;
use crate::settings::Settings;
use crate::store::{Claim, PlantLink, SharedStore, Worker};
use crate::work::{Judged, Work, WorkError};

/// Take jobs of the plant, one after the other, and judge the boards that they are about
///
/// `[work]` of the settings has the plans of the jobs that are taken. A job is done when the plant has its run; until then job and
/// board are held, and whoever loses them ends the run. A signal ends the run that is under way, and the program.
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
    json: bool,
}

/// Settings that say nothing of jobs.
#[derive(Debug, thiserror::Error)]
#[error("the settings do not say which jobs are taken; write plans = [\"plan.toml\"] into [work]")]
pub(super) struct NoWork;

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    fetch_at_start(&arguments.settings.path()?)?;
    let settings = arguments.settings.load_plant()?;
    let address = plant(&settings)?.address()?;
    let worker = worker(&settings)?;
    let signal = Signal::heed()?;
    let mut store = arguments.disk.opens(&settings.data)?;
    recovered(&mut store)?;
    let sinks = sinks(&settings, &mut store)?;
    let store = SharedStore::new(store);
    let outbox = Outbox::start(&store, sinks)?;
    let program = std::env::current_exe().map_err(Failure::error)?;
    let plant = PlantLink::new(address);
    let work = Work { settings: &settings, plant, store, program, worker };
    let stop = || signal.by();
    let ended = take_jobs(&work, arguments, &stop);
    outbox.close();
    ended?;
    Ok(signal.by().map_or(Exit::Pass, |by| halfrow::Cause::Stopped(by).into()))
}

/// Judges one job after the other.
fn take_jobs(
    work: &Work<'_>,
    arguments: &Arguments,
    stop: &dyn Fn() -> Option<halfrow::verdict::StoppedBy>,
) -> Result<(), Failure> {
    loop {
        let claim = if arguments.once { work.claim()? } else { work.next(stop)? };
        let Some(claim) = claim else { return Ok(()) };
        if stop().is_some() {
            work.decline(&claim);
            return Ok(());
        }
        let job = claim.job.clone();
        tracing::info!("the job {job} is on the board {}", claim.lease.board);
        match work.judge(claim, stop, &mut |_| ()) {
            Ok(judged) => {
                print(&if arguments.json { document(&judged) } else { text(&judged) })?;
            }
            Err(error @ WorkError::Store(_)) => return Err(Failure::error(error)),
            // The next one may come to something.
            Err(error) => {
                let error = anyhow::Error::from(error).context(format!("the job {job} came to no run"));
                console::error(&format_args!("{error:#}"));
            }
        }
    }
}

fn worker(settings: &Settings) -> Result<Worker, Failure> {
    let work = settings.work.as_ref().ok_or_else(|| Failure::call(NoWork))?;
    let plans = work.plans.iter().filter_map(|place| settings.plans.get(*place));
    Ok(Worker {
        holder: format!("{} {:016x}", settings.name, rng().random::<u64>()),
        station: settings.name.clone(),
        plans: plans.map(|file| file.plan.sha256.clone()).collect(),
        has: work.has.clone(),
    })
}

fn document(Judged { claim: Claim { job, lease, .. }, saved, is_sent, counts }: &Judged) -> String {
    let (run, ended) = (&saved.record.run, &saved.record.conclusion);
    json!({
        "job": job, "board": lease.board, "serial": run.serial, "run": run.id, "verdict": ended.verdict,
        "headline": ended.headline, "at_plant": is_sent, "counts": counts,
    })
    .to_string()
}

fn text(Judged { claim: Claim { job, lease, .. }, saved, is_sent, counts }: &Judged) -> String {
    let (run, ended) = (&saved.record.run, &saved.record.conclusion);
    let note = match (is_sent, counts) {
        (_, Some(false)) => "; another run of the job counts",
        (false, _) => "; the plant does not have it yet",
        (true, _) if ended.verdict == Verdict::Error => "; the job is given back",
        (true, _) => "",
    };
    format!("{} {}: {} (job {job}, board {}{note})", ended.verdict, run.serial, ended.headline, lease.board)
}
