use halfrow::compare::Comparison;
use halfrow::report;
use halfrow::result::{
    Account, BoardKind, BoardReport, CoverageReport, Defect, Evidence, Finding, LinkReport, Problem,
    Reconnection, Report, Suspect,
};

use crate::made;

/// Elements that have no end tag.
const VOID: [&str; 3] = ["meta", "img", "!DOCTYPE"];

pub(crate) fn page(report: &Report, evidence: &[Evidence]) -> String {
    report::html(report, evidence).unwrap()
}

/// The names of all tags; those of end tags with their slash.
fn tags(page: &str) -> Vec<&str> {
    let name = |piece: &'_ str| piece.find(|end: char| " >".contains(end)).unwrap_or(piece.len());
    page.split('<').skip(1).map(|piece| &piece[..name(piece)]).collect()
}

#[test]
fn every_element_is_closed_in_order() {
    let (report, evidence) = made::fail();
    let mut open = Vec::new();
    for tag in tags(&page(&report, &evidence)) {
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name.to_owned())),
            None if VOID.contains(&tag) => {}
            None => open.push(tag.to_owned()),
        }
    }
    assert_eq!(open, Vec::<String>::new());
}

#[test]
fn nothing_from_outside_becomes_markup() {
    let (report, evidence) = made::fail();
    let page = page(&report, &evidence);
    assert!(!tags(&page).contains(&"script"));
    assert!(page.contains("frames/&lt;script&gt;alert(1)&lt;/script&gt;&amp;.pgm"));
}

/// The permitted number of retries is not too many.
#[test]
fn a_link_s_retries_are_told_with_the_most_that_are_allowed() {
    let report = made::pass();
    let link = LinkReport { retries: 30, retry_limit: 30, ..report.link.clone() };
    assert!(report::wording::link(&link).contains("0 damaged, 30 sent again (limit 30)"));
    let page = page(&Report { link, ..report }, &[]);
    assert!(page.contains("30; limit 30"), "{page}");
}

#[test]
fn a_pass_lists_what_was_not_exercised() {
    assert!(page(&made::pass(), &[]).contains("<li>samples of 8 or 10 bits</li>"));
    assert!(!page(&made::fail().0, &[]).contains("Not exercised"));
}

/// What a PASS does not cover belongs to the verdict, and the frame to look at is one that differs.
#[test]
fn what_was_not_exercised_and_what_differs_come_first() {
    let pass = page(&made::pass(), &[]);
    let place = |page: &str, words: &str| page.find(words).unwrap_or_else(|| panic!("{words}"));
    assert!(place(&pass, "<h2>Not exercised</h2>") < place(&pass, "<h2>Checks</h2>"));
    let (mut report, mut evidence) = made::fail();
    evidence.insert(0, Evidence { index: 0, found: evidence[0].expected.clone(), ..evidence[0].clone() });
    report.frames[0].number = 1;
    report.frames[1].number = 2;
    let page = page(&report, &evidence);
    assert!(place(&page, "</span> Frame 2: ") < place(&page, "</span> Frame 1: "));
}

/// A row that the board swallowed is one row, and the others were given up when it was.
#[test]
fn a_frame_whose_row_was_swallowed_is_wrong_and_the_rows_behind_it_are_not_called_lost() {
    let (mut report, mut evidence) = made::fail();
    report.frames[1].comparison = Comparison { samples: 64 * 7, ..Comparison::new(64, 40) };
    report.frames[1].rows = 7;
    evidence[0].found = evidence[0].expected.clone();
    let number = report.frames[1].number;
    report.finding = Finding::RowSwallowed { row: 3, frame: number, again: 3 };
    assert_eq!(report::wording::differences(&report, &report.frames[1]), "incomplete");
    let page = page(&report, &evidence);
    assert!(page.contains(&format!("FAIL</span> Frame {number}: ")) && !page.contains(">ERROR<"), "{page}");
    assert!(page.contains("33 rows had not come back when the run ended, and are black"), "{page}");
}

