//! Whether an operator learns what to do: on the screen, read aloud, without scripts, on paper.

use std::time::Duration;

use serde_json::{Value, json};

use super::chromium::Chromium;
use crate::common::until;
use crate::pages::station::{SERIALS, Serving, Station};

/// A station of `lanes` lanes. The third has a board that cannot be reached, the sixth a button.
fn station(lanes: usize) -> Station {
    let six = "board = \"mock,serial=6\"";
    Station::private(lanes)
        .where_instead("station.toml", "mock,serial=3", "tcp:127.0.0.1:1")
        .where_instead("station.toml", "mock,serial=2", "mock,serial=2,fault=stuck-data,bit=7")
        .where_instead("station.toml", six, &format!("{six}\nstart = [\"button\"]"))
}

/// Opens the page in `language`, at this size.
fn shown(page: &mut Chromium, serving: &Serving, language: &str, (width, height): (u32, u32)) {
    let own = format!("http://127.0.0.1:{}/", serving.port);
    let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 700 });
    page.call("Emulation.setDeviceMetricsOverride", size);
    let cookie = json!({ "url": own, "name": "halfrow-language", "value": language });
    page.call("Network.setCookie", cookie);
    page.go(&own);
    page.wait(&format!(
        "document.readyState === 'complete' && document.documentElement.lang === '{language}' && document.querySelector('#lamp') !== null"
    ));
}

/// Words that are cut off or broken, buttons that overlap, and lanes that are not whole.
const CUT: &str = "(() => {
    const found = [];
    for (const lane of document.querySelectorAll('.lane')) {
        const say = what => found.push(`${lane.dataset.lane} ${lane.className}: ${what}`);
        for (const part of lane.querySelectorAll('.word, .serial, .does, .asks, .pass > .why')) {
            const box = part.getBoundingClientRect(), end = lane.getBoundingClientRect().top + lane.clientTop + lane.clientHeight;
            const isSaid = part.matches('.asks') || !lane.querySelector('.asks, .doing');
            const isCut = part.matches('.does, .asks') && part.scrollHeight > part.clientHeight + 1;
            if (isCut || box.bottom > end + 1 || isSaid && !part.checkVisibility()) say(part.textContent);
        }
        const word = document.createRange();
        word.selectNodeContents(lane.querySelector('.word span'));
        if (lane.classList.contains('short') && word.getClientRects().length > 1) say('its word is broken');
        // *abort* has to stay where it is when *start* goes: whoever taps *start* twice means no abort.
        const last = [...lane.querySelectorAll('.acts button')].at(-1)?.getBoundingClientRect();
        if (last && last.right < lane.querySelector('header').getBoundingClientRect().right - 1) say('its last button is not at the end');
        const buttons = [...lane.querySelectorAll('button')].map(button => button.getBoundingClientRect());
        for (const [i, one] of buttons.entries()) for (const other of buttons.slice(i + 1)) {
            const isClear = one.right <= other.left || other.right <= one.left || one.bottom <= other.top || other.bottom <= one.top;
            if (!isClear) say('a button on another');
        }
    }
    return found;
})()";

/// Short names of lanes that are broken, or of which the button beside them is cut off.
const BROKEN: &str =
    "[...document.querySelectorAll('.lane')].flatMap(lane => ['', 'MAT-9'].flatMap(other => {
    const word = {de: 'abbrechen', zh: '中止'}[document.documentElement.lang] ?? 'abort';
    lane.querySelector('.acts').innerHTML = `<form class=act><button>${word}</button></form>`;
    const [name, text] = [lane.querySelector('.name'), document.createRange()];
    name.textContent = other || name.textContent;
    text.selectNodeContents(name);
    const button = lane.querySelector('.act button').getBoundingClientRect();
    const isCut = button.right > lane.getBoundingClientRect().right - lane.clientLeft;
    return isCut || text.getClientRects().length > 1 ? [`${lane.id} ${other}`] : [];
}))";

