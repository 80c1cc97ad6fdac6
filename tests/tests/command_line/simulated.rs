//! The simulated board as a target.

use halfrow_tests::program::Folder;

use crate::refused;

#[test]
fn what_a_simulated_board_cannot_be_is_refused() {
    let folder = Folder::new();
    let refuse = |target, sentence| refused(&folder, &["verify", "--board", target], sentence);
    refuse("sim:moon", "uart");
    refuse("sim,latency=12", "`latency` is not an option of this board");
    refuse("sim,fault=late", "late");
    refuse("sim,speed=0", "speed=0 is out of range");
    refuse("sim,trace=no/such/folder.vcd", "the waveform no/such/folder.vcd cannot be written");
}

#[test]
fn a_waveform_is_written_and_never_over_another_file() {
    let folder = Folder::new();
    // Of `info` only, since the waveform of a whole run has gigabytes.
    let call = ["info", "--board", "sim,trace=run.vcd"];
    assert_eq!(folder.halfrow(call.iter().copied()).code, Some(0));
    let waveform = folder.text("run.vcd");
    assert!(waveform.contains("$timescale") && waveform.contains("out_sample"), "{}", &waveform[..400]);
    refused(&folder, &call, "run.vcd is there already");
    assert_eq!(folder.text("run.vcd"), waveform);
}

/// It would be refused, as a place that is taken.
#[test]
fn a_board_with_a_waveform_is_not_opened_again() {
    let folder = Folder::new();
    let target = format!("sim,trace={}", folder.path().join("run.vcd").display()).parse().unwrap();
    assert!(halfrow::link::open(&target).unwrap().reopen.is_none());
    assert!(halfrow::link::open(&"sim".parse().unwrap()).unwrap().reopen.is_some());
}
