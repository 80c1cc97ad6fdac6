//! Badges, passwords, cookies, and where pages may be served.

use std::fs;
use std::io::Write as _;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Command;
use std::thread;

use crate::common::{Did, held_up, program};
use crate::pages::http::{Request, exchange};
use crate::pages::station::{Browser, PUBLIC, SERIALS, Station};

#[test]
fn what_others_can_reach_needs_people() {
    let open = Station::with(1, "[web]\nlisten = \"0.0.0.0:0\"");
    let said = open.refused();
    assert!(said.contains("station.toml:6:") && said.contains("nobody logs in"), "{said}");
    for proxied in
        ["public = \"https://station12.example\"", "public = \"http://station12\"", "hosts = [\"station12\"]"]
    {
        let said = Station::with(1, &format!("[web]\n{proxied}")).refused();
        assert!(said.contains("nobody logs in"), "{proxied}: {said}");
    }
    for listen in ["0.0.0.0:0", "[::]:0"] {
        let settings = format!("[web]\nlisten = \"{listen}\"\n[access]\nusers = \"users.toml\"");
        let said = Station::with(1, &settings).refused();
        assert!(said.contains("station.toml:6:") && said.contains("write `hosts`"), "{listen}: {said}");
    }
    let people = Station::public(1);
    fs::set_permissions(people.path("users.toml"), fs::Permissions::from_mode(0o644)).unwrap();
    assert!(people.refused().contains("chmod 600"));
    fs::remove_file(people.path("users.toml")).unwrap();
    assert!(people.refused().contains("users.toml cannot be read"));
}

/// Nothing can be written, as on a full disk.
#[test]
fn a_key_that_cannot_be_written_is_drawn_when_it_can() {
    let station = Station::with(1, "[access]\nusers = \"users.toml\"");
    let mut full = Command::new("sh");
    full.args(["-c", "ulimit -f 0; echo A-0017 | \"$0\" user add Weber --settings \"$1\""]);
    let refused: Did = full.arg(program()).arg(station.path("station.toml")).output().unwrap().into();
    assert!(refused.code == Some(2) && refused.complained.contains("station.key"), "{refused:?}");
    let added: Did = station.user(&["add", "Weber"], "A-0017\n").into();
    assert_eq!(added.code, Some(0), "{added:?}");
}

#[test]
fn a_badge_logs_in_and_nobody_may_guess_for_long() {
    let station = Station::public(1);
    let serving = station.serve();
    let browser = serving.browser(PUBLIC);
    for wrong in 0..10 {
        let guess = format!("A-1{wrong:03}");
        let refused = browser.post("/login", &[("badge", &guess)]).send();
        // A scanner has no way back.
        assert!(refused.status == 403 && refused.text().contains("name=\"badge\""), "{guess}: {refused:?}");
    }
    let right = browser.post("/login", &[("badge", "A-0017")]).send();
    let is_asked = right.text().contains("name=\"badge\"");
    assert_eq!((right.status, is_asked), (429, true), "the eleventh waits, even if it is right");
    assert_eq!(station.query("SELECT act FROM audit"), ["login refused"; 10]);
}

#[test]
fn a_token_is_told_once_and_nobody_may_guess_for_long() {
    let station = Station::public(1);
    let add = |name: &str| -> Did { station.token(&["add", name, "--scope", "read"]).into() };
    let added = add("mes");
    let token = added.said.trim();
    assert!(token.len() == 64 && token.bytes().all(|digit| digit.is_ascii_hexdigit()), "{added:?}");
    let file = station.path("tokens.toml");
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o600);
    assert!(!fs::read_to_string(&file).unwrap().contains(token));
    assert_eq!(add("mes").code, Some(2), "a name is one machine's");
    let listed: Did = station.token(&["list"]).into();
    assert_eq!(listed.said.trim(), "read  mes");
    let no_jobs: Did = station.token(&["add", "line", "--scope", "jobs"]).into();
    assert_eq!(no_jobs.code, Some(2), "{no_jobs:?}");
    let serving = station.serve();
    let ask = |token: &str| {
        let request = Request::bare(serving.port, "GET", "/history").with("host", PUBLIC);
        request.with("authorization", &format!("Bearer {token}")).send()
    };
    for wrong in 0..10 {
        let answer = ask(&format!("{wrong:064x}"));
        assert_eq!((answer.status, answer.header("www-authenticate")), (401, Some("Bearer")), "{wrong}");
    }
    assert_eq!(ask(&"0".repeat(64)).status, 429, "the eleventh waits");
    assert_eq!(station.query("SELECT act FROM audit"), ["token refused"; 10]);
    assert_eq!(ask(token).status, 200, "nobody guesses what is right");
    // Behind a proxy all clients have one address, but people can still log in.
    assert_eq!(serving.operator().get("/").send().status, 200);
    drop(serving);
    fs::set_permissions(&file, fs::Permissions::from_mode(0o644)).unwrap();
    assert!(station.refused().contains("chmod 600"));
}

