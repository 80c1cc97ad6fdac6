//! `halfrow-station outbox`

use clap::{Args, Subcommand};
use serde::Serialize;

use super::beginning::{Disk, SettingsFile, plant_sink};
use super::looking::{either, table, time};
use super::plant::plant;
use super::{Failure, print};
use crate::exit::Exit;
use crate::outbox::{OutboxError, PlantSink, Round, round};
use crate::settings::Settings;
use crate::store::{Dead, Folder, SharedStore, Store, Unsent};

/// See what is still to be sent on, send it, or have it tried again
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Print what is still to be sent, and what waits for a person
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Send what is due while the station does not run, which sends by itself
    Send {
        #[command(flatten)]
        disk: Disk,
    },
    /// Have something tried again that waits for a person
    Release {
        /// The id of the run, the waiver or the line of the audit
        id: String,
        /// Why it may be tried again
        #[arg(long)]
        reason: String,
        /// Who says so
        #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
        operator: String,
    },
}

/// What is still to be sent.
#[derive(Debug, Serialize)]
struct Left {
    unsent: Vec<Unsent>,
    dead: Vec<Dead>,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load()?;
    let folder = Folder::new(&settings.data);
    match what {
        What::List { json } => either(&Left { unsent: folder.unsent()?, dead: folder.dead()? }, *json, text),
        What::Send { disk } => send(&settings, disk.opens(&settings.data)?),
        What::Release { id, reason, operator } => {
            let mut store = Store::open_existing(&folder)?;
            if store.release(id)? == 0 {
                return Err(Failure::call(NotDead { id: id.clone() }));
            }
            store.note(operator, "release", id, reason)?;
            print(&format!("{id} is tried again"))
        }
    }
}

/// Sends to the plant until nothing is due.
fn send(settings: &Settings, mut store: Store) -> Result<Exit, Failure> {
    let mut sink = plant_sink(settings, plant(settings)?, &mut store)?;
    store.sends_to(vec![PlantSink::NAME.to_owned()])?;
    let store = SharedStore::new(store);
    let mut all = Round::default();
    loop {
        let Round { sent, failed, is_away } = round(&store, &mut sink)?;
        all = Round { sent: all.sent + sent, failed: all.failed + failed, is_away };
        if is_away || sent + failed == 0 {
            break;
        }
    }
    let left = store.with(|store| store.folder().unsent())?;
    print(&format!("{} sent, {} not", all.sent, all.failed))?;
    if all.failed == 0 { Ok(Exit::Pass) } else { print(&table_of(&left)).map(|_| Exit::Error) }
}

fn text(Left { unsent, dead }: &Left) -> String {
    if unsent.is_empty() {
        return "nothing is left to be sent".to_owned();
    }
    let dead = dead.iter().map(|Dead { sink, entry, dead_ms, said }| {
        vec![sink.clone(), entry.subject.clone(), time(*dead_ms), said.clone()]
    });
    let dead = table(&["sink", "waits for a person", "since", "said"], &[], dead);
    format!("{}\n\n{dead}", table_of(unsent))
}

fn table_of(unsent: &[Unsent]) -> String {
    let row = |Unsent { sink, entries, dead, since_ms, said }: &Unsent| {
        let said = said.clone().unwrap_or_default();
        vec![sink.clone(), entries.to_string(), dead.to_string(), time(*since_ms), said]
    };
    table(&["sink", "unsent", "dead", "since", "said last"], &[1, 2], unsent.iter().map(row))
}

/// Nothing of this id waits for a person.
#[derive(Debug, thiserror::Error)]
#[error("nothing of the id {id} waits for a person; `halfrow-station outbox list` tells what does")]
pub(super) struct NotDead {
    pub(super) id: String,
}

impl From<OutboxError> for Failure {
    fn from(error: OutboxError) -> Self {
        Self::error(error)
    }
}
