//! A station in its own folder, and calls of its program.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use halfrow_station::record::Record;
use halfrow_station::store::{Folder, Stored};
use serde_json::Value;
use tempfile::TempDir;

use crate::common;

pub(crate) use crate::common::{Did, PLAN, program};

/// A station.
pub(crate) struct Station {
    folder: TempDir,
}

impl Station {
    /// A station with this plan.
    pub(crate) fn with(plan: &str) -> Self {
        let station = Self { folder: common::folder() };
        station.plan(plan);
        station
    }

    /// Replaces the plan.
    pub(crate) fn plan(&self, plan: &str) {
        fs::write(self.path("plan.toml"), plan).unwrap();
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn data(&self) -> PathBuf {
        self.path("data")
    }

    pub(crate) fn store(&self) -> Folder {
        Folder::new(&self.data())
    }

    /// The arguments of a run.
    pub(crate) fn run_arguments(&self, serial: &str, board: &str) -> Vec<String> {
        let path = |path: PathBuf| path.display().to_string();
        let (plan, data) = (path(self.path("plan.toml")), path(self.data()));
        ["run", "--plan", &plan, "--data", &data, "--serial", serial, "--board", board, "--operator", "weber"]
            .map(str::to_owned)
            .to_vec()
    }

    pub(crate) fn run(&self, serial: &str, board: &str) -> Did {
        Command::new(program()).args(self.run_arguments(serial, board)).output().unwrap().into()
    }

    /// Starts a run, with its streams piped.
    pub(crate) fn begin(&self, serial: &str, board: &str, more: &[&str]) -> Child {
        let mut run = Command::new(program());
        run.args(self.run_arguments(serial, board)).args(more);
        run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }

    pub(crate) fn check(&self) -> Did {
        common::check(&self.data())
    }

    /// Changes the database without the program; returns how many rows the last statement changed.
    pub(crate) fn change(&self, text: &str) -> usize {
        common::change(&self.data(), text)
    }

    /// Reads the database without the program: the first value of each row.
    pub(crate) fn query(&self, text: &str) -> Vec<String> {
        common::query(&self.data(), text)
    }

    /// The run whose id the program printed.
    pub(crate) fn saved(&self, did: &Did) -> (Stored, Record, Value) {
        let line = did.said.lines().find_map(|line| line.strip_prefix("run       ")).unwrap();
        let stored = self.store().verdict_of(&line[..36]).unwrap().unwrap();
        let bytes = fs::read(self.store().blobs().path(&stored.record_sha256)).unwrap();
        let record = Record::parse(&bytes).unwrap();
        (stored, record, serde_json::from_slice(&bytes).unwrap())
    }
}

/// The `sha256sum` of a file.
pub(crate) fn sha256sum(path: &Path) -> String {
    let output = Command::new("sha256sum").arg(path).output().unwrap();
    String::from_utf8(output.stdout).unwrap()[..64].to_owned()
}
