//! What all pages work with.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::{io, mem};

use axum::http::StatusCode;
use halfrow::words::plain;
use parking_lot::Mutex;
use tokio::task;

use super::access::Access;
use super::assets;
use super::live::Live;
use super::metrics::Turns;
use super::trouble::Trouble;
use super::visit::{User, Visit};
use crate::engine::Engine;
use crate::plan::Plan;
use crate::said::Said;
use crate::secret::SecretError;
use crate::settings::{PlanFile, Settings};
use crate::store::{Deed, PlantAddress, PlantLink, Snapshot, Store, StoreError};

/// How many plans are named in the head of a page.
const NAMED: usize = 2;

/// How long metrics do not count a plant again, as a multiple of the time that the last count took: a plant may have a year of
/// hundreds of stations.
const RESTS: u32 = 20;

/// The station as its pages know it. A clone is the same one.
#[derive(Clone, Debug)]
pub struct App(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    settings: Settings,
    access: Access,
    plans: String,
    /// By this an open page of the lanes finds out whether it still fits the station.
    mark: String,
    /// For clients that ask every few seconds.
    turns: Turns,
    source: Source,
    /// The code of why the audit took nothing when something was last to be entered.
    unaudited: Mutex<Option<String>>,
}

/// The source of what is shown.
#[derive(Debug)]
enum Source {
    Station(Lanes),
    Plant(PlantLink),
}

/// The lanes of a station, at work.
#[derive(Debug)]
pub(super) struct Lanes {
    pub(super) engine: Arc<Engine>,
    pub(super) live: Arc<Live>,
    /// What brings `live` the engine's news.
    listens: JoinHandle<()>,
    /// Serial numbers that a visitor of a demonstration may type.
    pub(super) hints: Vec<String>,
}

impl App {
    /// The station of these settings, with its engine at work, for those whom `access` lets in. `hints` are serial numbers
    /// that a visitor of a demonstration may type.
    ///
    /// # Errors
    /// When the system has no thread for its news.
    pub fn new(
        settings: Settings,
        engine: Arc<Engine>,
        access: Access,
        hints: Vec<String>,
    ) -> io::Result<Self> {
        let (live, listens) = Live::start(&engine)?;
        let (plans, mark) = (named(&settings), mark(&settings));
        let (source, turns) = (Source::Station(Lanes { engine, live, listens, hints }), Turns::new(true, 0));
        Ok(Self(Arc::new(Parts {
            settings,
            access,
            plans,
            mark,
            turns,
            source,
            unaudited: Mutex::default(),
        })))
    }

    /// The results of all stations of the plant at `address`.
    #[must_use]
    pub fn of_plant(settings: Settings, address: PlantAddress, access: Access) -> Self {
        let source = Source::Plant(PlantLink::new(address));
        let (plans, mark, turns) = (String::new(), String::new(), Turns::new(false, RESTS));
        Self(Arc::new(Parts { settings, access, plans, mark, turns, source, unaudited: Mutex::default() }))
    }

    /// Whether it shows the results of all stations.
    pub(super) fn is_plant(&self) -> bool {
        matches!(self.0.source, Source::Plant(_))
    }

    /// The lanes.
    ///
    /// # Errors
    /// [`Trouble`] when it has none: a plant.
    pub(super) fn lanes(&self, visit: &Visit) -> Result<&Lanes, Trouble> {
        match &self.0.source {
            Source::Station(lanes) => Ok(lanes),
            Source::Plant(_) => Err(Trouble::missing(visit)),
        }
    }

    /// Whether its lanes were told to end, and take nothing more.
    pub(super) fn is_ending(&self) -> bool {
        matches!(&self.0.source, Source::Station(lanes) if lanes.engine.is_ending())
    }

    /// Whether it hears no news of its lanes any more, so that no page is live.
    pub(super) fn is_deaf(&self) -> bool {
        matches!(&self.0.source, Source::Station(lanes) if lanes.listens.is_finished())
    }

    /// Its name.
    pub(super) fn station(&self) -> &str {
        &self.0.settings.name
    }

    /// Its plans, for the head of every page.
    pub(super) fn plans(&self) -> &str {
        &self.0.plans
    }

    /// What changes whenever a page of the lanes that was made before no longer fits the station.
    pub(super) fn mark(&self) -> &str {
        &self.0.mark
    }

    pub(super) fn settings(&self) -> &Settings {
        &self.0.settings
    }

    pub(super) fn access(&self) -> &Access {
        &self.0.access
    }

    pub(super) fn turns(&self) -> &Turns {
        &self.0.turns
    }

    /// The user of this cookie, as [`Access::user`] says. The file of users may be on a slow disk.
    ///
    /// # Errors
    /// [`Trouble`] when that broke off.
    pub(super) async fn user(
        &self,
        visit: &Visit,
        session: Option<String>,
        is_act: bool,
    ) -> Result<Result<Option<User>, SecretError>, Trouble> {
        let app = self.clone();
        self.blocking(visit, move || app.access().user(session.as_deref(), is_act)).await
    }

