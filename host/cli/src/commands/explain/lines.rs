//! The words at the left of a result's lines that are neither codes nor checks nor verdicts.

use super::known::Explanation;

/// A word, what follows it on its line, whose concern that is, what to do about it (nothing, if empty), and where it is in JSON.
struct Line {
    word: &'static str,
    meaning: &'static str,
    fault: &'static str,
    act: &'static str,
    place: &'static str,
}

/// Whose concern a line is that only informs.
const NOBODYS: &str = "nobody's: it is information only";

const LINES: &[Line] = &[
    Line {
        word: "board",
        meaning: "The board that was judged: its kind, the target that it was reached by, and what it says of itself.",
        fault: NOBODYS,
        act: "",
        place: "`board` of a result",
    },
    Line {
        word: "tables",
        meaning: "The tables that the board was given: what they were made from, and the size and depth of their frames.",
        fault: NOBODYS,
        act: "",
        place: "`tables` of a result",
    },
    Line {
        word: "operator",
        meaning: "Who ran it, as `--operator` says.",
        fault: NOBODYS,
        act: "",
        place: "`operator` of a result's `run`",
    },
    Line {
        word: "ok",
        meaning: "The check beside it passed.",
        fault: "nobody's: it is as it must be",
        act: "",
        place: "`outcome` of each of a result's `checks`, `passed`",
    },
    Line {
        word: "skipped",
        meaning: "The check beside it was not made, and nothing is known of what it looks at.",
        fault: "depends on the check that ended the run; nobody's if an option left this one out",
        act: "Look at the check that is not `ok`, put that right, and run again.",
        place: "`outcome` of each of a result's `checks`, `skipped`",
    },
    Line {
        word: "soak",
        meaning: "How long the board was judged by frames of its own making, and how many frames that were.",
        fault: NOBODYS,
        act: "",
        place: "`soak` of a result",
    },
    Line {
        word: "frame",
        meaning: "The head of a table of the streamed frames, of which long runs leave out equal ones: how many samples of each came back \
                  other than the model has them, where the first of them is, and how far off the worst is.",
        fault: "depends on the verdict",
        act: "Look at the verdict, and at the line `suspect` if there is one.",
        place: "`frames` of a result",
    },
    Line {
        word: "differs",
        meaning: "A frame of a soak that came out wrong, and when.",
        fault: "the board's",
        act: "Look at heat, supply and timing first: a fault that comes with time is most often one of these.",
        place: "`differences` of a result's `soak`",
    },
    Line {
        word: "latency",
        meaning: "Pixel clocks from a row's first sample into the core to its first corrected sample: half a row and what the board says that \
                  its build takes, and the most that is allowed.",
        fault: "nobody's: the check `latency` judges it",
        act: "",
        place: "`latency` of a result",
    },
    Line {
        word: "street",
        meaning: "How many pixels the façade edges of the frame `builtin:street` are off straight lines before and after correction, on the \
                  average, and at most in brackets. The lens is equidistant with the R that was given or, with a file of tables, the default \
                  one. It decides no verdict.",
        fault: "nobody's: it is a property of lens and tables, and the same with every right board",
        act: "",
        place: "`street` of a result",
    },
    Line {
        word: "link",
        meaning: "What went over the link, and how much of it came damaged or had to be sent again.",
        fault: "the link's: none of it leads to FAIL",
        act: "If packets were damaged or sent again, test the cable alone with `halfrow link`.",
        place: "`link` of a result",
    },
    Line {
        word: "within",
        meaning: "What `--within` took of the run and what it left out, how long that was expected to take, and which share of the \
                  single faults of the Verilog it finds.",
        fault: NOBODYS,
        act: "Run without `--within`, or give it more seconds, to have judged what it left out.",
        place: "`within` of a result",
    },
    Line {
        word: "limits",
        meaning: "What no frame of the run put to the test, so that a fault there would have gone unseen: what a PASS says nothing about.",
        fault: "nobody's: the frames of the run leave it open",
        act: "Stream all built-in frames, at the size and speed of use, and leave nothing out; ask `halfrow \
              explain` for the code of each, which the line `explain` names.",
        place: "`not_exercised` of a result",
    },
    Line {
        word: "coverage",
        meaning: "The share of single faults that a run with these frames finds at this geometry, of those that \
                  were put into the project's Verilog one by one. A mock board is not made of that Verilog and has \
                  no such line.",
        fault: NOBODYS,
        act: "",
        place: "`coverage` of a result",
    },
    Line {
        word: "suspect",
        meaning: "The part of the board that explains the differences that were seen, the likeliest first, with the evidence below it.",
        fault: "the board's",
        act: "Do what stands after \"At the bench\"; \"Next\" is for whoever designed the board.",
        place: "`suspects` of a result",
    },
    Line {
        word: "do",
        meaning: "What to do: \"At the bench\" is for the technician, \"Next\" for whoever designed the board.",
        fault: "depends on the verdict",
        act: "Do it, then run again.",
        place: "`technician` and `remedy` of a result",
    },
    Line {
        word: "UNSAVED",
        meaning: "The first line of `halfrow-station run` without --json: the station could not keep the result of a run, so there is none, and no verdict.",
        fault: "the station's: its disk, or the folder or the database there",
        act: "Do what the line says, then test the board again.",
        place: "`error` of `halfrow-station run`, with the code `run-unsaved`",
    },
    Line {
        word: "explain",
        meaning: "A command that tells more about each code of this result.",
        fault: "depends on the code",
        act: "Run that command.",
        place: "`finding`, `suspects` and `not_exercised` of a result",
    },
];

/// The explanation of each line.
pub(super) fn all() -> impl Iterator<Item = Explanation> {
    LINES.iter().map(|it| Explanation {
        code: it.word.to_owned(),
        of: "line",
        meaning: it.meaning.to_owned(),
        fault: it.fault,
        acts: [it.act].into_iter().filter(|act| !act.is_empty()).map(str::to_owned).collect(),
        place: it.place,
        ..Explanation::default()
    })
}
