//! Whether what is shown is legible.

use std::time::Duration;

use serde_json::json;

use super::chromium::Chromium;
use crate::pages::station::{SERIALS, Station};

/// WCAG 2.1, success criterion 1.4.3.
const LEAST: f64 = 4.5;

/// The least contrast between a text and its background, and where it is, with the lane in each state.
const CONTRAST: &str = "(() => {
    const light = ([r, g, b]) => {
        const [x, y, z] = [r, g, b].map(c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
        return 0.2126 * x + 0.7152 * y + 0.0722 * z;
    };
    const numbers = colour => colour.match(/[\\d.]+/g).map(Number);
    const ground = element => {
        for (let at = element; at; at = at.parentElement) {
            const colour = numbers(getComputedStyle(at).backgroundColor);
            if (colour.length < 4 || colour[3] === 1) return colour;
        }
        return [255, 255, 255];
    };
    let least = {ratio: 99, looked: 0};
    const lane = document.querySelector('.lane');
    const states = ['empty', 'ready', 'waiting', 'running', 'saving', 'pass', 'fail', 'error', 'unsaved', 'out'];
    document.getElementById('answer').textContent = 'said';
    for (const state of states) for (const answer of ['taken', 'refused']) for (const dead of [false, true]) {
        document.body.classList.toggle('dead', dead);
        document.getElementById('answer').className = `answer ${answer}`;
        lane.className = `lane ${state}`;
        for (const element of document.querySelectorAll('body *')) {
            const texts = [...element.childNodes].filter(node => node.nodeType === 3 && node.data.trim());
            if (!texts.length || !element.checkVisibility() || element.closest('.heard')) continue;
            const [one, other] = [light(numbers(getComputedStyle(element).color)), light(ground(element))].sort((a, b) => b - a);
            const ratio = (one + 0.05) / (other + 0.05);
            least.looked += 1;
            if (ratio < least.ratio) Object.assign(least, {ratio, where: `${state} ${element.tagName}.${element.className}`});
        }
    }
    return least;
})()";

#[test]
fn every_text_can_be_told_from_what_is_behind_it() {
    let station = Station::private(2);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    for scheme in ["light", "dark"] {
        let media = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        page.call("Emulation.setEmulatedMedia", media);
        let least = page.evaluate(CONTRAST);
        println!("{scheme}: {least}");
        assert!(least["looked"].as_u64().unwrap() > 200, "{least}");
        assert!(least["ratio"].as_f64().unwrap() >= LEAST, "{scheme}: {least}");
    }
}

/// With one lane its word fills the screen; with sixteen, each word is legible from three metres: 4 % of the height.
#[test]
fn words_are_large_and_nothing_lies_upon_another() {
    for (lanes, is_long) in [(1, false), (4, false), (16, false), (4, true), (16, true)] {
        let mut station = Station::private(lanes);
        // The longest name that settings allow.
        for lane in (1..=lanes).filter(|_| is_long) {
            let (was, is) = (format!("name = \"{lane}\""), format!("name = \"north-fixture-{lane:02}\""));
            station = station.where_instead("station.toml", &was, &is);
        }
        let serving = station.serve();
        let mut page = Chromium::open(&format!("http://127.0.0.1:{}/", serving.port));
        for (width, height, is_phone) in [(1280, 720, false), (390, 844, true)] {
            let size =
                json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": is_phone });
            page.call("Emulation.setDeviceMetricsOverride", size);
            page.wait("document.getElementById('lamp')?.textContent === 'live' && document.querySelector('.lane.ready') !== null");
            let word =
                page.evaluate("parseFloat(getComputedStyle(document.querySelector('.word')).fontSize)");
            let least = if lanes == 1 { 0.12 } else { 0.04 };
            let word = word.as_f64().unwrap();
            assert!(is_phone || word >= least * f64::from(height), "{lanes} lanes: {word} px");
            let wide = page.evaluate("document.documentElement.scrollWidth > innerWidth");
            assert_eq!(wide, json!(false), "{lanes} lanes at {width}");
            let over = page.evaluate(OVER);
            assert_eq!(over, json!([]), "{lanes} lanes at {width}, {is_long}");
        }
    }
}

