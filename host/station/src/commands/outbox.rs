//! `halfrow-station outbox`

use clap::{ArgGroup, Args, Subcommand};
use halfrow::words::verb;
use serde::Serialize;

use super::beginning::{Disk, SettingsFile, sinks};
use super::looking::{either, table, time};
use super::why::{Why, at_station};
use super::{Failure, tell};
use crate::console;
use crate::exit::Exit;
use crate::outbox::{Sink, all};
use crate::settings::Settings;
use crate::store::{DEAD_SHOWN, Dead, Folder, LastTold, SharedStore, Snapshot, Store, Unsent};

/// See what is still to be sent on, send it, or have it tried again
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Print what is still to be sent, and what waits for a person
    ///
    /// Of the entries that wait at a sink, the first hundred are printed; `dead` says how many there are.
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Send all that is left while the station is not running; a running station sends by itself
    ///
    /// What was tried in vain is tried again at once; what waits for a person is not. Exit codes: 0 nothing is left to be sent, 3
    /// something is, also what waits for a person, or the plant has lost what it had, or cannot be asked.
    Send {
        #[command(flatten)]
        disk: Disk,
    },
    /// Have something tried again that waits for a person
    #[command(group(ArgGroup::new("entries").required(true).args(["id", "sink"])))]
    Release {
        /// The id of the run, the waiver or the line of the audit
        id: Option<String>,
        /// All that waits for a person at this sink
        #[arg(long, value_name = "NAME")]
        sink: Option<String>,
        #[command(flatten)]
        why: Why,
    },
    /// Have all that was kept sent again to a sink that has lost what it had, such as a plant that was put back
    ///
    /// The station sends it when it starts, `outbox send` at once; what the sink still has stays as it is.
    Again {
        /// The sink
        sink: String,
        #[command(flatten)]
        why: Why,
    },
    /// Forget what is to be sent to a sink that the settings do not name any more
    Forget {
        /// The sink
        sink: String,
        #[command(flatten)]
        why: Why,
    },
}

/// What is said when every sink has everything, so that none is called.
const NOTHING_LEFT: &str = "nothing is left to be sent";

/// What is still to be sent.
#[derive(Debug, Serialize)]
struct Backlog {
    unsent: Vec<Unsent>,
    dead: Vec<Dead>,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load_without_lanes()?;
    let folder = Folder::new(&settings.data);
    match what {
        Action::List { json } => {
            let now = Snapshot::take(&folder)?;
            let unsent = now.unsent_to(settings.sink_names())?;
            either(&Backlog { dead: now.dead(&unsent)?, unsent }, *json, text)
        }
        Action::Send { disk } => {
            disk.takes(&settings.data)?;
            send(&settings, Store::open_existing(&folder)?)
        }
        Action::Release { id, sink, why } => release(&folder, id.as_deref(), sink.as_deref(), why),
        Action::Again { sink, why } => again(&settings, &folder, sink, why),
        Action::Forget { sink, why } => forget(&settings, &folder, sink, why),
    }
}

fn release(folder: &Folder, id: Option<&str>, sink: Option<&str>, why: &Why) -> Result<Exit, Failure> {
    let given = format!("outbox release {}", id.or(sink).unwrap_or_default());
    let mut store = at_station(folder, &why.operator, &given)?;
    let (released, what) = match (id, sink) {
        (Some(id), _) => (store.release(id, why.by())?, id),
        (None, Some(sink)) => (store.release_all(sink, why.by())?, sink),
        (None, None) => (0, ""),
    };
    if released == 0 {
        return Err(Failure::call(NotDead { what: what.to_owned() }));
    }
    Ok(tell(&format!("{released} of {what} {} tried again", verb(released, "are"))))
}

fn again(settings: &Settings, folder: &Folder, sink: &str, why: &Why) -> Result<Exit, Failure> {
    if !settings.sink_names().any(|name| name == sink) {
        return Err(Failure::call(SinkUnknown { sink: sink.to_owned() }));
    }
    let mut store = at_station(folder, &why.operator, &format!("outbox again {sink}"))?;
    let unsent = Snapshot::take(folder)?.unsent()?;
    let again = store.send_again(sink, why.by())?;
    let dead = unsent.into_iter().find(|unsent| unsent.sink == sink).map_or(0, |unsent| unsent.dead);
    let rest = match dead {
        0 => String::new(),
        _ => format!(
            "; `halfrow-station outbox release --sink {sink}` has {dead} more tried, which wait for a person"
        ),
    };
    Ok(tell(&format!("{again} of {sink} {} sent again{rest}", verb(again, "are"))))
}

