//! axe-core's rules for accessibility, on every page.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::json;

use super::chromium::Chromium;
use crate::pages::station::{SERIALS, Station};

/// From npm, as published; not part of the program.
const AXE: &str = "axe-core@4.14.1";
/// SHA-256 of its `axe.min.js`.
const SHA256: &str = "29348999450cdf2849a8e70b7912fc2da85a849da39c0d0d5394f51d4a9ed95c";

/// The script with the rules; npm fetches it if it is not there.
fn axe() -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("axe-core-4.14.1");
    let file = folder.join("package/axe.min.js");
    if !file.exists() {
        fs::create_dir_all(&folder).unwrap();
        let bring = ["pack", "--silent", AXE, "--pack-destination", "."];
        assert!(Command::new("npm").args(bring).current_dir(&folder).status().unwrap().success());
        let unpack = ["xzf", "axe-core-4.14.1.tgz"];
        assert!(Command::new("tar").args(unpack).current_dir(&folder).status().unwrap().success());
    }
    let text = fs::read_to_string(&file).unwrap();
    assert_eq!(halfrow::result::sha256([text.as_bytes()]), SHA256, "another axe-core than was looked at");
    text
}

/// What is violated, and where.
const RUN: &str = "axe.run(document, {resultTypes: ['violations']}).then(found =>
    found.violations.map(one => `${one.id}: ${one.nodes.map(node => node.target.join(' ')).join(', ')}`))";

/// Adds the violations of the page at `path`, in every language, light and dark.
fn violations(page: &mut Chromium, axe: &str, own: &str, path: &str, found: &mut Vec<String>) {
    for language in ["en", "de", "zh"] {
        let cookie = json!({ "url": own, "name": "halfrow-language", "value": language });
        page.call("Network.setCookie", cookie);
        for scheme in ["light", "dark"] {
            let media = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
            page.call("Emulation.setEmulatedMedia", media);
            page.go(&format!("{own}{path}"));
            page.wait(&format!(
                "document.readyState === 'complete' && document.documentElement.lang === '{language}'"
            ));
            page.evaluate(&format!("{axe}; true"));
            let violated = page.evaluate(RUN);
            let violated = violated.as_array().unwrap().iter().filter_map(|one| one.as_str());
            found.extend(violated.map(|one| format!("{path} {language} {scheme}: {one}")));
        }
    }
}

#[test]
#[ignore = "for scripts/soak: needs axe-core from npm"]
fn no_page_violates_a_rule_of_axe() {
    let (axe, mut found) = (axe(), Vec::new());
    for lanes in [1, 4, 16] {
        let station = Station::private(lanes).where_instead(
            "station.toml",
            "mock,serial=1\"",
            "mock,serial=1,fault=stuck-data\"",
        );
        let serving = station.serve();
        let (here, own) = (serving.here(), format!("http://127.0.0.1:{}", serving.port));
        here.scan(SERIALS[0], "1");
        let failed = station.until_failed();
        let mut page = Chromium::open(&format!("{own}/"));
        violations(&mut page, &axe, &own, "/", &mut found);
        if lanes == 1 {
            let (run, unit) = (format!("/runs/{failed}"), format!("/unit?serial={}", SERIALS[0]));
            for path in ["/login", "/history", &run, &unit, "/yield", "/yield?by=day", "/pareto", "/nothing"]
            {
                violations(&mut page, &axe, &own, path, &mut found);
            }
            // The control: an image without a text for those who cannot see it.
            let unseen = "document.querySelector('main').append(Object.assign(new Image(), {src: '/x'}))";
            page.evaluate(&format!("{unseen}, true"));
            assert!(page.evaluate(RUN).to_string().contains("image-alt"));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
