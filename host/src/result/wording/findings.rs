//! What a finding says, and what it asks for.

use super::{designer, evidence, place};
use crate::result::{Account, BoardKind, Defect, Finding};

/// A finding in one sentence, without a full stop.
#[must_use]
pub fn sentence(finding: &Finding) -> String {
    match finding {
        Finding::GoldenSamplesFound { samples, path } => {
            format!("this computer finds all {samples} golden samples ({path})")
        }
        Finding::BoardIdentified { name, wire, datapath } => {
            format!("{name}, wire {wire}, datapath {datapath}")
        }
        Finding::EchoesReturned { bytes, echoes } => {
            format!("{bytes} bytes in {echoes} echoes came back as they went")
        }
        Finding::TablesUploaded { rows, nodes, generation } => {
            format!("{rows} row factors and {nodes} kernel nodes, as generation {generation}")
        }
        Finding::TablesReadBack { ports } => format!("{ports} datapath ports read what was uploaded"),
        Finding::FramesEqual { frames, samples } => format!("{frames} frames, {samples} samples, all equal"),
        Finding::LatencyRight { clocks } => {
            format!("every row takes {clocks} pixel clocks, first and last sample")
        }
        Finding::TablesUnchanged {} => "the tables are still what was uploaded".to_owned(),
        Finding::TablesUnused {} => "no frame came to use them".to_owned(),
        Finding::CountersRight { rows } => format!("{rows} rows in, {rows} rows out"),
        Finding::NotReached {} => "not reached".to_owned(),
        Finding::AllRight { frames, samples, latency, board, reconnections } => {
            all_right((*frames, *samples), *latency, *board, *reconnections)
        }
        Finding::Problem(problem) => problem.sentence(),
        wrong => of_board(wrong),
    }
}

fn all_right(
    (frames, samples): (usize, usize),
    latency: u32,
    board: BoardKind,
    reconnections: usize,
) -> String {
    let untested = match board {
        BoardKind::Hardware => "",
        BoardKind::Mock => " (mock board: no hardware was tested)",
        BoardKind::Sim => " (simulated board: no hardware was tested)",
        BoardKind::Replay => " (recording: no hardware was tested now)",
    };
    let away = match reconnections {
        0 => String::new(),
        times => format!("; the board went away and came back, {times} x"),
    };
    format!(
        "{frames} frames, {samples} samples, all equal to the reference; every row takes {latency} pixel \
         clocks{untested}{away}"
    )
}

/// What is wrong with a board.
fn of_board(finding: &Finding) -> String {
    match finding {
        Finding::LatencyClaimTooLong { claimed, limit } => {
            format!("the board claims L = {claimed}, and no datapath may take over {limit}")
        }
        Finding::EchoWrong {} => {
            "the board returns other bytes than it was sent, under a CRC that it computed itself".to_owned()
        }
        Finding::TableReadsWrong { defect, account } => table(defect, account),
        Finding::TableCrcWrong {} => {
            "a table's CRC is wrong although every entry reads back right".to_owned()
        }
        Finding::CommitCrcWrong {} => {
            "the tables read back right, and the board finds another CRC when it commits them".to_owned()
        }
        Finding::TablesChanged { found } => format!("the tables changed during the run: {}", sentence(found)),
        Finding::SamplesDiffer { differences, samples, differing_frames, frames, suspect } => {
            let suspicion = match suspect {
                Some(suspect) => format!("the suspect is {}", place(suspect)),
                None => "no single defect that is known explains them".to_owned(),
            };
            format!(
                "{differences} of {samples} samples differ, in {differing_frames} of {frames} frames; {suspicion}"
            )
        }
        Finding::RowsMiscounted { rows, rows_in, rows_out } => {
            format!("{rows} rows went through the board, and it counts {rows_in} in and {rows_out} out")
        }
        Finding::SamplesMiscounted { samples_over } => {
            format!("the board counts {samples_over} samples above the depth, and none was sent")
        }
        Finding::LatencyMiscounted { least, most, counted_least, counted_most } => format!(
            "the rows name latencies of {least} to {most} pixel clocks, and the board's counters {counted_least} to \
             {counted_most}"
        ),
        other => of_rows(other),
    }
}

fn table(defect: &Defect, account: &Account) -> String {
    format!("{}: {}", place(defect), evidence(defect, account))
}

