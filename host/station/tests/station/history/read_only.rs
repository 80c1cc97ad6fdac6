//! A station's folder that may only be read: another user's, or on a disk that became read-only after an error.

use std::fs::{self, Permissions};
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use nix::unistd::geteuid;

use super::made::{End, Made, Run};
use super::put_back::killed;
use crate::common::{Did, PLAN, folder, program, query};

/// A folder to which nobody may write until this is dropped, except for root.
struct ReadOnly<'a>(&'a Path);

impl<'a> ReadOnly<'a> {
    fn new(folder: &'a Path) -> Self {
        fs::set_permissions(folder, Permissions::from_mode(0o555)).unwrap();
        Self(folder)
    }

    /// What this call does as a user who is not root, or has given up what root may.
    fn call(&self, program: &Path, arguments: &[&str]) -> Did {
        as_others(program).args(arguments).arg(self.0).output().unwrap().into()
    }

    fn history(&self) -> Did {
        self.call(program(), &["history", "--data"])
    }
}

impl Drop for ReadOnly<'_> {
    fn drop(&mut self) {
        // What cannot be removed then stays.
        let _ = fs::set_permissions(self.0, Permissions::from_mode(0o755));
    }
}

/// This program for a user who is not root, or has given up what root may.
fn as_others(program: &Path) -> Command {
    if !geteuid().is_root() {
        return Command::new(program);
    }
    let mut call = Command::new("setpriv");
    call.args([
        "--bounding-set=-dac_override,-dac_read_search",
        "--inh-caps=-dac_override,-dac_read_search",
        "--",
    ]);
    call.arg(program);
    call
}

/// The name of the folder has letters that mean something in a URI.
#[test]
fn a_folder_that_may_only_be_read_is_read_with_the_log_that_a_kill_left_and_without_one() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    let (left, place) = (killed(&made), folder());
    let ended = place.path().join("a? b#%20&c");
    let kept = made.closed();
    fs::rename(kept.path(), &ended).unwrap();
    for (data, has_log) in [(ended.as_path(), false), (left.path(), true)] {
        assert_eq!(data.join("station.db-wal").exists(), has_log);
        let data = ReadOnly::new(data);
        // The control.
        assert_eq!(data.call("sh".as_ref(), &["-c", "touch \"$0/new\""]).code, Some(1));
        let history = data.history();
        assert!(history.code == Some(0) && history.said.contains("S1"), "{history:?}");
        let check = data.call(program(), &["check", "--data"]);
        assert!(check.code == Some(0) && check.said.contains("1 run and "), "{check:?}");
    }
}

/// SQLite reads the log by an index that it cannot make there.
#[test]
fn a_log_that_cannot_be_read_in_its_folder_is_not_passed_over() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    let left = killed(&made);
    fs::remove_file(left.path().join("station.db-shm")).unwrap();
    let data = ReadOnly::new(left.path());
    let history = data.history();
    assert_eq!(history.code, Some(3), "{history:?}");
    assert!(history.complained.contains("; copy the folder, and name the copy"), "{history:?}");
    // The control, which is what the sentence asks for.
    let copy = killed(&made);
    fs::remove_file(copy.path().join("station.db-shm")).unwrap();
    let history =
        Did::from(Command::new(program()).args(["history", "--data"]).arg(copy.path()).output().unwrap());
    assert!(history.code == Some(0) && history.said.contains("S1"), "{history:?}");
}

/// The folder `path`, or a link to one, which another user than the tests' has made. Only root can give a folder away; anybody else
/// has one of root's.
fn of_other_user(path: &Path) -> PathBuf {
    if geteuid().is_root() {
        fs::create_dir(path).unwrap();
        assert!(Command::new("chown").arg("nobody").arg(path).status().unwrap().success());
    } else {
        symlink("/", path).unwrap();
    }
    path.to_owned()
}

