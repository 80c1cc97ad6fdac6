//! Who does something, and why. The audit keeps both, and under which account it was called.

use std::{env, fs};

use clap::Args;
use halfrow::words::plain;
use nix::unistd::{Uid, User, getuid};

use crate::store::{By, Deed, Folder, Plant, PlantAddress, Reason, Store, StoreError};

/// What the audit calls a command that somebody gives to do something.
const ACT: &str = "command";

/// Who, and why.
#[derive(Debug, Args)]
pub(super) struct Why {
    /// Why, in 500 characters at most
    #[arg(long, value_parser = Reason::of)]
    pub(super) reason: Reason,
    /// Your name, which the audit keeps
    #[arg(long, value_name = "NAME", value_parser = person)]
    pub(super) operator: String,
}

impl Why {
    pub(super) fn by(&self) -> By<'_> {
        By { operator: &self.operator, reason: &self.reason }
    }
}

/// The name of the person who acts. None is taken from the environment: `sudo -u halfrow` sets USER to a service's account.
pub(super) fn person(text: &str) -> Result<String, String> {
    some(text, "say who you are")
}

/// The name of something, which blanks are not.
pub(super) fn name(text: &str) -> Result<String, String> {
    some(text, "write a name")
}

/// The text without blanks around it, or what is asked for in its place.
fn some(text: &str, asked: &str) -> Result<String, String> {
    let text = text.trim();
    if text.is_empty() { Err(asked.to_owned()) } else { Ok(text.to_owned()) }
}

/// Opens the store in `folder`, and enters in its audit first that `operator` gives the command `given`, and by which account. Any
/// name can be written after `--operator`.
pub(super) fn at_station(folder: &Folder, operator: &str, given: &str) -> Result<Store, StoreError> {
    let mut store = Store::open_existing(folder)?;
    store.note(Deed { operator, act: ACT, subject: given, detail: &account() })?;
    Ok(store)
}

/// Enters it in the audit of the plant.
pub(super) fn entered_at(plant: &mut Plant, operator: &str, given: &str) -> Result<(), StoreError> {
    plant.note(Deed { operator, act: ACT, subject: given, detail: &account() })
}

/// Connects to the plant at `address`, and enters it there first.
pub(super) fn at_plant(address: &PlantAddress, operator: &str, given: &str) -> Result<Plant, StoreError> {
    let mut plant = Plant::connect(address)?;
    entered_at(&mut plant, operator, given)?;
    Ok(plant)
}

/// Whose process this is: by the real user id, by the login that it came from, and as `sudo` says. The last is only what the
/// environment has.
fn account() -> String {
    let login = fs::read_to_string("/proc/self/loginuid").ok();
    let login = login.and_then(|text| text.trim().parse().ok()).filter(|uid| *uid != u32::MAX);
    let login = login.map(|uid| format!(", login {}", named(Uid::from_raw(uid))));
    let sudo = env::var_os("SUDO_USER").map(|name| format!(", SUDO_USER {}", plain(&name.to_string_lossy())));
    format!("{}{}{}", named(getuid()), login.unwrap_or_default(), sudo.unwrap_or_default())
}

/// A user's id and name.
fn named(uid: Uid) -> String {
    match User::from_uid(uid) {
        Ok(Some(user)) => format!("uid {uid} ({})", plain(&user.name)),
        _ => format!("uid {uid}"),
    }
}
