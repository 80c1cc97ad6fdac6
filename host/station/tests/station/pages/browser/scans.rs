//! Scans by real key events, at the speeds of scanners, wherever the focus is.

use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::thread;
use std::time::{Duration, Instant};

use super::chromium::Chromium;
use crate::common::{program, until};
use crate::pages::station::Station;

/// Milliseconds between two keys.
const SPEEDS: [u64; 4] = [0, 1, 8, 20];
const LANES: usize = 4;

/// A serial number made of `number`, with its check digit as ISO 2108:1992 computes it for an ISBN.
pub(super) fn serial(number: usize) -> String {
    let digits = format!("{number:09}");
    let sum: usize = digits.bytes().zip(1..).map(|(digit, place)| usize::from(digit - b'0') * place).sum();
    format!("CA{digits}{}", if sum % 11 == 10 { "X".to_owned() } else { (sum % 11).to_string() })
}

/// Where the focus is before a scan.
const FOCUS: [&str; 5] = [
    "document.activeElement.blur()",
    "document.querySelector('nav a').focus()",
    "document.getElementById('sound').focus()",
    "document.querySelector('.lane .name').focus()",
    "document.querySelector('.lane .act button')?.focus()",
];

/// Waits until `all` scans are answered.
fn answered(page: &mut Chromium, all: usize) {
    page.wait(&format!("document.getElementById('counter').textContent === '{all} / {all}'"));
}

/// Whether the page says that the last scan did not come in time, as happens on a busy computer: nothing was done, and the
/// operator is told to scan again.
fn was_late(page: &mut Chromium) -> bool {
    let said = "document.getElementById('answer').textContent";
    let unsent = "document.getElementById('station').dataset.unsent";
    let late =
        ["this came too late", "was chosen more than"].map(|late| format!("{said}.includes('{late}')"));
    page.evaluate(&format!("{} || {said} === {unsent}", late.join(" || "))) == true
}

/// An operator who scans, and reads the page after each scan.
struct Operator {
    page: Chromium,
    scans: usize,
}

impl Operator {
    /// Scans; returns whether the scan came in time.
    fn scan(&mut self, text: &str, end: &str, apart: Duration) -> bool {
        self.page.scan(text, end, apart);
        self.scans += 1;
        answered(&mut self.page, self.scans);
        !was_late(&mut self.page)
    }

    /// Chooses a lane, and tries again if that came late.
    fn choose(&mut self, lane: usize, apart: Duration) {
        let scan = format!("HR:LANE:{lane}");
        until("a scan of a lane that comes in time", || self.scan(&scan, "Enter", apart));
        let armed = self.page.evaluate("document.getElementById('armed').textContent");
        assert!(armed.as_str().unwrap().ends_with(&format!(" {lane}")), "{armed} instead of {lane}");
    }
}

/// Scans so many times in time at each speed. What the station received is what was scanned, each for its lane and in order. Only scans
/// that the page called late may be missing.
fn scanned(counts: [usize; 4], first: usize) {
    let station = Station::private(LANES);
    let serving = station.serve();
    let mut operator = Operator { page: Chromium::live(&serving), scans: 0 };
    let (mut scans, mut late) = (Vec::new(), Vec::new());
    for (milliseconds, count) in SPEEDS.into_iter().zip(counts) {
        let apart = Duration::from_millis(milliseconds);
        for _ in 0..count {
            until("a scan that comes in time", || {
                let number = first + scans.len();
                let (serial, lane) = (serial(number), number % LANES + 1);
                operator.page.evaluate(FOCUS[number % FOCUS.len()]);
                operator.choose(lane, apart);
                let end = if number.is_multiple_of(2) { "Enter" } else { "Tab" };
                let scan = format!("{lane} {serial}");
                let is_in_time = operator.scan(&serial, end, apart);
                if !is_in_time {
                    late.push(scan.clone());
                }
                scans.push(scan);
                is_in_time
            });
        }
    }
    let sent = station.query("SELECT subject || ' ' || detail FROM audit WHERE act = 'scan' ORDER BY id");
    // A scan may have arrived although the page did not get the answer in time.
    scans.retain(|scan| sent.contains(scan) || !late.contains(scan));
    assert_eq!(sent, scans);
    let others = station.query("SELECT act FROM audit WHERE act <> 'scan'");
    assert_eq!(others, Vec::<String>::new(), "no key pressed a button");
}

#[test]
fn no_scan_is_lost_or_changed_or_goes_to_another_lane() {
    scanned([12, 12, 8, 4], 0);
}

/// The ten thousand scans are divided into parts, each at one speed.
const PARTS: usize = 100;

