//! What the station's commands share: their settings, the signals that end them, how one begins that keeps new results (the disk
//! is checked, the store is opened, and what was left open is closed), and how it ends (nothing is being sent any more, and the log
//! is in the database).

use std::mem;
use std::path::{self, Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use clap::Args;
use halfrow::verdict::StoppedBy;
use halfrow_program::signals::ending;
use signal_hook::flag;

use super::Failure;
use crate::console;
use crate::disk;
use crate::engine::Engine;
use crate::exit::Exit;
use crate::history::runs::RunLine;
use crate::history::unit::UnitRun;
use crate::labgrid::LaneBoard;
use crate::lane::supervisor::OWN_PROGRAM;
use crate::outbox::{self, Outbox, PlantSink, Sink};
use crate::plan::PlanName;
use crate::run::{self as runs, Recovered, Saved};
use crate::said::Saying;
use crate::settings::{PlanFile, PlantSettings, Settings};
use crate::store::{Folder, Introduction, LastTold, SharedStore, Store};

/// How often signals are checked for.
const LOOK: Duration = Duration::from_millis(100);

/// Which disks are taken for new results.
#[derive(Debug, Default, Args)]
pub(super) struct Disk {
    /// Take any disk for the station's folder, memory and networks too, although it may lose results
    #[arg(long, env = "HALFROW_STATION_ANY_DISK")]
    any_disk: bool,
}

impl Disk {
    /// Refuses a folder that may lose results.
    pub(super) fn takes(&self, folder: &Path) -> Result<(), Failure> {
        if self.any_disk { Ok(()) } else { disk::keeps(folder).map_err(Failure::call) }
    }

    /// The same, but taking any disk if what is kept there `goes` with the program.
    pub(super) fn unless(&self, goes: bool) -> Self {
        Self { any_disk: self.any_disk || goes }
    }

    /// Opens the store in `folder`, which is created if the disk is taken.
    pub(super) fn opens(&self, folder: &Path) -> Result<Store, Failure> {
        self.takes(folder)?;
        Ok(Store::open(&Folder::new(folder))?)
    }
}

/// Which settings the command is about, whatever it does with them.
#[derive(Debug, Args)]
pub(super) struct SettingsFile {
    /// The station's settings
    #[arg(
        long,
        global = true,
        value_name = "FILE",
        env = "HALFROW_STATION_SETTINGS",
        default_value = "station.toml"
    )]
    settings: PathBuf,
}

impl SettingsFile {
    /// Their absolute path.
    pub(super) fn path(&self) -> Result<PathBuf, Failure> {
        path::absolute(&self.settings).map_err(Failure::call)
    }

    /// Loads them.
    pub(super) fn load(&self) -> Result<Settings, Failure> {
        settings(&self.settings)
    }

    /// Loads them by [`load_without_lanes`].
    pub(super) fn load_without_lanes(&self) -> Result<Settings, Failure> {
        load_without_lanes(&self.settings)
    }
}

/// The settings in the file `path`.
pub(super) fn settings(path: &Path) -> Result<Settings, Failure> {
    let path = path::absolute(path).map_err(Failure::call)?;
    Ok(Settings::load(&path)?)
}

/// The settings in the file `path` for a command that needs no lanes: a plant has none, nor has a station that only
/// takes jobs.
pub(super) fn load_without_lanes(path: &Path) -> Result<Settings, Failure> {
    let path = path::absolute(path).map_err(Failure::call)?;
    Ok(Settings::load_without_lanes(&path)?)
}

/// Makes the station's folder if there is none, for a command that keeps something there beside the store.
pub(super) fn make_data(settings: &Settings) -> Result<(), Failure> {
    Folder::new(&settings.data).make().map_err(Failure::call)
}

/// `[plant]` of these settings.
pub(super) fn plant(settings: &Settings) -> Result<&PlantSettings, Failure> {
    settings.plant.as_ref().ok_or_else(|| Failure::call(NoPlant))
}

/// The settings do not name a plant.
#[derive(Debug, thiserror::Error)]
#[error("the settings name no plant; write url = \"postgres://station@db.example/plant\" into [plant]")]
pub(super) struct NoPlant;

/// The last signal received, which ends what is under way, by its exit code; 0 before the first one.
#[derive(Clone, Debug, Default)]
pub(super) struct Signal(Arc<AtomicUsize>);

impl Signal {
    /// Heeds the signals from now on.
    pub(super) fn heed() -> Result<Self, Failure> {
        let last = Arc::new(AtomicUsize::new(0));
        for (signal, exit) in ending() {
            flag::register_usize(signal, Arc::clone(&last), exit.code().into()).map_err(Failure::error)?;
        }
        Ok(Self(last))
    }

    /// Who wants the program to end, if anybody does.
    pub(super) fn by(&self) -> Option<StoppedBy> {
        Exit::stopped_by(self.0.load(Ordering::Relaxed))
    }