#[test]
fn a_cookie_is_the_browsers_alone_and_ends_with_its_owner() {
    let station = Station::public(1);
    let serving = station.serve();
    let given = serving.browser(PUBLIC).get("/login").without("cookie").send().headers["set-cookie"].clone();
    for part in ["__Host-halfrow-", "HttpOnly", "SameSite=Lax", "Secure", "Path=/"] {
        assert!(given.contains(part), "{given}");
    }
    let (operator, before) = (serving.operator(), serving.browser(PUBLIC));
    assert_ne!(operator.cookie, before.cookie, "logging in draws another one");
    assert_eq!(operator.get("/").send().status, 200);
    assert!(station.user(&["remove", "Weber"], "").status.success());
    assert_eq!(operator.get("/").send().status, 401, "whoever was removed is logged out");
    let engineer = serving.engineer();
    assert_eq!(engineer.post("/logout", &[]).send().status, 303);
    assert_eq!(engineer.get("/").send().status, 401);
}

#[test]
fn whoever_is_added_anew_logs_in_anew_with_what_is_another() {
    let station = Station::public(1);
    let serving = station.serve();
    let (operator, engineer) = (serving.operator(), serving.engineer());
    let braun = serving.logged_in("B-0022", "");
    let anew = |name: &str, role: &str, said: &str| {
        assert!(station.user(&["remove", name], "").status.success());
        assert!(station.user(&["add", name, "--role", role], said).status.success());
    };
    anew("Weber", "operator", "A-0099\n");
    assert_eq!(operator.get("/").send().status, 401, "the badge is another");
    anew("Braun", "engineer", "B-0022\nanother horse\n");
    assert_eq!(engineer.get("/").send().status, 401, "the password is another");
    assert_eq!(braun.get("/").send().status, 200, "the badge is the same");
    // A station that is started again knows it, too.
    let [weber, braun] = ["A-0099", "B-0022"].map(|badge| serving.logged_in(badge, ""));
    anew("Weber", "operator", "A-0017\n");
    drop(serving);
    let again = station.serve();
    let asks = |browser: &Browser| {
        let (_, session) = browser.cookie.split_once('=').unwrap();
        // The cookie's name contains the port.
        let cookie = format!("__Host-halfrow-{}={session}", again.port);
        again.browser(PUBLIC).get("/").with("cookie", &cookie).send().status
    };
    assert_eq!((asks(&weber), asks(&braun)), (401, 200));
}

#[test]
fn people_who_cannot_be_read_stay_logged_in_and_are_told() {
    let station = Station::public(1);
    let serving = station.serve();
    let (operator, stranger) = (serving.operator(), serving.browser(PUBLIC));
    let (file, people) = (station.path("users.toml"), fs::read(station.path("users.toml")).unwrap());
    fs::write(&file, "no table").unwrap();
    for answer in [
        operator.get("/").send(),
        operator.get("/").with("accept", "text/html").send(),
        operator.post("/lanes/1/abort", &[]).send(),
        stranger.post("/login", &[("badge", "A-0017")]).send(),
    ] {
        assert!(answer.status == 503 && answer.text().contains("users.toml"), "{answer:?}");
    }
    fs::write(&file, people).unwrap();
    assert_eq!(operator.get("/").send().status, 200);
}

/// The first request may come from a link on another site, without the cookie that browsers withhold then.
#[test]
fn a_link_from_elsewhere_leads_to_a_page_that_logs_in() {
    let station = Station::public(1);
    let serving = station.serve();
    let mut browser = serving.browser(PUBLIC);
    browser.cookie = String::new();
    browser.learn(&browser.get("/login").with("sec-fetch-site", "cross-site").send());
    assert_eq!(browser.post("/login", &[("badge", "A-0017")]).send().status, 303);
}