fn forget(settings: &Settings, folder: &Folder, sink: &str, why: &Why) -> Result<Exit, Failure> {
    if settings.sink_names().any(|name| name == sink) {
        return Err(Failure::call(SinkInUse { sink: sink.to_owned() }));
    }
    let mut store = at_station(folder, &why.operator, &format!("outbox forget {sink}"))?;
    if !Snapshot::take(folder)?.unsent()?.iter().any(|unsent| unsent.sink == sink) {
        return Err(Failure::call(SinkUnknown { sink: sink.to_owned() }));
    }
    let forgotten = store.forget_sink(sink, why.by())?;
    Ok(tell(&format!("{forgotten} of {sink} {} forgotten", verb(forgotten, "are"))))
}

/// Sends to every sink what it does not have yet, and prints what is left.
fn send(settings: &Settings, mut store: Store) -> Result<Exit, Failure> {
    let mut sinks = sinks(settings, &mut store, &LastTold::default())?;
    if sinks.is_empty() {
        return Err(Failure::call(NoSink));
    }
    store.sends_to(sinks.iter().map(|sink| sink.name().to_owned()).collect())?;
    let store = SharedStore::new(store);
    let mut sent = 0;
    for sink in &mut sinks {
        sent += all(&store, &mut **sink)?.sent;
    }
    let mut left = Snapshot::take(store.folder())?.unsent()?;
    // What was for former sinks is not sent to them any more.
    left.retain(|unsent| sinks.iter().any(|sink| sink.name() == unsent.sink));
    let unsure = unsure(&mut sinks, &left);
    if sent == 0 && left.is_empty() && unsure.is_empty() {
        return Ok(tell(NOTHING_LEFT));
    }
    let entries: u32 = left.iter().map(|unsent| unsent.entries).sum();
    let sent = tell(&format!("{sent} sent, {entries} not"));
    if left.is_empty() && unsure.is_empty() {
        return Ok(sent);
    }
    if !left.is_empty() {
        console::tell(&table_of(&left));
    }
    unsure.iter().for_each(|said| console::tell_line(said));
    Ok(Exit::Error)
}

/// What sinks say to which nothing is `left` to be sent, and which may have lost what they had all the same.
fn unsure(sinks: &mut [Box<dyn Sink>], left: &[Unsent]) -> Vec<String> {
    let is_done = |sink: &&mut Box<dyn Sink>| left.iter().all(|unsent| unsent.sink != sink.name());
    let asked = sinks.iter_mut().filter(is_done).map(|sink| (sink.beat(0, 0), sink));
    asked.filter_map(|(heard, sink)| Some(format!("{}: {}", sink.name(), heard.err()?))).collect()
}

fn text(Backlog { unsent, dead }: &Backlog) -> String {
    if unsent.is_empty() {
        return NOTHING_LEFT.to_owned();
    }
    let dead = dead.iter().map(|Dead { sink, entry, dead_ms, said }| {
        vec![sink.clone(), entry.subject.clone(), time(*dead_ms), said.to_string()]
    });
    let dead = table(&["sink", "waits for a person", "since", "said"], &[], dead);
    let more = unsent.iter().filter(|unsent| unsent.dead > DEAD_SHOWN).map(|Unsent { sink, dead, .. }| {
        format!(
            "\n{sink}: these are the first {DEAD_SHOWN} of {dead}; `halfrow-station outbox release --sink {sink}` has all tried again"
        )
    });
    format!("{}\n\n{dead}{}", table_of(unsent), more.collect::<String>())
}

fn table_of(unsent: &[Unsent]) -> String {
    let row = |Unsent { sink, entries, dead, since_ms, said, .. }: &Unsent| {
        let said = said.as_ref().map_or_else(String::new, ToString::to_string);
        vec![sink.clone(), entries.to_string(), dead.to_string(), time(*since_ms), said]
    };
    table(&["sink", "unsent", "dead", "since", "said last"], &[1, 2], unsent.iter().map(row))
}

/// The settings name nothing that results are sent to.
#[derive(Debug, thiserror::Error)]
#[error("the settings name nobody to send to; write [plant] or a [[sink]]")]
pub(super) struct NoSink;

/// No entry of this number or sink waits for a person.
#[derive(Debug, thiserror::Error)]
#[error("nothing of {what} waits for a person; `halfrow-station outbox list` tells what does")]
pub(super) struct NotDead {
    pub(super) what: String,
}

/// The settings still name this sink, so results are still sent to it.
#[derive(Debug, thiserror::Error)]
#[error("the settings name the sink {sink}, so all would be sent to it again; take it out of them first")]
pub(super) struct SinkInUse {
    pub(super) sink: String,
}

/// The settings do not name this sink, nor does anything wait for it.
#[derive(Debug, thiserror::Error)]
#[error(
    "there is no sink {sink}; name `plant`, a [[sink]] of the settings, or to forget it one that `outbox list` names"
)]
pub(super) struct SinkUnknown {
    pub(super) sink: String,
}
