//! `--board pool:KIND`: a board that several computers share, leased by the program next to this one.

use std::process::Command;

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::{Folder, Running, command, finish};

/// A folder with a copy of the program, and next to it a script that leases boards.
fn leased_by(script: &str) -> Folder {
    let folder = Folder::new();
    folder.write("lease", script);
    let text = "cp \"$1\" halfrow; cp lease halfrow-station; chmod +x halfrow-station";
    let mut shell = Command::new("sh");
    shell.current_dir(folder.path()).args(["-ec", text, "sh"]).arg(command([]).get_program());
    finish(&mut shell).succeeded();
    folder
}

fn verify(folder: &Folder, board: &str) -> Command {
    let mut call = Command::new(folder.path().join("halfrow"));
    let small = ["--width", "64", "--height", "8", "--radius", "10"];
    call.current_dir(folder.path()).args(["verify", "--quiet", "--board", board]).args(small);
    call
}

/// Where a report goes that may replace an earlier one.
const INTO: [&str; 3] = ["--report", "out", "--overwrite"];

/// A script that leases a board, and records when it is given back.
const LEASES: &str = r#"#!/bin/sh
echo "$@" > called
echo '{"waits":{"before":2,"seconds":0}}'
echo '{"waits":{"before":2,"seconds":1}}'
echo '{"waits":{"before":0,"seconds":2}}'
echo '{"held":{"board":"shelf-1","target":"BOARD","holder":"x","fence":7}}'
cat > /dev/null
echo back > back
"#;

#[test]
fn a_board_of_a_kind_is_waited_for_and_given_back() {
    let folder = leased_by(&LEASES.replace("BOARD", "mock"));
    let ended = finish(&mut verify(&folder, "pool:ulx3s")).succeeded();
    assert_eq!(folder.text("called"), "board hold -- ulx3s\n");
    let said: Vec<_> = ended.stderr.lines().collect();
    let expected = [
        "waiting for a board of the kind ulx3s: 2 in front, 0 s",
        "waiting for a board of the kind ulx3s: the next one is ours, 2 s",
        "the board shelf-1 is ours, at mock",
    ];
    assert_eq!(said, expected);
    wait_until("the board to be given back", || folder.names(".").contains(&"back".to_owned()));
}

#[test]
fn a_call_that_is_wrong_or_only_lists_waits_for_no_board() {
    let folder = leased_by(&LEASES.replace("BOARD", "mock"));
    folder.write("frame.pgm", format!("P5 64 2 255\n{}", "x".repeat(128)));
    let call = |command: &str, more: &[&str]| {
        let mut call = Command::new(folder.path().join("halfrow"));
        call.current_dir(folder.path()).args([command, "--quiet", "--board", "pool:ulx3s"]).args(more);
        finish(&mut call)
    };
    for (command, wrong) in [
        ("verify", &["--frame", "nowhere.pgm"][..]),
        ("verify", &["--lens", "nowhere.yml"]),
        ("verify", &["--reconnect=-1"]),
        ("verify", &["--timeout", "0"]),
        ("verify", &["--report", "lease"]),
        ("correct", &["frame.pgm", "--width", "64", "--height", "2", "-o", "out.pgm", "--timeout", "0"]),
        ("info", &["--timeout", "0"]),
        ("link", &["--timeout", "0"]),
        ("soak", &["--frames", "3", "--reconnect=-1"]),
        ("soak", &["--frames", "3", "--report", "lease"]),
    ] {
        let ended = call(command, wrong);
        assert_eq!(ended.code, Some(2), "{command} {wrong:?}: {ended:?}");
    }
    let listed = call("verify", &["--list"]);
    assert!(listed.code == Some(0) && listed.stdout.contains("FIFO, 5 MB/s"), "{listed:?}");
    assert!(!folder.path().join("called").exists());
}

#[test]
fn a_run_that_is_killed_gives_its_board_back_and_one_whose_board_is_lost_ends() {
    let folder = leased_by(&LEASES.replace("BOARD", crate::running::SLOW));
    let mut running = Running::start(&mut verify(&folder, "pool:ulx3s"));
    running.wait_for("shelf-1 is ours");
    running.send("KILL");
    let _ = running.end();
    wait_until("the board to be given back", || folder.names(".").contains(&"back".to_owned()));
    let lost = r#"echo '{"lost":{"board":"shelf-1","said":"somebody has it"}}'"#;
    for (told, said) in [
        (lost, "error: somebody has it"),
        (&lost.replace("lost", "held"), "which is no message; install the one"),
        (r"printf '\377\n'", "the output of halfrow-station cannot be read; install the one"),
        ("", "which held the board, has ended"),
    ] {
        let script = LEASES.replace("BOARD", crate::running::SLOW);
        let folder = leased_by(&script.replace("cat > /dev/null", &format!("sleep 1\n{told}")));
        let ended = finish(&mut verify(&folder, "pool:ulx3s"));
        assert_eq!(ended.code, Some(130), "{ended:?}");
        assert!(ended.stderr.contains(said), "{ended:?}");
    }
}

#[test]
fn without_a_board_nothing_is_judged_and_it_is_said_why() {
    let nothing = "#!/bin/sh\necho 'error: the plant is away' >&2\nexit 3\n";
    let cases = [
        (nothing, "pool:ulx3s", 3, "no board of the kind ulx3s is available"),
        ("#!/bin/sh\necho hello\n", "pool:ulx3s", 3, "says `hello`, which is no message"),
        (nothing, "pool:", 2, "write pool:KIND"),
        (nothing, "pool", 2, "write pool:KIND"),
    ];
    for (script, board, code, said) in cases {
        let folder = leased_by(script);
        let ended = finish(&mut verify(&folder, board));
        assert!(ended.code == Some(code) && ended.stderr.contains(said), "{board}: {ended:?}");
    }
    let folder = leased_by(nothing);
    finish(verify(&folder, "mock").args(INTO)).succeeded();
    for extra in [&[][..], &["--within", "1"]] {
        let ended = finish(verify(&folder, "pool:ulx3s").args(INTO).args(extra));
        assert_eq!(ended.code, Some(3), "{ended:?}");
        let report = folder.json("out/report.json");
        assert_eq!(
            (&report["verdict"], &report["error"]["code"]),
            (&"ERROR".into(), &"pool-without-board".into())
        );
        assert_eq!(report["board"]["target"], "pool:ulx3s");
    }
    std::fs::remove_file(folder.path().join("halfrow-station")).unwrap();
    let ended = finish(&mut verify(&folder, "pool:ulx3s"));
    assert!(
        ended.code == Some(3) && ended.stderr.contains("cargo build --release --package halfrow-station"),
        "{ended:?}"
    );
}
