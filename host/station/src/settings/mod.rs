//! The settings of a station: its name, its folder, its lanes, its scanner, its hooks.

mod address;
mod lender;
mod plans;
mod plant;
mod read;
mod sink;
mod stable;
mod text;

use std::path::{Path, PathBuf};
use std::time::Duration;

use halfrow::Verdict;

pub use address::{Address, AddressError};
pub(crate) use plant::PASSWORD_OF_PLANT;
pub use plant::{PlantSettings, PlantSettingsError};
pub(crate) use read::{LANE_NAME, is_lane_name, is_word};
pub use sink::{Destination, Login, SinkAddress, SinkSettings};
pub(crate) use stable::moving;

use crate::floor::{Floor, Place, Rule, Starts};
use crate::input_error::{Fault, InputError, text_of};
use crate::labgrid::LaneBoard;
use crate::plan::{Plan, PlanName};
use crate::published::PublicKey;
use crate::store::{Introduction, LastTold, SINK_OF_PLANT};

/// The version of the settings' own format.
pub const SCHEMA: u32 = 1;

/// A station's settings, checked against each other and against what they name.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Its name.
    pub name: String,
    /// Its folder.
    pub data: PathBuf,
    /// How long a lane may be silent.
    pub silence: Duration,
    /// How much memory a lane may have, in MiB of addresses.
    pub memory_mib: u64,
    /// Whether a serial number that is scanned first goes to the next board that is plugged in.
    pub scan_then_plug: bool,
    /// What the scanner adds before and after every label.
    pub scanner: Scanner,
    /// Every plan that a lane or `[work]` names.
    pub plans: Vec<PlanFile>,
    /// The lanes: at least one, unless the settings were loaded by [`Self::load_without_lanes`].
    pub lanes: Vec<LaneSettings>,
    /// What is started when a verdict is saved, or no longer shown.
    pub hooks: Vec<Hook>,
    /// Where the pages are.
    pub address: Address,
    /// Who may act on them; without it, everybody at the computer itself.
    pub access: Option<AccessSettings>,
    /// The plant that results are sent on to.
    pub plant: Option<PlantSettings>,
    /// The other sinks that are sent results.
    pub sinks: Vec<SinkSettings>,
    /// Which jobs of the plant it takes.
    pub work: Option<WorkSettings>,
}

/// `[access]`
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AccessSettings {
    /// The file of those who may act.
    pub users: PathBuf,
    /// The file of machines that may read.
    pub tokens: Option<PathBuf>,
    /// How long somebody may be idle and stay logged in.
    pub idle: Duration,
}

/// The plans that settings take from the plant, whether they were fetched or not.
#[derive(Clone, Debug)]
pub struct PlansOfPlant {
    /// The station's folder.
    pub data: PathBuf,
    /// Where the plant is.
    pub plant: Option<PlantSettings>,
    /// The plans of the plant by which lanes or jobs are judged, each once.
    pub plans: Vec<PlanName>,
}

impl PlansOfPlant {
    /// The keys of those whose plans are taken.
    #[must_use]
    pub fn trusts(&self) -> &[PublicKey] {
        self.plant.as_ref().map_or(&[], |plant| &plant.trusts)
    }
}

/// `[work]`
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorkSettings {
    /// Its plans, as indexes into [`Settings::plans`].
    pub plans: Vec<usize>,
    /// What it has that jobs may need.
    pub has: Vec<String>,
    /// How many jobs it judges at once.
    pub at_once: u32,
}

/// A plan with its file.
#[derive(Clone, Debug)]
pub struct PlanFile {
    /// The file.
    pub path: PathBuf,
    /// The plan.
    pub plan: Plan,
}

/// A `[[lane]]`.
#[derive(Clone, Debug)]
pub struct LaneSettings {
    /// Its name.
    pub name: String,
    /// Its board, by a name that stays.
    pub board: LaneBoard,
    /// Its plans, as indexes into [`Settings::plans`].
    pub plans: Vec<usize>,
    /// How its runs are started.
    pub starts: Starts,
}

/// What the scanner adds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scanner {
    /// Before the label.
    pub prefix: String,
    /// After the label.
    pub suffix: String,
}

