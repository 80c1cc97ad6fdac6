//! Lanes whose processes outlived their station, and cannot be killed.

use std::fs;
use std::path::Path;
use std::process::{Child, Command};

use halfrow_station::store::Folder;

use super::bench::PLAN;
use crate::common::{change, query, stat, until};
use crate::history::commands::did;
use crate::history::made::{End, Made, Run};
use crate::history::served::Served;

/// A process that no kill of its group reaches: it stays in this test's group.
pub(crate) struct Outlived(Child);

impl Outlived {
    /// Enters an open run in the lane `lane` of `made`, and begins its process.
    pub(crate) fn of(made: &mut Made, lane: &str) -> Self {
        Self::by(made, lane, Command::new("sleep").arg("600"))
    }

    fn by(made: &mut Made, lane: &str, command: &mut Command) -> Self {
        let run = Run { lane: lane.to_owned(), ..Run::of("CAT00001", End::Open) };
        let spool = made.folder().spool(&made.begin(&run).0.id);
        fs::create_dir(&spool).unwrap();
        let outlived = Self(command.spawn().unwrap());
        let began = &stat(outlived.0.id())[19];
        fs::write(spool.join("lane.pid"), format!("{} {began}\n", outlived.0.id())).unwrap();
        outlived
    }
}

impl Drop for Outlived {
    fn drop(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

/// What `run` does with the mock in the lane `lane` of the station in `data`: the exit code and stderr.
fn run(data: &impl AsRef<Path>, lane: &str) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("plan.toml");
    fs::write(&plan, PLAN).unwrap();
    let plan = plan.display().to_string();
    let (code, _, complained) =
        did(data, &["run", "--plan", &plan, "--serial", "CAT00002", "--board", "mock", "--lane", lane]);
    (code, complained)
}

fn is_out(made: Made) {
    let served = Served::of(made);
    // The pages may come before the engine has taken the lane out.
    until("the lane is out", || {
        let page = served.page("/");
        page.contains("lane out") && page.contains("its process cannot be killed")
    });
}

/// As in uninterruptible sleep: it may still have the board, beside which another run would judge the same board.
#[test]
fn the_lane_of_a_process_that_outlived_its_station_and_cannot_be_killed_is_out() {
    let mut made = Made::new();
    let _outlived = Outlived::of(&mut made, "1");
    is_out(made);
}

/// The kernel ends threads one by one: the first may have ended while another waits for the board's chip.
#[test]
fn a_process_has_not_ended_with_its_first_thread() {
    let thread = "import ctypes, threading, time
threading.Thread(target=time.sleep, args=[600]).start()
ctypes.CDLL(None).pthread_exit(None)";
    let mut made = Made::new();
    let outlived = Outlived::by(&mut made, "1", Command::new("python3").args(["-c", thread]));
    until("the end of the first thread", || stat(outlived.0.id())[0] == "Z");
    is_out(made);
}

/// The settings of the next start may call the lane something else.
#[test]
fn the_board_of_a_process_that_outlived_its_station_is_out_in_whichever_lane_it_is() {
    let mut made = Made::new();
    let _outlived = Outlived::of(&mut made, "another");
    made.change("UPDATE run SET target = 'mock'");
    is_out(made);
}

#[test]
fn no_start_judges_beside_a_process_until_it_has_ended() {
    let mut made = Made::new();
    let _outlived = Outlived::of(&mut made, "1");
    let data = made.closed();
    for found in ["first", "second"] {
        let (code, complained) = run(&data, "1");
        assert!(code == 3 && complained.contains("cannot be killed"), "{found}: {code} {complained}");
    }
    // Which lane and board are meant is not only in the record.
    let record = query(data.path(), "SELECT record_sha256 FROM run").concat();
    fs::write(Folder::new(data.path()).blobs().path(&record), "half of it").unwrap();
    let (code, complained) = run(&data, "2");
    assert_eq!(code, 0, "another board in another lane: {complained}");
    is_out(Made::at(data));
}

#[test]
fn a_lane_is_as_before_once_its_process_has_ended() {
    let mut made = Made::new();
    let outlived = Outlived::of(&mut made, "1");
    let data = made.closed();
    assert_eq!(run(&data, "1").0, 3);
    drop(outlived);
    let (code, complained) = run(&data, "1");
    assert_eq!(code, 0, "{complained}");
    assert_eq!(fs::read_dir(data.path().join("spool")).unwrap().count(), 0);
}

/// As where an earlier copy of the database was put back: nobody knows which lane the process has, and nothing may begin.
#[test]
fn a_run_that_was_closed_is_told_though_the_process_of_another_is_in_no_lane_that_is_known() {
    let mut made = Made::new();
    let outlived = Outlived::of(&mut made, "1");
    let spools = made.folder().spools();
    let spool = fs::read_dir(&spools).unwrap().next().unwrap().unwrap().path();
    let unknown = spools.join("0".repeat(36));
    fs::create_dir(&unknown).unwrap();
    fs::copy(spool.join("lane.pid"), unknown.join("lane.pid")).unwrap();
    let (code, complained) = run(&made.closed(), "2");
    assert_eq!(code, 3, "{complained}");
    assert!(complained.contains("of CAT00001 was found open, and is ERROR"), "{complained}");
    let place = format!("{} is of a run that station.db does not have", unknown.display());
    assert!(complained.contains(&place), "{complained}");
    assert!(complained.contains(&format!("end the process {}", outlived.0.id())), "{complained}");
    assert!(!complained.contains("the board not touched"), "no run was to begin yet: {complained}");
}

/// Another run keeps the station from starting, and this one is told and not forgotten.
#[test]
fn a_run_that_was_closed_is_told_though_another_cannot_be_closed() {
    let mut made = Made::new();
    let _outlived = Outlived::of(&mut made, "1");
    made.begin(&Run { lane: "2".to_owned(), ..Run::of("CAT00002", End::Open) });
    let refuses = "CREATE TRIGGER refuses BEFORE UPDATE ON run WHEN OLD.lane = '2'
        BEGIN SELECT RAISE(ABORT, 'not this one'); END";
    made.change(refuses);
    let data = made.closed();
    let (code, complained) = run(&data, "3");
    assert_eq!(code, 3, "{complained}");
    assert!(complained.contains("of CAT00001 was found open, and is ERROR"), "{complained}");
    assert!(complained.contains("not this one"), "{complained}");
    change(data.path(), "DROP TRIGGER refuses");
    is_out(Made::at(data));
}
