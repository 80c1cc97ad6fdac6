//! What all tests stand on: a plan, serial numbers, the program, and a look at what it kept.

use std::fs::{self, File};
use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use tempfile::TempDir;

/// A plan whose runs take a moment; `scripts` and `packages` read it as well.
pub(crate) const PLAN: &str = include_str!("quick.toml");

/// [`PLAN`] for a product whose serial numbers are `letters` before a number that guards itself as an ISBN-10 does.
pub(crate) fn guarded_plan(product: &str, letters: &str) -> String {
    let pattern = format!("^{letters}(?<number>[0-9]{{9}}[0-9X])$");
    PLAN.replace("CAM-T", product).replace("^CAT[0-9]{5}$", &pattern).replace("\"none\"", "\"mod11\"")
}

/// Milliseconds since 1970.
pub(crate) fn now_ms() -> i64 {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap();
    now.as_millis().try_into().unwrap()
}

/// A folder for a station, on a disk: where others keep temporary files may be memory.
pub(crate) fn folder() -> TempDir {
    tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap()
}

/// A program of this name in `folder`, which a shell carries out.
pub(crate) fn script(folder: &Path, name: &str, lines: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, format!("#!/bin/sh\n{lines}")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

/// How long somebody is waited for who must come: it ends hangs alone.
const HANG: Duration = Duration::from_secs(120);

/// The writing end of the FIFO at `path`, as soon as somebody reads there; they wait until it is dropped.
pub(crate) fn held_up(path: &Path) -> File {
    let begun = Instant::now();
    while !fs::metadata(path).is_ok_and(|found| found.file_type().is_fifo()) {
        assert!(begun.elapsed() < HANG, "{} is no FIFO", path.display());
        thread::sleep(Duration::from_millis(10));
    }
    let (sender, opened) = mpsc::channel();
    let fifo = path.to_owned();
    thread::spawn(move || sender.send(File::options().write(true).open(fifo)));
    opened.recv_timeout(HANG).unwrap().unwrap()
}

/// `[plant]` of a station whose results go to `url`, however full the disk is that the tests have.
pub(crate) fn plant_settings(url: &str) -> String {
    format!("[plant]\nurl = \"{url}\"\nmost_filled = 100\n")
}

/// Serial numbers whose check digits publishers computed: ISBNs of printed books, The C Programming Language and TeX:
/// The Program among them.
pub(crate) const SERIALS: [&str; 4] = ["CA0131103628", "CA0201134373", "CA080442957X", "CA0306406152"];

pub(crate) fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_halfrow-station"))
}

/// What the program did.
#[derive(Debug)]
pub(crate) struct Did {
    pub(crate) code: Option<i32>,
    pub(crate) said: String,
    pub(crate) complained: String,
}

impl From<Output> for Did {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code(), said: text(output.stdout), complained: text(output.stderr) }
    }
}

/// Has the database take nothing more into the audit.
pub(crate) const NO_AUDIT: &str =
    "CREATE TRIGGER full BEFORE INSERT ON audit BEGIN SELECT RAISE(FAIL, 'the disk is full'); END";

/// What `check` says of this folder.
pub(crate) fn check(data: &Path) -> Did {
    Command::new(program()).arg("check").arg("--data").arg(data).output().unwrap().into()
}

/// A look at the database of this folder that is not the program's: one value of each row.
pub(crate) fn query(data: &Path, text: &str) -> Vec<String> {
    let database = rusqlite::Connection::open(data.join("station.db")).unwrap();
    let mut statement = database.prepare(text).unwrap();
    let rows = statement.query_map([], |row| row.get::<_, rusqlite::types::Value>(0)).unwrap();
    let text = |value| match value {
        rusqlite::types::Value::Text(text) => text,
        rusqlite::types::Value::Integer(number) => number.to_string(),
        other => format!("{other:?}"),
    };
    rows.map(|row| text(row.unwrap())).collect()
}
