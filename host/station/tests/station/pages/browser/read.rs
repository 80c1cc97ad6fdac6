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
    serving.here().post("/scan", &[("text", SERIALS[0]), ("lane", "1")]).until_taken();
    let run = station.until_failed();
    (station, serving, run)
}

/// The browser with the page at `path`.
fn opened(page: &mut Chromium, serving: &Serving, path: &str) {
    let address = format!("http://127.0.0.1:{}{path}", serving.port);
    page.go(&address);
    page.wait(&format!("document.readyState === 'complete' && location.href === '{address}'"));
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
