//! The report for a terminal: what a technician sees at a glance, with the verdict last.

use std::fmt::Write as _;

use anstyle::{AnsiColor, Style};
use comfy_table::{CellAlignment, Table, presets};

use halfrow::report::wording::{self, mark};
use halfrow::result::{FrameReport, FrameTiming, Outcome, Report, SoakReport, Suspect};
use halfrow::verdict::Verdict;
use halfrow::words::{self, grouped, plain};

use crate::flags;

/// The most columns of every line but the verdict's.
const WIDTH: usize = 80;
/// The most rows in the table of frames.
const MOST_FRAMES: usize = 20;
/// The most differences that are listed of a soak.
const MOST_DIFFERENCES: usize = 10;
/// The most characters of a frame's name.
const MOST_NAME: usize = 30;
/// Columns of the labels on the left.
const LABEL: usize = 9;

/// Units that stay on the same line as their figure.
const UNITS: [&str; 17] = [
    "%", "B", "kB", "MB", "GB", "B/s", "kB/s", "MB/s", "Hz", "kHz", "MHz", "s", "ms", "µs", "min", "h",
    "bits",
];

pub(crate) const BOLD: Style = Style::new().bold();
const GREEN: Style = AnsiColor::Green.on_default().bold();
const RED: Style = AnsiColor::Red.on_default().bold();
const YELLOW: Style = AnsiColor::Yellow.on_default().bold();
const DIM: Style = Style::new().dimmed();

/// The report with ANSI colours, which the printing stream removes where they do not belong.
#[must_use]
pub fn render(report: &Report) -> String {
    let mut sections = vec![head(report), checks(report)];
    if !report.frames.is_empty() {
        sections.push(frames(report));
    }
    sections.extend(report.soak.as_ref().map(soak));
    sections.push(figures(report));
    sections.extend(Some(advice(report)).filter(|advice| !advice.is_empty()));
    sections.push(verdict(report));
    sections.join("\n")
}

fn head(report: &Report) -> String {
    let mut text = format!("{BOLD}halfrow {}{BOLD:#} ({})\n", report.run.version, report.run.commit);
    let board = match &report.board.identity {
        None => wording::UNIDENTIFIED.to_owned(),
        Some(it) => format!(
            "{}, serial {}, build {}, datapath {}, wire {}",
            words::board_name(&it.name),
            it.serial,
            it.build,
            it.datapaths(),
            it.protocol
        ),
    };
    let board = format!("{} at {}: {board}", wording::kind_of(&report.board), report.board.target);
    push(&mut text, "board", Style::new(), &board);
    let tables = &report.tables;
    let size = format!("{}, {} x {}, {} bits", tables.source, tables.width, tables.height, tables.bits);
    push(&mut text, "tables", Style::new(), &size);
    if let Some(operator) = &report.run.operator {
        push(&mut text, "operator", Style::new(), operator);
    }
    text
}

/// A line for each check. The finding that decides the verdict is at the end of the text, so it is not repeated here.
fn checks(report: &Report) -> String {
    let widest = report.checks.iter().map(|check| check.name.name().len()).max().unwrap_or(0);
    let mut text = String::new();
    for check in &report.checks {
        let detail = if check.finding == report.finding { "see below".to_owned() } else { check.detail() };
        let name = format!("{}{:widest$}  ", label(colour(check.outcome), mark(check.outcome)), check.name);
        push_after(&mut text, &name, LABEL + widest + 2, &detail);
    }
    text
}

/// The table of frames. If there are too many, equal ones are left out.
fn frames(report: &Report) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(["frame", "name", "rows", "differences", "first at\nrow, column", "largest\nerror"]);
    let (listed, left_out) = wording::worth_listing(report, MOST_FRAMES);
    for frame in listed {
        let comparison = &frame.comparison;
        table.add_row([
            frame.number.to_string(),
            shortened(&frame_label(frame)),
            grouped(frame.rows),
            wording::differences(report, frame),
            comparison.first.map_or_else(String::new, |first| format!("{}, {}", first.row, first.column)),
            comparison.first.map_or_else(String::new, |_| comparison.largest.to_string()),
        ]);
    }
    for column in table.column_iter_mut().filter(|column| column.index != 1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut text = table.lines().fold(String::new(), |text, line| text + line.trim_end() + "\n");
    if left_out > 0 {
        let _ = writeln!(text, "{DIM}   … and {}{DIM:#}", words::count(left_out, "more frame"));
    }
    text
}

/// A frame's name, and what tells it from others of the same name.
fn frame_label(frame: &FrameReport) -> String {
    let timing = match frame.timing {
        FrameTiming::LeastBlanking { .. } => None,
        FrameTiming::Blanking { .. } => Some("sensor blanking"),
        FrameTiming::Gaps { .. } => Some("gaps"),
    };
    let name = wording::frame_name(frame);
    std::iter::once(&*name).chain(timing).collect::<Vec<_>>().join(", ")
}

