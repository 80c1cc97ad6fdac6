//! Faults of the mock board that a run can never meet, or a build cannot have.

use halfrow_tests::program::Folder;

use crate::{refused, small};

#[test]
fn a_fault_without_effect_is_refused_with_one_that_has_some() {
    let folder = Folder::new();
    for (fault, sentence) in [
        ("row-factor,row=16,max-height=16", "there is no row=16 in frames of 16 rows; give one from 0 to 15"),
        ("lost-row,row=16,max-height=16", "there is no row=16"),
        ("drifting-table,row=16,max-height=16", "there is no row=16"),
        // docs/full-speed.md: the tallest frame has one row less than the board takes.
        ("warm-bit,row=2047", "there is no row=2047 in frames of 2047 rows; give one from 0 to 2046"),
        // A row has 2048 samples at most.
        ("stuck-centre,bit=12", "at most 4094, which has no bit=12; give one from 0 to 11, or value=1"),
        ("tap-offset,columns=0", "columns=0 leaves the taps where they are; give -3 to -1 or 1 to 3"),
        (
            "dead-tap,tap=6,taps=five",
            "a build of five taps has no tap=6; give one from 1 to 5, or leave taps=five out",
        ),
        ("dead-tap,tap=3,reads=6,taps=five", "a build of five taps has no reads=6; give one from 1 to 5"),
        ("dead-tap,tap=4,reads=4", "tap=4,reads=4 lets the tap carry its own sample"),
        ("spoilt-row,column=128", "there is no column=128 in rows of 128 samples; give one from 0 to 127"),
        ("spoilt-row,row=16,column=128", "there is no row=16"),
        ("stuck-address,bit=11", "the ring has no address line bit=11; give one from 0 to 10"),
        ("stale-table,table-banks=1", "the wrong one of two banks of tables; give table-banks=2"),
        ("slow-path,bursts=no", "leave bursts=no out"),
        // Such a board makes no frame.
        ("lost-row,row=16,bursts=no", "there is no row=16 in frames of 16 rows"),
        // One frame and two of noise with these tables: 32 rows are played before row 3 of the last frame.
        ("drifting-table,after=36", "give 35 at most, or stream more frames"),
    ] {
        let board = format!("mock,fault={fault}");
        refused(&folder, &small("verify", &["--board", &board, "--frame", "builtin:noise"]), sentence);
    }
    for fault in [
        "row-factor,row=15",
        "warm-bit,row=2046,after=0",
        "drifting-table,after=35",
        "tap-offset,columns=-1",
        "stuck-centre,bit=12,value=1",
    ] {
        let board = format!("mock,fault={fault}");
        let ended = folder.halfrow(small("verify", &["--board", &board, "--frame", "builtin:noise"]));
        assert_eq!(ended.code, Some(1), "{fault}: {}", ended.stdout);
    }
}

#[test]
fn a_fault_at_speed_is_refused_where_no_frame_at_speed_is_judged() {
    let folder = Folder::new();
    // The wire's rules are tried with a few such frames.
    let tried = small("verify", &["--board", "mock,fault=hidden-pause", "--at-speed", "0"]);
    assert_eq!(folder.halfrow(tried).code, Some(1));
    for fault in ["late-swap", "wrong-clock-claim"] {
        let board = format!("mock,fault={fault}");
        let call = small("verify", &["--board", &board, "--at-speed", "0"]);
        refused(
            &folder,
            &call,
            "it strikes in frames that the board makes at full speed, and there are none",
        );
    }
    // The rules' tallest frame has 1023 rows: ten bits, all set.
    let tall = ["verify", "--width", "128", "--height", "1200", "--radius", "700", "--at-speed", "0"];
    let told = [&tall[..], &["--board", "mock,fault=hidden-pause,row=1100"]].concat();
    refused(&folder, &told, "there is no row=1100 in frames of 1023 rows");
    let untrapped = ["--at-speed", "0", "--board", "mock,fault=lost-row,row=16,bursts=untrapped"];
    refused(&folder, &small("verify", &untrapped), "there is no row=16 in frames of 16 rows");
}

