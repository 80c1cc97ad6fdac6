//! What the operator's page says and does, without a browser.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::TcpStream;

use serde_json::Value;

use crate::common::{HANG, plant_settings, until};
use crate::pages::station::{SERIALS, Serving, Station};

/// The page's stream of news.
struct Live(BufReader<TcpStream>);

impl Live {
    fn of(serving: &Serving) -> Self {
        Self::in_language(serving, "en")
    }

    fn in_language(serving: &Serving, language: &str) -> Self {
        let mut stream = TcpStream::connect(("127.0.0.1", serving.port)).unwrap();
        stream.set_read_timeout(Some(HANG)).unwrap();
        let host = format!("host: 127.0.0.1:{}\r\naccept-language: {language}", serving.port);
        write!(stream, "GET /live HTTP/1.1\r\n{host}\r\n\r\n").unwrap();
        Self(BufReader::new(stream))
    }

    /// The next event: its number, name and data.
    fn next(&mut self) -> (u64, String, Value) {
        let (mut id, mut name, mut line) = (0, String::new(), String::new());
        loop {
            line.clear();
            assert!(self.0.read_line(&mut line).unwrap() > 0, "the news end");
            if let Some(text) = line.strip_prefix("id: ") {
                id = text.trim().parse().unwrap();
            } else if let Some(text) = line.strip_prefix("event: ") {
                name = text.trim().to_owned();
            } else if let Some(text) = line.strip_prefix("data: ") {
                return (id, name, serde_json::from_str(text).unwrap());
            }
        }
    }
}

#[test]
fn news_begin_with_everything_and_have_no_gap_and_every_verdict_has_its_record() {
    let station = Station::private(2);
    let serving = station.serve();
    let mut live = Live::of(&serving);
    let (mut last, name, all) = live.next();
    assert_eq!((name.as_str(), all["lanes"].as_array().unwrap().len()), ("snapshot", 2));
    let here = serving.here();
    let scan = |text: &str, lane: &str| {
        let answer = here
            .post("/scan", &[("text", text), ("lane", lane), ("counter", "7")])
            .with("accept", "application/json");
        serde_json::from_str::<Value>(&answer.send().text()).unwrap()
    };
    let armed = scan("HR:LANE:2", "");
    assert_eq!((&armed["armed"], &armed["counter"]), (&"2".into(), &7.into()), "{armed}");
    assert!(!scan(SERIALS[0], "")["is_taken"].as_bool().unwrap(), "nobody knows for which lane");
    let taken = scan(SERIALS[0], "2");
    assert_eq!(
        (&taken["is_taken"], &taken["lane"], &taken["armed"]),
        (&true.into(), &"2".into(), &Value::Null)
    );
    let (mut beats, mut verdict) = (0, None);
    while beats < 2 || verdict.is_none() {
        let (id, name, said) = live.next();
        assert_eq!(id, last + 1, "{name}");
        last = id;
        beats += u32::from(name == "beat");
        if name == "lane" && said["state"] == "PASS" {
            verdict = Some(said);
        }
    }
    let verdict = verdict.unwrap();
    let run = verdict["run"].as_str().unwrap();
    let stored = station.query(&format!("SELECT verdict || record_sha256 FROM run WHERE id = '{run}'"));
    assert_eq!(stored, [format!("PASS{}", verdict["record_sha256"].as_str().unwrap())]);
    assert!(verdict["html"].as_str().unwrap().contains(SERIALS[0]));
}

/// Plans name their steps as they like.
#[test]
fn a_step_that_is_named_like_something_that_a_run_does_is_shown_by_its_name() {
    for (name, ended) in [
        ("cable that failed", "cable that failed: bestanden"),
        ("the board is on", "the board is on: bestanden"),
        ("testing the link", "testing the link: bestanden"),
    ] {
        let named = format!("kind = \"verify\"\nname = \"{name}\"");
        let station = Station::private(1).where_instead("plan.toml", "kind = \"verify\"", &named);
        let serving = station.serve();
        let mut live = Live::in_language(&serving, "de");
        serving.here().post("/scan", &[("text", SERIALS[0])]).until_taken();
        let mut what = Vec::new();
        while what.last().is_none_or(|last| last != ended) {
            let (_, event, said) = live.next();
            assert!(event != "lane" || said["verdict"].is_null(), "{ended}: {what:?}");
            what.extend((event == "doing").then(|| said["what"].as_str().unwrap().to_owned()));
        }
        assert!(what.iter().any(|what| what == name), "{name}: {what:?}");
    }
}

