//! What is shown is live, or is said not to be.

use std::time::Duration;

use nix::sys::signal::Signal;
use serde_json::json;

use super::chromium::Chromium;
use crate::pages::station::{SERIALS, Serving, Station};

/// The most milliseconds from the last beat until the page says that it is not live, apart from delays of a busy machine.
pub(super) const NOT_LIVE: f64 = 3000.0;

/// Records when the page last got a beat, and when it stopped and began to be live, by the page's own clock.
pub(super) const WATCH: &str = "new Promise(done => {
    window.beat = window.died = window.rose = 0;
    new MutationObserver(() => window.beat = performance.now()).observe(document.getElementById('clock'), {childList: true});
    new MutationObserver(() => {
        const is_dead = document.body.classList.contains('dead');
        if (is_dead && !window.died) window.died = performance.now();
        if (!is_dead && window.died && !window.rose) window.rose = performance.now();
    }).observe(document.body, {attributes: true});
    done(true);
})";

#[test]
fn a_verdict_is_shown_with_its_record_and_stays_when_the_page_comes_anew() {
    let station = Station::private(2);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    page.scan("HR:LANE:2", "Enter", Duration::ZERO);
    page.scan(SERIALS[0], "Enter", Duration::ZERO);
    page.wait("document.querySelector('#lane-2.pass') !== null");
    let shown = "const lane = document.getElementById('lane-2').dataset; `${lane.run} ${lane.record}`";
    let stored = station.query("SELECT id || ' ' || record_sha256 FROM run WHERE verdict = 'PASS'");
    assert_eq!(page.evaluate(shown), json!(stored[0]));
    page.go(&format!("http://127.0.0.1:{}/", serving.port));
    page.wait("document.getElementById('lamp')?.textContent === 'live'");
    assert_eq!(page.evaluate(&format!("{{ {shown} }}")), json!(stored[0]));
    // Requests to other origins would tell them something, or let them send something.
    let own = format!("http://127.0.0.1:{}/", serving.port);
    assert!(page.asked.len() > 8, "{:?}", page.asked);
    let others: Vec<_> =
        page.asked.iter().filter(|url| !url.starts_with(&own) && !url.starts_with("data:")).collect();
    assert_eq!(others, Vec::<&String>::new());
    assert_eq!(page.evaluate("window.violations ?? []"), json!([]));
}

/// The page checks this itself, with events that the station would never send.
#[test]
fn a_verdict_without_its_record_is_not_drawn() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let draw = |event: &str| {
        format!(
            "import('/assets/floor.js').then(floor => floor.draw({{lane: '1', html: '<article id=lane-1 class=lane>drawn</article>', {event}}}))"
        )
    };
    let hash = "0f".repeat(32);
    for refused in [
        "state: 'PASS'".to_owned(),
        "state: 'PASS', verdict: 'PASS', run: 'r'".to_owned(),
        format!("state: 'PASS', verdict: 'PASS', record_sha256: '{hash}'"),
        format!("state: 'PASS', verdict: 'FAIL', run: 'r', record_sha256: '{hash}'"),
        format!("state: 'FAIL', verdict: 'FAIL', run: 'r', record_sha256: '{}'", &hash[1..]),
    ] {
        assert_eq!(page.evaluate(&draw(&refused)), json!(false), "{refused}");
    }
    assert_eq!(page.evaluate("document.getElementById('lane-1').textContent === 'drawn'"), json!(false));
    let whole = format!("state: 'PASS', verdict: 'PASS', run: 'r', record_sha256: '{hash}'");
    assert_eq!(page.evaluate(&draw(&whole)), json!(true));
}

#[test]
fn the_day_is_counted_anew_when_the_clock_begins_again() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let counted =
        "performance.getEntriesByType('resource').filter(one => one.name.endsWith('/today')).length";
    page.wait(&format!("{counted} > 0"));
    // As if the last beat had been in the second before midnight.
    page.evaluate("document.getElementById('clock').textContent = '23:59:60'");
    page.wait(&format!("{counted} > 1"));
}

#[test]
fn the_day_is_asked_for_until_it_was_counted() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let fails = "window.asked = 0; const known = window.fetch;
        const cut = new ReadableStream({start: (body) => body.error(new TypeError('cut'))});
        const answers = [() => Promise.reject(new TypeError('away')), async () => new Response('', {status: 502}),
            async () => new Response(cut), async () => new Response('counted')];
        window.fetch = (address, ...of) => address === '/today' ? answers[window.asked++]() : known(address, ...of);
        true";
    page.evaluate(fails);
    page.evaluate("document.getElementById('clock').textContent = '23:59:60'");
    page.wait("document.getElementById('today').textContent === 'counted'");
    assert_eq!(page.evaluate("window.asked"), json!(4));
}