#[test]
fn a_pass_says_what_share_of_faults_it_stands_for_where_it_may() {
    let of = |kind, coverage| {
        let report = made::pass();
        let report = Report { board: BoardReport { kind, ..report.board }, coverage, ..report };
        report::wording::coverage(&report)
    };
    // Rounding to the nearest would make it 100.0 %.
    let measured = Some(CoverageReport { found: 1999, faults: 2000, equivalent: 100 });
    let share = "finds 99.9 % of 2,000 single faults of the Verilog at this geometry";
    assert_eq!(of(BoardKind::Sim, measured).as_deref(), Some(share));
    assert_eq!(of(BoardKind::Hardware, None).as_deref(), Some("of this plan and build was not measured"));
    assert_eq!(of(BoardKind::Mock, measured), None);
    assert_eq!(report::wording::coverage(&Report { coverage: measured, ..made::fail().0 }), None);
}

#[test]
fn each_figure_stands_there_whatever_others_the_run_has() {
    let pass = made::pass();
    let coverage = Some(CoverageReport { found: 1999, faults: 2000, equivalent: 100 });
    let board = BoardReport { kind: BoardKind::Sim, ..pass.board.clone() };
    let alone = Report { latency: None, street: None, board, coverage, ..pass };
    assert!(page(&alone, &[]).contains("<dt>Coverage</dt>"));
    let of_mock = Report { latency: None, street: None, ..made::pass() };
    assert!(!page(&of_mock, &[]).contains("Figures"));
}

/// The headline of a FAIL counts the samples that differ; other headlines do not.
#[test]
fn the_banner_says_each_figure_once() {
    let banner = |report: &Report| page(report, &[]).split_once("</header>").unwrap().0.to_owned();
    let (fail, _) = made::fail();
    let differing = banner(&fail);
    assert!(differing.contains("5 of 2,076,160 samples differ, in 1 of 2 frames"), "{differing}");
    let below = differing.split_once("<p class=\"facts\">").unwrap().1;
    assert!(below.starts_with("latency 972 = 960 + 12 pixel clocks, "), "{below}");
    assert!(!below.contains(" different") && !below.contains("frames"), "{below}");
    let gone = Report { finding: Finding::TablesUnused {}, ..made::fail().0 };
    assert!(banner(&gone).contains("<p class=\"facts\">2 frames, 5 of "), "{}", banner(&gone));
}

#[test]
fn nothing_is_loaded_from_anywhere() {
    let (report, evidence) = made::fail();
    let page = page(&report, &evidence);
    let sources: Vec<_> = page.split("src=\"").skip(1).collect();
    assert!(sources.len() >= 7 && sources.iter().all(|source| source.starts_with("data:image/png;base64,")));
    assert!(!["href=", "url(", "@import", "http://", "https://"].iter().any(|loads| page.contains(loads)));
    assert!(page.contains("default-src 'none'"));
}

#[test]
fn the_banner_says_that_no_hardware_was_tested() {
    let page = page(&made::pass(), &[]);
    let (banner, _) = page.split_once("</header>").unwrap();
    assert!(banner.contains("PASS") && banner.contains("mock board: no hardware was tested"));
}

#[test]
fn a_fail_shows_suspects_and_what_to_do() {
    let (report, evidence) = made::fail();
    let page = page(&report, &evidence);
    for words in ["row 3's factor, bit 4", "Check entry 3 of the row table", "Reload the bitstream"] {
        assert!(page.contains(words), "{words}");
    }
    assert!(page.contains("row 3, column 0: expected 193, found 209"));
    assert!(page.contains("halfrow verify --frame 'my frames/a.pgm'"));
}

/// Whatever the result, the head says which board it was, and when; what to do follows.
#[test]
fn the_head_names_board_serial_time_and_operator() {
    for (report, board) in [
        (made::pass(), "mock, serial <strong>000000000000002a</strong>, at mock"),
        (made::fail().0, "mock, serial <strong>000000000000002a</strong>, at mock"),
        (made::error(), "a board that did not identify itself, at serial:/dev/ttyUSB1"),
    ] {
        let page = page(&report, &[]);
        let (head, rest) = page.split_once("</header>").unwrap();
        let when_and_who = format!("{} · tested by Ada Weber", report.run.started);
        assert!(head.contains(board) && head.contains(&when_and_who), "{head}");
        let first = rest.split("<h2>").nth(1).unwrap();
        assert_eq!(
            first.starts_with("What to do"),
            report.verdict() != halfrow::verdict::Verdict::Pass,
            "{first}"
        );
    }
}

#[test]
fn evidence_of_a_frame_that_was_never_streamed_is_passed_over() {
    let (report, mut evidence) = made::fail();
    evidence[0].index = 99;
    assert!(!page(&report, &evidence).contains("<img"));
}

