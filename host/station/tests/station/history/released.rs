//! A database of every schema that was released can be opened, and what is exported from it has the same bytes as ever. The
//! databases are in the folder `released`; its README.md says how they were made.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use halfrow_station::check::check;
use halfrow_station::history::Period;
use halfrow_station::history::yields::{By, Wanted, yields};
use halfrow_station::record::RunCause;
use halfrow_station::store::{Change, Folder, Store};
use rusqlite::Connection;
use tempfile::TempDir;

use super::commands::did;
use super::made::{BEGIN_MS, End, Made, Run};
use crate::common::{change, program, query, reason, untold};

/// Each format, and the name of its export.
const FORMATS: [(&str, &str); 4] =
    [("record", "record"), ("junit", "junit"), ("openhtf", "openhtf"), ("csv", "runs.csv")];

/// The hashes of all exports, as `sha256sum` prints them.
const SUMS: &str = "SHA256SUMS";

fn crate_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The text of a schema for SQLite, and its hash; none when no schema has this number.
fn schema(number: usize) -> Option<(String, String)> {
    let text = fs::read_to_string(crate_folder(&format!("sql/schema-{number}.sql"))).ok()?;
    let hash = halfrow::result::sha256([&text]);
    Some((for_sqlite(&text), hash))
}

fn for_sqlite(text: &str) -> String {
    text.replace("{int}", "INTEGER").replace("{real}", "REAL").replace("{strict}", " STRICT")
}

pub(super) fn newest() -> usize {
    (1..).take_while(|number| schema(*number).is_some()).count()
}

fn released(name: &str) -> PathBuf {
    crate_folder("tests/station/history/released").join(name)
}

/// The database of a program with this schema.
fn database_of(number: usize) -> PathBuf {
    released(&format!("schema-{number}.sql"))
}

/// The hashes of what is exported from each of them.
fn sums() -> String {
    fs::read_to_string(released(SUMS)).unwrap()
}

/// A station's folder as a program with this schema left it.
pub(super) fn left(number: usize) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(database_of(number)).unwrap();
    change(folder.path(), &text);
    copied(&released("blobs"), &folder.path().join("blobs"));
    folder
}

fn copied(from: &Path, to: &Path) {
    let did = Command::new("cp").arg("-r").arg(from).arg(to).status().unwrap();
    assert!(did.success());
}

/// The hashes of everything that is exported from this folder, as `sha256sum` prints them.
fn exported(data: &Path) -> String {
    let place = tempfile::tempdir().unwrap();
    for (format, to) in FORMATS {
        let to = place.path().join(to);
        let (code, said, complained) =
            did(&data, &["export", "--format", format, "--to", to.to_str().unwrap()]);
        assert_eq!(code, 0, "{said}{complained}");
    }
    let list = "find * -type f | LC_ALL=C sort | xargs sha256sum";
    let listed = Command::new("sh").args(["-c", list]).current_dir(place.path()).output().unwrap();
    String::from_utf8(listed.stdout).unwrap()
}

/// Asserts the figures of the history that each of them has, counted by hand: S1 failed and then passed, S2 passed, S3 passed
/// after a crash, S4 was too late, S5 only came to an error, and S6 is open.
fn is_true_of(data: &Path) {
    let folder = Folder::new(data);
    let checked = check(&folder, &mut untold).unwrap();
    assert!(checked.faults.is_empty(), "{:?}", checked.faults);
    assert_eq!((checked.runs, checked.open), (7, 1));
    let snapshot = halfrow_station::store::Snapshot::take(&folder).unwrap();
    let wanted = Wanted { period: Period::default(), ..Wanted::default() };
    let lines = yields(&snapshot, &wanted, By::Plan).unwrap().lines;
    let [line] = &lines[..] else { panic!("{lines:?}") };
    assert_eq!((line.first_pass.count, line.first_pass.of), (2, 4));
    assert_eq!((line.last.count, line.waived, line.flipped), (3, 0, 1));
    assert_eq!((line.errors.count, line.errors.of, line.crashes), (2, 7, 1));
    assert_eq!(query(data, "SELECT device FROM binding WHERE to_ms IS NULL"), ["00a1b2c3d4e5f607"]);
    assert_eq!(query(data, "SELECT reason FROM waiver"), ["it's \"as\" is"]);
}

