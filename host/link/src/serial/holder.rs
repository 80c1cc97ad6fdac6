//! Who has a device open.

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

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (process {})", self.program, self.process)
    }
}

/// By whom a device is held, as an error says it.
pub(crate) fn by(holders: &[Holder]) -> String {
    if holders.is_empty() {
        return "another program".to_owned();
    }
    let names: Vec<_> = holders.iter().map(ToString::to_string).collect();
    names.join(" and ")
}

/// Other processes that have `device` open, as far as this user may know: root sees all, others their own.
#[must_use]
pub fn holders(device: &Path) -> Vec<Holder> {
    let Ok(device) = fs::canonicalize(device) else { return Vec::new() };
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    processes
        .filter_map(|entry| {
            let process: u32 = entry.file_name().to_str()?.parse().ok()?;
            let open = fs::read_dir(entry.path().join("fd")).ok()?;
            let holds = process != std::process::id()
                && open.flatten().any(|fd| fs::read_link(fd.path()).is_ok_and(|target| target == device));
            let name = fs::read_to_string(entry.path().join("comm"));
            holds.then(|| Holder { process, program: name.unwrap_or_default().trim().to_owned() })
        })
        .collect()
}
