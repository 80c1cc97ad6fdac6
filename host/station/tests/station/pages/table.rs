//! Every route refuses everybody who may not use it. A new route without a row here fails the test.

use std::collections::BTreeSet;

use halfrow_station::web::{Who, routes};

use crate::pages::http::Request;
use crate::pages::station::{Browser, PUBLIC, Station};

/// A route: method, pattern, who may use it, a path that exists, and the fields of a valid form.
type Row = (&'static str, &'static str, Who, &'static str, &'static [(&'static str, &'static str)]);

const ROWS: [Row; 30] = [
    ("GET", "/assets/{name}", Who::Anyone, "/assets/style.css", &[]),
    ("GET", "/login", Who::Anyone, "/login", &[]),
    ("POST", "/login", Who::Anyone, "/login", &[("badge", "A-0017")]),
    ("POST", "/logout", Who::Anyone, "/logout", &[]),
    ("POST", "/language", Who::Anyone, "/language", &[("language", "de")]),
    ("GET", "/", Who::Reader, "/", &[]),
    ("GET", "/still", Who::Reader, "/still", &[]),
    ("GET", "/live", Who::Reader, "/live", &[]),
    ("GET", "/today", Who::Reader, "/today", &[]),
    ("GET", "/history", Who::Reader, "/history", &[]),
    ("GET", "/history.csv", Who::Reader, "/history.csv", &[]),
    ("GET", "/runs/{run}", Who::Reader, "/runs/1", &[]),
    ("GET", "/runs/{run}/export/{format}", Who::Reader, "/runs/1/export/csv", &[]),
    ("GET", "/runs/{run}/evidence/{hash}", Who::Reader, "/runs/1/evidence/2", &[]),
    ("GET", "/runs/{run}/preview/{hash}", Who::Reader, "/runs/1/preview/2", &[]),
    ("GET", "/runs/{run}/difference/{found}/{expected}", Who::Reader, "/runs/1/difference/2/3", &[]),
    ("GET", "/unit", Who::Reader, "/unit?serial=1", &[]),
    ("GET", "/yield", Who::Reader, "/yield", &[]),
    ("GET", "/pareto", Who::Reader, "/pareto", &[]),
    ("GET", "/outbox", Who::Reader, "/outbox", &[]),
    ("GET", "/metrics", Who::Reader, "/metrics", &[]),
    ("POST", "/outbox/{id}/release", Who::Engineer, "/outbox/1/release", &[("reason", "looked at")]),
    ("POST", "/scan", Who::Anyone, "/scan", &[("text", "A-0017")]),
    ("POST", "/lanes/{lane}/start", Who::Operator, "/lanes/1/start", &[]),
    ("POST", "/lanes/{lane}/abort", Who::Operator, "/lanes/1/abort", &[]),
    ("POST", "/lanes/{lane}/out", Who::Engineer, "/lanes/1/out", &[]),
    ("POST", "/lanes/{lane}/in", Who::Engineer, "/lanes/1/in", &[]),
    ("POST", "/runs/{run}/waive", Who::Engineer, "/runs/1/waive", &[("reason", "used as it is")]),
    ("POST", "/unit/rebind", Who::Engineer, "/unit/rebind", &[("serial", "1"), ("reason", "repaired")]),
    // Paths without a route are refused before anybody's rights are checked.
    ("GET", "", Who::Anyone, "/nothing/here", &[]),
];

/// The status codes of refusals.
const REFUSALS: [u16; 4] = [303, 401, 403, 421];

#[test]
fn every_route_has_a_row() {
    let known: BTreeSet<_> =
        ROWS.iter().filter(|row| !row.1.is_empty()).map(|row| (row.0.to_owned(), row.1, row.2)).collect();
    let there: BTreeSet<_> =
        routes().iter().map(|route| (route.method.to_string(), route.path, route.who)).collect();
    assert_eq!(known, there, "a route has no row in this table, or another one");
    for route in routes() {
        let changes = route.method == "POST";
        assert!(changes || route.method == "GET", "{route:?} is neither a page nor an act");
    }
}

fn status(request: &Request) -> u16 {
    request.send().status
}

/// The request of a row, sent by `browser`.
fn request(browser: &Browser, row: &Row) -> Request {
    if row.0 == "POST" { browser.post(row.3, row.4) } else { browser.get(row.3) }
}

#[test]
fn who_may_not_is_refused_at_every_route() {
    let station = Station::public(1);
    let serving = station.serve();
    let browsers = [serving.browser(PUBLIC), serving.operator(), serving.engineer()];
    let foreign = serving.browser(PUBLIC);
    for row in ROWS {
        let (who, what) = (row.2, format!("{} {}", row.0, row.3));
        let [stranger, operator, engineer] = browsers.each_ref().map(|browser| request(browser, &row));
        // The control: whoever may use the route is not refused.
        let right = match who {
            Who::Anyone => stranger.clone(),
            Who::Reader | Who::Operator => operator.clone(),
            Who::Engineer => engineer,
        };
        let other = right.clone().with("host", "evil.example").with("origin", "https://evil.example");
        assert_eq!(status(&other), 421, "{what} under another name");
        if who > Who::Anyone {
            let refused = stranger.send();
            // RFC 9110, section 15.5.2: with a challenge, so that a program knows that a token would do.
            let challenged = (refused.status, refused.header("www-authenticate"));
            assert_eq!(challenged, (401, Some("Bearer")), "{what} by a stranger");
        }
        if who == Who::Engineer {
            assert_eq!(status(&operator), 403, "{what} by an operator");
        }
        if row.0 == "POST" {
            refused_from_elsewhere(&right, request(&foreign, &row).body, &what);
        }
        let control = right.send();
        let is_done = row.0 == "POST" && control.status == 303;
        assert!(is_done || !REFUSALS.contains(&control.status), "{what}: {control:?}");
        assert!(control.headers["content-security-policy"].contains("default-src 'none'"));
        assert_eq!(control.headers["x-content-type-options"], "nosniff");
    }
}