fn every_schema(look: impl Fn(usize)) {
    let newest = newest();
    assert!(newest >= 2 && !database_of(newest + 1).exists());
    (1..=newest).for_each(look);
}

#[test]
fn a_database_of_every_released_schema_opens_and_exports_the_same_bytes() {
    every_schema(|number| {
        let data = left(number);
        let (code, _, complained) = did(&data, &["history"]);
        if number < newest() {
            assert_eq!(code, 3, "schema {number}");
            assert!(complained.contains("start the station on it once"), "{complained}");
        }
        drop(Store::open(&Folder::new(data.path())).unwrap());
        is_true_of(data.path());
        assert_eq!(exported(data.path()), sums(), "schema {number}");
        assert_eq!(copies(data.path()), before(number), "schema {number}");
    });
}

/// What is told of the upgrade of a database of this schema.
pub(super) fn upgraded(number: usize) -> String {
    let next = number + 1;
    if next > newest() {
        return String::new();
    }
    format!(
        " WARN station.db is upgraded, which takes a while if it is large\n WARN station.db has version {}; as it was, with \
         version {number}, it is in station.before-{next}.db\n",
        newest()
    )
}

/// The copy that is kept of a database with this schema.
pub(super) fn before(number: usize) -> Vec<String> {
    (number < newest()).then(|| format!("station.before-{}.db", number + 1)).into_iter().collect()
}

/// The copies of earlier databases in this folder, finished or not.
pub(super) fn copies(data: &Path) -> Vec<String> {
    let names = fs::read_dir(data).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.contains("before")).collect()
}

/// The database is of an earlier day, and the station of the folder has a number for its log.
#[test]
fn a_database_that_is_put_back_is_in_no_start_s_way_wherever_the_one_is_killed_that_brings_it_up_to_date() {
    let mut kills = 0;
    for number in 1.. {
        let data = left(1);
        fs::write(data.path().join("station.lock"), "12345678\n").unwrap();
        let inject = format!("inject=fsync,fdatasync:signal=KILL:when={number}");
        let mut strace = Command::new("strace");
        strace.args(["-f", "-qq", "-o", "/dev/null", "-e", &inject]).arg(program());
        let did = strace.args(["prune", "--operator", "weber", "--data"]).arg(data.path()).output().unwrap();
        if did.status.code().is_some() {
            assert!(did.status.success(), "{did:?}");
            break;
        }
        kills += 1;
        Store::open(&Folder::new(data.path())).unwrap_or_else(|error| panic!("{number}: {error}"));
        is_true_of(data.path());
    }
    assert!(kills > 5, "{kills}");
}

#[test]
fn a_backup_of_every_released_schema_is_restored_and_stays_as_it_is() {
    every_schema(|number| {
        let backup = left(number);
        let place = tempfile::tempdir().unwrap();
        let before = fs::read(backup.path().join("station.db")).unwrap();
        let new = place.path().join("new");
        let (code, said, complained) = did(&new, &["restore", backup.path().to_str().unwrap()]);
        assert_eq!((code, complained), (0, upgraded(number)), "schema {number}: {said}");
        assert!(said.starts_with("7 runs and "), "{said}");
        is_true_of(&new);
        assert_eq!(exported(&new), sums(), "schema {number}");
        assert_eq!(new.join("station.before-2.db").is_file(), number < 2);
        assert_eq!(fs::read(backup.path().join("station.db")).unwrap(), before, "the backup is as it was");
        assert_eq!(fs::read_dir(backup.path()).unwrap().count(), 2);
        // A station can work in it.
        let mut store = Store::open(&Folder::new(&new)).unwrap();
        assert_eq!(halfrow_station::run::recover(&mut store).unwrap().closed.len(), 1);
    });
}