#[test]
fn what_to_do_is_shown_whole_on_every_screen_and_in_every_language() {
    for lanes in [8, 16] {
        let station = station(lanes);
        let serving = station.serve();
        let here = serving.here();
        for (serial, lane) in SERIALS.iter().zip(["1", "2", "3", "6"]) {
            here.scan(serial, lane);
        }
        let mut page = Chromium::live(&serving);
        page.wait(
            "document.querySelector('#lane-3.error .asks') && document.querySelector('#lane-2.fail')
                && document.querySelector('#lane-6.waiting') && true",
        );
        for size in [(1920, 1080), (1280, 800), (800, 450), (360, 740)] {
            for (language, asked) in [
                ("en", "Start ser2net or halfrow serve there, and check the port"),
                ("de", "Bei der Platine ser2net oder halfrow serve starten"),
                ("zh", "请在板卡所在主机上启动 ser2net 或 halfrow serve，并检查端口"),
            ] {
                shown(&mut page, &serving, language, size);
                assert_eq!(page.evaluate(CUT), json!([]), "{lanes} {language} {size:?}");
                assert_eq!(page.evaluate(BROKEN), json!([]), "{lanes} {language} {size:?}");
                let said = "document.querySelector('#lane-3 .asks').textContent.replaceAll('`', '')";
                assert_eq!(page.evaluate(said), json!(asked));
                // It is only said once.
                let why = page.evaluate("document.querySelector('#lane-3 .why').textContent");
                assert!(!why.as_str().unwrap().contains(asked), "{why}");
                assert_eq!(page.evaluate("document.documentElement.scrollWidth > innerWidth"), json!(false));
            }
        }
    }
}

/// What a screen reader reads for each lane: heading, button, whether the button is pressed.
const HEARD: &str = "[...document.querySelectorAll('.lane')].map(lane => {
    const [heading, button] = [lane.querySelector('h2'), lane.querySelector('.name')];
    const names = document.getElementById(lane.getAttribute('aria-labelledby'));
    return [names.ariaLabel, heading.ariaLabel, button.ariaLabel, button.ariaPressed].join('|');
})";

#[test]
fn a_screen_reader_says_which_lane_the_next_scan_is_for() {
    let station = Station::private(2);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let heard = |first: bool, second: bool| {
        json!([
            format!("Lane 1|Lane 1|scan for lane 1|{first}"),
            format!("Lane 2|Lane 2|scan for lane 2|{second}"),
        ])
    };
    assert_eq!(page.evaluate(HEARD), heard(false, false));
    page.scan("HR:LANE:2", "Enter", Duration::ZERO);
    page.wait("document.querySelector('#lane-2.armed') !== null");
    assert_eq!(page.evaluate(HEARD), heard(false, true));
    page.scan("HR:LANE:1", "Enter", Duration::ZERO);
    page.wait("document.querySelector('#lane-1.armed') !== null");
    assert_eq!(page.evaluate(HEARD), heard(true, false));
}

/// A live region is read aloud whenever it changes, and the clock changes every second.
#[test]
fn a_screen_reader_is_told_that_the_page_is_live_and_not_what_time_it_is() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let said = |id: &str| {
        format!(
            "document.getElementById('{id}').closest('[role=status], [role=alert], [role=log], [aria-live]')?.id ?? ''"
        )
    };
    assert_eq!(page.evaluate(&said("clock")), json!(""));
    assert_eq!(page.evaluate(&said("lamp")), json!("lamp"));
}