/// The board in the lane is a file, which can be taken away. It is no serial port, so its run is ERROR.
#[test]
fn a_verdict_is_drawn_over_the_empty_lane_and_small_over_the_next_board() {
    let station = Station::private(1);
    let port = station.path("port");
    let board = format!("serial:{}", port.display());
    let station = station.where_instead("station.toml", "mock,serial=1", &board);
    let serving = station.serve();
    let mut live = Live::of(&serving);
    fs::write(&port, "").unwrap();
    serving.here().post("/scan", &[("text", SERIALS[0])]).until_taken();
    let mut html = |state: &str| loop {
        let (_, name, said) = live.next();
        if name == "lane" && said["state"] == state {
            break said["html"].as_str().unwrap().to_owned();
        }
    };
    let drawn = html("ERROR");
    fs::remove_file(&port).unwrap();
    assert!(html("ERROR").contains("data-record") && drawn.contains("data-record"), "{drawn}");
    fs::write(&port, "").unwrap();
    let next = html("READY");
    assert!(next.contains(&format!(">last: ERROR {}</a></p>", SERIALS[0])), "{next}");
    assert!(next.contains("scan its label") && !next.contains("data-record"), "{next}");
    for (preferred, said) in [("de", "zuletzt: STÖRUNG"), ("zh", "上一块板：错误")] {
        serving.here().get("/still").with("accept-language", preferred).until(said);
    }
}

/// A page without a script goes on saying which lane was chosen, but not for ever.
#[test]
fn without_a_script_a_lane_that_was_chosen_long_ago_gets_no_scan() {
    let station = Station::private(2);
    let serving = station.serve();
    let here = serving.here();
    let scan = |text: &str, more: &[(&str, &str)]| {
        here.post("/scan", &[&[("text", text), ("typed", "true")], more].concat()).send().text()
    };
    let chosen = scan("HR:LANE:2", &[]);
    for part in ["<option selected>2</option>", "name=\"chosen\" value=\"2\"", "name=\"made_ms\" value=\""] {
        assert!(chosen.contains(part), "{part}: {chosen}");
    }
    let long_ago = [("chosen", "2"), ("made_ms", "-16000")];
    let over = scan(SERIALS[0], &[&[("lane", "2")], &long_ago[..]].concat());
    assert!(over.contains("lane 2 was chosen more than 15 s ago") && !over.contains("selected"), "{over}");
    here.get("/").until("lane ready");
    let by_hand = scan(SERIALS[0], &[&[("lane", "1")], &long_ago[..]].concat());
    assert!(by_hand.contains(&format!("{} is tested in lane 1", SERIALS[0])), "{by_hand}");
}

#[test]
fn a_verdict_is_drawn_with_what_its_lane_owes_beside_it() {
    let shift = format!("[shift]\ngood = \"{}\"\nbad = \"HR:MOCK\"\nhours = 8\n[tables]", SERIALS[0]);
    let station = Station::private(1).where_instead("plan.toml", "[tables]", &shift).where_instead(
        "station.toml",
        "mock,serial=1",
        "mock,fault=stuck-data",
    );
    let serving = station.serve();
    let mut live = Live::of(&serving);
    serving.here().post("/scan", &[("text", SERIALS[0])]).with("accept", "application/json").send();
    let drawn = loop {
        let (_, name, said) = live.next();
        if name == "lane" && !said["run"].is_null() {
            break said;
        }
    };
    assert_eq!((&drawn["state"], &drawn["verdict"]), (&"FAIL".into(), &"FAIL".into()), "{drawn}");
    let html = drawn["html"].as_str().unwrap();
    for said in ["no hardware was tested", "the good unit CA0131103628 was judged FAIL", "samples differ"] {
        assert!(html.contains(said), "{said}: {html}");
    }
}

/// As on a full disk, before the shift is checked: what to put right comes before what to scan then.
#[test]
fn why_a_run_was_not_begun_stands_above_what_its_lane_owes() {
    let shift = format!("[shift]\ngood = \"{}\"\nbad = \"HR:MOCK\"\nhours = 8\n[tables]", SERIALS[0]);
    let station = Station::private(1).where_instead("plan.toml", "[tables]", &shift);
    let serving = station.serve();
    let owed = "the good unit CA0131103628 must be judged PASS first";
    let before = seen(&serving, owed);
    assert!(before.contains("<p class=\"asks\">Scan its label</p>"), "{before}");
    let full = "CREATE TRIGGER full BEFORE INSERT ON run BEGIN SELECT RAISE(FAIL, 'the disk is full'); END";
    station.change(full);
    serving.here().post("/scan", &[("text", SERIALS[0])]).until_taken();
    let page = seen(&serving, "the run was not begun");
    assert!(page.contains("lane out") && page.contains("the disk is full"), "{page}");
    assert!(page.contains("<p class=\"asks\">Check that its folder is writable and has space</p>"), "{page}");
    let [why, owed] = ["the run was not begun", owed].map(|said| page.find(said).unwrap());
    assert!(why < owed, "{page}");
}