/// Its database is brought up to date under a lock of its own, which must not replace the one that is held.
#[test]
fn a_backup_of_an_earlier_program_is_restored_into_a_folder_that_is_there() {
    let (backup, data) = (left(1), tempfile::tempdir().unwrap());
    let (code, said, complained) = did(&data, &["restore", backup.path().to_str().unwrap()]);
    assert_eq!((code, complained), (0, upgraded(1)), "{said}");
    assert_eq!(fs::read_to_string(data.path().join("station.lock")).unwrap(), "");
    let earlier = fs::metadata(data.path().join("station.before-2.db")).unwrap();
    assert_eq!(earlier.permissions().mode() & 0o777, 0o600);
    is_true_of(data.path());
    let (code, _, complained) = did(&data, &["prune", "--operator", "weber"]);
    assert_eq!((code, complained.as_str()), (0, ""));
}

#[test]
fn a_backup_of_a_newer_program_or_with_a_fault_is_refused_and_nothing_is_left() {
    let newer = "INSERT INTO schema_version (n, sha256, applied_ms) VALUES (99, 'x', 1)";
    let altered = "UPDATE run SET headline = 'all is well' WHERE verdict = 'FAIL' AND nth = 1";
    let edited = "UPDATE schema_version SET sha256 = 'x' WHERE n = 1";
    for (change, told) in [
        (newer, "use the halfrow-station that made it"),
        (altered, "`halfrow-station check` tells all"),
        (edited, "is not this program's; restore it from a copy"),
    ] {
        let backup = left(1);
        Connection::open(backup.path().join("station.db")).unwrap().execute_batch(change).unwrap();
        refused(&backup, told);
    }
    let backup = left(1);
    let record = query(backup.path(), "SELECT record_sha256 FROM run WHERE verdict = 'FAIL'").remove(0);
    fs::write(Folder::new(backup.path()).blobs().path(&record), "{}").unwrap();
    refused(&backup, "holds other bytes than its name says");
    fs::remove_file(Folder::new(backup.path()).blobs().path(&record)).unwrap();
    refused(&backup, &format!("{record} cannot be read"));
    let backup = left(1);
    fs::create_dir(backup.path().join("plans")).unwrap();
    std::os::unix::fs::symlink(backup.path(), backup.path().join("plans/evil")).unwrap();
    refused(&backup, "plans/evil is neither a file nor a folder");
}

/// A restore of `backup` is refused with these words, and leaves nothing behind.
fn refused(backup: &TempDir, told: &str) {
    let place = tempfile::tempdir().unwrap();
    let from = backup.path().to_str().unwrap();
    let (code, said, complained) = did(&place.path().join("new"), &["restore", from]);
    assert_eq!((code, said.as_str()), (3, ""), "{complained}");
    assert!(complained.contains(told) && complained.contains(from), "{complained}");
    assert!(!complained.contains(place.path().to_str().unwrap()), "it names what is no more: {complained}");
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
}

/// Makes the database of each schema that has none, if the environment asks for it. Existing ones are never made again.
#[test]
#[ignore = "for whoever adds a schema; see released/README.md"]
fn make_those_that_are_missing() {
    let missing: Vec<_> = (1..=newest()).filter(|number| !database_of(*number).exists()).collect();
    if missing.is_empty() {
        return;
    }
    assert!(std::env::var_os("HALFROW_STATION_RELEASE").is_some(), "no database for the schemas {missing:?}");
    let made = history();
    assert_eq!(exported(made.folder().path()), sums(), "another history than that of the other schemas");
    for number in missing {
        fs::write(database_of(number), database(number, &made)).unwrap();
    }
}

/// Writes the sums of all views anew, if the environment asks for it. Those of records never change.
#[test]
#[ignore = "for whoever adds to a view; see released/README.md"]
fn sum_the_views_anew() {
    if std::env::var("HALFROW_STATION_RELEASE").as_deref() != Ok("views") {
        return;
    }
    let records = |sums: &str| -> Vec<_> {
        sums.lines().filter(|line| line.contains("  record/")).map(str::to_owned).collect()
    };
    let data = left(newest());
    let anew = exported(data.path());
    assert_eq!(records(&anew), records(&sums()));
    assert_eq!(records(&anew).len(), 7);
    fs::write(released(SUMS), anew).unwrap();
}