/// Four browsers at the same time, which keeps the computer busy. The test resumes where it was stopped: parts that this build of
/// the program has passed are not run again.
#[test]
#[ignore = "for scripts/soak"]
fn none_of_ten_thousand_scans_is_lost_or_changed_or_goes_to_another_lane() {
    let of_program = halfrow::result::sha256([fs::read(program()).unwrap()]);
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("scans-{}", &of_program[..16]));
    fs::create_dir_all(&kept).unwrap();
    let is_left = |part: &usize| !kept.join(part.to_string()).exists();
    let left = Mutex::new((0..PARTS).filter(is_left).collect::<Vec<_>>());
    println!("{} of {PARTS} parts are done", PARTS - left.lock().unwrap().len());
    let begun = Instant::now();
    thread::scope(|scope| {
        for _ in SPEEDS {
            scope.spawn(|| {
                while let Some(part) = { left.lock().unwrap().pop() } {
                    let mut counts = [0; 4];
                    counts[part % SPEEDS.len()] = 10_000 / PARTS;
                    scanned(counts, part * 10_000 / PARTS);
                    fs::write(kept.join(part.to_string()), "").unwrap();
                }
            });
        }
    });
    println!("ten thousand scans, the last of them in {:.0} s", begun.elapsed().as_secs_f64());
    fs::remove_dir_all(kept).unwrap();
}

/// A station on a line, without a keyboard.
#[test]
fn a_scanner_is_enough_to_log_in_and_to_log_in_again() {
    let station = Station::with(1, "[web]\nlisten = \"127.0.0.1:0\"\n[access]\nusers = \"users.toml\"");
    for (name, badge) in [("Weber", "A-0017\n"), ("Braun", "B-0022\n")] {
        assert!(station.user(&["add", name], badge).status.success());
    }
    let serving = station.serve();
    let mut page = Chromium::open(&format!("http://127.0.0.1:{}/", serving.port));
    let live = "document.getElementById('lamp')?.textContent === 'live'";
    let who =
        |name: &str| format!("document.querySelector('.top .who')?.textContent.includes('{name}') && {live}");
    page.wait(&who("Log in"));
    page.scan("A-0017", "Enter", Duration::ZERO);
    page.wait(&who("Weber"));
    page.scan("CA0131103628", "Enter", Duration::ZERO);
    page.wait("document.querySelector('.lane.pass') !== null");
    // The page tells an operator who was removed.
    assert!(station.user(&["remove", "Weber"], "").status.success());
    page.scan("CA0201134374", "Enter", Duration::ZERO);
    page.wait(&who("Log in"));
    page.scan("B-0022", "Enter", Duration::ZERO);
    page.wait(&who("Braun"));
    assert_eq!(station.query("SELECT operator_id FROM run"), ["Weber"]);
}

/// As in another tab of the same browser.
#[test]
fn a_page_shows_who_is_logged_in_and_says_what_was_not_taken_because_it_is_somebody_else() {
    let station = Station::with(1, "[web]\nlisten = \"127.0.0.1:0\"\n[access]\nusers = \"users.toml\"");
    assert!(station.user(&["add", "Weber"], "A-0017\n").status.success());
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let who = |name: &str| {
        let live = "document.getElementById('lamp')?.textContent === 'live'";
        format!("document.querySelector('.top .who')?.textContent.includes('{name}') && {live}")
    };
    let elsewhere = |page: &mut Chromium, path: &str, badge: &str| {
        let fields = format!("{{csrf: document.getElementById('station').dataset.csrf, badge: '{badge}'}}");
        page.evaluate(&format!(
            "fetch('{path}', {{method: 'POST', body: new URLSearchParams({fields})}}).then(() => true)"
        ));
    };
    page.scan("A-0017", "Enter", Duration::ZERO);
    page.wait(&who("Weber"));
    elsewhere(&mut page, "/logout", "");
    page.wait(&who("Log in"));
    elsewhere(&mut page, "/login", "A-0017");
    page.scan(&serial(0), "Enter", Duration::ZERO);
    page.wait(&who("Weber"));
    page.wait("document.getElementById('answer').textContent.startsWith('The scan did not arrive')");
    page.scan(&serial(0), "Enter", Duration::ZERO);
    page.wait("document.querySelector('.lane.pass') !== null");
}

