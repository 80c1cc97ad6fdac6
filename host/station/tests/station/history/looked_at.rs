//! The history's pages over HTTP, compared with what was entered.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use halfrow_station::record::RunCause;

use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run};
use super::served::Served;
use super::yields::{CASES, enter};
use crate::common::{program, reason};

/// Sixty runs of seven units in three lanes by two operators, one every hour.
fn many() -> (Served, Vec<(String, Run)>) {
    let mut made = Made::new();
    let ends = [End::Pass, End::Fail(&["memory"]), End::Error(RunCause::Link), End::Pass];
    let mut entered = Vec::new();
    for number in 0_usize..60 {
        let mut run = Run::of(&format!("S{}", number % 7), ends[number % 4]);
        run.started_ms = BEGIN_MS + HOUR_MS * number as i64;
        run.lane = (number % 3).to_string();
        run.operator = ["weber", "lang"][number / 2 % 2].to_owned();
        entered.push((made.run(&run), run));
    }
    (Served::of(made), entered)
}

/// What follows each `before`, up to `end`.
pub(super) fn all_between(page: &str, before: &str, end: char) -> Vec<String> {
    page.split(before).skip(1).map(|rest| rest.split(end).next().unwrap().to_owned()).collect()
}

/// The runs that a list shows, in its order.
pub(super) fn listed(page: &str) -> Vec<String> {
    all_between(page, "<td class=\"when\"><a href=\"/runs/", '"')
}

/// The runs of the list at `path` and of all pages that follow it.
fn walked(served: &Served, path: &str) -> Vec<String> {
    let mut runs = Vec::new();
    let mut path = path.to_owned();
    loop {
        let page = served.page(&path);
        runs.extend(listed(&page));
        match all_between(&page, "<a rel=\"next\" href=\"", '"').first() {
            Some(next) => path = next.replace("&amp;", "&"),
            None => return runs,
        }
    }
}

#[test]
fn lists_are_what_was_entered_page_by_page_whatever_is_asked_for() {
    let (served, entered) = many();
    let wanted = |is: &dyn Fn(&Run) -> bool| -> Vec<String> {
        entered.iter().rev().filter(|(_, run)| is(run)).map(|(id, _)| id.clone()).collect()
    };
    assert_eq!(listed(&served.page("/history")).len(), 50, "a page has an end");
    assert_eq!(walked(&served, "/history"), wanted(&|_| true));
    assert_eq!(walked(&served, "/history?serial=S3"), wanted(&|run| run.serial == "S3"));
    assert_eq!(
        walked(&served, "/history?lane=2&verdict=PASS"),
        wanted(&|run| { run.lane == "2" && run.end == End::Pass })
    );
    assert_eq!(
        walked(&served, "/history?operator=lang&verdict=error&plan=final"),
        wanted(&|run| { run.operator == "lang" && matches!(run.end, End::Error(_)) })
    );
    assert_eq!(
        walked(&served, "/history?from=2026-11-02&until=2026-11-02"),
        wanted(&|run| { (24..48).contains(&((run.started_ms - BEGIN_MS) / HOUR_MS)) })
    );
    assert_eq!(walked(&served, "/history?plan=other"), Vec::<String>::new());
    for wrong in ["verdict=GOOD", "from=yesterday", "until=2026-02-30", "after=7"] {
        let answer = served.get(&format!("/history?{wrong}"));
        assert_eq!(answer.status, 400, "{wrong}");
    }
}

/// The numbers of a line of the yield: units, first pass, in the end, waived, flipped, runs, errors, crashes.
fn yield_line(served: &Served) -> Vec<u64> {
    let page = served.page("/yield?plan=final");
    let Some((_, row)) = page.split_once("<td class=\"name\">") else { return Vec::new() };
    let row = row.split("</tr>").next().unwrap();
    let counts = all_between(row, "<span class=\"soft\">", '<');
    let counts: Vec<Vec<u64>> = counts
        .iter()
        .filter_map(|count| count.split_once('/'))
        .map(|(count, of)| vec![count.parse().unwrap(), of.parse().unwrap()])
        .collect();
    let numbers = all_between(row, "<td class=\"number\">", '<');
    let [units, flipped, waived, runs, crashes] =
        numbers.iter().map(|number| number.parse().unwrap()).collect::<Vec<u64>>()[..]
    else {
        panic!("{row}")
    };
    // Without units there is no share.
    let rate = |place: usize| counts.get(place).map_or([0, 0], |rate| [rate[0], rate[1]]);
    let [first, last, errors] = [rate(0), rate(1), rate(2)];
    assert_eq!((first[1], last[1], errors[1]), (units, units, runs));
    vec![units, first[0], last[0], waived, flipped, runs, errors[0], crashes]
}

