//! The sentence of a finding, and what to do about it.

use super::{at_speed, designer, evidence, latency, missing, place, rules, suspicion};
use crate::result::{Account, BoardKind, Defect, Doubt, Finding, NumberedRow, RepeatedRow};
use crate::words::{board_name, count, grouped, verb};

const CHECK_THE_LINK: &str = "Check the link, and run again.";

/// A finding in one sentence, without a full stop.
#[must_use]
pub fn sentence(finding: &Finding) -> String {
    match finding {
        Finding::GoldenSamplesFound { samples, path } => {
            format!("this computer reproduces all {} reference samples ({path})", grouped(*samples))
        }
        Finding::BoardIdentified { name, wire, datapath } => {
            format!("{}, wire {wire}, tables for datapath {datapath}", board_name(name))
        }
        Finding::EchoesReturned { bytes, echoes } => {
            format!(
                "{}, {}, all came back unchanged",
                if *echoes == 1 { "1 echo".to_owned() } else { format!("{} echoes", grouped(*echoes)) },
                count(*bytes, "byte")
            )
        }
        Finding::TablesUploaded { entries, nodes, generation } => {
            let (entries, nodes) = (count(*entries, "table entry"), count(*nodes, "kernel node"));
            format!("{entries} and {nodes}, as generation {generation}")
        }
        Finding::TablesReadBack { ports } => read_back(*ports),
        Finding::FramesEqual { frames, samples } => {
            format!("{}, {}, all equal", count(*frames, "frame"), count(*samples, "sample"))
        }
        Finding::LatencyRight { clocks } => {
            format!("every row is delayed by {clocks} pixel clocks, its first and last sample alike")
        }
        Finding::TablesUnchanged {} => "the tables are still what was uploaded".to_owned(),
        Finding::TablesUnused {} => "no frame came to use them".to_owned(),
        Finding::CountersRight { rows, damaged_unseen } => counters_right(*rows, *damaged_unseen),
        Finding::NotReached {} => "not reached".to_owned(),
        Finding::AllRight { frames, samples, latency, board, reconnections } => {
            all_right((*frames, *samples), *latency, *board, *reconnections)
        }
        Finding::Problem(problem) => problem.sentence(),
        other => {
            at_speed::sentence(other).or_else(|| rules::sentence(other)).unwrap_or_else(|| of_board(other))
        }
    }
}

fn read_back(ports: usize) -> String {
    let ports = match ports {
        1 => "the one read port".to_owned(),
        some => format!("all {} read ports", grouped(some)),
    };
    format!("{ports} of the tables returned what was uploaded")
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
        times => format!("; the board went away and came back {}", count(times, "time")),
    };
    format!(
        "{}, {}, all equal to the reference; every row takes {latency} pixel clocks{untested}{away}",
        count(frames, "frame"),
        count(samples, "sample")
    )
}

fn counters_right(rows: usize, damaged: u32) -> String {
    let unseen = match damaged {
        0 => String::new(),
        _ => format!(
            "; the board counts {}, although nothing had to be sent again",
            count(damaged, "damaged packet")
        ),
    };
    let rows = count(rows, "row");
    format!("{rows} in, {rows} out{unseen}")
}

/// The sentences of findings on a board.
fn of_board(finding: &Finding) -> String {
    match finding {
        Finding::CapabilityImpossible { capability, value, legal } => format!(
            "the board says {capability} = {value}, but {legal}; correct what it says of itself (CAPABILITIES in \
             protocol/WIRE.md), or load another bitstream"
        ),
        Finding::EchoWrong {} => {
            "the board returns other bytes than it was sent, under a CRC that it computed itself".to_owned()
        }
        Finding::TableReadsWrong { defect, account } => table(defect, account),
        Finding::TableCrcWrong {} => {
            "a table's CRC is wrong although every entry reads back right".to_owned()
        }
        Finding::CommitCrcWrong {} => {
            "the tables read back right, but the board finds another CRC when it commits them".to_owned()
        }
        Finding::TablesChanged { found } => format!("the tables changed during the run: {}", sentence(found)),
        Finding::SamplesDiffer { differences, samples, differing_frames, frames, suspect, others, short } => {
            let differ = samples_differ((*differences, *samples), (*differing_frames, *frames));
            format!("{differ}; {}", suspicion(suspect.as_deref(), *others, *short))
        }
        Finding::CounterWrong { counter, counted, right, rule } => {
            let (counted, right) = (grouped(*counted), grouped(*right));
            let (words, bound) = (counter.words(), counter.bound());
            let tried = rule.map(|rule| format!(" (rule: {})", rules::meaning(rule))).unwrap_or_default();
            format!("the board counts {counted} {words}; the right number is {bound}{right}{tried}")
        }
        Finding::GapsMiscounted { row, frame, counted, expected } => format!(
            "the board counts {} of gaps in row {row} of frame {frame}, but the gaps of its seed are {expected}",
            count(*counted, "board clock")
        ),
        Finding::LatencyMiscounted { least, most, counted_least, counted_most } => format!(
            "the rows name latencies of {least} to {most} pixel clocks, but the board's counters say \
             {counted_least} to {counted_most}"
        ),
        other => of_rows(other),
    }
}