/// The findings are the last column of a run's tables.
#[test]
fn what_was_found_can_be_read_on_a_phone() {
    let station =
        Station::private(1).where_instead("station.toml", "mock,serial=1", "mock,serial=1,fault=stuck-data");
    let station = station.where_instead("plan.toml", "not-checked", "if-present");
    let serving = station.serve();
    let mut page = Chromium::open(&format!("http://127.0.0.1:{}/", serving.port));
    page.wait("document.querySelector('.lane.ready') !== null && document.getElementById('lamp').textContent === 'live'");
    page.scan(SERIALS[0], "Enter", Duration::ZERO);
    page.wait("document.querySelector('.lane.fail') !== null");
    let run = page.evaluate("document.querySelector('.lane').dataset.run");
    let size = json!({ "width": 400, "height": 844, "deviceScaleFactor": 1, "mobile": true });
    page.call("Emulation.setDeviceMetricsOverride", size);
    page.go(&format!("http://127.0.0.1:{}/runs/{}", serving.port, run.as_str().unwrap()));
    page.wait(
        "document.readyState === 'complete' && document.querySelectorAll('.steps tr, .checks tr').length > 1",
    );
    let narrowest = page.evaluate(
        "Math.min(...[...document.querySelectorAll('.steps tr, .checks tr')].map(row => row.lastElementChild.clientWidth))",
    );
    assert!(narrowest.as_f64().unwrap() > 200.0, "{narrowest} px of 400");
    let lines = page.evaluate(LINES);
    assert!(lines.as_array().unwrap().len() > 4, "{lines}");
    assert!(lines.as_array().unwrap().iter().all(|lines| lines == 1), "{lines}");
    assert_eq!(page.evaluate("document.documentElement.scrollWidth > innerWidth"), json!(false));
    for (path, table, widths) in [
        (format!("/unit?serial={}", SERIALS[0]), ".bindings", &[390][..]),
        ("/history".to_owned(), ".runs", &[390, 721, 800, 1280]),
    ] {
        page.go(&format!("http://127.0.0.1:{}{path}", serving.port));
        page.wait(&format!(
            "document.readyState === 'complete' && document.querySelector('{table}') !== null"
        ));
        // A headline may name a serial number that has no place to break.
        page.evaluate("document.querySelectorAll('.headline').forEach(one => one.append('W'.repeat(200)))");
        for width in widths {
            let size = json!({ "width": width, "height": 844, "deviceScaleFactor": 1, "mobile": false });
            page.call("Emulation.setDeviceMetricsOverride", size);
            let wide = page.evaluate("document.documentElement.scrollWidth > innerWidth");
            assert_eq!(wide, json!(false), "{path} at {width}");
        }
    }
}

/// In how many lines each measurement's name, and each value with its unit, is written.
const LINES: &str =
    "[...document.querySelectorAll('.measurements th code, .measurements td.number')].map(one => {
    const text = document.createRange();
    text.selectNodeContents(one);
    return new Set([...text.getClientRects()].map(line => Math.round(line.top))).size;
})";

/// Parts of a lane, in every state, that overlap each other or extend beyond the lane.
const OVER: &str = "(() => {
    const found = [];
    const long = 'a headline that says at some length what was found in which row and what is to be done about it';
    const lane = document.querySelector('.lane');
    const [before, state] = [lane.innerHTML, lane.className];
    for (const state of ['ready', 'running', 'pass', 'error']) {
        lane.className = `lane ${state} ${state === 'running' ? 'middle' : 'short'}`;
        const more = state === 'running' ? '<p class=doing>rows</p><progress></progress>' : `<p class=why>${long}</p>`;
        lane.innerHTML = before + (['ready', 'pass'].includes(state) ? '' : more);
        lane.querySelector('.acts').innerHTML = '<form class=act><button id=out>out</button></form>';
        const saved = ['ready', 'running'].includes(state) ? '' : '<p class=saved><span>gesichert</span> <time>2026-11-30 14:02</time></p>';
        lane.querySelector('header').insertAdjacentHTML('beforeend', saved);
        lane.querySelector('.word span').textContent = state.toUpperCase();
        const serial = lane.querySelector('.serial');
        if (state === 'ready') serial.outerHTML = '<p class=last><a href=/>zuletzt: SCHLECHT CA080442957X</a></p>';
        else serial.textContent = 'CA080442957X';
        const boxes = of => [...of].filter(part => part.checkVisibility()).map(part => [part, part.getBoundingClientRect()]);
        const parts = boxes(lane.children), all = lane.getBoundingClientRect();
        const head = boxes(lane.querySelectorAll('.name, header button:not(.name), .saved'));
        for (const [part, box] of head) {
            const isCut = part.scrollWidth > part.clientWidth + 1 || box.right > all.right || box.bottom > parts[0][1].bottom + 1;
            if (isCut) found.push(`${state}: ${part.className} ${part.id} is cut off`);
            for (const [other, its] of head.filter(([other]) => other !== part)) {
                const isClear = its.right <= box.left || its.left >= box.right || its.bottom <= box.top + 1 || its.top >= box.bottom - 1;
                if (!isClear) found.push(`${state}: ${part.className} on ${other.className}`);
            }
        }
        for (const [i, [part, box]] of parts.entries()) {
            if (box.bottom > all.bottom + 1) found.push(`${state}: ${part.className} stands out`);
            const next = parts[i + 1];
            if (next && next[1].top < box.bottom - 1) found.push(`${state}: ${next[0].className} on ${part.className}`);
        }
    }
    [lane.innerHTML, lane.className] = [before, state];
    return found;
})()";
