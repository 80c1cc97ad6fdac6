//! Options that another one leaves without effect: refused on the command line, ignored from elsewhere.

use halfrow_tests::program::{Folder, finish};

use crate::{refused, small};

/// A folder with a recording of two frames of 128 x 16.
fn recorded() -> Folder {
    let folder = Folder::new();
    let frames = ["--frame", "builtin:bars", "--frame", "builtin:grey", "--record", "run.rec"];
    folder.halfrow(small("verify", &frames)).succeeded();
    folder
}

const REPLAY: [&str; 3] = ["verify", "--board", "replay:run.rec"];

#[test]
fn a_recording_takes_no_option_that_it_decides_itself() {
    let folder = recorded();
    for option in [
        ["--frame", "nowhere.pgm"],
        ["--tables", "other.json"],
        ["--kernel", "keys"],
        ["--seed", "7"],
        ["--repeat", "3"],
        ["--bits", "8"],
        ["--phase", "rggb"],
        ["--width", "128"],
        ["--height", "74"],
        ["--radius", "100"],
        ["--lens", "README.md"],
        ["--rows", "fitted"],
        ["--focal-length", "2"],
        ["--pixel-pitch", "3"],
        ["--field-of-view", "170"],
        ["--centre-x", "5"],
        ["--centre-y", "5"],
        ["--raw", "u8"],
        ["--retry-limit", "50"],
        ["--reconnect=5", "--fail-fast"],
        ["--fail-fast", "--json"],
        ["--take-over", "-q"],
        ["--within", "5"],
    ] {
        let call: Vec<_> = REPLAY.into_iter().chain(option).collect();
        let name = if option[0] == "--reconnect=5" { "--fail-fast" } else { option[0] };
        let ended = folder.halfrow(call);
        assert_eq!(ended.code, Some(2), "{option:?}: {}{}", ended.stdout, ended.stderr);
        let sentence = format!("{name} does nothing beside a recording");
        assert!(ended.stderr.contains(&sentence), "{option:?}: {}", ended.stderr);
    }
    let call: Vec<_> = REPLAY.into_iter().chain(["--lens", "x.yml", "--lens-pitch", "3"]).collect();
    refused(&folder, &call, "does nothing beside a recording");
    let stands = ["--report", "out", "--record", "again.rec", "--overwrite", "--timeout", "600"];
    folder.halfrow(REPLAY.into_iter().chain(stands)).succeeded();
}

#[test]
fn what_a_station_always_says_is_passed_over_beside_a_recording() {
    let folder = recorded();
    folder.write(
        "settings.toml",
        "seed = 9\nkernel = 'keys'\nframe = ['nowhere.pgm']\ntables = 'nowhere.json'\n",
    );
    let call = |verbose: &'static [&'static str]| {
        let call = verbose.iter().copied().chain(REPLAY).chain(["--settings", "settings.toml"]);
        finish(folder.command(call).env("HALFROW_RETRY_LIMIT", "1"))
    };
    let quiet = call(&["-q"]);
    assert_eq!((quiet.code, quiet.stderr.as_str()), (Some(0), ""), "{}", quiet.stdout);
    let said = call(&["-v"]).stderr;
    for option in ["--seed of the settings", "--kernel of the settings", "--frame of the settings"] {
        assert!(said.contains(&format!("{option} is passed over")), "{said}");
    }
    assert!(said.contains("--retry-limit of the environment is passed over"), "{said}");
}

/// A recording is of one link. But a station's patience for its boards does not prevent a recording.
#[test]
fn a_recording_that_is_made_waits_for_no_board() {
    let folder = Folder::new();
    let call = |more: &[&'static str]| {
        small("verify", &[&["--frame", "builtin:grey", "--record", "run.rec"], more].concat())
    };
    refused(
        &folder,
        &call(&["--reconnect=5"]),
        "--reconnect does nothing beside a recording to make (--record)",
    );
    folder.write("settings.toml", "reconnect = 5\n");
    folder.halfrow(call(&["--settings", "settings.toml"])).succeeded();
    finish(folder.command(call(&["--overwrite"])).env("HALFROW_RECONNECT", "5")).succeeded();
}

#[test]
fn the_list_of_a_recording_is_what_it_holds() {
    let folder = recorded();
    let listed = folder.halfrow(REPLAY.into_iter().chain(["--list"])).succeeded();
    let named: Vec<_> = listed.stdout.lines().filter_map(|line| line.split_whitespace().nth(1)).collect();
    let noise = "builtin:noise";
    assert_eq!(named, [noise, noise, "builtin:bars", "builtin:grey", noise, noise]);
}

/// A list runs nothing. What a station always says does not prevent one.
#[test]
fn a_list_takes_no_option_of_a_run() {
    let folder = Folder::new();
    let list = small("verify", &["--list"]);
    for option in [&["--report", "out"][..], &["--record", "run.rec"], &["--timeout", "60"]] {
        let call: Vec<_> = list.iter().chain(option).copied().collect();
        refused(&folder, &call, &format!("{} does nothing beside --list", option[0]));
    }
    finish(folder.command(list).env("HALFROW_REPORT", "out")).succeeded();
    assert!(!folder.path().join("out").exists());
}