/// How many samples and frames of how many differ.
fn samples_differ(
    (differences, samples): (usize, usize),
    (differing_frames, frames): (usize, usize),
) -> String {
    format!(
        "{} of {} {}, in {} of {}",
        grouped(differences),
        count(samples, "sample"),
        verb(differences, "differ"),
        grouped(differing_frames),
        count(frames, "frame")
    )
}

/// How many of the samples and frames differ, and `why` the run then broke off.
pub(crate) fn broken_off(samples: (usize, usize), frames: (usize, usize), why: &str) -> String {
    format!("{}, and the run broke off before that was looked into: {why}", samples_differ(samples, frames))
}

fn table(defect: &Defect, account: &Account) -> String {
    format!("{}: {}", place(defect), evidence(defect, account))
}

/// The sentences of findings on single rows.
fn of_rows(finding: &Finding) -> String {
    match finding {
        Finding::GenerationWrong { row, frame, named, committed } => format!(
            "row {row} of frame {frame} names the tables of generation {named}, but generation {committed} was \
             committed for it"
        ),
        Finding::RowsEnteredChanged { rows, row, frame, flipped } => format!(
            "{} changed on the way into the core, and the error is not in the computation: the board's own CRC of \
             the samples that entered differs from that of the samples that were sent, first in row {row} of frame \
             {frame}{}",
            count(*rows, "row"),
            at_speed::flipped_bit(*flipped)
        ),
        Finding::EntryMiscounted { rows, row, frame } => format!(
            "{} came out right, but the board's CRC of the samples that entered the core differs from that of the \
             samples that were sent, first in row {row} of frame {frame}: the CRC unit is wrong, or samples that no \
             output reads changed on their way in",
            count(*rows, "row")
        ),
        Finding::LatencyWrong(late) => latency::sentence(late),
        Finding::RowMisplaced { row, frame } => format!(
            "the board returned row {row} of frame {frame} with a place that was never sent; its bitstream and this \
             halfrow do not match"
        ),
        Finding::RowSwallowed { row, frame, again } => format!(
            "row {row} of frame {frame} went into the board and never came out; when it was streamed again, \
             only row {again} was lost, although the board counts it as received"
        ),
        other => of_conduct(other),
    }
}

/// The sentences of findings on rows that no link can cause.
fn of_conduct(finding: &Finding) -> String {
    match finding {
        Finding::RowCopyDiffers { row, frame } => format!(
            "row {row} of frame {frame} came twice with different samples, each time with a right CRC"
        ),
        Finding::RowNeverSent { row, frame, sequence } => format!(
            "the board returned row {row} of frame {frame}, number {sequence} of the session, which it was never given"
        ),
        Finding::RowNumberedTwice(NumberedRow { row, frame, number }) => format!(
            "the board numbers its ROW_OUT packets wrongly: row {row} of frame {frame} has the number {number}, and \
             so has another row shortly before it"
        ),
        Finding::RowRepeatsStand(RepeatedRow { row, frame, repeats }) => format!(
            "the board sent row {row} of frame {frame} twice with `repeats` = {repeats}, which must grow by one each time"
        ),
        Finding::RowOutOfOrder { row, frame } => format!(
            "the board reorders rows: by the board's own packet numbers, row {row} of frame {frame} left it after a \
             later row"
        ),
        other => perhaps_of_link(other),
    }
}

/// The sentences of findings that board or link may have caused.
fn perhaps_of_link(finding: &Finding) -> String {
    match finding {
        Finding::RightInAnotherSession { found, doubt } => format!(
            "{}; the link may have caused that, because {}: in another session everything was right; check the \
             link, and run again",
            sentence(found),
            because(*doubt)
        ),
        Finding::WrongOverDoubtfulLink { found, doubt: doubt @ Doubt::AnswerLost {} } => format!(
            "{}; this proves no fault of the board, because {}; check first how the board answers this, then the link, and run \
             again",
            sentence(found),
            because(*doubt)
        ),
        Finding::WrongOverDoubtfulLink { found, doubt } => format!(
            "{}; but the link may have caused that, because {}; check the link, and run again",
            sentence(found),
            because(*doubt)
        ),
        Finding::SecondLookBrokenOff(it) => format!(
            "{}; the link may have caused that, because {}, and the second look, in another session, broke off: {}",
            sentence(&it.found),
            because(it.doubt),
            sentence(&it.reason)
        ),
        other => missing::sentence(other).unwrap_or_else(|| unjudged(other)),
    }
}

/// Why the link may have caused what is wrong, as a clause after "because".
pub(crate) fn because(doubt: Doubt) -> String {
    match doubt {
        Doubt::RequestsTwice { requests } => {
            format!("{} to change the board may have reached it twice", count(requests, "request"))
        }
        Doubt::PacketsMiscounted { counted, sent } => {
            format!(
                "the board counts {}, but {} should have reached it",
                count(counted, "packet"),
                grouped(sent)
            )
        }
        Doubt::CountersOfLinks {} => {
            "a link that brings one packet twice and loses another changes such counters too".to_owned()
        }
        Doubt::PacketsUncounted {} => "the board does not tell how many packets reached it".to_owned(),
        Doubt::AnswerLost {} => "a link can lose the same packet each time".to_owned(),
    }
}