/// What `program` says, in one line.
fn line_of(program: &str, arguments: &[&str], path: Option<&Path>) -> String {
    let said = Did::from(Command::new(program).args(arguments).args(path).output().unwrap()).said;
    said.trim_end().to_owned()
}

/// A run's record is saved in one of 256 folders, so one of them that root made would otherwise be met by one run in 256.
#[test]
fn a_folder_with_something_that_another_user_made_is_refused_at_once_and_its_owner_named() {
    let place = folder();
    let plan = place.path().join("plan.toml");
    fs::write(&plan, PLAN).unwrap();
    let run = |data: &Path| {
        let mut run = as_others(program());
        run.args(["run", "--any-disk", "--board", "mock", "--serial", "CAT00001", "--plan"]).arg(&plan);
        Did::from(run.arg("--data").arg(data).output().unwrap())
    };
    let ours = place.path().join("ours");
    let others = of_other_user(&place.path().join("others"));
    fs::create_dir_all(ours.join("blobs")).unwrap();
    let among = of_other_user(&ours.join("blobs/ab"));
    let me = line_of("id", &["-un"], None);
    for (data, path) in [(&others, &others), (&ours, &among)] {
        let did = run(data);
        let owner = line_of("stat", &["-L", "-c", "%U"], Some(path));
        let belongs = format!("{} belongs to {owner}, and {me}, ", path.display());
        assert!(did.code == Some(3) && did.complained.contains(&belongs), "{did:?}");
        let remedy = format!("as root: chown -R USER: {}: ", data.display());
        assert!(did.complained.contains(&remedy), "{did:?}");
        assert!(did.complained.contains("store-of-other-user"), "{did:?}");
    }
    assert_eq!(fs::read_dir(&ours).unwrap().count(), 1, "no run was begun");
    // The control.
    fs::rename(&among, place.path().join("aside")).unwrap();
    assert_eq!(run(&ours).code, Some(0));
}

/// Evidence that only another user may read need not be wrong, and hides neither what is nor the other runs.
#[test]
fn what_may_not_be_read_is_told_with_all_the_rest() {
    let mut made = Made::new();
    let ends = [("1", End::Pass), ("2", End::Fail(&["memory"])), ("3", End::Pass)];
    let runs = ends.map(|(lane, end)| made.run(&Run { lane: lane.to_owned(), ..Run::of(lane, end) }));
    let records = query(made.as_ref(), "SELECT record_sha256 FROM run ORDER BY lane");
    let unnamed = made.folder().blobs().put(b"nobody's").unwrap();
    let path = |hash: &str| made.folder().blobs().path(hash);
    for hash in [&records[0], &unnamed] {
        fs::set_permissions(path(hash), Permissions::from_mode(0o000)).unwrap();
    }
    fs::write(path(&records[1]), "damaged").unwrap();
    let check =
        Did::from(as_others(program()).args(["check", "--data"]).arg(made.as_ref()).output().unwrap());
    let faults: Vec<_> = check.said.lines().filter(|line| line.starts_with("fault: ")).collect();
    let of_file = |hash: &str| faults.iter().find(|line| line.contains(&path(hash).display().to_string()));
    for hash in [&records[0], &unnamed] {
        let told = of_file(hash).unwrap_or_else(|| panic!("{check:?}"));
        assert!(told.contains("this user may not read") && !told.contains("copy"), "{told}");
    }
    assert!(check.code == Some(3) && of_file(&records[1]).is_some(), "{check:?}");
    let place = folder();
    let to = place.path().join("out");
    let mut export = as_others(program());
    export.args(["export", "--to"]).arg(&to).arg("--data").arg(made.as_ref());
    let export = Did::from(export.output().unwrap());
    assert!(export.code == Some(3) && export.said.starts_with("1 run is in "), "{export:?}");
    assert_eq!([0, 1, 2].map(|place| export.complained.contains(&runs[place])), [true, true, false]);
    assert!(to.join(format!("{}.json", runs[2])).is_file());
}
