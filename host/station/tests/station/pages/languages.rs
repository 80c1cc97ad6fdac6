//! Whether pages say everything in the reader's language.

use crate::common::until;
use crate::pages::station::{Browser, SERIALS, Station};

/// Waits for the verdict on what was scanned in the lane, and returns the page of that run.
fn run_of(here: &Browser, lane: &str, word: &str, language: &str) -> String {
    let page = here.get("/").until(&format!("lane {word}"));
    let lane = page.split(&format!("id=\"lane-{lane}\"")).nth(1).unwrap();
    let run = lane.split("data-run=\"").nth(1).unwrap().split('"').next().unwrap();
    let run = here.get(&format!("/runs/{run}")).with("accept-language", language).send().text();
    run.split_once("<main>").unwrap().1.to_owned()
}

fn scan(here: &Browser, serial: &str, lane: &str) {
    here.post("/scan", &[("text", serial), ("lane", lane)]).until_taken();
}

#[test]
fn nothing_that_an_operator_is_told_stays_english_in_another_language() {
    let station =
        Station::public(2).where_instead("station.toml", "mock,serial=1", "mock,serial=1,fault=stuck-data");
    let serving = station.serve();
    let here = serving.engineer();
    let scan = |text: &str, lane: &str, language: &str| {
        let request = here.post("/scan", &[("text", text), ("lane", lane)]);
        request.with("accept", "application/json").with("accept-language", language).send().text()
    };
    for (language, said) in
        [("de", "die Prüfziffer von „CA0131103629“ ist falsch"), ("zh", "“CA0131103629”的校验位错误")]
    {
        let refused = scan("CA0131103629", "1", language);
        assert!(refused.contains(said), "{refused}");
    }
    until("a scan that is taken", || scan(SERIALS[0], "1", "de").contains("wird auf Platz 1 geprüft"));
    assert_eq!(here.post("/lanes/2/out", &[]).send().status, 303);
    let page = |language: &str| here.get("/").with("accept-language", language).send().text();
    here.get("/").until("lane fail");
    for (language, said) in [
        ("de", ["Abtastwerten weichen ab", "durch einen Bediener", "gesichert ", "Bitstream neu laden"]),
        ("zh", ["个样值中", "由操作员停用", "已保存 ", "请重新加载比特流"]),
    ] {
        let page = page(language);
        for said in said {
            assert!(page.contains(said), "{said}: {page}");
        }
        assert!(!page.contains("class=\"why\" lang=\"en\""), "{page}");
        let run = page.split("data-run=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        let run = here.get(&format!("/runs/{run}")).with("accept-language", language).send().text();
        assert!(run.contains(said[0]) && run.contains(said[3]), "{run}");
        let (_, body) = run.split_once("<main>").unwrap();
        assert!(!body.contains("lang=\"en\""), "{run}");
    }
}

/// Scanning the label of another board is the most common mistake on a line.
#[test]
fn what_to_do_about_a_wrong_label_is_told_in_the_language() {
    let station = Station::private(1).where_instead("plan.toml", "not-checked", "required");
    let serving = station.serve();
    let here = serving.here();
    scan(&here, SERIALS[0], "1");
    run_of(&here, "1", "pass", "en");
    scan(&here, SERIALS[1], "1");
    for (language, asked) in [
        ("en", "Scan the label of the board that is in the lane"),
        ("de", "Etikett der Platine scannen, die auf dem Platz liegt"),
        ("zh", "请扫描工位上那块板卡的标签"),
    ] {
        let run = run_of(&here, "1", "error", language);
        assert!(run.contains(asked), "{run}");
        let page = here.get("/").with("accept-language", language).send().text();
        let (_, lane) = page.split_once("id=\"lane-1\"").unwrap();
        assert!(lane.contains(asked), "{lane}");
        assert!(!lane.contains("lang=\"en\"") && !run.contains("lang=\"en\""), "{run}");
    }
}

/// On a run's page, once for the whole run and once for its step.
#[test]
fn what_to_do_is_told_once_and_in_one_language() {
    let station = Station::private(1).where_instead("station.toml", "mock,serial=1", "tcp:127.0.0.1:1");
    let serving = station.serve();
    let here = serving.here();
    scan(&here, SERIALS[0], "1");
    for language in ["en", "de", "zh"] {
        let run = run_of(&here, "1", "error", language);
        assert_eq!(run.matches("ser2net").count(), 2, "{language}: {run}");
        assert_eq!(run.matches("check the port").count() == 2, language == "en", "{language}: {run}");
    }
}

/// The mock checks the shift, and says nothing about the board in the lane.
#[test]
fn under_the_fail_of_the_mock_board_nobody_is_told_to_put_the_own_board_aside() {
    let shift = format!("[shift]\ngood = \"{}\"\nbad = \"HR:MOCK\"\nhours = 8\n[tables]", SERIALS[0]);
    let station = Station::private(1).where_instead("plan.toml", "[tables]", &shift);
    let serving = station.serve();
    let here = serving.here();
    scan(&here, SERIALS[0], "1");
    run_of(&here, "1", "pass", "en");
    let page = |language: &str| here.get("/").with("accept-language", language).send().text();
    // Now and then a fault is drawn that goes unfound.
    until("a FAIL of the mock board", || {
        let is_there = page("en").contains("lane fail");
        if !is_there {
            here.post("/scan", &[("text", "HR:MOCK"), ("lane", "1")]).send();
        }
        is_there
    });
    for (language, said, aside) in [
        ("en", "the mock board failed, as it must", "put the board aside"),
        ("de", "Mock-Platine SCHLECHT, wie erwartet", "Platine aussondern"),
        ("zh", "模拟板不合格，符合要求", "将板卡隔离"),
    ] {
        let page = page(language);
        let (_, lane) = page.split_once("id=\"lane-1\"").unwrap();
        let (lane, _) = lane.split_once("</article>").unwrap();
        assert!(lane.contains(said) && !lane.contains(aside), "{lane}");
    }
}

#[test]
fn a_pass_of_a_board_whose_identity_nobody_checked_says_so_in_every_language() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    scan(&here, SERIALS[0], "1");
    for (language, unchecked) in
        [("en", "; identity not checked"), ("de", "; Identität nicht geprüft"), ("zh", "；身份未核对")]
    {
        let run = run_of(&here, "1", "pass", language);
        let (_, headline) = run.split_once("<p class=\"headline\">").unwrap();
        let (headline, _) = headline.split_once("</p>").unwrap();
        assert!(headline.ends_with(unchecked), "{headline}");
    }
}