#[test]
fn the_yield_s_page_says_what_was_worked_by_hand() {
    for (story, right) in CASES {
        let mut made = Made::new();
        for (word, hour) in story.split(' ').zip(0..) {
            enter(&mut made, word, hour);
        }
        let served = Served::of(made);
        // The served program closes an open run as a crash.
        if story.contains(":O") {
            continue;
        }
        assert_eq!(yield_line(&served), right, "{story}");
    }
}

#[test]
fn no_share_of_a_yield_stands_without_its_interval_and_flips_are_listed_by_unit() {
    let (served, entered) = many();
    for by in ["plan", "day", "lane"] {
        let page = served.page(&format!("/yield?by={by}"));
        let shares = page.matches("<span class=\"share\">").count();
        assert!(shares > 0);
        assert_eq!(shares, page.matches("</span> <span class=\"interval\">").count());
        // The head of the first column names what the lines are about.
        let head = match by {
            "day" => "Day, Plan",
            "lane" => "Lane, Plan",
            _ => "Plan",
        };
        assert!(page.contains(&format!("<table class=\"yields\"><thead><tr><th>{head}</th>")), "{page}");
    }
    let page = served.page("/yield");
    let judged = |serial: &str| -> Vec<End> {
        let of_unit = entered.iter().map(|(_, run)| run).filter(|run| run.serial == serial);
        of_unit.map(|run| run.end).filter(|end| !matches!(end, End::Error(_))).collect()
    };
    let serials: BTreeSet<_> = entered.iter().map(|(_, run)| run.serial.clone()).collect();
    let is_flip = |serial: &&String| {
        let judged = judged(serial);
        judged[0] != End::Pass && *judged.last().unwrap() == End::Pass
    };
    let right: BTreeSet<_> = serials.iter().filter(is_flip).cloned().collect();
    assert!(!right.is_empty() && right.len() < serials.len());
    let told: BTreeSet<_> = all_between(&page, "<a href=\"/unit?serial=", '"').into_iter().collect();
    assert_eq!(told, right);
}

#[test]
fn failures_have_bars_by_part_and_by_check() {
    let (served, _) = many();
    let row = |page: &str, name: &str| {
        let (_, row) = page.split_once(&format!("<th scope=\"row\">{name}</th>")).unwrap();
        row.split("</tr>").next().unwrap().to_owned()
    };
    assert!(row(&served.page("/pareto"), "memory").contains("</svg> 15</td>"));
    assert!(row(&served.page("/pareto?by=check"), "verify").contains("</svg> 15</td>"));
    let page = served.page("/pareto");
    assert!(page.contains("Judged runs that failed: 15 of "), "{page}");
    assert!(page.contains("Products: CAM-T."), "{page}");
    for nothing in ["plan=none", "product=none", "from=2026-12-05"] {
        assert!(
            served.page(&format!("/pareto?{nothing}")).contains("No run that matches was judged."),
            "{nothing}"
        );
    }
    // As at the command line.
    for page in ["pareto", "yield", "history", "history.csv"] {
        let answer = served.get(&format!("/{page}?from=2026-12-05&until=2026-11-01"));
        assert!(
            answer.status == 400 && answer.text().contains("“2026-11-01” cannot be"),
            "{}",
            answer.text()
        );
    }
}