#[test]
fn a_soak_is_shown_over_time_with_what_differed() {
    let page = page(&made::soaked(), &[]);
    assert!(page.contains("8 h 0 min of 8 h 0 min: 1,326,976 frames in 480 bursts, 2 of which differ."));
    assert!(page.contains("Frames judged in each 2 min 8 s: at most 5,924"));
    // Intervals without a frame have no bar, and those in which frames differ have one of another class.
    let path = |class: &str| {
        let rest = page.split(&format!("class=\"{class}\" d=\"")).nth(1).unwrap();
        rest.split('"').next().unwrap().matches('M').count()
    };
    assert_eq!((path("judged"), path("wrong")), (224, 2));
    let when = "after 2 h 13 min, in a burst with content of seed 08d12e6a and tables of generation 2:";
    assert!(page.contains(when));
    assert!(!self::page(&made::pass(), &[]).contains("over time"));
}

/// Two boards' reports are compared by what came out.
#[test]
fn the_hash_of_what_went_in_is_told_from_that_of_what_came_out() {
    let (report, evidence) = made::fail();
    let page = page(&report, &evidence);
    let hash = |name: &str| {
        let (_, rest) = page.split_once(&format!("<dt>{name}</dt><dd>")).unwrap_or_else(|| panic!("{name}"));
        rest.split('<').next().unwrap().to_owned()
    };
    assert_eq!(hash("SHA-256 of the samples that went in"), report.frames[1].sha256);
    let bytes: Vec<u8> = evidence[0].found.samples().iter().flat_map(|sample| sample.to_le_bytes()).collect();
    assert_eq!(hash("SHA-256 of those that came out"), halfrow::result::sha256([bytes]));
}

/// A suspect for differences that nothing known explains.
fn unknown() -> Suspect {
    let defect = Defect::NoneKnown {
        rows: None,
        columns: None,
        least: None,
        most: None,
        bright: None,
        bits: Vec::new(),
        unstreamed: false,
        frames: 1,
        of_frames: 2,
    };
    Suspect { defect, account: Account::Nothing, explained: 0.0 }
}

#[test]
fn a_report_asks_nobody_to_make_one() {
    let (mut report, evidence) = made::fail();
    let known = report.suspects.clone();
    report.suspects = vec![unknown()];
    assert!(page(&report, &evidence).contains("Look at the difference maps below."));
    report.frames.truncate(1);
    let without_maps = page(&report, &[]);
    assert!(without_maps.contains("every frame that has a map is right"), "{without_maps}");
    // Next to a suspect that explains the differences, one that does not is not worth showing.
    report.suspects = [known, vec![unknown()]].concat();
    let page = page(&report, &[]);
    assert!(page.contains("row 3's factor") && !page.contains("an unknown part"), "{page}");
}

/// WCAG 2.1, success criterion 1.4.11: a contrast of 3 : 1 between what must be told apart, which survives every kind of colour
/// blindness.
#[test]
fn intervals_that_differ_are_told_from_others_by_brightness() {
    let page = page(&made::soaked(), &[]);
    let light = |colour: &str| {
        let channel = |at: usize| {
            let value = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * channel(0) + 0.7152 * channel(2) + 0.0722 * channel(4)
    };
    let values = |name: &str| -> Vec<f64> {
        page.split(&format!("{name}: #")).skip(1).map(|rest| light(&rest[..6])).collect()
    };
    let (judged, wrong) = (values("--judged"), values("--wrong"));
    assert_eq!((judged.len(), wrong.len()), (3, 3), "light, dark and on paper");
    for (one, other) in judged.into_iter().zip(wrong) {
        let ratio = (one.max(other) + 0.05) / (one.min(other) + 0.05);
        assert!(ratio >= 3.0, "{ratio}");
    }
}

#[test]
fn times_away_that_are_alike_stand_in_one_line() {
    let mut report = made::pass();
    let away = |reason: &str| Reconnection {
        reason: Problem::new("link-closed", reason),
        seconds_away: 0.0,
        kept_tables: None,
    };
    report.link.reconnections = [vec![away("unplugged"); 16], vec![away("closed")]].concat();
    let page = page(&report, &[]);
    assert!(page.contains("<dd>16 times, each for 0.0 s: unplugged</dd>"), "{page}");
    assert_eq!(page.matches("Went away").count(), 2);
}
