//! `halfrow codes`, and the codes of the program's own errors.

use std::error::Error;

use clap::Args;
use halfrow_mock::{ConnectError, OptionError};
use halfrow_pipe::{FaultError, TargetError as BoardTargetError, ValueError};
use halfrow_program::codes::{self as program, parameters};
use serde::Serialize;
use serde_json::json;

use super::load::LoadError;
use super::{Context, Failure, print};
use crate::call_error::CallError;
use crate::document::print_result;
use crate::exit::Exit;
use crate::pool::PoolError;
use crate::serve::ServeError;
use crate::settings::SettingsError;
use crate::signals::Unheard;
use halfrow::result::codes::{self, CodeList, Coded};
use halfrow::result::wording::AT_THE_BENCH;
use halfrow::result::{Finding, Problem, examples};
use halfrow::run::{RECORDING_LOST, REPORT_LOST};
use halfrow_lab::paper::{FolderError, MarkedError, PaperError, PhotographError};
use halfrow_lab::training::TrainingError;

#[derive(Debug, Args)]
pub(super) struct Arguments {}

codes::codes! {
    CallError {
        NoJson [command] => "command-without-json",
        NoDocument [command] => "command-without-document",
        CodeUnknown [code] => "code-unknown",
        NobodyCorrects => "corrector-missing",
        RecordingAnswersNothingNew => "recording-answers-nothing-new",
        FaultWithoutEffect [target, reason] => "fault-without-effect",
        OtherThanTables [option, path] => "option-contradicts-tables",
        PitchAlone => "pixel-pitch-without-effect",
        LensPitchWithoutFile => "lens-pitch-without-lens-file",
        RadiusTwice => "radius-given-twice",
        RowsOfGrid => "rows-of-grid",
        EntriesOfRows => "entries-without-grid",
        FieldOfViewVoid [what] => "field-of-view-without-effect",
        LensSizeMissing [path] => "lens-size-missing",
        OtherFormat [path] => "frame-format-contradicted",
        OneFile [path, frames, option] => "one-file-for-several-frames",
        Unnamed [path] => "input-without-name",
        FramesShare [path] => "frames-share-a-file",
        FolderNotMade [path] => "folder-not-made",
        FolderUnlisted [path] => "folder-not-listed",
        NoPhotograph => "photographs-missing",
        PhotographTwice [first, second] => "photograph-given-twice",
        PhotographsMissing => "paper-photographs-missing",
        Stopped [by] => "command-stopped",
        Unreadable [path] => "input-unreadable",
        StationMissing [path] => "station-missing",
        StationNotStarted [path] => "station-not-started",
    }
    LoadError {
        Missing [path] => "bitstream-missing",
        RecordMalformed [path] => "bitstream-record-malformed",
        OtherBitstream [path, record] => "bitstream-differs-from-record",
        Nameless [path, known] => "bitstream-board-not-named",
        UnknownBoard [path, board, known] => "bitstream-board-unknown",
        OtherBoard [path, board, named] => "bitstream-for-other-board",
        OfPool [target] => "bitstream-for-board-of-pool",
        BuiltIn [target] => "bitstream-for-built-in-board",
        LoaderMissing [other] => "loader-missing",
        LoaderNotStarted [call] => "loader-not-started",
        LoaderFailed [call, said, device, other] => "loader-failed",
        LoaderLate [call, deadline, said] => "loader-late",
        Stopped [call, by] => "loading-stopped",
        NotAwaited [by] => "loaded-board-not-awaited",
        OtherBuild [target, board, file] => "board-of-other-build",
    }
    SettingsError {
        Io [path] => "settings-file-unreadable",
        UnknownKey [path, line, key] => "settings-key-unknown",
        Value [path, line, reason] => "settings-value-wrong",
    }
    ServeError {
        Door [what] => "serving-place-not-opened",
        Exists (path) => "serving-link-exists",
        Unnameable (path) => "serving-link-unnameable",
        Board => "served-board-failed",
    }
    PaperError {
        Board => "paper-board-failed",
        NoBoard => "paper-board-missing",
        Synthesis [path] => "synthesis-report-unreadable",
        Frame => "paper-frame-not-made",
        Correct => "paper-frame-not-corrected",
        Geometry => "paper-geometry-refused",
        Lens => "paper-lens-refused",
        Camera => "paper-camera-refused",
        Room => "paper-grid-refused",
        Lines => "scene-lines-contradict",
        Tables => "paper-tables-refused",
        = Misfit,
    }
    MarkedError {
        Photograph => "photograph-not-read",
        Io [path] => "lines-file-unreadable",
        Content [path] => "lines-file-malformed",
        Radius [path, radius] => "lines-file-without-circle",
        NoLine [path] => "lines-file-without-line",
        Line [path, number] => "scene-line-not-shown",
        Outside [path, number, width, height] => "scene-line-outside",
    }
    PhotographError {
        Read [number] => "photograph-unreadable",
        Size [path, width, height] => "photograph-of-other-size",
    }
    FolderError {
        Make [path] => "paper-folder-not-made",
        Picture => "paper-picture-not-encoded",
        = Write,
    }
    TrainingError {
        Geometry => "photograph-of-impossible-size",
        Singular => "photographs-say-too-little",
        Kernel => "trained-kernel-impossible",
        Lens => "training-lens-refused",
        Table => "training-tables-refused",
        Frame => "training-frame-not-made",
        Correct => "training-frame-not-corrected",
    }
    PoolError {
        NoKind => "pool-without-kind",
        NoStation => "pool-without-station",
        None [kind] => "pool-without-board",
        Unread => "pool-unreadable",
        Message [line] => "pool-message-wrong",
        Target [board, target] => "pool-board-without-place",
    }
    ConnectError {
        = Target,
        = Build,
    }
    BoardTargetError {
        Board => "board-option-wrong",
        Pipe => "wire-option-wrong",
        Fault => "fault-not-made",
        UnknownFault [name, known] => "fault-unknown",
        TwoFaults [first, second] => "faults-exclude-each-other",
        UnknownKey [key, known] => "board-option-unknown",
        Ambiguous [key, pipe, board] => "fault-option-ambiguous",
        Duplicate [key] => "board-option-repeated",
    }
    ValueError {
        NotANumber [key, value, least, most] => "option-is-no-whole-number",
        OutOfRange [key, value, least, most] => "option-out-of-range",
        NotAWord [key, value, known] => "option-word-unknown",
        Decimal [key, value, least, most] => "option-is-no-number",
        TwoPlaces [first, second] => "fault-strikes-in-two-places",
        Missing [key] => "option-without-value",
    }
    OptionError {
        RingNotPowerOfTwo [ring] => "board-ring-not-power-of-two",
        RingTooShort [ring, max_width] => "board-ring-too-short",
        OddWidth [max_width] => "board-width-odd",
        NoDepth => "board-without-depth",
        NoAddressLine [bit, last] => "fault-without-address-line",
        NoTap [key, tap] => "fault-without-tap",
        NoWeight [weight] => "fault-without-weight",
        NoLongerLatency [claimed, most] => "fault-without-longer-latency",
        NoOtherBank => "fault-without-other-bank",
        NoBursts => "fault-without-bursts",
        = Value,
    }
    ;
    FaultError [fault] => "fault-parameter-wrong"
    ;
    Unheard => "signals-unheard"
}

