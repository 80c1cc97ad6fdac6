//! Several runs at the same time, and what killed ones leave behind.

use std::fs;
use std::io::Write as _;

use halfrow_tests::parallel;
use halfrow_tests::program::{Ended, Folder};

use crate::running::{opened_to_write, started, stopped_amid, streaming};
use crate::signals::LARGE;
use crate::small;

/// A run whose report and recording have the same names for every seed.
fn run(folder: &Folder, seed: usize, more: &[&str]) -> Ended {
    let seed = seed.to_string();
    let call = ["--seed", &seed, "--report", "out", "--record", "run.rec", "--json"];
    folder.halfrow(small("verify", &[&call, more].concat()))
}

/// The seed that the report names, in both views that name it.
fn reported_seed(folder: &Folder) -> u64 {
    let report = folder.json("out/report.json");
    let seed = report["run"]["seed"].as_u64().unwrap();
    assert!(folder.text("out/report.html").contains(&format!("--seed {seed}")));
    seed
}

/// Runs the seeds 1 to 6 at the same time.
fn six(folder: &Folder, more: &[&str]) -> Vec<Ended> {
    std::thread::scope(|scope| {
        let started: Vec<_> = (1..=6).map(|seed| scope.spawn(move || run(folder, seed, more))).collect();
        started.into_iter().map(|run| run.join().unwrap()).collect()
    })
}

#[test]
fn of_runs_with_one_name_one_wins_and_the_others_say_so() {
    for round in 0..5 {
        let folder = Folder::new();
        let ended = six(&folder, &[]);
        let codes: Vec<_> = ended.iter().map(|ended| ended.code).collect();
        let winner = codes.iter().position(|code| *code == Some(0)).unwrap();
        for (index, ended) in ended.iter().enumerate().filter(|(index, _)| *index != winner) {
            assert_eq!(ended.code, Some(2), "round {round}, run {index}: {codes:?} {}", ended.stderr);
            let says =
                ["another run is writing out", "out exists"].iter().any(|why| ended.stderr.contains(why));
            assert!(says, "{}", ended.stderr);
        }
        assert_eq!(reported_seed(&folder), winner as u64 + 1, "round {round}");
        assert_eq!(folder.names("."), ["out", "run.rec"], "round {round}");
        folder.halfrow(["verify", "--board", "replay:run.rec"]).succeeded();
    }
}

#[test]
fn of_runs_that_replace_one_another_the_last_is_whole() {
    for round in 0..3 {
        let folder = Folder::new();
        let ended = six(&folder, &["--overwrite"]);
        assert!(ended.iter().all(|ended| ended.code == Some(0)), "round {round}: {ended:?}");
        assert!((1..=6).contains(&reported_seed(&folder)));
        assert_eq!(folder.names("."), ["out", "run.rec"], "round {round}");
        assert_eq!(folder.names("out"), ["report.html", "report.json", "report.xml"]);
        folder.halfrow(["verify", "--board", "replay:run.rec"]).succeeded();
    }
}

#[test]
fn memory_images_that_replace_one_another_are_of_one_run() {
    let folder = Folder::new();
    let sets = [("nearest", "76"), ("linear", "85"), ("keys", "94"), ("hermite", "103")];
    let made = |(kernel, radius), name| {
        let call = ["--kernel", kernel, "--radius", radius, "-o", name, "--overwrite"];
        folder.halfrow(small("tables", &call)).succeeded();
    };
    let both = |name: &str| ["steps", "kernel"].map(|kind| folder.text(&format!("{name}.{kind}.mem")));
    let alone = sets.map(|set| {
        made(set, "alone.mem");
        both("alone")
    });
    for (place, set) in alone.iter().enumerate() {
        // Halves of two runs would else look like one run's.
        let differs = |other: &[String; 2]| other[0] != set[0] && other[1] != set[1];
        assert!(alone[place + 1..].iter().all(differs), "{:?}", sets[place]);
    }
    for _ in 0..5 {
        parallel::map(&sets, |set| made(*set, "t.mem"));
        assert!(alone.contains(&both("t")));
    }
}

#[test]
fn a_name_is_taken_before_the_board_is_opened() {
    for option in ["--report", "--record"] {
        let folder = Folder::new();
        let first = streaming(&folder, [option, "name"]);
        let second =
            folder.halfrow(small("verify", &[option, "name", "--board", "mock,fault=disconnect,byte=0"]));
        assert_eq!(second.code, Some(2), "{}", second.stderr);
        assert!(
            second.stderr.contains("another run is writing name; wait until it is done"),
            "{}",
            second.stderr
        );
        first.send("INT");
        assert_eq!(first.end().code, Some(130));
        assert_eq!(folder.names("."), ["name"]);
    }
}

