//! The simulated board as a target.

use std::os::unix::fs::symlink;

use halfrow_tests::program::{Folder, Running};

use crate::{refused, small};

#[test]
fn what_a_simulated_board_cannot_be_is_refused() {
    let folder = Folder::new();
    let refuse = |target, sentence| refused(&folder, &["verify", "--board", target], sentence);
    refuse("sim:moon", "uart");
    refuse("sim,latency=12", "`latency` is not an option of this board");
    refuse("sim,fault=late", "late");
    refuse("sim,speed=0", "speed=0 is out of range");
    refuse("sim,trace=a.vcd,trace=b.vcd", "trace is given twice");
    refuse("sim,traec=a.vcd", "(did you mean trace?); choose from pace, trace, speed");
    refuse("sim,trace=no/such/folder.vcd", "nothing can be written into the folder no/such");
    refuse("sim,trace=-", "`trace=FILE -` names no place");
    let call = ["info", "--board", "sim,trace=no/such/folder.vcd"];
    refused(&folder, &call, "the waveform no/such/folder.vcd cannot be written");
}

#[test]
fn a_waveform_is_written_and_never_over_another_file() {
    let folder = Folder::new();
    // Of `info` only, since the waveform of a whole run has gigabytes.
    let call = ["info", "--board", "sim,trace=run.vcd"];
    folder.halfrow(call.iter().copied()).succeeded();
    let waveform = folder.text("run.vcd");
    assert!(waveform.contains("$timescale") && waveform.contains("out_sample"), "{}", &waveform[..400]);
    refused(&folder, &call, "run.vcd is there already");
    let overwriting = small("verify", &["--board", "sim,trace=run.vcd", "--overwrite"]);
    refused(&folder, &overwriting, "run.vcd is there already");
    assert_eq!(folder.text("run.vcd"), waveform);
}

/// The file may have 512 bytes, which is less than the waveform's own head.
#[test]
fn a_waveform_that_has_no_space_is_an_error_and_no_hang() {
    let folder = Folder::new();
    let call = ["info", "--json", "--board", "sim,trace=run.vcd"];
    let ended = Running::start(&mut folder.by_shell("ulimit -f 1; exec \"$@\"", call)).end();
    assert_eq!(ended.code, Some(3), "{}", ended.stderr);
    assert!(ended.stdout.contains("waveform-not-written"), "{}", ended.stdout);
}

#[test]
fn a_waveform_is_never_written_through_a_link() {
    let folder = Folder::new();
    symlink("nowhere.vcd", folder.path().join("link.vcd")).unwrap();
    refused(&folder, &["info", "--board", "sim,trace=link.vcd"], "link.vcd is there already");
    let call = small("verify", &["--board", "sim,trace=link.vcd"]);
    refused(&folder, &call, "link.vcd is a link to nowhere.vcd");
}

/// Before the board is switched on: it would run to its end, and only then find its other output's place taken.
#[test]
fn a_waveform_has_a_place_of_its_own_among_a_call_s_files() {
    let folder = Folder::new();
    folder.halfrow(small("frames", &["--only", "black", "-o", "."])).succeeded();
    let verify = |rest: &[&'static str]| small("verify", &[&["--board", "sim,trace=out"], rest].concat());
    let shared = "would both be written to";
    refused(&folder, &verify(&["--record", "out"]), shared);
    refused(&folder, &verify(&["--report", "out"]), shared);
    let soak = ["soak", "--frames", "1", "--board", "sim,trace=out", "--report", "out"];
    refused(&folder, &soak, shared);
    let correct = |trace: &'static str, rest: &[&'static str]| {
        small("correct", &[&["builtin:black", "--board", trace], rest].concat())
    };
    refused(&folder, &correct("sim,trace=out.png", &["-o", "out.png"]), shared);
    let paper = ["paper", "delay", "--board", "sim,trace=paper/paper.html", "-o", "paper"];
    refused(&folder, &paper, shared);
    let of_input = small("verify", &["--board", "sim,trace=black.pgm", "--frame", "black.pgm"]);
    refused(&folder, &of_input, "black.pgm is read by this call, and trace=FILE would write there");
}

/// It would be refused, as a place that is taken.
#[test]
fn a_board_with_a_waveform_is_not_opened_again() {
    let folder = Folder::new();
    let target = format!("sim,trace={}", folder.path().join("run.vcd").display()).parse().unwrap();
    assert!(halfrow::link::open(&target).unwrap().reopen.is_none());
    assert!(halfrow::link::open(&"sim".parse().unwrap()).unwrap().reopen.is_some());
}