fn known(error: &(dyn Error + 'static)) -> Option<Coded> {
    // Errors of other crates may contain an error of the library, whose code the library knows.
    lookup(error).filter(|coded| coded.code != codes::FOREIGN).or_else(|| program::known(error))
}

/// Why a command has no result.
pub(crate) fn problem(exit: Exit, error: &anyhow::Error) -> Problem {
    program::problem(exit, error, known)
}

pub(super) fn run(_: &Arguments, context: &Context) -> Result<Exit, Failure> {
    if context.json {
        print_result("codes", json!({ "codes": all() }))?;
    } else {
        print(page().trim_end())?;
    }
    Ok(Exit::Pass)
}

fn error_lists() -> impl Iterator<Item = &'static CodeList> {
    codes::LISTS.into_iter().chain([LISTS, program::lists()]).flatten()
}

/// Codes of errors without a type of their own.
fn other_codes() -> impl Iterator<Item = &'static str> {
    let lost = [RECORDING_LOST, REPORT_LOST];
    codes::io_codes().into_iter().chain(program::USAGE).chain(lost).chain(program::UNTYPED)
}

/// Parameters that some findings have, and the examples of their codes have not.
const SOMETIMES: [(&str, &str); 9] = [
    ("counter-wrong", "rule"),
    ("samples-differ", "tried"),
    ("row-misplaced", "rules"),
    ("row-stayed-away", "rules"),
    ("row-copy-differs", "rules"),
    ("row-never-sent", "rules"),
    ("row-numbered-twice", "rules"),
    ("row-repeats-stand", "rules"),
    ("row-out-of-order", "rules"),
];