/// `verify` and `correct` with `option`, and a table file for 128 x 16, 12 bits, centre at 63.5.
fn beside_tables<'a>(option: &[&'a str]) -> [Vec<&'a str>; 2] {
    let call = |command: &[&'a str]| [command, &["--tables", "made.json"], option].concat();
    [call(&["verify", "-q"]), call(&["correct", "builtin:street", "--model", "-o", "out.pgm"])]
}

fn with_tables() -> Folder {
    let folder = Folder::new();
    folder.halfrow(small("tables", &["-o", "made.json"])).succeeded();
    folder
}

#[test]
fn a_table_file_takes_no_option_that_makes_tables() {
    let folder = with_tables();
    for option in [
        ["--radius", "100"],
        ["--focal-length", "2"],
        ["--pixel-pitch", "3"],
        ["--field-of-view", "170"],
        ["--centre-y", "5"],
        ["--rows", "fitted"],
        ["--lens", "equidistant:100"],
    ] {
        let sentence = format!("{} cannot be used together with --tables", option[0]);
        for call in beside_tables(&option) {
            refused(&folder, &call, &sentence);
        }
    }
    for option in [["--width", "1280"], ["--height", "80"], ["--bits", "8"], ["--centre-x", "5"]] {
        let sentence =
            format!("{} contradicts --tables made.json, which is for 128 x 16, 12 bits", option[0]);
        for call in beside_tables(&option) {
            refused(&folder, &call, &sentence);
        }
    }
}

#[test]
fn what_a_table_file_says_itself_may_be_said() {
    let folder = with_tables();
    let same = ["--width", "128", "--height", "16", "--bits", "12", "--centre-x", "63.5", "--phase", "rggb"];
    for call in beside_tables(&same) {
        folder.halfrow(call).succeeded();
    }
}

/// Flags take precedence over a table file that a station always uses.
#[test]
fn options_that_make_tables_beat_a_file_from_elsewhere() {
    let folder = with_tables();
    let tables = |more: &[&str]| {
        let call = ["verify", "--json"].into_iter().chain(more.iter().copied());
        let ended = finish(folder.command(call).env("HALFROW_TABLES", "made.json")).succeeded();
        let said = ended.json()["tables"].clone();
        (said["source"].as_str().unwrap().to_owned(), said["width"].clone(), ended.stderr)
    };
    let (source, _, _) = tables(&["--width", "128"]);
    assert_eq!(source, "made.json");
    for more in
        [&["--width", "64", "--height", "9"][..], &["--width", "64", "--height", "9", "--radius", "40"]]
    {
        let (source, width, said) = tables(more);
        assert!(source.starts_with("equidistant lens") && width == 64, "{source}");
        assert!(said.contains("the table file made.json is passed over, since --"), "{said}");
    }
}

#[test]
fn the_model_takes_no_board() {
    let folder = Folder::new();
    let correct = small("correct", &["builtin:grey", "--model", "-o", "out.pgm"]);
    for option in [&["--board", "mock"][..], &["--timeout", "5"], &["--retry-limit", "5"], &["--take-over"]] {
        let call: Vec<_> = correct.iter().copied().chain(option.iter().copied()).collect();
        refused(&folder, &call, &format!("{} does nothing beside --model", option[0]));
    }
    finish(folder.command(correct).env("HALFROW_BOARD", "mock")).succeeded();
}

#[test]
fn what_is_the_same_whatever_an_option_says_takes_none() {
    let folder = Folder::new();
    refused(&folder, &["tables", "--phase", "rggb", "-o", "x.json"], "--phase changes nothing about tables");
    refused(&folder, &["lens", "--bits", "8"], "--bits changes nothing about a lens's figures");
}

#[test]
fn a_layout_needs_a_file() {
    let folder = Folder::new();
    let sentence = "--raw is for frames that are files, and none is";
    refused(&folder, &small("verify", &["--raw", "u8"]), sentence);
    refused(
        &folder,
        &small("correct", &["builtin:grey", "--model", "--raw", "u8", "-o", "out.pgm"]),
        sentence,
    );
}

#[test]
fn an_option_of_paper_needs_an_item_that_heeds_it() {
    let folder = Folder::new();
    let call = ["paper", "fig5", "-o", "paper", "--board", "mock"];
    refused(&folder, &call, "--board does nothing, since no item that is asked for goes through a board");
    let call = ["paper", "table1", "--images", ".", "-o", "paper", "--take-over"];
    refused(&folder, &call, "--take-over does nothing, since no item that is asked for goes through a board");
    for (option, sentence) in [
        (&["--images", "."][..], "--images does nothing, since no item"),
        (&["--photograph", "p.png", "--lines", "l.toml"], "--photograph is for fig4"),
        (&["--synthesis", "report.json"], "--synthesis is for resources"),
    ] {
        refused(&folder, &[&["paper", "fig5", "-o", "paper"], option].concat(), sentence);
    }
}
