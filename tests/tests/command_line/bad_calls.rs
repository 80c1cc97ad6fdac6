//! Sizes and names that do not exist.

use halfrow_tests::program::Folder;

use crate::{refused, refused_with, small};

#[test]
fn a_frame_that_no_datapath_takes_is_refused() {
    let folder = Folder::new();
    for command in ["verify", "tables", "frames", "correct"] {
        let more: &[&str] = match command {
            "verify" => &[],
            "correct" => &["builtin:black", "--model", "-o", "out.pgm"],
            _ => &["-o", "out.json"],
        };
        let call = |size: [&'static str; 2]| {
            [command].into_iter().chain(size).chain(more.iter().copied()).collect::<Vec<_>>()
        };
        refused(
            &folder,
            &call(["--width", "129"]),
            "a width of 129 columns is not an even number from 64 to 2592",
        );
        refused(&folder, &call(["--width", "0"]), "a width of 0 columns");
        refused(&folder, &call(["--width", "62"]), "a width of 62 columns");
        refused(&folder, &call(["--width", "2594"]), "a width of 2594 columns");
        refused(
            &folder,
            &call(["--height", "0"]),
            "a height of 0 rows is outside 1 to 2048; give a height within",
        );
        refused(&folder, &call(["--height", "2049"]), "a height of 2049 rows");
        refused(&folder, &call(["--centre-x", "-1"]), "the optical centre is at column -1");
        refused(&folder, &call(["--centre-x", "1920"]), "the optical centre is at column 1920");
        refused(&folder, &call(["--width", "wide"]), "invalid value 'wide'");
    }
}

/// The error is about the option's value, not about an unknown option `-1`.
#[test]
fn a_negative_number_is_refused_by_its_option() {
    let folder = Folder::new();
    refused(&folder, &["verify", "--width", "-1"], "invalid value '-1' for '--width <SAMPLES>'");
    refused(
        &folder,
        &["verify", "--within", "-1"],
        "give a number of seconds, more than 0 and at most 1000000",
    );
    refused(&folder, &["verify", "--at-speed", "x"], "give a number of seconds");
    refused(&folder, &["verify", "--width", "6.4"], "give a whole number of samples");
    refused(&folder, &["verify", "--retry-limit", "-1"], "give a number of percent, 0 to 100");
    refused(
        &folder,
        &["link", "--board", "mock", "--seconds", "-0.5"],
        "give a number of seconds, 0.001 to 86400",
    );
    refused(&folder, &["load", "a.bit", "--deadline", "-1"], "give a number of seconds, 0.1 to 86400");
    refused(&folder, &["soak", "--hours", "-1"], "give a number of hours, 0.0001 to 8760");
}

#[test]
fn names_of_nothing_are_refused_with_those_that_there_are() {
    let folder = Folder::new();
    refused(
        &folder,
        &["verify", "--frame", "builtin:moon"],
        "`moon` is no built-in frame; use one of black, white",
    );
    refused(&folder, &["frames", "--only", "moon", "-o", "."], "`moon` is no built-in frame");
    let neither = "there is no file sharq5, and `sharq5` is no named kernel; use nearest, linear, keys, hermite, \
                   hermite-balanced, sharp5 or sharp7, or a kernel file";
    refused(&folder, &["verify", "--kernel", "sharq5"], neither);
    refused(&folder, &["kernel", "measure", "--images", ".", "--kernel", "sharq5"], neither);
    refused(&folder, &small("tables", &["--kernel", "sharq5", "-o", "lens.json"]), neither);
    std::os::unix::fs::symlink("loop", folder.path().join("loop")).unwrap();
    refused(&folder, &["verify", "--kernel", "loop"], "Too many levels of symbolic links");
    refused(&folder, &["verify", "--phase", "moon"], "moon");
    refused(&folder, &["verify", "--raw", "u15"], "u15");
    refused(&folder, &["verify", "--moon"], "unexpected argument '--moon'");
    refused(&folder, &["moon"], "unrecognized subcommand 'moon'");
    refused(&folder, &["completions", "moon"], "invalid value 'moon'");
    refused(&folder, &["verify", "--board", "replay:moon"], "moon");
}

/// An error in an address is found before there is anything to serve.
#[test]
fn an_address_that_is_none_is_a_wrong_call() {
    let folder = Folder::new();
    for address in ["99999", "x", "localhost", ":3001", "localhost:99999"] {
        refused(
            &folder,
            &["serve", "--tcp", address],
            "give PORT or ADDRESS:PORT, with a port of 0 to 65535",
        );
    }
    let busy = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = busy.local_addr().unwrap().port().to_string();
    refused_with(3, &folder, &["serve", "--tcp", &port], "cannot be made; choose another one");
    refused(&folder, &["serve", "--link", "missing/board"], "the link missing/board cannot be made");
    // The target that it prints could not be given to anybody.
    refused(
        &folder,
        &["serve", "--link", "board,1"],
        "no target can name board,1, since a comma ends a path there; choose another name with --link",
    );
}

#[test]
fn more_frames_than_can_be_numbered_are_refused() {
    let folder = Folder::new();
    let call = |frames, repeat| {
        let size = ["verify", "--list", "--width", "64", "--height", "1", "--repeat", repeat];
        let frames = std::iter::repeat_n(["--frame", "builtin:black"], frames).flatten();
        size.into_iter().chain(frames).collect::<Vec<_>>()
    };
    refused(&folder, &call(66, "993"), "65538 frames are more than the 65529 that a run can number");
    // 81 · 809 = 65529
    let most = folder.halfrow(call(81, "809"));
    let listed = most.stdout.lines().take_while(|line| !line.is_empty());
    assert_eq!((most.code, listed.count()), (Some(0), 65533));
    assert!(most.stdout.contains("\n65532  builtin:noise"));
}

#[test]
fn places_that_are_not_there_are_refused() {
    let folder = Folder::new();
    refused(&folder, &["verify", "--tables", "missing.json"], "cannot read missing.json");
    refused(&folder, &["verify", "--frame", "missing.pgm"], "cannot read missing.pgm");
}
