//! How soon a verdict is on the screen, and whether a page grows.

use serde_json::json;

use super::chromium::Chromium;
use super::scans::serial;
use crate::pages::station::{Browser, Serving, Station};

const LANES: usize = 16;
/// Milliseconds that half of the verdicts may take from the read-back after COMMIT to the screen. All lanes start at the same
/// moment here, and judge on the processors that show the page; on a line, 95 of 100 verdicts should be that fast.
const MOST_LATE: f64 = 150.0;
/// How much nodes and heap may grow from the hundredth run to the last, as a factor.
const MOST_GROWTH: f64 = 1.1;

/// Records for each run when its verdict was saved, from the station, and when the frame that shows it was drawn, from the page:
/// both by this computer's clock.
const WATCH: &str = "(() => {
    window.seen = new Map();
    const look = () => {
        for (const lane of document.querySelectorAll('.lane[data-run]')) {
            const run = lane.dataset.run;
            if (seen.has(run)) continue;
            const saved = Date.parse(lane.querySelector('.saved time').dateTime);
            seen.set(run, undefined);
            requestAnimationFrame(() => setTimeout(() => seen.set(run, performance.timeOrigin + performance.now() - saved)));
        }
    };
    new MutationObserver(look).observe(document.getElementById('floor'), {childList: true, subtree: true});
    return true;
})()";

fn open(serving: &Serving) -> Chromium {
    let mut page = Chromium::live(serving);
    page.wait(&format!("document.querySelectorAll('.lane.ready').length === {LANES}"));
    page
}

/// Scans another board in every lane; returns their serial numbers.
fn round(here: &Browser, number: usize) -> Vec<String> {
    let serials: Vec<_> = (0..LANES).map(|lane| serial(number * LANES + lane)).collect();
    for (serial, lane) in serials.iter().zip(1..) {
        let name = format!("{lane}");
        let scan =
            here.post("/scan", &[("text", serial), ("lane", &name)]).with("accept", "application/json");
        let answer = scan.send().text();
        assert!(answer.contains("\"is_taken\":true"), "{answer}");
    }
    serials
}

const ALL_SEEN: &str = "[...seen.values()].filter(late => late !== undefined).length";

#[test]
#[ignore = "for scripts/soak: a figure of a machine that does nothing else"]
fn verdicts_are_soon_on_the_screen_after_their_commit() {
    let station = Station::private(LANES);
    let serving = station.serve();
    let (mut page, here) = (open(&serving), serving.here());
    page.evaluate(WATCH);
    for number in 0..8 {
        round(&here, number);
        page.wait(&format!("{ALL_SEEN} === {}", (number + 1) * LANES));
    }
    let late = page.evaluate("[...seen.values()].sort((a, b) => a - b)");
    let late: Vec<f64> = late.as_array().unwrap().iter().map(|late| late.as_f64().unwrap()).collect();
    let at = |share: f64| late[(late.len() as f64 * share).ceil() as usize - 1];
    println!(
        "{} verdicts on {LANES} lanes: {:.0} ms at the median, {:.0} at 95 %, {:.0} at most; wanted {MOST_LATE} at 95 %",
        late.len(),
        at(0.5),
        at(0.95),
        at(1.0)
    );
    assert!(late[0] > -2.0, "a verdict was shown {} ms before it was saved", -late[0]);
    assert!(at(0.5) <= MOST_LATE, "{late:?}");
}

#[test]
#[ignore = "for scripts/soak: a thousand runs"]
fn a_page_does_not_grow_in_a_thousand_runs() {
    let station = Station::private(LANES);
    let serving = station.serve();
    let (mut page, here) = (open(&serving), serving.here());
    page.call("Performance.enable", json!({}));
    let measured = |page: &mut Chromium| {
        page.call("HeapProfiler.collectGarbage", json!({}));
        let metrics = page.call("Performance.getMetrics", json!({}));
        let metric = |name: &str| {
            let all = metrics["metrics"].as_array().unwrap();
            all.iter().find(|metric| metric["name"] == name).unwrap()["value"].as_f64().unwrap()
        };
        (metric("Nodes"), metric("JSHeapUsedSize"))
    };
    let (mut first, mut last) = (None, (0.0, 0.0));
    for number in 0..1008 / LANES {
        let serials = round(&here, number).join(",");
        let shown = "[...document.querySelectorAll('.lane.pass .serial')].map(one => one.textContent).join()";
        page.wait(&format!("{shown} === '{serials}'"));
        let runs = (number + 1) * LANES;
        if runs >= 100 && first.is_none() || runs >= 1000 {
            last = measured(&mut page);
            println!("{runs} runs: {} nodes, {:.0} KiB of heap", last.0, last.1 / 1024.0);
            first.get_or_insert(last);
        }
    }
    let (nodes, heap) = first.unwrap();
    assert!(last.0 <= MOST_GROWTH * nodes && last.1 <= MOST_GROWTH * heap, "{first:?} became {last:?}");
}
