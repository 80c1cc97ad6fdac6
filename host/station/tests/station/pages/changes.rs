//! What an engineer changes on a page: a waiver, and another device for a serial number.

use crate::pages::station::{Browser, PUBLIC, SERIALS, Serving, Station};

/// A station with user accounts and a board that fails, and the run that failed.
fn failed() -> (Station, Serving, String) {
    let station = Station::public(1)
        .where_instead("station.toml", "mock,serial=1", "mock,serial=1,fault=stuck-data")
        .where_instead("plan.toml", "not-checked", "if-present");
    let serving = station.serve();
    let operator = serving.operator();
    operator.post("/scan", &[("text", SERIALS[0])]).until_taken();
    let failed = station.until_failed();
    (station, serving, failed)
}

fn page(browser: &Browser, path: &str) -> String {
    let answer = browser.get(path).send();
    assert_eq!(answer.status, 200, "{path}: {}", answer.text());
    answer.text()
}

#[test]
fn a_reason_that_is_longer_than_the_form_takes_waives_nothing() {
    let (station, serving, run) = failed();
    let act = format!("/runs/{run}/waive");
    let long = serving.engineer().post(&act, &[("reason", &"x".repeat(501))]).send();
    assert!(long.status == 400 && long.text().contains("reason-too-long"), "{}", long.text());
    assert_eq!(station.query("SELECT id FROM waiver"), Vec::<String>::new());
}

/// The audit would have a line without one.
#[test]
fn nothing_is_sent_again_without_a_reason_that_fits() {
    let station = Station::public(1);
    let serving = station.serve();
    let release = |reason: &str| serving.engineer().post("/outbox/1/release", &[("reason", reason)]).send();
    let long = "x".repeat(501);
    for (reason, said) in [(" ", "there is no reason"), (&long, "the reason has 501 characters")] {
        let refused = release(reason);
        assert!(refused.status == 400 && refused.text().contains(said), "{}", refused.text());
    }
    assert_eq!(release("looked at").status, 303);
}

/// The form is below the answer of one sink.
#[test]
fn what_waits_at_two_sinks_is_tried_again_where_the_engineer_says() {
    let station = Station::public(1);
    let serving = station.serve();
    let run = "018f0000-0000-7000-8000-000000000000";
    let database = rusqlite::Connection::open(station.path("data/station.db")).unwrap();
    let waits = "INSERT INTO outbox (sink, kind, subject, attempts, next_ms, dead_ms, said)
        VALUES ('mes', 'run', $1, 1, 0, 1, 'no'), ('share', 'run', $1, 1, 0, 1, 'no')";
    database.execute(waits, [run]).unwrap();
    let engineer = serving.engineer();
    let form = "<input type=\"hidden\" name=\"sink\" value=\"share\">";
    let shown = page(&engineer, "/outbox");
    assert!(shown.contains(form), "{shown}");
    let long = "x".repeat(501);
    let refused =
        engineer.post(&format!("/outbox/{run}/release"), &[("sink", "share"), ("reason", &long)]).send();
    let typed = format!("name=\"reason\" value=\"{long}\"");
    assert_eq!((refused.status, refused.text().matches(&typed).count()), (400, 1), "{}", refused.text());
    let fields = [("sink", "share"), ("reason", "looked at")];
    assert_eq!(engineer.post(&format!("/outbox/{run}/release"), &fields).send().status, 303);
    assert_eq!(station.query("SELECT sink FROM outbox WHERE dead_ms IS NOT NULL"), ["mes"]);
    let told = station.query("SELECT subject || ' ' || detail FROM audit WHERE act = 'release'");
    assert_eq!(told, [format!("{run} at share: looked at")]);
}

/// A screen on a line has no address bar.
#[test]
fn the_page_leads_to_what_a_sink_does_not_have() {
    let sink = |name| format!("[[sink]]\nname = \"{name}\"\nfolder = \"no-{name}\"\nformat = \"record\"\n");
    let sinks = ["share", "mes"].map(sink).concat();
    let station = Station::with(1, &format!("[web]\nlisten = \"127.0.0.1:0\"\n{sinks}"));
    let serving = station.serve();
    let here = serving.here();
    assert!(!here.get("/").send().text().contains("/outbox"), "nothing is unsent");
    here.post("/scan", &[("text", SERIALS[0])]).until_taken();
    // One result, which neither of them has.
    here.get("/today").until("<a href=\"/outbox\">still to be sent: 1</a>");
}

#[test]
fn nobody_is_told_to_log_in_where_nobody_can() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    for act in [here.post("/lanes/1/out", &[]), here.post("/scan", &[("text", "HR:OUT")])] {
        let said = act.with("accept", "application/json").send().text();
        assert!(said.contains("nobody logs in") && !said.contains("log in as"), "{said}");
    }
}

