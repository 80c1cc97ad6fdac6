use super::*;

/// Before every run, and every two seconds for a lane that waits for its plant, while no other lane can begin or save.
#[test]
fn no_question_of_a_run_takes_longer_the_more_was_ever_kept() {
    let folder = tempfile::tempdir().unwrap();
    let folder = Folder::new(folder.path());
    drop(Store::open(&folder).unwrap());
    let looks = |text: &str| {
        let explained = format!("EXPLAIN QUERY PLAN {text}");
        let plan = folder.read("a plan", |from| from.all(&explained, &[], |row| row.get::<String>(3)));
        let tables = ["run ", "audit "].map(|table| [format!("SCAN {table}"), format!("SEARCH {table}")]);
        let is_of_tables = |look: &String| tables.iter().flatten().any(|begin| look.starts_with(begin));
        plan.unwrap().into_iter().filter(is_of_tables).collect::<Vec<_>>()
    };
    // Only open runs are in the one index, and only changes of bindings in the other.
    assert_eq!(looks(statements::OPEN_RUNS), ["SCAN run USING INDEX run_open_unit"]);
    let newest =
        ["SEARCH run USING COVERING INDEX sqlite_autoindex_run_1", "SEARCH audit USING INDEX audit_rebind"];
    assert_eq!(looks(statements::NEWEST_ID), newest);
}

/// A restore that failed removes the folder that it made, with the lock, on which a start may wait. With the lock of a file that has
/// no name it would keep no other program out.
#[test]
fn the_lock_of_a_folder_is_of_the_file_that_is_there() {
    let place = tempfile::tempdir().unwrap();
    let folder = Folder::new(place.path());
    let path = folder.lock_file();
    let held = folder.lock().unwrap();
    let starts = {
        let folder = folder.clone();
        // A busy computer may let it wait for too long.
        std::thread::spawn(move || std::iter::repeat_with(|| folder.lock()).find_map(Result::ok).unwrap())
    };
    let opened = || {
        let all = std::fs::read_dir("/proc/self/fd").unwrap();
        all.flatten().filter(|file| std::fs::read_link(file.path()).is_ok_and(|to| to == path)).count()
    };
    while opened() < 2 {
        std::thread::yield_now();
    }
    std::fs::remove_file(&path).unwrap();
    drop(held);
    let lock = starts.join().unwrap();
    assert!(generation::is_named(&lock, &path));
    folder.lock().unwrap_err();
}
