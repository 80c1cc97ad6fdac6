//! What the parts of the settings mean together.

use std::path::{Path, PathBuf};
use std::time::Duration;

use halfrow::Verdict;
use toml::Spanned;

use super::lender::Lender;
use super::plans::Plans;
use super::text::{AccessText, HookText, LaneText, OrderText, SettingsText, StartText, WebText, WorkText};
use super::{
    AccessSettings, Address, AddressError, Hook, LaneSettings, PlansOfPlant, PlantSettings, SCHEMA, Scanner,
    Settings, SinkSettings, WorkSettings,
};
use crate::floor::Starts;
use crate::input_error::{At, Fault, within};
use crate::labgrid::LaneBoard;
use crate::lane::{MEMORIES_MIB, MEMORY_MIB};
use crate::published::named_by;

/// What to do about a wrong key: where all keys are listed.
const KEYS: &str = "the table \"All settings\" of docs/station-lanes.md names every key";
/// How long a lane may be silent, in seconds.
const SILENCE: f64 = 60.0;
/// How long a hook may take, in seconds.
const DEADLINE: f64 = 10.0;
/// Where the pages are, unless the settings say otherwise.
const LISTEN: &str = "127.0.0.1:8612";
/// How long somebody may be idle and stay logged in, and the most that can be set.
const HOURS: f64 = 8.0;
const MOST_HOURS: f64 = 720.0;
/// The longest silence and the longest deadline.
const MOST_SECONDS: f64 = 86_400.0;
/// The most characters of a lane's name, which stands on a barcode and is read from afar.
const MOST_NAME: usize = 16;
/// What such a name consists of.
pub(crate) const LANE_NAME: &str = "1 to 16 letters, digits and hyphens, which a barcode has room for";
/// The most jobs that may be judged at once, each by a process of its own.
const MOST_AT_ONCE: u32 = 64;

/// The settings of `text` in the file `path`.
pub(super) fn settings(path: &Path, text: &str, has_lanes: bool) -> Result<Settings, Fault> {
    let read = read(text)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let station = &read.station;
    if has_lanes && read.lane.is_empty() {
        let remedy = "write a [[lane]] with name, board and plans";
        return Err(Fault::wrong(&read.schema, "the station has no lane", remedy));
    }
    let data = folder.join(not_empty(&station.data)?);
    let plant = read.plant.as_ref().map(|plant| PlantSettings::of(folder, plant)).transpose()?;
    let mut plans = Plans::beside(folder, &data, plant.as_ref());
    let lanes = lanes(folder, &read, &mut plans)?;
    let work = read.work.as_ref().map(|text| work(text, &mut plans)).transpose()?;
    Ok(Settings {
        name: not_empty(&station.name)?,
        data,
        silence: seconds(station.silence.as_ref(), SILENCE)?,
        memory_mib: station.memory.as_ref().map_or(Ok(MEMORY_MIB), memory)?,
        scan_then_plug: station.order == OrderText::ScanThenPlug,
        scanner: Scanner { prefix: read.scanner.prefix.clone(), suffix: read.scanner.suffix.clone() },
        plans: plans.all(),
        lanes,
        hooks: hooks(folder, &read)?,
        address: address(&read)?,
        access: read.access.as_ref().map(|access| people(folder, access)).transpose()?,
        plant,
        sinks: sinks(folder, &read)?,
        work,
    })
}

/// Which jobs are taken.
fn work(text: &WorkText, plans: &mut Plans<'_>) -> Result<WorkSettings, Fault> {
    if text.plans.get_ref().is_empty() {
        return Err(Fault::wrong(&text.plans, "no job can be taken without a plan", "name the file of one"));
    }
    let files = text.plans.get_ref().iter().map(|file| plans.take(file));
    let files = files.collect::<Result<_, _>>()?;
    if let Some(word) = text.has.iter().find(|word| !is_word(word.get_ref())) {
        let what = format!("`{}` is no word that a job could name", word.get_ref());
        return Err(Fault::wrong(word, what, "write one without blanks"));
    }
    let has = text.has.iter().map(|word| word.get_ref().clone()).collect();
    Ok(WorkSettings { plans: files, has, at_once: text.at_once.as_ref().map_or(Ok(1), at_once)? })
}