#[test]
fn what_a_scanner_or_a_person_said_is_never_markup() {
    let mut made = Made::new();
    let script = "<script>alert(1)</script>\"'&";
    let mut run = Run::of(script, End::Fail(&["memory<b>"]));
    run.operator = script.to_owned();
    run.lane = "<i>".to_owned();
    let failed = made.run(&run);
    run.started_ms += HOUR_MS;
    run.end = End::Pass;
    made.run(&run);
    made.store.waive(&failed, script, &reason(script)).unwrap();
    let served = Served::of(made);
    let unit = "/unit?serial=%3Cscript%3Ealert(1)%3C%2Fscript%3E%22%27%26";
    let query = "/history?serial=%3Cscript%3E&operator=%22%3E%3Cscript%3E";
    for path in ["/history", "/yield?by=lane", "/pareto", unit, query, &format!("/runs/{failed}")] {
        let page = served.page(path);
        let markup = page.to_lowercase();
        let body = markup.split_once("<main").unwrap().1;
        for wrong in ["<script", "<i>", "<b>a", "\"'&\""] {
            assert!(!body.contains(wrong), "{path} has {wrong}");
        }
        assert!(path == "/pareto" || body.contains("&lt;"), "{path}");
    }
    assert_eq!(served.get(&query.replace('?', "/x?")).status, 404);
}

#[test]
fn a_run_s_page_says_all_of_it_and_gives_it_to_others() {
    let mut made = Made::new();
    let run = Run { evidence: vec!["<h1>told</h1>"], ..Run::of("S1", End::Fail(&["memory", "clock"])) };
    let id = made.run(&run);
    made.store.waive(&id, "engel", &reason("used as it is")).unwrap();
    let served = Served::of(made);
    let page = served.page(&format!("/runs/{id}"));
    for said in [
        "Suspected: memory, bit 3. It explains 75 % of what is wrong.",
        "Look at it.",
        "used as it is",
        "0123456789abcdef",
        "frames.samples_differing",
        "≤ 1004",
        "verify &quot;failed&quot;, &lt;board&gt;",
    ] {
        assert!(page.contains(said), "{said} is missing in\n{page}");
    }
    let hash = halfrow::result::sha256([b"<h1>told</h1>"]);
    let evidence = served.get(&format!("/runs/{id}/evidence/{hash}"));
    assert_eq!((evidence.status, evidence.body.as_slice()), (200, b"<h1>told</h1>".as_slice()));
    assert_eq!(evidence.header("content-type"), Some("text/plain; charset=utf-8"));
    assert_eq!(evidence.header("x-content-type-options"), Some("nosniff"));
    assert_eq!(evidence.header("cache-control"), Some("private, no-cache"));
    // The record has a hash, too, but is no attachment of the run; nor is an attachment of another run.
    let stored = served.folder().verdict_of(&id).unwrap().unwrap();
    for wrong in [stored.record_sha256.as_str(), &"0".repeat(64), "..%2F..%2Fstation.db", "x"] {
        for at in ["evidence", "preview"] {
            assert_eq!(served.get(&format!("/runs/{id}/{at}/{wrong}")).status, 404, "{at} {wrong}");
        }
    }
    // An attachment that is not a picture has no preview.
    assert_eq!(served.get(&format!("/runs/{id}/preview/{hash}")).status, 404);
    let record = served.get(&format!("/runs/{id}/export/record"));
    assert_eq!(record.body, served.folder().blobs().get(&stored.record_sha256).unwrap());
    for (format, begins) in [("junit", "<?xml"), ("csv", "run,"), ("openhtf", "{")] {
        let answer = served.get(&format!("/runs/{id}/export/{format}"));
        assert!(answer.text().starts_with(begins), "{format}: {}", answer.text());
        assert!(answer.header("content-disposition").unwrap().starts_with("attachment; "));
    }
    for missing in ["/runs/x", "/unit?serial=S2", "/unit", &format!("/runs/{id}/export/pdf")] {
        assert_eq!(served.get(missing).status, 404, "{missing}");
    }
}

#[test]
fn a_run_whose_record_is_damaged_is_told_as_such() {
    let mut made = Made::new();
    let id = made.run(&Run::of("S1", End::Pass));
    let hash = made.folder().verdict_of(&id).unwrap().unwrap().record_sha256;
    std::fs::write(made.folder().blobs().path(&hash), "{}").unwrap();
    let served = Served::of(made);
    assert!(served.page(&format!("/runs/{id}")).contains("holds other bytes than its name says"));
    assert_eq!(served.get(&format!("/runs/{id}/export/record")).status, 503);
}

