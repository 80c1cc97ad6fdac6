//! `verify --within SECONDS`.

use super::{refused, small};
use halfrow_tests::program::{Folder, command, finish};

const SLOW: &str = "mock,speed=20000";

fn call<'a>(options: &[&'a str]) -> Vec<&'a str> {
    small("verify", &[&["--board", SLOW], options].concat())
}

#[test]
fn what_is_no_time_and_what_does_nothing_beside_one_is_refused() {
    let folder = Folder::new();
    for seconds in ["0", "-1", "nan", "inf", "-inf", "1e7", "soon", ""] {
        let option = format!("--within={seconds}");
        refused(&folder, &call(&[&option]), "give a number of seconds, more than 0 and at most 1000000");
    }
    for option in [["--frame", "builtin:black"], ["--repeat", "2"]] {
        let sentence = format!("{} does nothing beside a time to judge within (--within)", option[0]);
        refused(&folder, &call(&[&["--within", "5"], &option[..]].concat()), &sentence);
    }
    refused(&folder, &call(&["--within", "5", "--record", "run.rec"]), "cannot be used with");
    refused(&folder, &call(&["--within", "5", "--list"]), "cannot be used with");
}

#[test]
fn too_few_seconds_end_with_2_and_the_least_that_this_link_needs() {
    let folder = Folder::new();
    let said = |options: &[&str]| {
        let ended = folder.halfrow(call(&[&["--json"], options].concat()));
        assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
        ended.json()["error"].clone()
    };
    let error = said(&["--within", "0.3"]);
    assert_eq!(error["code"], "seconds-too-few-for-verdict");
    let least = error["parameters"]["least"].as_f64().unwrap();
    assert_eq!(error["parameters"]["seconds"], 0.3);
    let sentence = format!("give at least {least} s");
    refused(&folder, &call(&["--within", "0.3"]), &sentence);
    folder.halfrow(call(&["-q", "--within", &least.to_string()])).succeeded();

    let error = said(&["--within", "3", "--at-speed", "3"]);
    assert_eq!(error["code"], "seconds-too-few-at-speed");
    assert!(error["parameters"]["least"].as_f64().unwrap() > 3.0, "{error}");
}

/// One packet is held back for a second, or swapped with the next, while the link is measured.
#[test]
fn a_packet_that_the_link_loses_does_not_make_a_call_wrong() {
    for fault in ["fault=stall,packet=5,seconds=1", "fault=reorder,packet=2,toward=both,seed=7"] {
        let board = format!("mock,{fault}");
        let ended = Folder::new().halfrow(small("verify", &["-q", "--within", "2", "--board", &board]));
        assert_eq!(ended.code, Some(0), "{fault}: {}{}", ended.stdout, ended.stderr);
    }
}

/// Both verdicts are a PASS, and one of them is of a part of the run.
#[test]
fn a_pass_within_a_time_says_how_many_parts_were_left_out() {
    let folder = Folder::new();
    let call = ["verify", "-q", "--within", "5", "--board", "mock,speed=300000"];
    let ended = folder.halfrow(call).succeeded();
    let last = ended.stdout.lines().last().unwrap();
    assert!(last.starts_with("PASS") && last.contains(", within 5.0 s: 16 parts left out, "), "{last}");
}

#[test]
fn a_clock_that_is_looked_at_again_is_no_warning() {
    let folder = Folder::new();
    let ended = folder.halfrow(small("verify", &["-q", "--board", "mock,fault=wrong-clock-claim"]));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(1), ""), "{}", ended.stdout);
}

/// A row of 64 samples takes this board a minute by the clock that it names, but no time on its wire.
#[test]
fn a_clock_that_the_board_names_is_not_told_as_the_link_s_or_the_call_s() {
    let folder = Folder::new();
    let judged = |seconds| {
        let call = small(
            "verify",
            &["-q", "--json", "--board", "mock,fault=wrong-clock-claim", "--within", seconds],
        );
        folder.halfrow(call)
    };
    let few = judged("1");
    assert_eq!(few.code, Some(2), "{}{}", few.stdout, few.stderr);
    assert!(
        few.stderr.contains("1 s is too short at the pixel clock of 1 Hz that the board names"),
        "{}",
        few.stderr
    );
    let error = &few.json()["error"];
    assert_eq!(
        (error["code"].as_str(), error["parameters"]["clock_hz"].as_u64()),
        (Some("seconds-too-few-for-named-clock"), Some(1))
    );
    let least = error["parameters"]["least"].as_f64().unwrap();
    let enough = judged(&least.to_string()).succeeded();
    let untested = enough.json()["not_exercised"].clone();
    let named = untested.as_array().unwrap().iter().find(|part| part["code"] == "unseen-clock");
    assert_eq!(named.unwrap()["parameters"]["clock_hz"], 1, "{untested}");
}

#[test]
fn frames_of_the_environment_are_passed_over() {
    let mut run = command(call(&["-q", "--json", "--within", "3"]));
    finish(run.env("HALFROW_FRAME", "missing.pgm")).succeeded();
}

#[test]
fn what_was_taken_and_left_out_stands_in_text_json_and_page() {
    let folder = Folder::new();
    let text = folder.halfrow(call(&["-q", "--within", "2.5", "--report", "out"])).succeeded();
    for told in ["within   expected to take", "within   covers", "within   leaves out", "rows"] {
        assert!(text.stdout.contains(told), "{told}: {}", text.stdout);
    }
    let report = folder.json("out/report.json");
    let within = &report["within"];
    assert_eq!(within["seconds"], 2.5);
    assert!(report["link"]["seconds"].as_f64().unwrap() <= 2.5, "{}", report["link"]);
    let cut = report["frames"].as_array().unwrap().iter().filter(|frame| frame["first_rows"].is_u64());
    assert!(cut.count() > 0, "{}", report["frames"]);
    let page = String::from_utf8(folder.read("out/report.html")).unwrap();
    assert!(page.contains("Within 2.5 s") && page.contains("Faults found (of "), "no chart");
}