/// Ends the station of a page and starts it again; returns how many milliseconds after the last beat the page was not live, and how
/// many after the start live again.
fn without_the_station() -> [f64; 2] {
    let station = Station::private(1);
    let serving = station.serve();
    let port = serving.port;
    let mut page = Chromium::live(&serving);
    page.evaluate(WATCH);
    page.wait("window.beat > 0");
    drop(serving);
    page.wait("window.died > 0");
    let silent = page.evaluate("window.died - window.beat").as_f64().unwrap();
    assert!(
        page.evaluate("document.getElementById('lamp').textContent")
            .as_str()
            .unwrap()
            .starts_with("NOT LIVE")
    );
    page.scan(SERIALS[0], "Enter", Duration::ZERO);
    page.wait("document.getElementById('answer').textContent.includes('did not arrive')");
    let station = station.at(port);
    let _again = station.serve();
    let back = page.evaluate("performance.now()").as_f64().unwrap();
    page.wait("window.rose > 0");
    let rose = page.evaluate("window.rose").as_f64().unwrap() - back;
    page.wait("!document.body.classList.contains('dead')");
    page.scan(SERIALS[0], "Enter", Duration::ZERO);
    page.wait("document.querySelector('.lane.pass') !== null");
    [silent, rose]
}

#[test]
fn without_the_station_nothing_is_live_and_with_it_everything_again() {
    let [silent, rose] = without_the_station();
    println!("not live {silent:.0} ms after the last beat, live again {rose:.0} ms after it was back");
}

#[test]
#[ignore = "for scripts/soak: a figure of a machine that does nothing else"]
fn without_the_station_nothing_is_live_for_long() {
    let [silent, _] = without_the_station();
    assert!(silent < 2.0 * NOT_LIVE, "not live after {silent} ms");
}

#[test]
fn an_open_page_comes_anew_by_itself_when_lanes_and_plans_are_others() {
    let station = Station::private(2);
    let serving = station.serve();
    let port = serving.port;
    let mut page = Chromium::live(&serving);
    page.scan("HR:LANE:1", "Enter", Duration::ZERO);
    page.scan(SERIALS[0], "Enter", Duration::ZERO);
    page.wait("document.querySelector('#lane-1.pass') !== null");
    drop(serving);
    page.wait("document.body.classList.contains('dead')");
    let station = station.at(port).where_instead("station.toml", "name = \"1\"", "name = \"A\"");
    let station = station.where_instead("plan.toml", "version = \"1\"", "version = \"2\"");
    let _again = station.serve();
    page.wait("document.querySelector('.plans')?.textContent === 'CAM-T quick 2'");
    page.wait("document.getElementById('lamp').textContent === 'live'");
    let lanes = page.evaluate("[...document.querySelectorAll('.lane')].map(lane => lane.dataset.lane)");
    assert_eq!(lanes, json!(["A", "2"]));
    page.scan("HR:LANE:A", "Enter", Duration::ZERO);
    page.scan(SERIALS[1], "Enter", Duration::ZERO);
    page.wait("document.querySelector('#lane-A.pass') !== null");
}

/// The station is stopped while its page scans, as by a busy computer, and then goes on.
#[test]
fn what_is_scanned_while_the_page_is_not_live_is_never_done() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    page.wait("document.querySelector('.lane.ready') !== null");
    serving.signal(Signal::SIGSTOP);
    page.wait("document.body.classList.contains('dead')");
    page.scan(SERIALS[0], "Enter", Duration::ZERO);
    page.wait("document.getElementById('answer').textContent.includes('did not arrive')");
    // It is said again if the page comes anew now, but not once it has gone on.
    page.wait("sessionStorage.getItem('left')?.includes('did not arrive')");
    serving.signal(Signal::SIGCONT);
    page.wait("!document.body.classList.contains('dead')");
    page.scan(SERIALS[1], "Enter", Duration::ZERO);
    page.wait("document.querySelector('.lane.pass') !== null");
    page.wait("sessionStorage.getItem('left') === null");
    assert_eq!(station.query("SELECT act || ' ' || detail FROM audit"), [format!("scan {}", SERIALS[1])]);
}

/// Records the page's event source, the last event's number, and the event of a PASS; counts tones.
const HEAR: &str = "
    window.tones = 0;
    window.OscillatorNode = class extends OscillatorNode { constructor(...of) { super(...of); window.tones += 1; } };
    window.EventSource = class extends EventSource {
        constructor(...of) {
            super(...of);
            window.source = this;
            for (const name of ['snapshot', 'lane', 'doing', 'scan', 'hook', 'beat']) this.addEventListener(name, event => {
                window.last = Number(event.lastEventId);
                if (name === 'lane' && JSON.parse(event.data).state === 'PASS') window.passed = event.data;
            });
        }
    };";

/// A page of the lanes that was told of a PASS, with what [`HEAR`] records.
fn heard(serving: &Serving) -> Chromium {
    let mut page = Chromium::open("about:blank");
    page.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": HEAR }));
    page.go(&format!("http://127.0.0.1:{}/", serving.port));
    page.wait("document.getElementById('lamp')?.textContent === 'live'");
    page.wait("document.querySelector('.lane.ready') !== null");
    page.scan(SERIALS[0], "Enter", Duration::ZERO);
    page.wait("window.passed !== undefined && window.tones === 2");
    page
}