/// What is wrong with single rows.
fn of_rows(finding: &Finding) -> String {
    match finding {
        Finding::GenerationWrong { row, frame, named, committed } => format!(
            "row {row} of frame {frame} names the tables of generation {named}, and generation {committed} was committed \
             for it"
        ),
        Finding::LatencyWrong { rows, row, frame, first, last, claimed } => format!(
            "{rows} rows have another latency than the board claims: row {row} of frame {frame} took {first} pixel clocks \
             from first in to first out and {last} from last in to last out; the board claims {claimed}"
        ),
        Finding::RowMisplaced { row, frame } => format!(
            "the board returned row {row} of frame {frame} under a place that was never sent; its bitstream and this halfrow \
             do not match"
        ),
        Finding::RowSwallowed { row, frame, again } => format!(
            "row {row} of frame {frame} went into the board and never came out; played again, row {again} was lost, and the \
             link is clean"
        ),
        other => unjudged(other),
    }
}

/// Why there is no judgement, where that is no error.
fn unjudged(finding: &Finding) -> String {
    match finding {
        Finding::NothingJudged {} => "nothing was judged: no frame came back".to_owned(),
        Finding::DatapathUnknown { datapath, known } => format!(
            "the board computes datapath {datapath}, and this program judges datapath {known}; load a bitstream of datapath \
             {known}, or install a halfrow that knows {datapath}"
        ),
        Finding::HardwareRequired { .. } => {
            "hardware is required and this is none, so nothing was judged; name a real board with --board"
                .to_owned()
        }
        Finding::BoardExchanged {} => {
            "another board, or another bitstream, came back than went away; run again".to_owned()
        }
        Finding::BoardStayedAway { reason, seconds } => {
            format!("{}; the board did not come back in {seconds} s", reason.sentence())
        }
        _ => String::new(),
    }
}

/// What to do about a finding, if there is something to do.
#[must_use]
pub fn remedy(finding: &Finding) -> Option<String> {
    let asked = match finding {
        Finding::Problem(problem) | Finding::BoardStayedAway { reason: problem, .. } => {
            return problem.remedy.clone();
        }
        Finding::TableReadsWrong { defect, .. } => return Some(designer(defect)),
        Finding::TablesChanged { found } => return remedy(found),
        Finding::SamplesDiffer { suspect: Some(suspect), .. } => return Some(designer(suspect)),
        Finding::SamplesDiffer { suspect: None, .. } => {
            "Make a report with --report and look at the difference maps."
        }
        Finding::LatencyClaimTooLong { .. } => "Check the pipeline's depth in the design that was loaded.",
        Finding::EchoWrong {} => "Check the board's packet buffers: the link carried what the board sent.",
        Finding::TableCrcWrong {} => {
            "Check the board's CRC unit, and whether the tables change on their own."
        }
        Finding::CommitCrcWrong {} => {
            "Check the board's CRC unit and whether the tables change on their own."
        }
        Finding::GenerationWrong { .. } => {
            "The board uses stale tables: check when its bank switch takes effect."
        }
        Finding::LatencyWrong { .. } => {
            "Check the depth of the pipeline behind the line memory, and the L that the capabilities advertise."
        }
        Finding::RowsMiscounted { .. }
        | Finding::SamplesMiscounted { .. }
        | Finding::LatencyMiscounted { .. } => {
            "Check the board's counters and its row player; the samples themselves were right."
        }
        Finding::RowMisplaced { .. } => "Check how the board keeps a row's place with its samples.",
        Finding::RowSwallowed { .. } => {
            "Check the row banks and the row player: the board took the row and lost it inside."
        }
        other => return asked_of_caller(other),
    };
    Some(asked.to_owned())
}

/// What the caller can do where nothing was judged.
fn asked_of_caller(finding: &Finding) -> Option<String> {
    Some(match finding {
        Finding::NothingJudged {} => {
            "Name at least one frame, or leave --frame out for the built-in ones.".to_owned()
        }
        Finding::DatapathUnknown { datapath, known } => {
            format!("Load a bitstream of datapath {known}, or install a halfrow that knows {datapath}.")
        }
        Finding::HardwareRequired { .. } => "Name a real board with --board.".to_owned(),
        Finding::BoardExchanged {} => "Run again.".to_owned(),
        _ => return None,
    })
}