#[test]
fn a_unit_s_page_tells_its_story_in_every_language() {
    let mut made = Made::new();
    for (end, hour) in [End::Error(RunCause::Link), End::Fail(&["memory"]), End::Pass].into_iter().zip(0..) {
        made.run(&Run::of("S1", end).at_hour(hour));
    }
    let served = Served::of(made);
    let unknown = served.get("/unit?serial=NOPE");
    assert_eq!(unknown.status, 404);
    assert!(
        unknown.text().contains("Nothing was tested here under the serial number NOPE."),
        "{}",
        unknown.text()
    );
    for (language, flip) in [
        ("en", "First FAIL, in the end PASS under final"),
        ("de", "Erst FAIL, am Ende PASS nach final"),
        ("zh", "先 FAIL，最终 PASS"),
    ] {
        let page = served.get_in("/unit?serial=S1", language).text();
        assert!(page.contains(flip), "{page}");
        let verdicts: Vec<_> = all_between(&page, "<p class=\"line\"><span class=\"verdict ", '"');
        assert_eq!(verdicts, ["pass", "fail", "error"]);
    }
}

/// More runs than are read at a time.
fn hundreds() -> Made {
    let mut made = Made::new();
    for number in 0_usize..450 {
        let end = if number.is_multiple_of(3) { End::Fail(&["memory"]) } else { End::Pass };
        let started_ms = BEGIN_MS + HOUR_MS * number as i64;
        let operator = ["weber", "=1+1", "O'Neil, \"J\""][number % 3].to_owned();
        made.run(&Run { started_ms, operator, ..Run::of(&format!("S{number}"), end) });
    }
    made
}

#[test]
fn a_table_of_a_filter_is_what_the_command_writes() {
    let made = hundreds();
    let place = tempfile::tempdir().unwrap();
    let written = |filter: &[&str], name: &str| {
        let to = place.path().join(name);
        let output = Command::new(program())
            .args(["export", "--format", "csv", "--data"])
            .arg(made.as_ref() as &Path)
            .arg("--to")
            .arg(&to)
            .args(filter)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read(to).unwrap()
    };
    let all = written(&[], "all.csv");
    let failed = written(&["--verdict", "FAIL", "--operator", "weber"], "failed.csv");
    assert!(all.len() > 3 * failed.len() / 2 && failed.len() > 50_000, "{} {}", all.len(), failed.len());
    let served = Served::of(made);
    let table = served.get("/history.csv");
    assert_eq!(table.header("content-disposition"), Some("attachment; filename=\"runs.csv\""));
    assert_eq!(table.header("content-type"), Some("text/csv; charset=utf-8"));
    assert!(table.body == all, "{} bytes, and {} are right", table.body.len(), all.len());
    let page = served.page("/history?verdict=FAIL&operator=weber");
    assert!(page.contains("href=\"/history.csv?verdict=FAIL&amp;operator=weber\" download"), "{page}");
    assert!(served.get("/history.csv?verdict=FAIL&operator=weber").body == failed);
    assert_eq!(served.get("/history.csv?verdict=MAYBE").status, 400);
    let nothing = served.get("/history.csv?serial=nobody").text();
    assert!(nothing.starts_with("run,product,serial,") && nothing.lines().count() == 1, "{nothing}");
}

/// Part of a table must not be taken for the whole.
#[test]
fn a_table_that_cannot_go_on_breaks_off() {
    let made = hundreds();
    let page = halfrow_station::history::runs::page(&made.now(), &Default::default(), None, 400).unwrap();
    let [newest, lost] =
        [page.runs.first(), page.runs.last()].map(|run| run.unwrap().record_sha256.clone().unwrap());
    let served = Served::of(made);
    assert!(served.get("/history.csv").is_whole);
    std::fs::remove_file(served.folder().blobs().path(&lost)).unwrap();
    let broken = served.get("/history.csv");
    assert_eq!(broken.status, 200, "its beginning was right");
    assert!(!broken.is_whole && !broken.body.is_empty());
    // One that cannot begin says what is damaged.
    std::fs::write(served.folder().blobs().path(&newest), "damaged").unwrap();
    let refused = served.get("/history.csv");
    assert!(refused.status == 503 && refused.text().contains(&newest), "{}", refused.text());
}
