//! What a verdict does not say: what a PASS did not test, and how much a suspect explains where nothing was counted.

use std::process::Command;

use halfrow_station::history::runs::{Filter, page};
use serde_json::Value;

use super::commands::{did, misread};
use super::made::Made;
use super::served::Served;
use crate::common::{self, PLAN, program};

/// One mock board, judged by a plan of this text.
fn judged(plan: &str, board: &str) -> Made {
    let folder = common::folder();
    let file = folder.path().join("plan.toml");
    std::fs::write(&file, plan).unwrap();
    let mut run = Command::new(program());
    run.args(["run", "--serial", "CAT00001", "--board", board, "--any-disk", "--data"]).arg(folder.path());
    run.arg("--plan").arg(&file).status().unwrap();
    Made::at(folder)
}

/// Its page in this language.
fn page_of(served: &Served, run: &str, language: &str) -> String {
    served.get_in(&format!("/runs/{run}"), language).text()
}

fn only_run(made: &Made) -> String {
    page(&made.now(), &Filter::default(), None, 1).unwrap().runs[0].id.clone()
}

/// docs/station-plans.md: `at_speed = 0` is for none of the frames at full speed.
#[test]
fn a_pass_says_what_was_not_tested_wherever_it_is_told() {
    let untested = "frames at the full pixel clock without a pause";
    let made = judged(&PLAN.replace("timeout = 60", "timeout = 60\nat_speed = 0"), "mock");
    let (code, said, complained) = did(&made, &["unit", "CAT00001"]);
    assert_eq!(code, 0, "{complained}");
    let line = said.lines().find(|line| line.starts_with("  untested  verify: "));
    assert!(line.is_some_and(|line| line.contains(untested)), "{said}");
    let units: Value = serde_json::from_str(&did(&made, &["unit", "CAT00001", "--json"]).1).unwrap();
    assert_eq!(misread("unit", &units), Vec::<String>::new(), "schema/results-1.json");
    let by_step = &units[0]["runs"][0]["not_exercised"];
    let parts = by_step[0]["parts"].as_array().unwrap();
    let is_told = parts.iter().any(|part| part["message"].as_str().unwrap().contains(untested));
    assert!(by_step[0]["step"] == "verify" && is_told, "{by_step}");
    let run = only_run(&made);
    let served = Served::of(made);
    let junit = served.get(&format!("/runs/{run}/export/junit")).text();
    let property = junit.split("<property ").find(|one| one.starts_with("name=\"not_exercised\"")).unwrap();
    assert!(property.contains("value=\"verify: ") && property.contains(untested), "{property}");
    for (language, told) in [
        ("en", ["Not tested by verify", untested]),
        ("de", ["Nicht geprüft von verify", "Bilder mit vollem Pixeltakt ohne Pause"]),
        ("zh", ["verify 未测试", "全像素时钟下无间隔的连续帧"]),
    ] {
        let page = page_of(&served, &run, language);
        assert!(told.iter().all(|words| page.contains(words)), "{told:?} is missing in\n{page}");
    }
}

/// Whoever counts runs by either must be able to leave out the mock.
#[test]
fn what_kind_of_board_it_was_and_its_exit_code_are_told_of_a_run_wherever_it_is_listed() {
    let made = judged(PLAN, "mock");
    for (arguments, run) in
        [(&["history", "--json"][..], "/runs/0"), (&["unit", "CAT00001", "--json"], "/0/runs/0")]
    {
        let said: Value = serde_json::from_str(&did(&made, arguments).1).unwrap();
        let run = said.pointer(run).unwrap();
        assert_eq!((&run["board_kind"], &run["exit_code"]), (&"mock".into(), &0.into()), "{run:#}");
    }
}

/// Nobody counts what such a fault explains.
#[test]
fn no_share_is_told_of_a_suspect_of_which_none_was_counted() {
    let made = judged(PLAN, "mock,fault=slow-path");
    let (_, said, _) = did(&made, &["unit", "CAT00001"]);
    assert!(said.contains("  suspect   ") && !said.contains("explains"), "{said}");
    let run = only_run(&made);
    let served = Served::of(made);
    for (language, suspected) in [("en", "Suspected: "), ("de", "Verdacht: "), ("zh", "可疑：")] {
        for page in
            [page_of(&served, &run, language), served.get_in("/unit?serial=CAT00001", language).text()]
        {
            assert!(page.contains(suspected) && !page.contains(" 0 %"), "{page}");
            assert!(!page.contains(&format!("{suspected}<span lang=\"en\">")), "{page}");
        }
    }
}