#[test]
fn without_a_script_the_page_says_the_states_and_takes_a_serial_number() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    let page = here.get("/").send().text();
    // What is loaded anew is the frame with the lanes, and no other site may frame it.
    assert!(page.contains("<noscript><iframe src=\"/still\"") && !page.contains("http-equiv"), "{page}");
    let still = here.get("/still").send();
    assert!(still.text().contains("<meta http-equiv=\"refresh\" content=\"5\">"), "{}", still.text());
    for (answer, ancestors) in [(still, "'self'"), (here.get("/").send(), "'none'")] {
        let policy = &answer.headers["content-security-policy"];
        assert!(policy.ends_with(&format!("frame-ancestors {ancestors}")), "{policy}");
    }
    let answer = here.post("/scan", &[("text", SERIALS[1]), ("typed", "true")]).send();
    assert_eq!(answer.status, 200);
    assert!(answer.text().contains(&format!("{} is tested in lane 1", SERIALS[1])), "{}", answer.text());
    let fields = [("text", "CA0201134374"), ("typed", "true"), ("lane", "1")];
    let refused = here.post("/scan", &fields).send().text();
    assert!(refused.contains("class=\"answer refused\""), "{refused}");
}

/// Nobody is logged in: a badge is asked for, in every lane and above them.
#[test]
fn whoever_is_not_logged_in_is_asked_for_the_badge() {
    let station = Station::with(1, "[web]\nlisten = \"127.0.0.1:0\"\n[access]\nusers = \"users.toml\"");
    assert!(station.user(&["add", "Weber"], "A-0017\n").status.success());
    let serving = station.serve();
    let page = seen(&serving, "lane ready");
    assert!(page.contains("<p class=\"badge\"><strong>Scan your badge</strong>"), "{page}");
    assert!(
        page.contains("<p class=\"does\">scan your badge</p>") && !page.contains("scan its label"),
        "{page}"
    );
    let mut here = serving.here();
    here.learn(&here.post("/login", &[("badge", "A-0017")]).send());
    let page = here.get("/").send().text();
    assert!(
        page.contains("<p class=\"does\">scan its label</p>") && !page.contains("class=\"badge\""),
        "{page}"
    );
}

/// A label of another product is answered with what to do, not with the plan's pattern.
#[test]
fn a_wrong_label_is_answered_without_a_pattern() {
    let station = Station::private(1);
    let serving = station.serve();
    let said = serving.here().post("/scan", &[("text", "WRONG"), ("typed", "true")]).send().text();
    assert!(said.contains("is no serial number of this product; scan the board"), "{said}");
    assert!(!said.contains("(?&lt;number&gt;"), "{said}");
}

#[test]
fn every_language_says_it_in_its_words() {
    let station = Station::private(1);
    let serving = station.serve();
    for (preferred, word) in [("de-AT", "BEREIT"), ("zh", "就绪"), ("fr", "READY")] {
        // The board is only seen once the station has looked for it.
        let seen = serving.here().get("/").with("accept-language", preferred).until("lane ready");
        assert!(seen.contains(word), "{preferred}: {seen}");
    }
    let here = serving.here();
    let answer = here.post("/language", &[("language", "de")]).send();
    assert!(answer.headers["set-cookie"].starts_with("halfrow-language=de;"), "{answer:?}");
    // The answer leads back to the page on which the language was chosen, if that page has an address.
    for (from, to) in [
        ("/history?serial=S%201&lane=1", "/history?serial=S%201&lane=1"),
        ("/runs/1", "/runs/1"),
        ("/lanes/1/start", "/"),
        ("//evil.example/history", "/"),
        ("", "/"),
    ] {
        let page = format!("http://127.0.0.1:{}{from}", serving.port);
        let answer = here.post("/language", &[("language", "de")]).with("referer", &page).send();
        assert_eq!((answer.status, answer.headers["location"].as_str()), (303, to), "{from}");
    }
    assert_eq!(answer.headers["location"], "/");
}

/// A scan is for the lane that its own page names, whatever another page scans in between.
#[test]
fn two_pages_do_not_get_each_others_lanes() {
    let station = Station::private(2);
    let serving = station.serve();
    let [one, other] = [serving.here(), serving.here()];
    let scan = |browser: &crate::pages::station::Browser, text: &str, lane: &str| {
        let answer = browser
            .post("/scan", &[("text", text), ("lane", lane)])
            .with("accept", "application/json")
            .send();
        serde_json::from_str::<Value>(&answer.text()).unwrap()
    };
    scan(&one, "HR:LANE:1", "");
    scan(&other, "HR:LANE:2", "");
    assert_eq!(scan(&one, SERIALS[0], "1")["lane"], "1");
    assert_eq!(scan(&other, SERIALS[1], "2")["lane"], "2");
}

