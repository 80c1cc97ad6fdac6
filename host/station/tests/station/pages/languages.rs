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

/// What lane 1 shows.
fn lane_of(here: &Browser, language: &str) -> String {
    let page = here.get("/").with("accept-language", language).send().text();
    let (_, lane) = page.split_once("id=\"lane-1\"").unwrap();
    lane.split_once("</article>").unwrap().0.to_owned()
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
        ("de", ["Abtastwerten weichen ab", "von Hand", "<span>gesichert</span>", "Bitstream neu laden"]),
        ("zh", ["个样值中", "由人停用", "<span>已保存</span>", "请重新加载比特流"]),
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
    here.scan(SERIALS[0], "1");
    run_of(&here, "1", "pass", "en");
    here.scan(SERIALS[1], "1");
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
    here.scan(SERIALS[0], "1");
    for language in ["en", "de", "zh"] {
        let run = run_of(&here, "1", "error", language);
        assert_eq!(run.matches("ser2net").count(), 2, "{language}: {run}");
        assert_eq!(run.matches("check the port").count() == 2, language == "en", "{language}: {run}");
    }
}

/// The mock checks the shift, and says nothing about the board in the lane.
#[test]
fn the_verdict_on_the_mock_board_is_not_shown_as_that_of_the_board_in_the_lane() {
    let shift = format!("[shift]\ngood = \"{}\"\nbad = \"HR:MOCK\"\nhours = 8\n[tables]", SERIALS[0]);
    let station = Station::private(1).where_instead("plan.toml", "[tables]", &shift);
    let serving = station.serve();
    let here = serving.here();
    here.scan(SERIALS[0], "1");
    run_of(&here, "1", "pass", "en");
    let lane = |language: &str| lane_of(&here, language);
    // Now and then a fault is drawn that goes unfound.
    until("a FAIL of the mock board", || {
        let is_there = lane("en").contains("last: FAIL HR:MOCK:1");
        if !is_there {
            here.post("/scan", &[("text", "HR:MOCK"), ("lane", "1")]).send();
        }
        is_there
    });
    assert!(here.get("/").send().text().contains("lane ready"));
    for (language, said, aside) in [
        ("en", "scan its label", "put the board aside"),
        ("de", "zuletzt: SCHLECHT HR:MOCK:1", "Platine aussondern"),
        ("zh", "上一块板：不合格 HR:MOCK:1", "将板卡隔离"),
    ] {
        let lane = lane(language);
        assert!(lane.contains(said) && !lane.contains(aside), "{lane}");
    }
}

/// The lanes are in local time, so a day without its zone would be taken for the day of the lanes.
#[test]
fn the_days_that_the_history_asks_for_are_said_to_be_of_utc() {
    let station = Station::private(1);
    let serving = station.serve();
    for (language, said) in [
        ("en", ["<span>From (UTC)<", "<span>To (UTC, that day included)<"]),
        ("de", ["<span>Von (UTC)<", "<span>Bis (UTC, Tag eingeschlossen)<"]),
        ("zh", ["<span>起始日期 (UTC)<", "<span>截止日期（UTC，含当日）<"]),
    ] {
        for path in ["/history", "/yield", "/pareto"] {
            let page = serving.here().get(path).with("accept-language", language).send().text();
            said.iter().for_each(|said| assert!(page.contains(said), "{path}: {said}: {page}"));
        }
    }
}

/// Its word and its colour are those of every PASS.
#[test]
fn a_lane_says_of_a_board_that_a_program_plays_that_no_hardware_was_tested() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    here.scan(SERIALS[0], "1");
    here.get("/").until("lane pass");
    for (language, said) in
        [("en", "no hardware was tested"), ("de", "keine Hardware geprüft"), ("zh", "未测试硬件")]
    {
        let lane = lane_of(&here, language);
        assert!(lane.contains(said), "{lane}");
    }
}

#[test]
fn a_pass_of_a_board_whose_identity_nobody_checked_says_so_in_every_language() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    here.scan(SERIALS[0], "1");
    for (language, unchecked) in
        [("en", "identity not checked"), ("de", "Identität nicht geprüft"), ("zh", "身份未核对")]
    {
        let run = run_of(&here, "1", "pass", language);
        let (_, headline) = run.split_once("<p class=\"headline\">").unwrap();
        let (headline, _) = headline.split_once("</p>").unwrap();
        let also = if language == "zh" { "；" } else { "; " };
        assert!(headline.ends_with(&format!("{also}{unchecked}")), "{headline}");
        let lane = lane_of(&here, language);
        assert!(lane.contains(&format!("<p class=\"why\">{unchecked}</p>")), "{lane}");
    }
}

#[test]
fn a_pass_of_a_board_whose_identity_was_checked_says_nothing_of_it() {
    let station = Station::private(1).where_instead("plan.toml", "not-checked", "if-present");
    let serving = station.serve();
    let here = serving.here();
    here.scan(SERIALS[0], "1");
    here.get("/").until("lane pass");
    let lane = lane_of(&here, "en");
    assert!(!lane.contains("identity"), "{lane}");
}