/// A station used at its own computer, with user accounts and only a scanner.
#[test]
fn a_badge_is_scanned_into_the_page_that_nobody_is_logged_in_on() {
    let more = "[web]\nlisten = \"127.0.0.1:0\"\n[access]\nusers = \"users.toml\"";
    let station = Station::with(1, more);
    assert!(station.user(&["add", "Weber"], "A-0017\n").status.success());
    let serving = station.serve();
    let mut browser = serving.here();
    let page = browser.get("/").with("accept", "text/html").send().text();
    assert!(page.contains("id=\"hand\"") && page.contains("href=\"/login\""), "{page}");
    let scan = |browser: &Browser, text: &str| {
        browser.post("/scan", &[("text", text), ("typed", "true")]).with("accept", "application/json").send()
    };
    let number = scan(&browser, SERIALS[0]);
    assert_eq!(number.status, 401, "{number:?}");
    assert!(number.text().contains("Log in first"), "{number:?}");
    let badge = scan(&browser, "A-0017");
    assert!(badge.text().contains("Weber tests from now on"), "{badge:?}");
    let stranger = serving.here();
    browser.learn(&badge);
    browser.learn(&browser.get("/").send());
    assert!(scan(&browser, SERIALS[0]).text().contains("\"is_taken\":true"));
    // A scan that is no badge counts, as it does at the login.
    for wrong in 1..10 {
        assert_eq!(scan(&stranger, &format!("A-1{wrong:03}")).status, 401, "{wrong}");
    }
    assert_eq!(scan(&stranger, "A-0017").status, 429, "the eleventh waits, even if it is right");
    let refused = station.query("SELECT act FROM audit WHERE act = 'login refused'");
    assert_eq!(refused.len(), 10);
    assert!(!scan(&browser, SERIALS[1]).text().contains("Too many"), "whoever tests goes on");
}

/// A proxy that forwards the requests of others as if they came from this computer.
#[test]
fn a_station_whose_pages_are_open_takes_nothing_from_a_proxy() {
    let public = Station::public(1);
    let listed =
        Station::public(1).where_instead("station.toml", &format!("public = \"https://{PUBLIC}\""), "");
    for station in [Station::private(1), listed] {
        let serving = station.serve();
        let get = || serving.here().get("/");
        assert_eq!(get().send().status, 200);
        for name in ["Forwarded", "Via", "X-Real-IP", "X-Forwarded-For"] {
            let answer = get().with(name, "192.0.2.2").send();
            assert!(answer.status == 421 && answer.text().contains("public"), "{name}: {answer:?}");
        }
    }
    // The control: where the settings name the address of the proxy and people log in, requests through it are fine.
    let behind = public.serve();
    assert_eq!(behind.operator().get("/").with("X-Forwarded-For", "192.0.2.2").send().status, 200);
}

#[test]
fn what_is_tested_here_is_told_to_nobody_who_may_not_look() {
    let station = Station::public(1);
    let serving = station.serve();
    let foreign = serving.browser(PUBLIC).get("/login").with("host", "evil.example").send();
    assert!(foreign.status == 421 && !foreign.text().contains("CAM-T"), "{foreign:?}");
    for page in ["/login", "/nothing/here"] {
        let stranger = serving.browser(PUBLIC).get(page).send().text();
        assert!(stranger.contains("<html") && !stranger.contains("CAM-T"), "{stranger}");
        // The control.
        assert!(serving.operator().get(page).send().text().contains("CAM-T"), "{page}");
    }
}