/// What a soak judged, and when frames differed.
fn soak(soak: &SoakReport) -> String {
    let mut text = String::new();
    push(&mut text, "soak", Style::new(), &wording::soak(soak));
    for difference in soak.differences.iter().take(MOST_DIFFERENCES) {
        push(&mut text, "differs", RED, &wording::soak_difference(difference));
    }
    let left_out = soak.unlisted(MOST_DIFFERENCES);
    if left_out > 0 {
        let _ = writeln!(text, "{DIM}   … and {}{DIM:#}", words::count(left_out, "more difference"));
    }
    text
}

fn figures(report: &Report) -> String {
    let mut text = String::new();
    let no_style = Style::new();
    if let Some(latency) = &report.latency {
        push(&mut text, "latency", no_style, &wording::latency(latency));
    }
    if let Some(street) = wording::street(report) {
        push(&mut text, "street", no_style, &street);
    }
    push(&mut text, "link", no_style, &wording::link(&report.link));
    for told in report.within.iter().flat_map(wording::within) {
        push(&mut text, "within", no_style, &told);
    }
    if let Some(untouched) = wording::not_exercised(report) {
        push(&mut text, "limits", no_style, &untouched);
    }
    if let Some(share) = wording::coverage(report) {
        push(&mut text, "coverage", no_style, &share);
    }
    text
}

/// Who is suspected, and what to do about it.
fn advice(report: &Report) -> String {
    let mut text = String::new();
    for suspect in &report.suspects {
        push_suspect(&mut text, suspect);
    }
    for (place, line) in wording::what_to_do(report).iter().enumerate() {
        push(&mut text, if place == 0 { "do" } else { "" }, BOLD, line);
    }
    let mut codes = wording::codes(report);
    if codes.is_empty() {
        codes.extend(report.not_exercised.iter().map(|part| part.tagged().0));
    }
    if !codes.is_empty() {
        push(&mut text, "explain", DIM, &format!("halfrow explain {}", codes.join(" ")));
    }
    text
}

/// The verdict in one line, the last of the text.
fn verdict(report: &Report) -> String {
    let style = match report.verdict() {
        Verdict::Pass => GREEN,
        Verdict::Fail => RED,
        Verdict::Error => YELLOW,
    };
    let line = flags::named(&wording::verdict_line(report));
    let word = report.verdict().to_string();
    let rest = line.strip_prefix(&word).unwrap_or(&line);
    format!("{style}{word}{style:#}{rest}\n")
}

fn push_suspect(text: &mut String, suspect: &Suspect) {
    let share = wording::share(suspect).map_or_else(String::new, |share| format!(" ({share})"));
    let who = format!("{}{share}", suspect.place());
    push(text, "suspect", BOLD, &who);
    wording::of_suspect(suspect).iter().for_each(|line| push(text, "", BOLD, line));
}

/// Appends `words` with a label to their left.
pub(crate) fn push(text: &mut String, word: &str, style: Style, words: &str) {
    push_after(text, &label(style, word), LABEL, words);
}

/// A word at the left edge, [`LABEL`] columns wide.
fn label(style: Style, word: &str) -> String {
    format!("{style}{word}{style:#}{:1$}", "", LABEL.saturating_sub(word.len()))
}

/// Appends `words`, wrapped at [`WIDTH`], to the right of `head`, which takes `indent` columns.
fn push_after(text: &mut String, head: &str, indent: usize, words: &str) {
    for (place, line) in
        wrapped(&flags::named(&plain(words)), WIDTH.saturating_sub(indent)).iter().enumerate()
    {
        let _ = match place {
            0 => writeln!(text, "{head}{line}"),
            _ => writeln!(text, "{:indent$}{line}", ""),
        };
    }
}

/// The words of `text` on lines of at most `width` characters. A longer word has a line of its own, and a figure stays with its
/// unit.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in inseparable(text) {
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(&word),
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// The words of `text`. A figure with its unit counts as one word, and so does a size (`629.6 kB`, `1920 x 1080`).
fn inseparable(text: &str) -> Vec<String> {
    let is_figure = |word: &str| {
        word.rsplit(' ').next().is_some_and(|last| last.ends_with(|letter: char| letter.is_ascii_digit()))
    };
    let is_unit =
        |word: &str| word == "x" || UNITS.contains(&word.trim_end_matches([',', '.', ';', ':', ')']));
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match words.last_mut() {
            Some(before) if is_figure(before) && is_unit(word) || before.ends_with(" x") => {
                *before = format!("{before} {word}");
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// A name that is too long is cut at its beginning, since file names differ at the end.
fn shortened(name: &str) -> String {
    let letters = name.chars().count();
    if letters <= MOST_NAME {
        return name.to_owned();
    }
    std::iter::once('…').chain(name.chars().skip(letters - MOST_NAME + 1)).collect()
}

const fn colour(outcome: Outcome) -> Style {
    match outcome {
        Outcome::Passed => GREEN,
        Outcome::Failed => RED,
        Outcome::Error => YELLOW,
        Outcome::Skipped => DIM,
    }
}