/// How many jobs are judged at once.
fn at_once(text: &Spanned<u32>) -> Result<u32, Fault> {
    let what = format!("{} jobs cannot be judged at once", text.get_ref());
    within(text, 1..=MOST_AT_ONCE, what, format!("give 1 to {MOST_AT_ONCE}"))
}

fn read(text: &str) -> Result<SettingsText, Fault> {
    let read: SettingsText = toml::from_str(text).map_err(|error| Fault::of_toml(&error, KEYS))?;
    if *read.schema.get_ref() != SCHEMA {
        let what = format!("this program reads settings of schema {SCHEMA}, not {}", read.schema.get_ref());
        let remedy = "take the halfrow-station that they were written for";
        return Err(Fault::wrong(&read.schema, what, remedy));
    }
    Ok(read)
}

/// The plans that the settings of `text` take from the plant, the station's folder, and where the plant is.
pub(super) fn plans_of_plant(path: &Path, text: &str) -> Result<PlansOfPlant, Fault> {
    let read = read(text)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let of_lanes = read.lane.iter().map(|lane| &lane.plans);
    let named = of_lanes.chain(read.work.iter().map(|work| &work.plans)).flat_map(Spanned::get_ref);
    let mut plans: Vec<_> = named.filter_map(|place| named_by(place.get_ref())).collect();
    plans.sort();
    plans.dedup();
    let plant = read.plant.as_ref().map(|plant| PlantSettings::of(folder, plant)).transpose()?;
    Ok(PlansOfPlant { data: folder.join(not_empty(&read.station.data)?), plant, plans })
}

/// Whether a job can name this among what it needs.
pub(crate) fn is_word(word: &str) -> bool {
    !word.is_empty() && !word.contains(|letter: char| letter.is_whitespace() || letter.is_control())
}

/// The other sinks that are sent results, each under a name of its own.
fn sinks(folder: &Path, read: &SettingsText) -> Result<Vec<SinkSettings>, Fault> {
    let mut sinks = Vec::<SinkSettings>::new();
    for text in &read.sink {
        let sink = SinkSettings::of(folder, text)?;
        if sinks.iter().any(|other| other.name == sink.name) {
            let what = format!("two sinks are called {}", sink.name);
            return Err(Fault::wrong(&text.name, what, "give each a name of its own"));
        }
        sinks.push(sink);
    }
    Ok(sinks)
}

/// Where the pages are. If others can reach them, people must log in.
fn address(read: &SettingsText) -> Result<Address, Fault> {
    let WebText { listen, public, hosts } = &read.web;
    let [of_listen, of_public] = [listen, public].map(|text| text.as_ref().map_or(0, At::at));
    let of_hosts = hosts.as_ref().map_or(0, At::at);
    let listen = listen.as_ref().map_or(LISTEN, |text| text.get_ref());
    let public = public.as_ref().map(|text| text.get_ref().as_str());
    let names = hosts.as_ref().map_or(&[][..], |hosts| hosts.get_ref());
    let address = Address::new(listen, public, names).map_err(|error| {
        let place = match error {
            AddressError::Listen(_) => of_listen,
            AddressError::Public(_) => of_public,
            AddressError::Host(_) => of_hosts,
        };
        Fault::input(place, "the address", error)
    })?;
    if !address.is_private() && read.access.is_none() {
        let is_open = |public| Address::new(listen, public, &[]).is_ok_and(|address| !address.is_private());
        let place = match hosts {
            _ if is_open(None) => of_listen,
            Some(_) if !is_open(public) => of_hosts,
            _ => of_public,
        };
        let what = "others can reach these pages, and nobody logs in";
        let remedy = "write [access] with users, or listen on 127.0.0.1 without `public` and `hosts`";
        return Err(Fault::wrong(place, what, remedy));
    }
    if address.is_nameless() {
        let what = format!(
            "of all that arrives at {listen} nothing would be answered: no name is known by which browsers ask"
        );
        return Err(Fault::wrong(of_listen, what, "write `hosts`, or `public` behind a proxy"));
    }
    Ok(address)
}