    /// Waits until somebody wants the program to end, and calls `meanwhile` ten times a second, whose error ends the wait, too.
    ///
    /// # Errors
    /// That of `meanwhile`.
    pub(super) fn wait<E>(&self, mut meanwhile: impl FnMut() -> Result<(), E>) -> Result<StoppedBy, E> {
        loop {
            if let Some(by) = self.by() {
                return Ok(by);
            }
            meanwhile()?;
            thread::sleep(LOOK);
        }
    }
}

/// A station that is ready to work: signals are heeded, and no other program has its store.
#[derive(Debug)]
pub(super) struct Ready<'a> {
    pub(super) settings: &'a Settings,
    pub(super) store: Store,
    pub(super) signal: Signal,
}

impl<'a> Ready<'a> {
    /// The station with these settings, if `disk` takes its folder.
    pub(super) fn of(settings: &'a Settings, disk: &Disk) -> Result<Self, Failure> {
        let signal = Signal::heed()?;
        let mut store = disk.opens(&settings.data)?;
        for PlanFile { plan, path } in &settings.plans {
            if store.other_of_version(plan)?.is_some() {
                let (of, version) = (PlanName::from(plan), &plan.version);
                console::diagnose(&format_args!(
                    "warning: {}: runs were judged here by another plan {of} {version}, and yields add up both; give this one a \
                     version of its own",
                    path.display()
                ));
            }
        }
        Ok(Self { store, settings, signal })
    }

    /// Starts the engine, with nothing left open.
    pub(super) fn start(mut self) -> Result<Engine, Failure> {
        let (_, stuck) = recovered(&mut self.store)?;
        let engine =
            Engine::start(self.settings.clone(), self.store, OWN_PROGRAM.into()).map_err(Failure::error)?;
        for (place, lane) in self.settings.lanes.iter().enumerate() {
            if stuck.iter().any(|run| may_have(run, &lane.name, &lane.board)) {
                engine.stuck(place);
            }
        }
        Ok(engine)
    }
}

/// What sends on what the station keeps. When it is dropped, it ends, and the log is folded into the database.
#[derive(Debug)]
pub(super) struct Sending {
    store: SharedStore,
    outbox: Outbox,
}

impl Sending {
    /// Begins to send what is in `store` to all sinks of these settings; `told` is what this program tells the plant of itself.
    pub(super) fn begin(settings: &Settings, store: SharedStore, told: &LastTold) -> Result<Self, Failure> {
        let sinks = store.with(|store| sinks(settings, store, told))?;
        Self::to(sinks, store)
    }

    /// Begins to send what is in `store` to these sinks.
    pub(super) fn to(sinks: Vec<Box<dyn Sink>>, store: SharedStore) -> Result<Self, Failure> {
        let outbox = Outbox::start(&store, sinks)?;
        Ok(Self { store, outbox })
    }

    /// Refuses to go on when something is not sent any more.
    pub(super) fn refuse_ended(&self) -> Result<(), Failure> {
        self.outbox.refuse_ended().map_err(Failure::error)
    }
}

impl Drop for Sending {
    fn drop(&mut self) {
        mem::take(&mut self.outbox).close();
        self.store.with(Store::fold_log);
    }
}

/// All sinks to which the station sends what it keeps.
pub(super) fn sinks(
    settings: &Settings,
    store: &mut Store,
    told: &LastTold,
) -> Result<Vec<Box<dyn Sink>>, Failure> {
    let mut sinks: Vec<Box<dyn Sink>> = Vec::new();
    if let Some(plant) = &settings.plant {
        let station = Introduction { told: told.clone(), ..settings.introduction(store.origin()?) };
        sinks.push(Box::new(PlantSink::new(plant.address()?, station, store.folder().clone())));
    }
    for sink in &settings.sinks {
        sinks.push(outbox::open(sink, &settings.name).map_err(Failure::call)?);
    }
    Ok(sinks)
}

/// Closes the runs that were under way when the station ended, prints them, and returns them; with them those whose lanes'
/// processes cannot be killed.
pub(super) fn recovered(store: &mut Store) -> Result<(Vec<Saved>, Vec<UnitRun>), Failure> {
    let Recovered { closed, unclosed, stuck } = runs::recover(store)?;
    for Saved { record, .. } in &closed {
        let (id, serial) = (&record.run.id, &record.run.serial);
        console::error(&format_args!("the run {id} of {serial} was found open, and is ERROR; test it again"));
    }
    if let Some(error) = unclosed {
        return Err(error.into());
    }
    let stuck = stuck?;
    for RunLine { id, lane, .. } in stuck.iter().map(|run| &run.line) {
        let why = Saying::Unkillable;
        console::error(&format_args!("the lane {lane} of the run {id} may still have its board: {why}"));
    }
    Ok((closed, stuck))
}

/// Whether the process of this run may have the board that is in this lane now. Either may have been renamed since.
pub(super) fn may_have(run: &UnitRun, lane: &str, board: &LaneBoard) -> bool {
    run.line.lane == lane || run.target == board.to_string()
}
