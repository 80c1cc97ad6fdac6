//! Whether a page says as much on paper, and to those who do not see it, as on a screen.

use serde_json::{Value, json};

use super::chromium::Chromium;
use crate::pages::station::{SERIALS, Serving, Station};

/// A station of three lanes after a FAIL in the first, and the run's id.
fn failed() -> (Station, Serving, String) {
    let station = Station::private(3).where_instead(
        "station.toml",
        "mock,serial=1\"",
        "mock,serial=1,fault=stuck-data\"",
    );
    let serving = station.serve();
    serving.here().scan(SERIALS[0], "1");
    let run = station.until_failed();
    (station, serving, run)
}

/// The browser with the page at `path`.
fn opened(page: &mut Chromium, serving: &Serving, path: &str) {
    let address = format!("http://127.0.0.1:{}{path}", serving.port);
    page.go(&address);
    page.wait(&format!("document.readyState === 'complete' && location.href === '{address}'"));
}

/// The names of everything in the page that has this role for those who do not see it, in alphabetical order.
fn named(page: &mut Chromium, role: &str) -> Vec<String> {
    let tree = page.call("Accessibility.getFullAXTree", json!({}));
    let nodes = tree["nodes"].as_array().unwrap().iter();
    let is_wanted = |node: &&Value| node["role"]["value"] == role && node["ignored"] == false;
    let name = |node: &Value| node["name"]["value"].as_str().unwrap_or_default().to_owned();
    let mut names: Vec<_> = nodes.filter(is_wanted).map(name).collect();
    names.sort_unstable();
    names
}

/// The form is not printed, and nothing else says of what the figures are.
#[test]
fn what_was_asked_for_is_on_paper() {
    let (_station, serving, _) = failed();
    let mut page = Chromium::open("about:blank");
    for (path, asked) in [
        (
            "/pareto?lane=1&from=2026-11-30",
            json!("Group by: Part suspected first · Lane: 1 · From (UTC): 2026-11-30"),
        ),
        (
            "/yield?by=day&product=CAM-T&plan=quick&until=2036-11-30",
            json!("Group by: Day · Product: CAM-T · Plan: quick · To (UTC, that day included): 2036-11-30"),
        ),
        (
            "/history?serial=CA1&verdict=FAIL&operator=weber",
            json!("Serial number: CA1 · Verdict: FAIL · Operator: weber"),
        ),
        ("/history", Value::Null),
    ] {
        opened(&mut page, &serving, path);
        let visible = "document.querySelector('.asked')?.checkVisibility() ?? null";
        let is_asked = !asked.is_null();
        page.call("Emulation.setEmulatedMedia", json!({ "media": "screen" }));
        assert_eq!(page.evaluate(visible), if is_asked { json!(false) } else { Value::Null }, "{path}");
        page.call("Emulation.setEmulatedMedia", json!({ "media": "print" }));
        assert_eq!(page.evaluate(visible), if is_asked { json!(true) } else { Value::Null }, "{path}");
        assert_eq!(page.evaluate("document.querySelector('.asked')?.innerText ?? null"), asked, "{path}");
    }
}

/// Up to 1280 pixels a run is a card, whose cells are as many as the table's columns.
#[test]
fn a_screen_reader_says_the_columns_of_cards() {
    let (_station, serving, _) = failed();
    let mut page = Chromium::open("about:blank");
    for width in [390, 1024, 1920] {
        let size = json!({ "width": width, "height": 844, "deviceScaleFactor": 1, "mobile": false });
        page.call("Emulation.setDeviceMetricsOverride", size);
        opened(&mut page, &serving, "/history");
        let columns = ["Began (UTC)", "Lane", "Operator", "Plan", "Result", "Serial number", "Verdict"];
        assert_eq!(named(&mut page, "columnheader"), columns, "{width}");
        let cells = "['lane', 'operator'].map(cell => document.querySelector(`.runs td.${cell}`).innerText)";
        let card = if width > 1280 { ["1", "weber"] } else { ["Lane 1", "Operator weber"] };
        assert_eq!(page.evaluate(cells), json!(card), "{width}");
    }
}

/// What is moved sideways is a stop of the keyboard.
#[test]
fn a_screen_reader_says_at_which_table_the_keyboard_is() {
    let (_station, serving, run) = failed();
    let mut page = Chromium::open("about:blank");
    for (path, names) in [
        (format!("/runs/{run}"), &["Checks, verify", "Measurements", "Steps"][..]),
        ("/yield?by=day".to_owned(), &["First pass: CAM-T quick", "Yield"]),
        ("/pareto".to_owned(), &["What fails most"]),
    ] {
        opened(&mut page, &serving, &path);
        assert_eq!(named(&mut page, "region"), names, "{path}");
        let stops = page.evaluate("document.querySelectorAll('[tabindex]').length");
        assert_eq!(stops, json!(names.len()), "{path}");
    }
}