impl Scanner {
    /// The label in what was scanned; none if the scanner did not add what it always adds.
    #[must_use]
    pub fn label<'a>(&self, scanned: &'a str) -> Option<&'a str> {
        scanned.strip_prefix(self.prefix.as_str())?.strip_suffix(self.suffix.as_str())
    }
}

/// A program that is started when a verdict of its kind is saved, or when a lane shows none any more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hook {
    /// The verdict; `None` when the lane shows none any more.
    pub on: Option<Verdict>,
    /// The program.
    pub program: PathBuf,
    /// Its arguments, in which [`WORDS`] in braces are replaced.
    pub arguments: Vec<String>,
    /// How long it may take.
    pub deadline: Duration,
}

/// The words that an argument of a hook may have in braces.
pub const WORDS: [&str; 6] = ["lane", "serial", "verdict", "run", "record", "headline"];

impl Hook {
    /// Those of [`WORDS`] that mean something to a hook on this.
    pub(crate) const fn words(on: Option<Verdict>) -> &'static [&'static str] {
        match on {
            Some(_) => &WORDS,
            None => &["lane"],
        }
    }
}

impl Settings {
    /// The settings in the file `path`, whose own paths are relative to it.
    ///
    /// # Errors
    /// [`InputError`], with the line.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        Self::load_for(path, true)
    }

    /// The same for commands that need no lanes, such as those about a plant.
    ///
    /// # Errors
    /// Like [`Self::load`].
    pub fn load_without_lanes(path: &Path) -> Result<Self, InputError> {
        Self::load_for(path, false)
    }

    /// The plans that the settings in the file `path` take from the plant. No plan is read.
    ///
    /// # Errors
    /// Like [`Self::load`].
    pub fn plans_of_plant(path: &Path) -> Result<PlansOfPlant, InputError> {
        understood(path, |text| read::plans_of_plant(path, text))
    }

    fn load_for(path: &Path, has_lanes: bool) -> Result<Self, InputError> {
        understood(path, |text| read::settings(path, text, has_lanes))
    }

    /// The plans of a lane.
    pub(crate) fn plans_of(&self, lane: &LaneSettings) -> impl Iterator<Item = &PlanFile> {
        lane.plans.iter().filter_map(|&plan| self.plans.get(plan))
    }

    /// Whether a verdict is shown only when the plant has it.
    pub(crate) fn is_green_at_plant(&self) -> bool {
        self.plant.as_ref().is_some_and(|plant| plant.is_green_at_plant)
    }

    /// The names of all sinks, the plant included.
    pub(crate) fn sink_names(&self) -> impl Iterator<Item = &str> {
        self.plant.iter().map(|_| SINK_OF_PLANT).chain(self.sinks.iter().map(|sink| sink.name.as_str()))
    }

    /// What a station whose folder has the id `origin` tells the plant of itself.
    #[must_use]
    pub fn introduction(&self, origin: String) -> Introduction {
        let plan =
            |PlanFile { plan, .. }: &PlanFile| format!("{} {} {}", plan.product, plan.name, plan.version);
        let plans = self.plans.iter().map(plan).collect::<Vec<_>>().join("\n");
        let program = halfrow::VERSION.to_owned();
        let (name, told) = (self.name.clone(), LastTold::default());
        Introduction { name, origin, program, plans, unsent: 0, dead: 0, told }
    }

    /// The lanes as they are before any board comes.
    #[must_use]
    pub fn floor(&self) -> Floor {
        let place = |lane: &LaneSettings| Place {
            name: lane.name.clone(),
            starts: lane.starts,
            plans: lane.plans.clone(),
        };
        let rule = |PlanFile { plan, .. }: &PlanFile| Rule {
            product: plan.product.clone(),
            serial: plan.serial.clone(),
        };
        let places = self.lanes.iter().map(place).collect();
        Floor::new(places, self.plans.iter().map(rule).collect(), self.scan_then_plug)
    }
}

/// What `read` makes of the text of the file `path`.
fn understood<T>(path: &Path, read: impl FnOnce(&str) -> Result<T, Fault>) -> Result<T, InputError> {
    let text = text_of(path)?;
    read(&text).map_err(|fault| fault.in_file(path, &text))
}
