//! The results of a long campaign, kept in a file so that it can go on from there.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::Write as _;
use std::path::Path;
use std::sync::Mutex;

use halfrow::verdict::Verdict;
use serde_json::{Value, json};

use super::Came;

/// Results of runs by their number.
#[derive(Debug, Default)]
pub struct SavedResults {
    known: BTreeMap<usize, (Came, String)>,
    file: Option<Mutex<File>>,
}

impl SavedResults {
    /// Keeps nothing.
    #[must_use]
    pub fn nothing() -> Self {
        Self::default()
    }

    /// What this very build of the program has found in the campaign of `seed` under `name`, in the target folder.
    ///
    /// # Panics
    /// If the file cannot be used.
    #[must_use]
    pub fn of_campaign(name: &str, seed: u64) -> Self {
        let program = std::env::current_exe().unwrap();
        let mut fingerprint = DefaultHasher::new();
        fs::read(&program).unwrap().hash(&mut fingerprint);
        // target/PROFILE/deps/TEST
        let folder = program.ancestors().nth(3).unwrap().join("poor-links");
        Self::in_file(&folder.join(format!("{name}-{seed}-{:016x}.jsonl", fingerprint.finish())))
    }

    /// The results in the file at `path`, which is created if need be.
    ///
    /// # Panics
    /// If the file cannot be used.
    #[must_use]
    pub fn in_file(path: &Path) -> Self {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        // The last line may have been cut off.
        let text = fs::read_to_string(path).unwrap_or_default();
        let known = text.lines().filter_map(read).collect();
        let mut file = File::options().append(true).create(true).open(path).unwrap();
        if !text.is_empty() && !text.ends_with('\n') {
            writeln!(file).unwrap();
        }
        Self { known, file: Some(Mutex::new(file)) }
    }

    /// How many results are known.
    #[must_use]
    pub fn len(&self) -> usize {
        self.known.len()
    }

    /// Whether none is known.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.known.is_empty()
    }

    pub(super) fn of(&self, index: usize) -> Option<(Came, String)> {
        self.known.get(&index).cloned()
    }

    /// Keeps the result of a run. One that did not end is not kept: it shall be tried again, since the computer may have been
    /// busy.
    pub(super) fn keep(&self, index: usize, (came, headline): &(Came, String)) {
        let (Some(file), Came::To(verdict)) = (&self.file, came) else { return };
        let line = json!({ "index": index, "came": verdict.to_string(), "headline": headline });
        writeln!(file.lock().unwrap(), "{line}").unwrap();
    }
}

fn read(line: &str) -> Option<(usize, (Came, String))> {
    let value: Value = serde_json::from_str(line).ok()?;
    let came = match value["came"].as_str()? {
        "PASS" => Came::To(Verdict::Pass),
        "FAIL" => Came::To(Verdict::Fail),
        "ERROR" => Came::To(Verdict::Error),
        _ => return None,
    };
    let index = usize::try_from(value["index"].as_u64()?).ok()?;
    Some((index, (came, value["headline"].as_str()?.to_owned())))
}