/// The state is sent anew when a board is unplugged, and when the next one is plugged in.
#[test]
fn a_verdict_is_told_once() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = heard(&serving);
    let again = |run: &str| {
        format!(
            "(() => {{
                document.getElementById('said').textContent = '';
                const [lane, before] = [document.getElementById('lane-1'), window.tones];
                lane.querySelector('.serial a').focus();
                const data = JSON.stringify({{...JSON.parse(window.passed), {run}}});
                source.dispatchEvent(new MessageEvent('lane', {{data, lastEventId: `${{window.last + 1}}`}}));
                const isDrawn = document.getElementById('lane-1') !== lane;
                return [isDrawn, window.tones - before, document.getElementById('said').textContent !== '', document.activeElement.id];
            }})()"
        )
    };
    assert_eq!(page.evaluate(&again("")), json!([true, 0, false, "run-1"]));
    assert_eq!(page.evaluate(&again("run: 'another'")), json!([true, 2, true, "run-1"]), "the control");
}

/// A page that misses news is sent a snapshot, in which all lanes are.
#[test]
fn a_verdict_is_told_that_came_while_the_page_heard_nothing() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = heard(&serving);
    let snapshot = |run: &str| {
        format!(
            "(() => {{
                const before = [window.tones, document.getElementById('said').childElementCount];
                const lanes = [{{...JSON.parse(window.passed), {run}}}];
                const data = JSON.stringify({{mark: document.getElementById('station').dataset.mark, lanes, hooks: []}});
                source.dispatchEvent(new MessageEvent('snapshot', {{data, lastEventId: `${{window.last}}`}}));
                return [window.tones - before[0], document.getElementById('said').childElementCount - before[1]];
            }})()"
        )
    };
    assert_eq!(page.evaluate(&snapshot("")), json!([0, 0]), "it was told already");
    assert_eq!(page.evaluate(&snapshot("run: 'another'")), json!([2, 1]));
    page.go(&format!("http://127.0.0.1:{}/", serving.port));
    page.wait("document.getElementById('lamp')?.textContent === 'live' && document.querySelector('.lane.pass') !== null");
    let told = "[window.tones, document.getElementById('said').textContent]";
    assert_eq!(page.evaluate(told), json!([0, ""]), "whoever opens the page sees it");
}

/// What one lane says is still there when another lane has something to say, as ARIA asks of a log; not for ever.
#[test]
fn what_one_lane_says_can_be_read_after_another_has_said_something() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = heard(&serving);
    let log = "[...document.getElementById('said').children].map(line => line.textContent)";
    let pass = format!("Lane 1: PASS {}", SERIALS[0]);
    let said = page.evaluate(log);
    let said: Vec<_> = said.as_array().unwrap().iter().filter_map(|line| line.as_str()).collect();
    assert!(said.len() > 1 && said.last() == Some(&pass.as_str()), "{said:?}");
    let more = "for (let number = 1; number <= 30; number += 1) {
            const data = JSON.stringify({...JSON.parse(window.passed), run: `r${number}`, said: `news ${number}`});
            source.dispatchEvent(new MessageEvent('lane', {data, lastEventId: `${window.last + 1}`}));
        }";
    let kept: Vec<_> = (11..=30).map(|number| format!("news {number}")).collect();
    assert_eq!(page.evaluate(&format!("{more} {log}")), json!(kept));
    let region = "[document.getElementById('said').role, document.getElementById('said').ariaLive]";
    assert_eq!(page.evaluate(region), json!(["log", null]));
}

/// The hook is killed long after its verdict, and by then another board may be in the lane.
#[test]
fn each_hook_that_failed_is_told_with_its_unit_until_its_lane_has_something_else_to_say() {
    let more = "[web]\nlisten = \"127.0.0.1:0\"\n[[on-pass]]\nprogram = \"false\"";
    let station = Station::with(2, more);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let scan = |page: &mut Chromium, lane: &str, serial: &str| {
        page.wait(&format!("document.querySelector('#lane-{lane}.ready, #lane-{lane}.pass') !== null"));
        page.scan(&format!("HR:LANE:{lane}"), "Enter", Duration::ZERO);
        page.scan(serial, "Enter", Duration::ZERO);
    };
    let told = |units: &[&str]| {
        let told: Vec<_> = units.iter().map(|unit| format!("Lane {unit}: the hook false failed")).collect();
        let lines = "document.getElementById('notice').textContent.split('\\n').filter(Boolean)";
        format!(
            "(told => {lines}.length === told.length && told.every(of => {lines}.some(line => line.startsWith(of))))({})",
            json!(told)
        )
    };
    let units = [format!("1, {}", SERIALS[0]), format!("2, {}", SERIALS[1])];
    scan(&mut page, "1", SERIALS[0]);
    page.wait(&told(&[&units[0]]));
    scan(&mut page, "2", SERIALS[1]);
    page.wait(&told(&[&units[0], &units[1]]));
    page.go(&format!("http://127.0.0.1:{}/", serving.port));
    page.wait("document.getElementById('lamp')?.textContent === 'live'");
    page.wait(&told(&[&units[0], &units[1]]));
    let again = format!("1, {}", SERIALS[2]);
    scan(&mut page, "1", SERIALS[2]);
    page.wait(&told(&[&again, &units[1]]));
}