/// The names of the parameters that findings of the code of `example` have.
fn names(example: &Problem) -> Vec<&str> {
    let further = SOMETIMES.into_iter().filter(|(code, _)| *code == example.code).map(|(_, name)| name);
    example.parameters.keys().map(String::as_str).chain(further).collect()
}

/// A code, and what it is of.
#[derive(Serialize)]
pub(super) struct Entry {
    pub(super) of: &'static str,
    pub(super) code: String,
    pub(super) parameters: Vec<String>,
}

/// Every code with the names of its parameters.
pub(super) fn all() -> Vec<Entry> {
    let entry = |of, code: &str, parameters| Entry { of, code: code.to_owned(), parameters };
    let findings = examples::findings().into_iter().map(|finding| {
        let problem = finding.as_problem();
        entry("finding", &problem.code, names(&problem).into_iter().map(str::to_owned).collect())
    });
    let defects = examples::suspects().into_iter().map(|suspect| {
        let (code, parameters) = suspect.defect.tagged();
        entry("defect", &code, parameters.keys().cloned().collect())
    });
    let untouched = examples::not_exercised().into_iter().map(|part| {
        let (code, parameters) = part.tagged();
        entry("not-exercised", &code, parameters.keys().cloned().collect())
    });
    let errors = error_lists().flat_map(|list| list.codes).map(|(code, parameters)| {
        entry("error", code, parameters.iter().map(|&name| name.to_owned()).collect())
    });
    let others = other_codes().map(|code| {
        let parameters = if code.starts_with("io-") { vec!["os_error".to_owned()] } else { Vec::new() };
        entry("error", code, parameters)
    });
    findings.chain(defects).chain(untouched).chain(errors).chain(others).collect()
}

/// What to do about an example of a finding. If another finding of its code may need something else, the text says so.
pub(super) fn act(example: &Finding) -> Option<String> {
    let remedy = example.remedy()?;
    Some(match depending(example) {
        Some(on) => on.in_this_example(&remedy),
        None => remedy,
    })
}

/// What a technician does about it; none if another code says that.
pub(super) fn bench(example: &Finding) -> Option<String> {
    let asked = example.technician()?;
    match depending(example) {
        Some(Depends::Code(_)) => None,
        Some(on @ Depends::Both(_)) => Some(on.in_this_example(&asked)),
        Some(Depends::Remedy(_)) | None => Some(asked),
    }
}