/// An act that a page of another site makes a browser send, in each way in which it could.
fn refused_from_elsewhere(right: &Request, foreign: String, what: &str) {
    for origin in ["https://evil.example", "null", "http://station12.example"] {
        assert_eq!(status(&right.clone().with("origin", origin)), 403, "{what} from {origin}");
    }
    assert_eq!(status(&right.clone().without("origin")), 403, "{what} without an origin");
    let unmarked = Request { body: right.body.replace("csrf=", "crsf="), ..right.clone() };
    assert_eq!(status(&unmarked), 403, "{what} without its mark");
    assert_eq!(status(&Request { body: foreign, ..right.clone() }), 403, "{what} with another's mark");
}

#[test]
fn a_page_asked_for_by_a_stranger_leads_to_the_login() {
    let station = Station::public(1);
    let serving = station.serve();
    for (asked, login) in [
        ("/", "/login?page=%2F"),
        ("/unit?serial=CA01&plan=a+b", "/login?page=%2Funit%3Fserial%3DCA01%26plan%3Da%2Bb"),
    ] {
        let mut browser = serving.browser(PUBLIC);
        let answer = browser.get(asked).with("accept", "text/html").send();
        assert_eq!((answer.status, answer.header("location")), (303, Some(login)));
        let form = browser.get(login).send();
        browser.learn(&form);
        let page = format!("name=\"page\" value=\"{}\"", asked.replace('&', "&amp;"));
        assert!(form.text().contains(&page), "{}", form.text());
        let led = browser.post("/login", &[("page", asked), ("badge", "A-0017")]).send();
        assert_eq!((led.status, led.header("location")), (303, Some(asked)));
    }
}

/// A login page may be older than the browser's cookie, and a scanner cannot load it again.
#[test]
fn a_login_that_was_made_for_another_cookie_is_answered_with_a_form_that_logs_in() {
    let station = Station::public(1);
    let serving = station.serve();
    let other = serving.browser(PUBLIC).cookie;
    for cookie in [other, String::new()] {
        let mut browser = serving.browser(PUBLIC);
        browser.cookie = cookie;
        let login = |browser: &Browser| browser.post("/login", &[("badge", "A-0017")]).send();
        let refused = login(&browser);
        assert!(refused.status == 403 && refused.text().contains("name=\"badge\""), "{refused:?}");
        browser.learn(&refused);
        assert_eq!(login(&browser).status, 303, "{refused:?}");
    }
}

/// A page that an act has answered is asked for again by its address, as by Enter in the address bar.
#[test]
fn whoever_looks_where_acts_are_sent_is_led_to_the_page_with_their_form() {
    let station = Station::public(1);
    let serving = station.serve();
    let operator = serving.operator();
    let looks: Vec<_> = ROWS.iter().filter(|row| row.0 == "GET").map(|row| row.3).collect();
    for row in ROWS.iter().filter(|row| row.0 == "POST" && !looks.contains(&row.3)) {
        for method in ["GET", "HEAD"] {
            let answer = Request { method: method.to_owned(), ..operator.get(row.3) }.send();
            let led = (answer.status, answer.header("location"));
            let page = match row.3 {
                "/runs/1/waive" => "/runs/1",
                "/outbox/1/release" => "/outbox",
                "/unit/rebind" => "/unit",
                _ => "/",
            };
            assert_eq!(led, (303, Some(page)), "{method} {}", row.3);
        }
        let put = Request { method: "PUT".to_owned(), ..operator.get(row.3) };
        assert_eq!(status(&put), 403, "PUT {}", row.3);
    }
    let acted = "act IN ('abort', 'lane', 'scan', 'waive', 'rebind')";
    assert_eq!(station.query(&format!("SELECT count(*) FROM audit WHERE {acted}")), ["0"]);
}

/// A machine with a token sees every page that an operator sees, and may change nothing; an invalid token opens nothing.
#[test]
fn a_token_reads_every_page_and_does_nothing() {
    let station = Station::public(1);
    let token = String::from_utf8(station.token(&["add", "mes", "--scope", "read"]).stdout).unwrap();
    let serving = station.serve();
    let (stranger, operator) = (serving.browser(PUBLIC), serving.operator());
    let with = |request: Request, token: &str| request.with("authorization", &format!("Bearer {token}"));
    for row in ROWS.iter().filter(|row| row.2 < Who::Engineer || row.0 == "POST") {
        let what = format!("{} {}", row.0, row.3);
        let bare = request(&stranger, row).without("cookie");
        let answer = with(bare, token.trim()).send();
        if row.0 == "GET" {
            let seen = status(&request(&operator, row));
            assert_eq!(answer.status, seen, "{what}");
            assert_eq!(answer.header("set-cookie"), None, "{what}: a machine has no cookie");
        } else {
            assert_eq!(answer.status, 403, "{what}");
            // An operator's cookie in the same request does not help.
            assert_eq!(status(&with(request(&operator, row), token.trim())), 403, "{what}");
        }
    }
    assert_eq!(
        station
            .query("SELECT operator_id || ' ' || act || ' ' || subject FROM audit WHERE act LIKE 'token%'"),
        ["mes token 127.0.0.1"]
    );
    assert!(station.token(&["remove", "mes"]).status.success());
    assert_eq!(
        status(&with(operator.get("/history"), token.trim())),
        401,
        "whatever was removed opens nothing"
    );
}