/// One run of every kind, as the station enters them.
pub(crate) fn history() -> Made {
    let mut made = Made::new();
    let run = |serial, end, hour| Run::of(serial, end).at_hour(hour);
    let evidence = vec!["what it told", "what it logged"];
    let failed = made.run(&Run { evidence, ..run("S1", End::Fail(&["memory", "clock"]), 0) });
    made.run(&run("S1", End::Pass, 1));
    made.run(&Run { lane: "2".to_owned(), ..run("S2", End::Pass, 2) });
    made.run(&run("S3", End::Error(RunCause::Crash), 3));
    made.run(&Run { plan: ("final", "2"), ..run("S3", End::Pass, 24) });
    made.run(&Run { operator: "O'Neil, \"J\"\n<&>".to_owned(), ..run("S4", End::TooLate, 25) });
    made.run(&run("S5", End::Error(RunCause::Operator), 26));
    made.run(&run("S6", End::Open, 27));
    made.store.waive(&failed, "engel", &reason("it's \"as\" is")).unwrap();
    let change = Change {
        serial: "S2",
        product: None,
        device: Some("00a1b2c3d4e5f607"),
        operator: "engel",
        reason: &reason("a new FPGA"),
    };
    made.store.rebind(&change).unwrap();
    made
}

/// The history in a database of a program with this schema, as text: what the schema lacks is left out.
fn database(number: usize, of: &Made) -> String {
    let database = Connection::open_in_memory().unwrap();
    database.execute_batch("PRAGMA foreign_keys = OFF").unwrap();
    let version = fs::read_to_string(crate_folder("sql/schema-version.sql")).unwrap();
    database.execute_batch(&for_sqlite(&version)).unwrap();
    // Tables are filled after the schema that makes them, whose own rows come with it.
    let source = of.folder().database();
    database.execute("ATTACH $1 AS made", [source.to_str().unwrap()]).unwrap();
    for version in 1..=number {
        let (text, hash) = schema(version).unwrap();
        database.execute_batch(&text).unwrap();
        let note = "INSERT INTO main.schema_version (n, sha256, applied_ms) VALUES ($1, $2, $3)";
        database.execute(note, rusqlite::params![version as i64, hash, BEGIN_MS]).unwrap();
    }
    let mut text = "PRAGMA foreign_keys = OFF;\n".to_owned();
    for table in names(&database, "SELECT name FROM main.sqlite_master WHERE type = 'table' ORDER BY rowid") {
        let columns = names(&database, &format!("SELECT name FROM pragma_table_info('{table}', 'main')"));
        let names_of = columns.join(", ");
        if table != "schema_version" {
            let filled = format!("INSERT INTO main.{table} ({names_of}) SELECT {names_of} FROM made.{table}");
            database.execute_batch(&filled).unwrap();
        }
        text +=
            &names(&database, &format!("SELECT sql || ';' FROM main.sqlite_master WHERE name = '{table}'"))
                [0];
        text.push('\n');
        let values: Vec<_> = columns.iter().map(|column| format!("quote({column})")).collect();
        let row = format!("SELECT {} FROM main.{table} ORDER BY rowid", values.join(" || ', ' || "));
        for row in names(&database, &row) {
            text += &format!("INSERT INTO {table} ({names_of}) VALUES ({row});\n");
        }
    }
    let indexes =
        "SELECT sql || ';' FROM main.sqlite_master WHERE type = 'index' AND sql IS NOT NULL ORDER BY rowid";
    text + &names(&database, indexes).join("\n") + "\n"
}

pub(super) fn names(database: &Connection, text: &str) -> Vec<String> {
    let mut statement = database.prepare(text).unwrap();
    statement.query_map([], |row| row.get(0)).unwrap().map(Result::unwrap).collect()
}