fn people(folder: &Path, text: &AccessText) -> Result<AccessSettings, Fault> {
    let hours = text.hours.as_ref().map_or(Ok(HOURS), |hours| {
        let what = format!("{} is no number of hours", hours.get_ref());
        within(hours, 0.01..=MOST_HOURS, what, format!("give 0.01 to {MOST_HOURS}"))
    })?;
    let idle = Duration::from_secs_f64(3600.0 * hours);
    let tokens = text.tokens.as_ref().map(not_empty).transpose()?.map(|file| folder.join(file));
    Ok(AccessSettings { users: folder.join(not_empty(&text.users)?), tokens, idle })
}

pub(super) fn not_empty(word: &Spanned<String>) -> Result<String, Fault> {
    match word.get_ref().trim() {
        "" => Err(Fault::wrong(word, "there is nothing here", "write a name")),
        word => Ok(word.to_owned()),
    }
}

/// The file or folder that is written so in settings in `folder`.
pub(super) fn file(folder: &Path, written: &Spanned<String>) -> Result<PathBuf, Fault> {
    Ok(folder.join(not_empty(written)?))
}

pub(super) fn seconds(text: Option<&Spanned<f64>>, default: f64) -> Result<Duration, Fault> {
    let Some(text) = text else { return Ok(Duration::from_secs_f64(default)) };
    let what = format!("{} s is no such time", text.get_ref());
    let remedy = format!("give 0.1 to {MOST_SECONDS} seconds");
    within(text, 0.1..=MOST_SECONDS, what, remedy).map(Duration::from_secs_f64)
}

fn memory(text: &Spanned<u64>) -> Result<u64, Fault> {
    let what = format!("{} MiB are no memory for a lane", text.get_ref());
    let remedy = format!("give {} to {} MiB", MEMORIES_MIB.start(), MEMORIES_MIB.end());
    within(text, MEMORIES_MIB, what, remedy)
}

fn lanes(folder: &Path, read: &SettingsText, plans: &mut Plans<'_>) -> Result<Vec<LaneSettings>, Fault> {
    let mut lanes = Vec::<LaneSettings>::new();
    let lender = Lender::of(folder, read)?;
    for text in &read.lane {
        let lane = lane(text, &lender, plans)?;
        if lanes.iter().any(|other| other.name == lane.name) {
            let what = format!("two lanes are called {}", lane.name);
            return Err(Fault::wrong(&text.name, what, "give each a name of its own"));
        }
        if let Some(other) = lanes.iter().find(|other| other.board.is_same(&lane.board)) {
            let (written, known) = (text.board.get_ref(), other.board.to_string());
            let called = if *written == known { String::new() } else { format!(", as `{known}`") };
            let what = format!("lane {} has the board `{written}` already{called}", other.name);
            return Err(Fault::wrong(&text.board, what, "give each lane a board of its own"));
        }
        lanes.push(lane);
    }
    Ok(lanes)
}

/// Whether a lane may have this name.
pub(crate) fn is_lane_name(name: &str) -> bool {
    is_name(name, MOST_NAME)
}

/// Whether this is a name of at most `most` characters.
pub(super) fn is_name(name: &str, most: usize) -> bool {
    (1..=most).contains(&name.len()) && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-')
}