#[test]
fn half_scans_and_doubled_ones_are_refused_and_press_nothing() {
    let station = Station::private(1);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let apart = Duration::ZERO;
    let refused = "document.getElementById('answer').className === 'answer refused'";
    page.scan("CA01311", "Escape", apart);
    // Two labels without an end key in between, a letter in lower case, a wrong check digit, a blank.
    for (number, wrong) in
        ["CA0131103628CA0201134373", "cA0131103628", "CA0131103629", "CA013110362 8"].into_iter().enumerate()
    {
        page.scan(wrong, "Enter", apart);
        answered(&mut page, number + 1);
        page.wait(refused);
    }
    page.evaluate("document.querySelector('.lane .name').focus()");
    page.scan("CA0131103628", "Enter", apart);
    page.scan("", "Enter", apart);
    page.wait("document.querySelector('.lane.pass') !== null");
    assert_eq!(station.query("SELECT count(*) || '' FROM run"), ["1"]);
}

/// After lunch the next person scans the label of the board in another lane.
#[test]
fn a_lane_that_was_chosen_too_long_ago_gets_no_scan_and_the_page_says_so() {
    let order = "data = \"data\"\norder = \"scan-then-plug\"";
    let station = Station::private(2).where_instead("station.toml", "data = \"data\"", order);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    let chosen = "document.getElementById('station').dataset.chosen";
    assert_eq!(page.evaluate(chosen), "15000");
    page.evaluate(&format!("{chosen} = 200"));
    page.scan("HR:LANE:2", "Enter", Duration::ZERO);
    let says = |text: &str| format!("document.getElementById('answer').textContent.includes('{text}')");
    let is_over = says("Lane 2 is not chosen any more.");
    page.wait(&format!("{is_over} && document.querySelector('.lane.armed') === null"));
    assert_eq!(page.evaluate("document.getElementById('armed').textContent"), "");
    page.scan(&serial(0), "Enter", Duration::ZERO);
    page.wait(&says("lane 2 was chosen more than 15 s ago"));
    page.evaluate(&format!("{chosen} = 600000"));
    page.wait("document.querySelector('#lane-1.ready') !== null");
    page.evaluate("document.querySelector('#lane-1 .name').click()");
    page.scan(&serial(1), "Enter", Duration::ZERO);
    page.wait("document.querySelector('#lane-1.pass') !== null");
    assert_eq!(station.query("SELECT lane FROM run"), ["1"]);
}

/// A station with too many requests, and then one that is away.
#[test]
fn what_was_not_looked_at_chooses_no_lane_and_a_button_is_told_of_as_a_button() {
    let station = Station::private(2);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    page.scan("HR:LANE:2", "Enter", Duration::ZERO);
    page.wait("document.querySelector('#lane-2.armed') !== null");
    page.evaluate("(window.fetch = async () => new Response('{\"is_taken\": false, \"said\": \"busy\"}', {status: 503}), true)");
    page.scan("HR:LANE:1", "Enter", Duration::ZERO);
    let answer = "document.getElementById('answer').textContent";
    page.wait(&format!("{answer} === 'busy'"));
    assert_eq!(page.evaluate("document.querySelector('.lane.armed') === null"), true);
    page.evaluate("(window.fetch = async () => { throw new TypeError('away') }, true)");
    let button = "<form action=/lanes/1/abort method=post><button id=press></button></form>";
    page.evaluate(&format!("document.getElementById('floor').insertAdjacentHTML('beforeend', '{button}')"));
    page.evaluate("document.getElementById('press').click()");
    page.wait(&format!("{answer} === 'This did not arrive. Press it again.'"));
    page.scan("HR:LANE:1", "Enter", Duration::ZERO);
    page.wait(&format!("{answer} === 'The scan did not arrive. Scan the label again.'"));
}

/// With the keyboard's field open: into the field, by scanners of either kind, and outside it.
#[test]
fn no_scan_is_lost_while_the_field_is_open() {
    let station = Station::private(2);
    let serving = station.serve();
    let mut page = Chromium::live(&serving);
    page.evaluate("document.getElementById('type').click()");
    let ends = [("1", "Tab"), ("2", "Enter"), ("1", "Tab")];
    for (number, (lane, end)) in ends.into_iter().enumerate() {
        page.scan(&format!("HR:LANE:{lane}"), end, Duration::ZERO);
        page.scan(&serial(number), end, Duration::ZERO);
        answered(&mut page, 2 * (number + 1));
    }
    page.evaluate("const name = document.querySelector('#lane-2 .name'); name.focus(); name.click()");
    page.scan(&serial(3), "Enter", Duration::ZERO);
    answered(&mut page, 7);
    let sent = station.query("SELECT act || ' ' || subject || ' ' || detail FROM audit ORDER BY id");
    let expected: Vec<_> = ["1", "2", "1", "2"]
        .iter()
        .zip(0..)
        .map(|(lane, number)| format!("scan {lane} {}", serial(number)))
        .collect();
    assert_eq!(sent, expected);
}