/// The scan may be a badge, and the news may be read by a machine.
#[test]
fn what_somebody_scans_is_told_to_nobody_else() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    let mut news = here.get("/live").lines();
    assert!(news.any(|line| line == "event: snapshot"));
    assert_eq!(here.post("/scan", &[("text", "BADGE-OF-A-DOOR"), ("typed", "true")]).send().status, 200);
    assert!(news.any(|line| line == "event: scan"));
    assert_eq!(news.next().as_deref(), Some(r#"data: {"is_taken":false,"lane":null}"#));
}

/// A browser that several people share has it in its cache, and only asks whether it changed.
#[test]
fn what_never_changes_is_shown_from_no_cache_to_whoever_has_logged_out() {
    let station = Station::public(1);
    let serving = station.serve();
    let browser = serving.operator();
    let known = browser.get("/runs/1/evidence/1").with("if-none-match", "\"1\"");
    assert_eq!(known.send().status, 304);
    // The control: the run does not exist, so nothing could be sent.
    assert_eq!(known.clone().without("if-none-match").send().status, 404);
    assert_eq!(browser.post("/logout", &[]).send().status, 303);
    assert_eq!(known.send().status, 401);
}

/// Another program may write an export and draw a picture differently.
#[test]
fn what_this_program_makes_of_a_run_is_not_what_an_earlier_one_made() {
    let station = Station::public(1);
    let serving = station.serve();
    let browser = serving.operator();
    let own = format!("\"{}\"", halfrow::result::sha256([halfrow::VERSION]));
    for path in ["/runs/1/export/csv", "/runs/1/preview/1", "/runs/1/difference/1/2"] {
        let asked = |tag: &str| browser.get(path).with("if-none-match", tag).send();
        // The run does not exist, so nothing could be sent.
        assert_eq!(asked("\"1\"").status, 404, "{path}");
        let known = asked(&own);
        assert_eq!((known.status, known.header("etag")), (304, Some(own.as_str())), "{path}");
    }
}

#[test]
fn the_badge_of_another_operator_is_no_scan() {
    let station = Station::public(1);
    let serving = station.serve();
    let mut browser = serving.operator();
    let answer = browser.post("/scan", &[("text", "B-0022")]).with("accept", "application/json").send();
    let said = answer.text();
    assert!(said.contains("Braun tests from now on") && !said.contains("B-0022"), "{said}");
    browser.learn(&answer);
    browser.learn(&browser.get("/").send());
    let out = browser.post("/lanes/1/out", &[]).send();
    assert_eq!(out.status, 403, "without the password an engineer is an operator");
    let scan = browser.post("/scan", &[("text", SERIALS[0])]).with("accept", "application/json").send();
    assert!(scan.text().contains("\"is_taken\":true"), "{scan:?}");
    assert_eq!(
        station.query("SELECT operator_id || ' ' || act || ' ' || detail FROM audit ORDER BY id"),
        ["Weber login ", "Braun login ", &format!("Braun scan {}", SERIALS[0])]
    );
}

/// The text may be a badge that this station does not know.
#[test]
fn what_no_plan_takes_is_kept_by_its_length_alone() {
    let station = Station::public(1);
    let serving = station.serve();
    let operator = serving.operator();
    for text in ["A-1234", "HR:START", SERIALS[0]] {
        operator.post("/scan", &[("text", text)]).with("accept", "application/json").send();
    }
    let scans = station.query("SELECT detail FROM audit WHERE act = 'scan' ORDER BY id");
    assert_eq!(scans, ["6 characters", "HR:START", SERIALS[0]]);
}

#[test]
fn nobody_sends_more_than_a_form_and_nobody_holds_a_place_for_long() {
    let station = Station::private(1);
    let mut serving = station.serve();
    let here = serving.here();
    let large = here.post("/scan", &[("text", &"x".repeat(70_000))]).send();
    assert_eq!(large.status, 413);
    // RFC 9112, section 6.3: two lengths, or a length together with chunks, may be read in two ways.
    let host = format!("host: 127.0.0.1:{}\r\n", serving.port);
    for lengths in [
        "content-length: 3\r\ncontent-length: 5\r\n",
        "content-length: 3\r\ntransfer-encoding: chunked, identity\r\n",
    ] {
        let text =
            format!("POST /scan HTTP/1.1\r\n{host}{lengths}\r\n0\r\n\r\nGET /smuggled HTTP/1.1\r\n\r\n");
        let status = exchange(serving.port, text.as_bytes()).ok().map(|answer| answer.status);
        assert!(status.is_none_or(|status| status == 400), "{lengths}: {status:?}");
    }
    let two_hosts = here.get("/");
    let two = Request {
        headers: [two_hosts.headers.clone(), vec![("host".to_owned(), "evil.example".to_owned())]].concat(),
        ..two_hosts
    };
    assert_eq!(two.send().status, 421);
    assert!(serving.is_alive());
}

/// The file is on a slow network share, for example.
#[test]
fn a_file_that_says_who_may_enter_holds_up_those_alone_who_are_in_it() {
    let station = Station::public(1);
    let serving = station.serve();
    let operator = serving.operator().get("/");
    let machine = Request::bare(serving.port, "GET", "/history").with("host", PUBLIC);
    let machine = machine.with("authorization", &format!("Bearer {}", "0".repeat(64)));
    for (name, asked, status) in [("users.toml", operator, 200), ("tokens.toml", machine, 401)] {
        let path = station.path(name);
        let people = fs::read(&path).unwrap_or_default();
        let _ = fs::remove_file(&path);
        assert!(Command::new("mkfifo").args(["-m", "600"]).arg(&path).status().unwrap().success());
        let waits = thread::spawn(move || asked.send());
        let mut held = held_up(&path);
        let stranger = Request::bare(serving.port, "GET", "/login").with("host", PUBLIC);
        assert_eq!(stranger.send().status, 200, "{name}");
        held.write_all(&people).unwrap();
        drop(held);
        assert_eq!(waits.join().unwrap().status, status, "{name}");
        fs::remove_file(&path).unwrap();
        fs::write(&path, people).unwrap();
    }
}