/// Who is logged in, plan and station, when a verdict was saved, and the day so far: all without a script.
#[test]
fn the_page_says_plan_station_and_operator_when_it_was_saved_and_the_day() {
    let station = Station::public(1);
    let serving = station.serve();
    let operator = serving.operator();
    operator.post("/scan", &[("text", SERIALS[0])]).until_taken();
    let page = operator.get("/").until("lane pass");
    assert!(page.contains("<b class=\"plans\">CAM-T quick 1</b> · Station <b>12</b>"), "{page}");
    assert!(page.contains("Weber <span class=\"role\">(operator)</span>"), "{page}");
    let (_, saved) = page.split_once("class=\"saved\"").unwrap();
    let (moment, rest) = saved.split_once("datetime=\"").unwrap().1.split_once('"').unwrap();
    let moment: jiff::Timestamp = moment.parse().unwrap();
    let ended: i64 = station.query("SELECT ended_ms FROM run")[0].parse().unwrap();
    let late = moment.as_millisecond() - ended;
    assert!((-1000..600_000).contains(&late), "saved {late} ms behind the run's end");
    let (_, text) = rest.split_once('>').unwrap();
    let shape: String =
        text.chars().take(16).map(|letter| if letter.is_ascii_digit() { '0' } else { letter }).collect();
    assert_eq!(shape, "0000-00-00 00:00");
    // One of one: the lower end of Wilson's interval is 1 / (1 + 1.96²).
    assert!(page.contains("1 for the first time · first pass 100.0 % (20.7–100.0) · errors 0"), "{page}");
    operator.post("/scan", &[("text", SERIALS[0])]).until_taken();
    let german = operator.get("/").with("accept-language", "de").until("): 2 beurteilt, davon 1 zum");
    assert!(german.contains("100,0 % (20,7–100,0)") && german.contains("(Bediener)"), "{german}");
}

#[test]
fn the_page_counts_what_is_not_at_the_plant_apart_from_what_another_sink_does_not_have() {
    let plant = plant_settings("postgres://halfrow@127.0.0.1:1/plant");
    let sink = "[[sink]]\nname = \"share\"\nfolder = \"nowhere\"\nformat = \"record\"";
    let station = Station::with(1, &format!("[web]\nlisten = \"127.0.0.1:0\"\n{plant}{sink}"));
    let serving = station.serve();
    serving.here().post("/scan", &[("text", SERIALS[0])]).until_taken();
    seen(&serving, "lane pass");
    let unsent = |of: &str| station.query(&format!("SELECT count(*) FROM outbox WHERE {of}")).remove(0);
    for control in ["sink = 'share'", "sink = 'plant' AND kind = 'audit'"] {
        assert_ne!(unsent(control), "0", "{control}");
    }
    let results = unsent("sink = 'plant' AND kind <> 'audit'");
    let others = unsent("sink = 'share' AND kind <> 'audit'");
    serving.here().get("/").until(&format!("not at the plant yet: {results} · still to be sent: {others}<"));
}

/// A request names the last beat that its page got. After that, another board may be in the lane.
#[test]
fn what_comes_long_after_the_beat_that_its_page_heard_is_not_done() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    let post = |path: &str, text: &str, beat: &str| {
        let request = here.post(path, &[("text", text), ("beat", beat)]).with("accept", "application/json");
        serde_json::from_str::<Value>(&request.send().text()).unwrap()
    };
    let beat = || Live::of(&serving).next().2["beat"].as_str().unwrap().to_owned();
    let old = beat();
    // A scan of the lane's barcode changes nothing here.
    until("a beat that is too old", || post("/scan", "HR:LANE:1", &old)["is_taken"] == false);
    let (_, milliseconds) = old.split_once('-').unwrap();
    for (beat, of) in
        [(old.as_str(), "old"), (&format!("1-{milliseconds}"), "of another start"), ("x", "none")]
    {
        for path in ["/scan", "/lanes/1/abort"] {
            let late = post(path, SERIALS[0], beat);
            assert_eq!(late["is_taken"], false, "{of}: {late}");
            assert!(late["said"].as_str().unwrap().contains("too late"), "{of}: {late}");
        }
    }
    assert_eq!(station.query("SELECT act FROM audit"), Vec::<String>::new());
    // With a recent beat, once the board is seen.
    until("a board that is seen", || post("/scan", SERIALS[0], &beat())["is_taken"] == true);
}

/// The page of the lanes, as soon as it contains `state`.
pub(super) fn seen(serving: &Serving, state: &str) -> String {
    serving.here().get("/").until(state)
}