#[test]
fn an_engineer_waives_a_fail_once_and_with_a_reason_and_everyone_sees_it() {
    let (station, serving, run) = failed();
    let (operator, engineer) = (serving.operator(), serving.engineer());
    let (path, act) = (format!("/runs/{run}"), format!("/runs/{run}/waive"));
    let form = format!("action=\"{act}\"");
    assert!(!page(&operator, &path).contains(&form), "an operator has no such form");
    assert!(page(&engineer, &path).contains(&form));
    let forbidden = operator.post(&act, &[("reason", "x")]).send();
    assert!(forbidden.status == 403 && forbidden.text().contains("Only an engineer may"), "{forbidden:?}");
    for (language, said) in [("en", "there is no reason"), ("de", "es fehlt der Grund")] {
        let empty = engineer.post(&act, &[("reason", " ")]).with("accept-language", language).send();
        assert_eq!(empty.status, 400);
        assert!(empty.text().contains(said) && empty.text().contains("reason-missing"), "{}", empty.text());
        assert!(empty.text().contains(&form), "and the form is there still");
    }
    let long = "y".repeat(501);
    let typed = engineer.post(&act, &[("reason", &long)]).send().text();
    assert!(typed.contains(&format!("name=\"reason\" value=\"{long}\"")), "with what was typed: {typed}");
    assert_eq!(station.query("SELECT id FROM waiver"), Vec::<String>::new());
    let given = engineer.post(&act, &[("reason", "the lamp's cable, <not> the board")]).send();
    assert_eq!((given.status, given.headers["location"].as_str()), (303, path.as_str()));
    let again = engineer.post(&act, &[("reason", "once more")]).send();
    assert_eq!(again.status, 409);
    assert!(
        again.text().contains("waiver-given-already") && !again.text().contains(&form),
        "{}",
        again.text()
    );
    let stored = station.query("SELECT run_id || ' ' || operator_id || ' ' || reason FROM waiver");
    assert_eq!(stored, [format!("{run} Braun the lamp's cable, <not> the board")]);
    assert_eq!(
        station.query("SELECT operator_id || ' ' || subject FROM audit WHERE act = 'waive'"),
        [format!("Braun {run}")]
    );
    assert!(page(&operator, &path).contains("the lamp's cable, &lt;not&gt; the board"));
    for list in ["/history", &format!("/unit?serial={}", SERIALS[0])] {
        assert!(page(&operator, list).contains("<span class=\"waived\">waived</span>"), "{list}");
    }
    assert_eq!(engineer.post("/runs/1/waive", &[("reason", "x")]).send().status, 404);
}

/// A form that was refused is shown again at the address of its act.
#[test]
fn a_language_that_is_chosen_below_a_refused_form_leads_to_the_page_of_the_form() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    for (from, to) in [
        ("/runs/1/waive", "/runs/1"),
        ("/unit/rebind?serial=S%201", "/unit?serial=S%201"),
        ("/outbox/1/release", "/outbox"),
    ] {
        let page = format!("http://127.0.0.1:{}{from}", serving.port);
        let answer = here.post("/language", &[("language", "de")]).with("referer", &page).send();
        assert_eq!((answer.status, answer.header("location")), (303, Some(to)), "{from}");
    }
}

/// The form was open for longer than the session.
#[test]
fn whoever_sends_a_form_after_the_session_logs_in_there_and_is_led_back() {
    let station = Station::public(1);
    let serving = station.serve();
    let mut browser = serving.browser(PUBLIC);
    let over = browser.post("/runs/1/waive", &[("reason", "used as it is")]).send();
    let told = over.text();
    assert!(over.status == 401 && told.contains("Log in first") && told.contains("name=\"badge\""), "{told}");
    browser.learn(&over);
    let login = |page, badge| browser.post("/login", &[("page", page), ("badge", badge)]).send();
    let (_, page) = told.split_once("name=\"page\" value=\"").unwrap();
    let (page, _) = page.split_once('"').unwrap();
    assert!(login(page, "A-1").text().contains("name=\"page\" value=\"/runs/1\""), "a wrong badge");
    for (page, to) in [
        (page, "/runs/1"),
        ("//evil.example/history", "/"),
        ("https://evil.example", "/"),
        ("/unit?\r\nx", "/"),
    ] {
        let answer = login(page, "A-0017");
        assert_eq!((answer.status, answer.header("location")), (303, Some(to)), "{page}");
    }
}

#[test]
fn an_engineer_binds_a_unit_to_another_device_with_a_reason() {
    let (station, serving, _) = failed();
    let (operator, engineer) = (serving.operator(), serving.engineer());
    let unit = format!("/unit?serial={}", SERIALS[0]);
    let form = &format!("action=\"/unit/rebind?serial={}\"", SERIALS[0]);
    assert!(!page(&operator, &unit).contains(form) && page(&engineer, &unit).contains(form));
    let holds = "SELECT device FROM binding WHERE to_ms IS NULL";
    assert_eq!(station.query(holds), ["0000000000000001"]);
    let bind = |browser: &Browser, device: &str, reason: &str| {
        let fields = [("serial", SERIALS[0]), ("product", "CAM-T"), ("device", device), ("reason", reason)];
        browser.post("/unit/rebind", &fields).send()
    };
    assert_eq!(bind(&operator, "", "repaired").status, 403);
    let long = "x".repeat(501);
    for (device, reason, code) in [
        ("00000000000000Ff", "repaired", "device-malformed"),
        ("0000000000000000", "repaired", "device-malformed"),
        ("00000000000000ff", " ", "reason-missing"),
        ("00000000000000ff", &long, "reason-too-long"),
    ] {
        let refused = bind(&engineer, device, reason);
        assert_eq!(refused.status, 400, "{device}");
        assert!(refused.text().contains(code) && refused.text().contains(form), "{}", refused.text());
        // Empty, the field would ask for the device of the next judgement.
        for typed in [("device", device), ("reason", reason)]
            .map(|(name, is)| format!("name=\"{name}\" value=\"{is}\""))
        {
            assert!(refused.text().contains(&typed), "{typed}: {}", refused.text());
        }
    }
    assert_eq!(station.query(holds), ["0000000000000001"]);
    assert_eq!(bind(&engineer, "00000000000000ff", "FPGA exchanged").status, 303);
    assert_eq!(station.query(holds), ["00000000000000ff"]);
    let shown = page(&operator, &unit);
    assert!(shown.contains("00000000000000ff") && shown.contains("FPGA exchanged"), "{shown}");
    assert_eq!(bind(&engineer, "", "the next one is right").status, 303);
    assert_eq!(station.query(holds), Vec::<String>::new());
}
