//! `halfrow-station job`

use std::path::PathBuf;

use clap::{Args, Subcommand};
use halfrow_program::number::counted;

use super::beginning::{SettingsFile, plant};
use super::looking::{either, table, time};
use super::why::{Why, at_plant, name, person};
use super::{Failure, print, tell};
use crate::console;
use crate::exit::Exit;
use crate::plan::Plan;
use crate::settings::is_word;
use crate::store::{Job, JobState, NewJob, PlantAddress, PlantLink, SharedBoard, Wanted, boards, jobs};

/// How many jobs are listed unless the command says otherwise.
const LISTED: u32 = 100;

/// Add jobs to the plant, see them, cancel them
///
/// A job is judged by whichever station is free and has its plan: `halfrow-station work`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Add a job
    Add(Add),
    /// Print the jobs, the newest first
    List {
        /// Those of one state [default: waiting, claimed and dead]
        #[arg(long, value_enum)]
        state: Option<JobState>,
        /// How many at most
        #[arg(long, default_value_t = LISTED)]
        most: u32,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Cancel a job; a run of it that is under way is ended, and does not count
    Cancel(Change),
    /// Try a job again that came to nothing
    Retry(Change),
}

#[derive(Debug, Args)]
struct Add {
    /// The plan; a station takes the job that has just this one
    #[arg(long, value_name = "FILE")]
    plan: PathBuf,
    #[command(flatten)]
    about: About,
    /// What a station must have, as its settings name it; may be given several times
    #[arg(long, value_name = "WORD")]
    needs: Vec<String>,
    /// Jobs of a higher one come first
    #[arg(long, default_value_t = 0)]
    priority: i64,
    /// How many
    #[arg(long, default_value_t = 1, value_parser = counted::<u32>(1, Some(10_000)))]
    count: u32,
    /// Your name, which the audit keeps
    #[arg(long, value_name = "NAME", value_parser = person)]
    operator: String,
}

/// Which board a job is about.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct About {
    /// The board that is this unit
    #[arg(long)]
    serial: Option<String>,
    /// Any board of this kind
    #[arg(long, value_parser = name)]
    kind: Option<String>,
}

#[derive(Debug, Args)]
struct Change {
    /// The job
    id: String,
    #[command(flatten)]
    why: Why,
}

/// There is no such job, or its state does not allow this.
#[derive(Debug, thiserror::Error)]
#[error("there is no job {id} that could be {done}; `halfrow-station job list` shows the state of each")]
pub(super) struct NoJob {
    pub(super) id: String,
    done: &'static str,
}

/// The word cannot be one that a station has.
#[derive(Debug, thiserror::Error)]
#[error("`{word}` is no word that a station could have; write one without blanks")]
pub(super) struct NoWord {
    pub(super) word: String,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load_without_lanes()?;
    let address = plant(&settings)?.address()?;
    match what {
        Action::Add(add) => add_jobs(&address, add),
        Action::List { state, most, json } => {
            let states = match state {
                Some(state) => vec![*state],
                None => JobState::UNSETTLED.to_vec(),
            };
            let found = PlantLink::new(address).look(|now| jobs(now, &states, "", *most))?;
            either(&found, *json, |found| text(found))
        }
        Action::Cancel(Change { id, why }) => {
            let mut plant = at_plant(&address, &why.operator, &format!("job cancel {id}"))?;
            changed(plant.cancel_job(id, why.by())?, id, "cancelled")
        }
        Action::Retry(Change { id, why }) => {
            let mut plant = at_plant(&address, &why.operator, &format!("job retry {id}"))?;
            changed(plant.retry_job(id, why.by())?, id, "retried")
        }
    }
}

fn add_jobs(address: &PlantAddress, add: &Add) -> Result<Exit, Failure> {
    let plan = Plan::load(&add.plan)?;
    let wanted = match (&add.about.serial, &add.about.kind) {
        (Some(serial), _) => {
            plan.select(serial)?;
            Wanted::Serial(serial.clone())
        }
        (None, kind) => Wanted::Kind(kind.clone().unwrap_or_default()),
    };
    if let Some(word) = add.needs.iter().find(|word| !is_word(word)) {
        return Err(Failure::call(NoWord { word: word.clone() }));
    }
    let (Wanted::Serial(of) | Wanted::Kind(of)) = &wanted;
    let job = NewJob {
        plan: &plan,
        wanted: &wanted,
        needs: &add.needs,
        priority: add.priority,
        operator: &add.operator,
    };
    if let Wanted::Kind(kind) = &wanted {
        warn_of_no_board(address, kind, &plan.product)?;
    }
    let mut plant = at_plant(address, &add.operator, &format!("job add {of}"))?;
    let printed = print(&plant.add_jobs(&job, add.count)?.join("\n"));
    if printed.is_err() {
        console::diagnose(&"the jobs were added all the same; `halfrow-station job list` shows them");
    }
    printed
}

/// Warns of jobs for boards of a kind of which no unit of the product is shared.
fn warn_of_no_board(address: &PlantAddress, kind: &str, product: &str) -> Result<(), Failure> {
    let would_do = |board: &SharedBoard| board.kind == kind && board.product == product;
    if !PlantLink::new(address.clone()).look(boards)?.iter().any(would_do) {
        console::diagnose(&format_args!(
            "warning: no board of the kind {kind} is shared as a unit of {product}; jobs for one wait until one is: \
             `halfrow-station board list` shows what is shared"
        ));
    }
    Ok(())
}

fn changed(is_changed: bool, id: &str, done: &'static str) -> Result<Exit, Failure> {
    if is_changed {
        return Ok(tell(&format!("{id} is {done}")));
    }
    Err(Failure::call(NoJob { id: id.to_owned(), done }))
}

fn text(jobs: &[Job]) -> String {
    if jobs.is_empty() {
        return "no jobs".to_owned();
    }
    let row = |job: &Job| {
        let about = if job.serial.is_empty() { format!("any {}", job.kind) } else { job.serial.clone() };
        let state = match (&job.verdict, &job.holder) {
            (Some(verdict), _) => verdict.to_string(),
            (None, Some(holder)) if job.state == JobState::Claimed => format!("claimed by {holder}"),
            _ => job.state.to_string(),
        };
        let plan = format!("{} {} {}", job.product, job.plan, job.version);
        let (tries, priority) = (job.attempts.to_string(), job.priority.to_string());
        let said = job.said.clone().unwrap_or_default();
        vec![job.id.clone(), time(job.created_ms), plan, about, priority, state, tries, said]
    };
    let names = ["job", "added", "plan", "board", "priority", "state", "claims", "said last"];
    table(&names, &[4, 6], jobs.iter().map(row))
}