#[test]
fn a_place_that_is_taken_during_the_run_is_left_alone() {
    let folder = Folder::new();
    let first = streaming(&folder, ["--report", "out", "--record", "run.rec"]);
    folder.write("run.rec", "precious");
    folder.write("run.rec.partial", "evidence of yesterday");
    fs::create_dir(folder.path().join("out")).unwrap();
    folder.write("out/notes", "somebody's own");
    first.send("INT");
    let ended = first.end();
    assert_eq!(ended.code, Some(130), "{}", ended.stderr);
    assert!(ended.stderr.contains("what there is of it is kept in run.rec.partial-2"), "{}", ended.stderr);
    assert!(ended.stderr.contains("the report could not be written: out exists"), "{}", ended.stderr);
    assert_eq!(folder.names("."), ["out", "run.rec", "run.rec.partial", "run.rec.partial-2"]);
    assert_eq!(
        (folder.text("run.rec"), folder.names("out")),
        ("precious".to_owned(), vec!["notes".to_owned()])
    );
    assert_eq!(folder.text("run.rec.partial"), "evidence of yesterday");
    assert!(folder.read("run.rec.partial-2").starts_with(b"halfrow recording 1\n"));
}

/// The names in the folder that the program gives to files in progress.
fn under_way(folder: &Folder) -> Vec<String> {
    folder.names(".").into_iter().filter(|name| name.starts_with(".halfrow-")).collect()
}

#[test]
fn what_killed_runs_left_is_cleared_and_what_running_ones_write_is_not() {
    let folder = Folder::new();
    drop(streaming(&folder, ["--report", "out", "--record", "run.rec"]));
    let dead = under_way(&folder);
    // Two claims, the report's folder, the recording.
    assert_eq!(dead.len(), 4, "{dead:?}");
    folder.write(".halfrow-notes", "somebody's own");
    // A running call clears what dead ones left, and nobody clears what it has.
    let alive = streaming(&folder, ["--report", "alive", "--record", "alive.rec"]);
    folder.halfrow(small("tables", &["-o", "t.json"])).succeeded();
    let left = under_way(&folder);
    assert!(dead.iter().all(|name| !left.contains(name)), "{left:?}");
    assert_eq!(left.len(), 5, "{left:?}");
    assert!(folder.read("run.rec.partial").starts_with(b"halfrow recording 1\n"));
    run(&folder, 1, &[]).succeeded();
    alive.send("INT");
    assert_eq!(alive.end().code, Some(130));
    let names = [".halfrow-notes", "alive", "alive.rec", "out", "run.rec", "run.rec.partial", "t.json"];
    assert_eq!(folder.names("."), names);
    assert_eq!(folder.names("alive").len(), 3);
}

#[test]
fn a_frame_that_a_killed_program_left_is_cleared() {
    let folder = Folder::new();
    let running = stopped_amid(&folder, &LARGE);
    drop(running);
    let half = |name: &&String| name.starts_with('.');
    assert!(folder.names("out").iter().any(|name| half(&name)));
    let call = small("correct", &["builtin:black", "--model", "-o", "out"]);
    folder.halfrow(call).succeeded();
    assert_eq!(folder.names("out").iter().filter(half).count(), 0);
}

/// The frame comes through a pipe, so the call waits for it.
#[test]
fn files_that_come_while_a_frame_is_corrected_are_left_alone() {
    let frame = [b"P5\n128 16\n4095\n".as_slice(), &[0; 2 * 128 * 16]].concat();
    for board in [&["--model"][..], &["--board", "mock"]] {
        for taken in ["out.pgm", "out.png"] {
            let folder = Folder::new();
            let pipe = folder.path().join("in.pgm");
            nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::from_bits_truncate(0o600)).unwrap();
            let more = [board, &["-o", "out.pgm", "--preview", "out.png"]].concat();
            let running = started(&folder, small("correct", &[&["in.pgm"], &more[..]].concat()));
            let mut pipe = opened_to_write(&pipe);
            folder.write(taken, "precious");
            // The reader may stop before the end.
            let _ = pipe.write_all(&frame);
            drop(pipe);
            let ended = running.end();
            let said = format!("{taken} exists; allow it to be overwritten");
            assert!(ended.stderr.contains(&said), "{board:?}: {}", ended.stderr);
            assert_ne!(ended.code, Some(0));
            assert_eq!(folder.text(taken), "precious", "{board:?}");
        }
    }
}

#[test]
fn files_that_come_while_others_are_written_are_left_alone() {
    let folder = Folder::new();
    let names = ["noise.pgm", "bars.pgm"];
    let call =
        ["frames", "--only", "noise", "--only", "bars", "--width", "2592", "--height", "2048", "-o", "out"];
    let running = stopped_amid(&folder, &call);
    let came: Vec<_> =
        names.into_iter().filter(|name| !folder.names("out").contains(&(*name).to_owned())).collect();
    came.iter().for_each(|name| folder.write(&format!("out/{name}"), "precious"));
    running.send("CONT");
    let ended = running.end();
    assert!(ended.stderr.contains("exists; allow it to be overwritten"), "{}", ended.stderr);
    assert_ne!(ended.code, Some(0));
    assert!(!came.is_empty() && came.iter().all(|name| folder.text(&format!("out/{name}")) == "precious"));
}