fn lane(text: &LaneText, lender: &Lender, plans: &mut Plans<'_>) -> Result<LaneSettings, Fault> {
    let name = text.name.get_ref();
    if !is_lane_name(name) {
        let what = format!("`{name}` is no name for a lane");
        let remedy = format!("write {LANE_NAME}");
        return Err(Fault::wrong(&text.name, what, remedy));
    }
    let board = lender.board(text)?;
    if text.plans.get_ref().is_empty() {
        let what = format!("lane {name} has no plan");
        return Err(Fault::wrong(&text.plans, what, "name the file of one"));
    }
    let mut of_lane = Vec::new();
    for file in text.plans.get_ref() {
        let plan = plans.take(file)?;
        let earlier = of_lane.iter().position(|known| plans.are_same(*known, plan));
        let earlier = earlier.and_then(|at| text.plans.get_ref().get(at));
        if let Some(earlier) = earlier.map(Spanned::get_ref) {
            let first =
                if earlier == file.get_ref() { String::new() } else { format!(", first as {earlier}") };
            let what = format!("lane {name} has the plan {} twice{first}", file.get_ref());
            return Err(Fault::wrong(file, what, "leave one of them out"));
        }
        of_lane.push(plan);
    }
    let starts = starts(text, &board)?;
    Ok(LaneSettings { name: name.clone(), board, plans: of_lane, starts })
}

fn starts(text: &LaneText, board: &LaneBoard) -> Result<Starts, Fault> {
    let Some(start) = &text.start else { return Ok(Starts { scan: true, ..Starts::default() }) };
    let has = |kind| start.get_ref().contains(&kind);
    if start.get_ref().is_empty() {
        let remedy = "name scan, button or presence, or leave `start` out for scan";
        return Err(Fault::wrong(start, "nothing starts this lane", remedy));
    }
    let [scan, button, presence] = [StartText::Scan, StartText::Button, StartText::Presence].map(has);
    if !scan && !button && !board.is_pluggable() {
        let what = format!("nobody sees the board `{board}` being plugged in, so nothing starts this lane");
        return Err(Fault::wrong(start, what, "name scan or button"));
    }
    Ok(Starts { scan, button, presence })
}

fn hooks(folder: &Path, read: &SettingsText) -> Result<Vec<Hook>, Fault> {
    let kinds = [
        (Some(Verdict::Pass), &read.on_pass),
        (Some(Verdict::Fail), &read.on_fail),
        (Some(Verdict::Error), &read.on_error),
        (None, &read.on_clear),
    ];
    let all = kinds.into_iter().flat_map(|(on, texts)| texts.iter().map(move |text| hook(folder, on, text)));
    all.collect()
}

fn hook(folder: &Path, on: Option<Verdict>, text: &HookText) -> Result<Hook, Fault> {
    let written = not_empty(&text.program)?;
    let program = program(folder, &written);
    if written.contains('/') && !program.is_file() {
        let what = format!("there is no program {}", program.display());
        return Err(Fault::wrong(&text.program, what, "check its name; it is relative to this file"));
    }
    let known = Hook::words(on);
    for argument in &text.arguments {
        if let Some(word) = unknown_word(argument.get_ref(), known) {
            let what = format!("nothing is known that is called {{{word}}}");
            let known = known.iter().map(|word| format!("{{{word}}}")).collect::<Vec<_>>().join(", ");
            return Err(Fault::wrong(argument, what, format!("write one of {known}")));
        }
    }
    let arguments = text.arguments.iter().map(|argument| argument.get_ref().clone()).collect();
    Ok(Hook { on, program, arguments, deadline: seconds(text.deadline.as_ref(), DEADLINE)? })
}

/// The program that is written so in a file whose folder is `folder`. A name without a folder is searched for in `PATH`.
pub(super) fn program(folder: &Path, written: &str) -> PathBuf {
    if written.contains('/') { folder.join(written) } else { PathBuf::from(written) }
}

/// The first word in braces that stands for nothing.
fn unknown_word<'a>(argument: &'a str, known: &[&str]) -> Option<&'a str> {
    let words = argument.split('{').skip(1).filter_map(|piece| piece.split_once('}'));
    words.map(|(word, _)| word).find(|word| !known.contains(word))
}
