//! The processes that have a device open.

use std::fmt;
use std::fs;
use std::path::Path;

/// A process that has the device open.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Holder {
    /// Its id.
    pub process: u32,
    /// Its program's name.
    pub program: String,
}

impl Holder {
    /// Whether it is this process.
    fn is_own(&self) -> bool {
        self.process == std::process::id()
    }
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (process {})", self.program, self.process)
    }
}

/// Who holds a device, in the words of an error, and what to do.
pub(crate) fn by(holders: &[Holder]) -> String {
    match holders {
        [] => "another program; close that program, then run again".to_owned(),
        [own] if own.is_own() => {
            format!("{own}, which is this very program; wait until its other run is over, then run again")
        }
        others => {
            let names: Vec<_> = others.iter().map(ToString::to_string).collect();
            format!("{}; close that program, then run again", names.join(" and "))
        }
    }
}

/// Other processes that have `device` open, as far as this user may see: root sees all, others their own.
#[must_use]
pub fn holders(device: &Path) -> Vec<Holder> {
    let mut all = all_holders(device);
    all.retain(|holder| !holder.is_own());
    all
}

/// The processes that keep `device` from this call: those of [`holders`], or this process if only it is known to have the device
/// open.
pub(crate) fn keepers(device: &Path) -> Vec<Holder> {
    let (own, others): (Vec<_>, Vec<_>) = all_holders(device).into_iter().partition(Holder::is_own);
    if others.is_empty() { own } else { others }
}

fn all_holders(device: &Path) -> Vec<Holder> {
    let Ok(device) = fs::canonicalize(device) else { return Vec::new() };
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    processes
        .filter_map(|entry| {
            let process: u32 = entry.file_name().to_str()?.parse().ok()?;
            let open = fs::read_dir(entry.path().join("fd")).ok()?;
            let holds =
                open.flatten().any(|fd| fs::read_link(fd.path()).is_ok_and(|target| target == device));
            let name = fs::read_to_string(entry.path().join("comm"));
            holds.then(|| Holder { process, program: name.unwrap_or_default().trim().to_owned() })
        })
        .collect()
}