/// With a grid the fault's row is the number of an entry, of which there are more than rows.
#[test]
fn a_fault_of_a_grids_entry_is_held_against_the_grid() {
    let folder = Folder::new();
    let verify = |fault: &str| {
        let board = format!("mock,max-height=24,fault={fault}");
        let size = ["--width", "192", "--height", "24", "--radius", "130", "--projection", "exact"];
        let call = ["verify", "-q", "--frame", "builtin:noise", "--board", &board];
        folder.halfrow(call.into_iter().chain(size))
    };
    let told = |fault: &str| {
        let ended = verify(fault);
        assert_eq!(ended.code, Some(2), "{fault}: {}{}", ended.stdout, ended.stderr);
        ended.stderr
    };
    let missing = told("row-factor,row=65534");
    let entries = missing.split("in a grid of ").nth(1).and_then(|rest| rest.split(';').next()).unwrap();
    let entries: usize = entries.parse().unwrap();
    assert!(entries > 24, "{missing}");
    let last = entries - 1;
    assert!(
        missing.contains(&format!(
            "there is no entry row=65534 in a grid of {entries}; give one from 0 to {last}"
        ))
    );
    assert!(told(&format!("drifting-table,row={entries}")).contains(&format!("no entry row={entries}")));
    assert!(told("lost-row,row=24").contains("there is no row=24 in frames of 24 rows"));
    // One frame and two of noise with these tables.
    assert!(told("drifting-table,after=72").contains("give 71 at most"));
    for fault in [format!("row-factor,row={last}"), "drifting-table,after=71".to_owned()] {
        let ended = verify(&fault);
        assert_eq!(ended.code, Some(1), "{fault}: {}", ended.stdout);
    }
}

#[test]
fn a_fault_of_conduct_is_refused_where_no_rule_is_tried() {
    let folder = Folder::new();
    for fault in [
        "any-session",
        "never-held",
        "counters-kept",
        "rows-anywhere",
        "greedy-ack",
        "damaged-ack",
        "stuck-repeats",
        "unkept-rule,instead=ack-beyond",
        "unchecked-commit",
    ] {
        let board = format!("mock,fault={fault}");
        let sentence = "it strikes where the rules of the wire are tried, and this run tries none";
        refused(&folder, &small("soak", &["--frames", "9", "--board", &board]), sentence);
    }
    // Rows that are lost on the way are sent again.
    for fault in ["packets-anew", "stuck-repeats,fault=lose,packet=60,toward=host"] {
        let board = format!("mock,fault={fault}");
        let ended = folder.halfrow(small("soak", &["--frames", "9", "--board", &board]));
        assert_eq!(ended.code, Some(1), "{fault}: {}{}", ended.stdout, ended.stderr);
    }
}

/// A run with frames of 64 columns.
fn narrow<'a>(run: &[&'a str], board: &'a str) -> Vec<&'a str> {
    [run, &["--width", "64", "--height", "16", "--radius", "40", "--board", board]].concat()
}

/// The middle of 64 columns is C = 63, which has bits 0 to 5, and that of the 2048 for the rules is C = 2047.
#[test]
fn a_fault_of_the_centre_is_held_against_every_centre() {
    let folder = Folder::new();
    let soak = ["soak", "--frames", "9"];
    let middle = ["verify", "--centre-x", "31.5", "--at-speed", "0"];
    let ignored = "every row is played with its centre in the middle; give another centre";
    let stuck = |bit, level| format!("is {level} in bit={bit} for every row that is played");
    for (run, fault, sentence) in [
        (&soak[..], "centre-ignored", ignored.to_owned()),
        (&middle, "centre-ignored", ignored.to_owned()),
        (&middle, "stuck-centre,bit=0,value=1", stuck(0, 1)),
        (&soak, "stuck-centre,bit=7", stuck(7, 0)),
        (&soak, "stuck-centre,bit=12", "which has no bit=12".to_owned()),
    ] {
        let board = format!("mock,fault={fault}");
        refused(&folder, &narrow(run, &board), &sentence);
    }
    for (run, fault) in [
        (&["soak", "--frames", "9", "--centre-x", "20"][..], "centre-ignored"),
        (&["verify", "--at-speed", "0"], "centre-ignored"),
        (&["verify", "--at-speed", "0"], "stuck-centre,bit=0,value=1"),
        // At full speed other centres have a turn as well.
        (&["verify", "--centre-x", "31.5"], "centre-ignored"),
        (&middle, "stuck-centre,bit=7"),
        (&soak, "stuck-centre,bit=5"),
    ] {
        let board = format!("mock,fault={fault}");
        let ended = folder.halfrow(narrow(run, &board));
        assert_eq!(ended.code, Some(1), "{run:?}, {fault}: {}{}", ended.stdout, ended.stderr);
    }
}

#[test]
fn a_fault_of_a_data_line_is_held_against_the_depth() {
    let folder = Folder::new();
    let soak = ["--frames", "9", "--bits", "8", "--board"];
    let call = |board: &'static str| small("soak", &[&soak[..], &[board]].concat());
    let sentence = "no sample that is played has bit=11; give one from 0 to 7, or value=1";
    refused(&folder, &call("mock,fault=stuck-data,bit=11,value=0"), sentence);
    for fault in ["mock,fault=stuck-data,bit=7,value=0", "mock,fault=stuck-data,bit=11,value=1"] {
        assert_eq!(folder.halfrow(call(fault)).code, Some(1), "{fault}");
    }
    // The rules are also tried with samples of more bits than the depth.
    let verify = ["--bits", "8", "--at-speed", "0", "--board", "mock,fault=stuck-data,bit=11,value=0"];
    assert_eq!(folder.halfrow(small("verify", &verify)).code, Some(1));
}