/// What to do about a finding depends on more than its code.
enum Depends {
    /// On another code, which says it.
    Code(&'static str),
    /// On this, and so does what a technician does.
    Both(&'static str),
    /// On this.
    Remedy(&'static str),
}

impl Depends {
    /// On what it depends, and what is `asked` in the example.
    fn in_this_example(&self, asked: &str) -> String {
        match self {
            Self::Code(whose) => format!("See the code of {whose}. In this example: {asked}"),
            Self::Both(what) | Self::Remedy(what) => {
                format!("This depends on {what}. In this example: {asked}")
            }
        }
    }
}

fn depending(example: &Finding) -> Option<Depends> {
    Some(match example {
        Finding::TableReadsWrong { .. }
        | Finding::SamplesDiffer { suspect: Some(_), .. }
        | Finding::DiffersAtSpeed { suspect: Some(_), .. } => Depends::Code("its suspect"),
        Finding::TablesChanged { .. } | Finding::InCorner { .. } => Depends::Code("what was found"),
        Finding::LatencyWrong(_) => Depends::Both("which rows are late"),
        Finding::MiscountedAtSpeed { .. } => Depends::Both("what is miscounted"),
        Finding::RuleBroken { .. } => Depends::Both("what was answered"),
        Finding::CounterWrong { .. } => Depends::Remedy("whether a rule was tried"),
        Finding::WrongOverDoubtfulLink { .. } => Depends::Remedy("what the link may have done"),
        Finding::SecondLookBrokenOff(_) => Depends::Remedy("why it broke off"),
        Finding::BoardStayedAway { .. } => Depends::Remedy("how the board went away"),
        _ => return None,
    })
}

/// The page of all codes, in Markdown.
fn page() -> String {
    let mut text = HEAD.to_owned();
    AT_THE_BENCH.iter().for_each(|(blamed, asked)| text += &format!("\n### {blamed}\n\n{asked}\n"));
    text += "\n## Findings of checks and runs\n\n";
    for finding in examples::findings() {
        let problem = finding.as_problem();
        text += &format!("* `{}`{}: {}\n", problem.code, parameters(names(&problem).iter()), problem.message);
        let act = act(&finding).map_or_else(String::new, |remedy| format!("  *Do:* {remedy}\n"));
        let bench = bench(&finding).map_or_else(String::new, |bench| technician(&bench));
        text += &(act + &bench);
    }
    text += "\n## Defects that suspects have\n\n";
    for suspect in examples::suspects() {
        let (code, names) = suspect.defect.tagged();
        let (place, evidence) = (suspect.place(), suspect.evidence());
        text += &format!("* `{code}`{}: {place}: {evidence}\n", parameters(names.keys()));
        text += &format!("  *Designer:* {}\n{}", suspect.designer(), technician(&suspect.technician()));
    }
    text += "\n## What a PASS did not exercise\n\n";
    for part in examples::not_exercised() {
        let (code, names) = part.tagged();
        text += &format!("* `{code}`{}: {}\n", parameters(names.keys()), part.words());
    }
    text += "\n## Errors\n\nTheir sentence is in `message`, and what to do in `remedy` and at its end.\n";
    text += &program::page(error_lists());
    text += "\nOf the system (`os_error` is its own number), of command lines, and of what has no code of its own:\n\n";
    other_codes().for_each(|code| text += &format!("* `{code}`\n"));
    text
}

/// What a technician does about a code, with a link to the sentence instead of the sentence.
fn technician(bench: &str) -> String {
    let linked = AT_THE_BENCH.iter().fold(bench.to_owned(), |text, (blamed, asked)| {
        let blamed = blamed.to_lowercase();
        text.replace(asked, &format!("as for [{blamed}](#{blamed})"))
    });
    format!("  *Technician:* {linked}\n")
}

const HEAD: &str = "# Codes

Every finding, defect and error in JSON has a code and parameters, and so has what a PASS did not exercise. Codes are
stable: none changes its meaning or its parameters' names within a schema number, and new ones may come. The sentences
are made from them and may change.
`halfrow codes` prints this page; a test holds the two equal. Sentences are those of an example.

## What a technician does

One of these, by what is to blame. Each code that has a *Technician* says which.
";