/// Why nothing was judged, where that is not an error value.
fn unjudged(finding: &Finding) -> String {
    match finding {
        Finding::NothingJudged {} => "nothing was judged: no frame came back".to_owned(),
        Finding::DatapathUnknown { datapath, known } => format!(
            "the board computes datapath {datapath}, which this program does not know; load a bitstream of datapath \
             {known}, or install a halfrow that knows {datapath}"
        ),
        Finding::HardwareRequired { .. } => {
            "hardware is required, and this board is not hardware, so nothing was judged; name a real board"
                .to_owned()
        }
        Finding::BoardExchanged {} => {
            "the board that came back is another one, or runs another bitstream; run again".to_owned()
        }
        Finding::BoardStayedAway { reason, seconds } => {
            format!("{}; the board did not come back in {seconds} s", reason.sentence())
        }
        // A finding that has no sentence yet: better its code than nothing.
        other => other.code(),
    }
}

/// What to do about a finding, if anything.
#[must_use]
pub fn remedy(finding: &Finding) -> Option<String> {
    let asked = match finding {
        Finding::Problem(problem) | Finding::BoardStayedAway { reason: problem, .. } => {
            return problem.remedy.clone();
        }
        Finding::TableReadsWrong { defect, .. } => return Some(designer(defect)),
        Finding::TablesChanged { found } => return remedy(found),
        Finding::SecondLookBrokenOff(it) => {
            return Some(remedy(&it.reason).unwrap_or_else(|| CHECK_THE_LINK.to_owned()));
        }
        Finding::SamplesDiffer { suspect: Some(suspect), .. }
        | Finding::DiffersAtSpeed { suspect: Some(suspect), .. } => return Some(designer(suspect)),
        Finding::SamplesDiffer { suspect: None, .. } => super::MAPS,
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
        Finding::LatencyWrong(late) => latency::remedy(late.are_one_row()),
        Finding::CounterWrong { rule: Some(_), .. } => rules::REMEDY,
        Finding::CounterWrong { .. } | Finding::GapsMiscounted { .. } | Finding::LatencyMiscounted { .. } => {
            "Check the board's counters and its row player; the samples themselves were right."
        }
        Finding::RowMisplaced { .. } | Finding::RowNeverSent { .. } => {
            "Check how the board keeps a row's place with its samples."
        }
        Finding::RowSwallowed { .. } => {
            "Check the row banks and the row player: the board took the row and lost it inside."
        }
        Finding::RuleBroken { .. } => rules::REMEDY,
        other => return at_speed::remedy(other).or_else(|| asked_of_conduct(other)),
    };
    Some(asked.to_owned())
}

fn asked_of_conduct(finding: &Finding) -> Option<String> {
    let asked = match finding {
        Finding::RowCopyDiffers { .. } => {
            "Check what else writes to the output banks while the board waits for the acknowledgement of a row."
        }
        Finding::RowNumberedTwice(_) => {
            "Check the board's count of ROW_OUT packets, the sequence in their headers."
        }
        Finding::RowRepeatsStand(_) => {
            "Check where the board counts how often it sent a row, the `repeats` of ROW_OUT."
        }
        Finding::RowOutOfOrder { .. } => {
            "Check in which order the board plays its input banks and sends its output banks, and whether RESET \
             lets its packet numbers begin anew."
        }
        other => return asked_of_caller(other),
    };
    Some(asked.to_owned())
}

/// What the caller can do where nothing was judged.
fn asked_of_caller(finding: &Finding) -> Option<String> {
    Some(match finding {
        Finding::NothingJudged {} => {
            "Name at least one frame, or none for the built-in ones.".to_owned()
        }
        Finding::DatapathUnknown { datapath, known } => {
            format!("Load a bitstream of datapath {known}, or install a halfrow that knows {datapath}.")
        }
        Finding::HardwareRequired { .. } => "Name a real board.".to_owned(),
        Finding::BoardExchanged {} => "Run again.".to_owned(),
        Finding::CapabilityImpossible { .. } => {
            "Correct what the board says of itself (CAPABILITIES in protocol/WIRE.md), or load another bitstream.".to_owned()
        }
        Finding::BurstStalled { .. } => "Check the board's clock, and run again.".to_owned(),
        Finding::BurstEndedEarly { .. } => "Run again.".to_owned(),
        Finding::WrongOverDoubtfulLink { doubt: Doubt::AnswerLost {}, .. } => {
            "Check first how the board answers this, then the link, and run again.".to_owned()
        }
        Finding::RightInAnotherSession { .. } | Finding::WrongOverDoubtfulLink { .. } => {
            CHECK_THE_LINK.to_owned()
        }
        other => return missing::remedy(other).map(str::to_owned),
    })
}