#[test]
fn without_a_script_nothing_that_is_typed_is_thrown_away() {
    let station = Station::private(2);
    let serving = station.serve();
    let mut page = Chromium::open("about:blank");
    page.call("Emulation.setScriptExecutionDisabled", json!({ "value": true }));
    page.go(&format!("http://127.0.0.1:{}/", serving.port));
    page.wait("document.readyState === 'complete' && document.activeElement.name === 'text'");
    page.call("Input.insertText", json!({ "text": "CA967803" }));
    let lanes = |page: &Chromium| page.asked.iter().filter(|address| address.ends_with("/still")).count();
    until("lanes that are loaded anew", || {
        page.wait("true");
        lanes(&page) >= 3
    });
    let field = "[document.activeElement.name, document.activeElement.value]";
    assert_eq!(page.evaluate(field), json!(["text", "CA967803"]));
    let seen = page.evaluate("[...document.querySelectorAll('#floor, iframe, form.hand')].map(one => [one.tagName, one.checkVisibility()]).join()");
    assert_eq!(seen, json!("FORM,false,FORM,true,IFRAME,true,DIV,false"));
    // A button that needs a script to do anything is none there.
    page.wait(
        "(lanes => lanes.querySelectorAll('.lane.ready span.name').length === 2 && lanes.querySelector('[data-arm]') === null)
            (document.querySelector('iframe').contentDocument)",
    );
}

/// A sheet of A4 without its margins, in CSS pixels.
const A4: (u32, u32) = (718, 1046);

/// Which parts of the page are printed, and how.
fn on_paper(page: &mut Chromium, address: &str) -> Value {
    page.go(address);
    page.wait("document.readyState === 'complete' && document.querySelector('main') !== null");
    page.call("Emulation.setEmulatedMedia", json!({ "media": "print" }));
    page.evaluate(
        "[['verdict', one => getComputedStyle(one).printColorAdjust], ['filters', one => getComputedStyle(one).display],
          ['wide', one => getComputedStyle(one).overflowX], ['top nav', one => getComputedStyle(one).display]]
          .map(([name, look]) => document.querySelector('.' + name) && look(document.querySelector('.' + name)))",
    )
}

#[test]
fn on_paper_verdicts_keep_their_ground_and_no_column_is_cut_off() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    page.wait("document.querySelector('.lane.ready') !== null");
    serving.here().scan(SERIALS[0], "1");
    page.wait("document.querySelector('.lane.pass') !== null");
    let at = |path: &str| format!("http://127.0.0.1:{}{path}", serving.port);
    let history = on_paper(&mut page, &at("/history"));
    assert_eq!(history, json!(["exact", "none", null, "none"]));
    assert_eq!(on_paper(&mut page, &at("/yield?by=day")), json!([null, "none", "visible", "none"]));
    let (width, height) = A4;
    let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
    page.call("Emulation.setDeviceMetricsOverride", size);
    assert_eq!(page.evaluate("document.documentElement.scrollWidth > innerWidth"), json!(false));
}

/// What is told of a lane that is not whole on paper: nobody can follow a link there.
const CUT_ON_PAPER: &str = "(() => {
    const isCut = part => part.scrollWidth > part.clientWidth + 1 || part.scrollHeight > part.clientHeight + 1;
    return [...document.querySelectorAll('.lane')].flatMap(lane => {
        const end = lane.getBoundingClientRect().bottom + 1;
        const parts = [...lane.querySelectorAll('.why, .asks, .does, .doing')];
        const bad = parts.filter(part => !part.checkVisibility() || isCut(part) || part.getBoundingClientRect().bottom > end);
        return bad.map(part => `${lane.id}: ${part.textContent}`);
    });
})()";

#[test]
fn on_paper_what_was_found_in_a_lane_is_whole() {
    for lanes in [8, 16] {
        let station = station(lanes);
        let serving = station.serve();
        let here = serving.here();
        for (serial, lane) in SERIALS.iter().zip(["1", "2", "3"]) {
            here.scan(serial, lane);
        }
        let mut page = Chromium::live(&serving);
        page.wait("document.querySelector('#lane-3.error .asks') && document.querySelector('#lane-2.fail .why') && true");
        for language in ["en", "de", "zh"] {
            page.call("Emulation.setEmulatedMedia", json!({ "media": "print" }));
            shown(&mut page, &serving, language, A4);
            assert_eq!(page.evaluate(CUT_ON_PAPER), json!([]), "{lanes} {language}");
        }
    }
}