    /// Enters in the audit what the visitor is about to do. What cannot be entered is not done.
    ///
    /// # Errors
    /// [`Trouble`] when the store does not take it.
    pub(super) async fn audit(
        &self,
        visit: &Visit,
        act: &'static str,
        subject: &str,
        detail: &str,
    ) -> Result<(), Trouble> {
        let [operator, subject, detail] = [visit.name(), subject, detail].map(str::to_owned);
        let entered = match &self.0.source {
            Source::Station(_) => {
                let note = move |store: &mut Store| {
                    store.note(Deed { operator: &operator, act, subject: &subject, detail: &detail })
                };
                self.change(visit, note).await?
            }
            Source::Plant(plant) => {
                let plant = plant.clone();
                let note =
                    move || plant.note(Deed { operator: &operator, act, subject: &subject, detail: &detail });
                self.blocking(visit, note).await?
            }
        };
        self.log_audit(entered.as_ref().err().map(|error| Said::of(error)));
        entered.map_err(|error| {
            if let Ok(lanes) = self.lanes(visit) {
                lanes.engine.refused_by_store();
            }
            Trouble::telling(visit, StatusCode::SERVICE_UNAVAILABLE, &Said::of(&error))
        })
    }

    /// Logs once for each reason that the audit takes nothing, and once that it does again.
    // The end of it is a warning, too, so that a log of only warnings has both its beginning and its end.
    fn log_audit(&self, refused: Option<Said>) {
        let code = refused.as_ref().map(|said| said.code.clone());
        let before = mem::replace(&mut *self.0.unaudited.lock(), code.clone());
        match refused {
            Some(said) if before != code => tracing::error!("{}", said.with_codes()),
            None if before.is_some() => tracing::warn!("the audit takes entries again"),
            _ => {}
        }
    }

    /// What `look` finds in the store as it is at one moment. Other requests go on meanwhile.
    ///
    /// # Errors
    /// [`Trouble`] when the store cannot be read.
    pub(super) async fn look<T: Send + 'static>(
        &self,
        visit: &Visit,
        look: impl FnOnce(&Snapshot) -> Result<T, StoreError> + Send + 'static,
    ) -> Result<T, Trouble> {
        self.try_to_look(visit, look).await?.map_err(|error| Trouble::store(visit, &error))
    }

    /// The same, for a caller that can do without the result.
    ///
    /// # Errors
    /// [`Trouble`] when it broke off.
    pub(super) async fn try_to_look<T: Send + 'static>(
        &self,
        visit: &Visit,
        look: impl FnOnce(&Snapshot) -> Result<T, StoreError> + Send + 'static,
    ) -> Result<Result<T, StoreError>, Trouble> {
        match &self.0.source {
            Source::Station(lanes) => {
                let folder = lanes.engine.store().folder().clone();
                self.blocking(visit, move || Snapshot::at_work(&folder).and_then(|now| look(&now))).await
            }
            Source::Plant(plant) => {
                let plant = plant.clone();
                self.blocking(visit, move || plant.look(look)).await
            }
        }
    }

    /// Runs `change` on the store, and returns its result. Runs that end wait for it, so it must be brief.
    ///
    /// # Errors
    /// [`Trouble`] when it broke off.
    pub(super) async fn change<T: Send + 'static>(
        &self,
        visit: &Visit,
        change: impl FnOnce(&mut Store) -> T + Send + 'static,
    ) -> Result<T, Trouble> {
        let store = self.lanes(visit)?.engine.store();
        self.blocking(visit, move || store.with(change)).await
    }

    /// Runs `work`, which may wait for a disk or compute for long, on another thread, and returns its result.
    ///
    /// # Errors
    /// [`Trouble`] when it broke off.
    pub(super) async fn blocking<T: Send + 'static>(
        &self,
        visit: &Visit,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Trouble> {
        task::spawn_blocking(work).await.map_err(|error| Trouble::broken(visit, &error))
    }
}

/// The plans by product, name and version; of many only the first two, and how many more there are.
fn named(settings: &Settings) -> String {
    let name = |file: &PlanFile| {
        let Plan { product, name, version, .. } = &file.plan;
        plain(&format!("{product} {name} {version}")).into_owned()
    };
    let (first, more) = settings.plans.split_at(settings.plans.len().min(NAMED));
    let names = first.iter().map(name).collect::<Vec<_>>().join(", ");
    if more.is_empty() { names } else { format!("{names} + {}", more.len()) }
}

/// The hash of all that a page of the lanes shows, except their states, or that makes it: program, station, plans, lanes,
/// scripts.
fn mark(settings: &Settings) -> String {
    let plant = if settings.plant.is_some() { "plant" } else { "" };
    let mut parts = vec![halfrow::VERSION, &settings.name, plant];
    parts.extend(settings.plans.iter().map(|file| file.plan.sha256.as_str()));
    parts.extend(settings.lanes.iter().map(|lane| lane.name.as_str()));
    assets::texts().for_each(|text| parts.push(text));
    // No name has a line break in it.
    halfrow::result::sha256(parts.into_iter().flat_map(|part| [part, "\n"]))
}
