//! The sentence of a finding.

use super::{at_speed, evidence, latency, missing, place, rules, suspicion};
use crate::result::{
    Account, BoardKind, Counter, Defect, Doubt, Finding, NumberedRow, PlacedRow, RepeatedRow, Rule,
};
use crate::words::{board_name, count, differ_of, grouped};

/// A finding in one sentence, without a full stop.
#[must_use]
#[expect(clippy::too_many_lines, reason = "one arm a finding")]
pub fn sentence(finding: &Finding) -> String {
    match finding {
        Finding::GoldenSamplesFound { samples, path } => {
            format!("this computer reproduces all {} reference samples ({path})", grouped(*samples))
        }
        Finding::BoardIdentified { name, wire, datapath } => {
            format!("{}, wire {wire}, tables for datapath {datapath}", board_name(name))
        }
        Finding::EchoesReturned { bytes, echoes } => {
            let echoes =
                if *echoes == 1 { "1 echo".to_owned() } else { format!("{} echoes", grouped(*echoes)) };
            format!("{echoes}, {}, all came back unchanged", count(*bytes, "byte"))
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
        Finding::EqualAtSpeed(equal) => at_speed::equal(equal),
        Finding::PausedAtSpeed { frames, paused } => format!(
            "{}, every sample equal, but not at speed: {paused} of them had pauses",
            count(*frames, "frame")
        ),
        Finding::ClockNotAsNamed { clock_hz, seen } => at_speed::clock_not_as_named(*clock_hz, *seen),
        Finding::NothingAtSpeed { reason } => {
            format!("nothing was tested at speed: {}", at_speed::because(*reason))
        }
        Finding::RulesKept { requests } => {
            format!("{} answered as the wire's rules say", count(*requests, "request"))
        }
        Finding::RulesLeftOut {} => "left out of this run".to_owned(),
        Finding::NotReached {} => "not reached".to_owned(),
        Finding::AllRight { frames, samples, latency, board, reconnections } => {
            all_right((*frames, *samples), *latency, *board, *reconnections)
        }
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
        Finding::SamplesDiffer {
            differences,
            samples,
            differing_frames,
            frames,
            tried,
            suspect,
            others,
            short,
        } => {
            let differ = match tried {
                Some(rows) => rules::samples_differ((*differences, *samples), rows),
                None => samples_differ((*differences, *samples), (*differing_frames, *frames)),
            };
            format!("{differ}; {}", suspicion(suspect.as_deref(), *others, *short))
        }
        Finding::CounterWrong { counter, counted, right, rule } => {
            counter_wrong(*counter, (*counted, *right), *rule)
        }
        Finding::GapsMiscounted { row, frame, counted, expected } => format!(
            "the board counts {} of gaps in row {row} of frame {frame}, but the gaps of its seed are {expected}",
            count(*counted, "board clock")
        ),
        Finding::LatencyMiscounted { least, most, counted_least, counted_most } => format!(
            "the rows name latencies of {least} to {most} pixel clocks, but the board's counters say \
             {counted_least} to {counted_most}"
        ),
        Finding::DiffersAtSpeed { wrong, frames, first, repetition, suspect, others, short } => {
            let suspect = suspect
                .as_deref()
                .map(|suspect| suspicion(Some(suspect), *others, short.as_deref().copied()));
            at_speed::differs((*wrong, *frames), *first, repetition, suspect)
        }
        Finding::MiscountedAtSpeed { frame, count, counted, right } => {
            at_speed::miscounted(*frame, *count, *counted, *right)
        }
        Finding::InCorner { corner, found } => at_speed::in_corner(*corner, found),
        Finding::BurstStalled { frame, frames, seconds } => format!(
            "frame {frame} of {frames} at speed did not come within {seconds:.1} s; check the board's clock, and \
             run again"
        ),
        Finding::BurstEndedEarly { came, frames } => {
            format!("the board ended its frames at speed after {came} of {frames}; run again")
        }
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
        Finding::RowMisplaced(PlacedRow { row, frame, rules }) => format!(
            "the board returned {} with a place that was never sent; its bitstream and this halfrow do not match",
            row_of(*row, *frame, *rules)
        ),
        Finding::RowSwallowed { row, frame, again } => format!(
            "row {row} of frame {frame} went into the board and never came out; when it was streamed again, \
             only row {again} was lost, although the board counts it as received"
        ),
        Finding::RuleBroken { rule, request, right, found, asked } => {
            rules::broken(*rule, (request, asked.as_deref()), right, found)
        }
        Finding::RowCopyDiffers(PlacedRow { row, frame, rules }) => format!(
            "{} came twice, and the copies differ in samples, place, generation, latencies or pauses, each with a right CRC",
            row_of(*row, *frame, *rules)
        ),
        Finding::RowNeverSent { row, frame, sequence, rules } => format!(
            "the board returned {}, number {sequence} of the session, which it was never given",
            row_of(*row, *frame, *rules)
        ),
        Finding::RowNumberedTwice(NumberedRow { row, frame, number, rules }) => format!(
            "the board numbers its ROW_OUT packets wrongly: {} has the number {number}, and so has another packet shortly \
             before it",
            row_of(*row, *frame, *rules)
        ),
        Finding::RowRepeatsStand(RepeatedRow { row, frame, repeats, rules }) => format!(
            "the board sent {} twice with `repeats` = {repeats}, which must grow by one each time",
            row_of(*row, *frame, *rules)
        ),
        Finding::RowOutOfOrder(PlacedRow { row, frame, rules }) => format!(
            "the board reorders rows: by the board's own packet numbers, {} left it after a later row",
            row_of(*row, *frame, *rules)
        ),
        Finding::RowLostOnce { row, frame } => missing::once(*row, *frame),
        Finding::RowLostAmongOthers { row, frame } => missing::among_others(*row, *frame),
        Finding::RowLostEachTime(missing) => missing::each_time(missing),
        Finding::RowStayedAway(PlacedRow { row, frame, rules }) => {
            missing::stayed_away(&row_of(*row, *frame, *rules))
        }
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
        Finding::Problem(problem) => problem.sentence(),
    }
}

/// `row 3 of frame 2`; the frames that the rules are tried with have numbers of their own.
fn row_of(row: u16, frame: u16, rules: bool) -> String {
    format!("row {row} of {}frame {frame}", if rules { "the rules' " } else { "" })
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

fn counter_wrong(counter: Counter, (counted, right): (u32, u32), rule: Option<Rule>) -> String {
    let (counted, right) = (grouped(counted), grouped(right));
    let (words, bound) = (counter.words(), counter.bound());
    let tried = rule.map(|rule| format!(" (rule: {})", rule.meaning())).unwrap_or_default();
    // Of damaged packets only what was counted meanwhile is compared.
    let is_of_damaged = matches!(counter, Counter::CrcErrors | Counter::FramingErrors);
    let more = if is_of_damaged && rule == Some(Rule::Damage) { " more" } else { "" };
    format!("the board counts {counted}{more} {words}; the right number is {bound}{right}{tried}")
}

/// How many samples and frames of how many differ.
pub(crate) fn samples_differ(
    (differences, samples): (usize, usize),
    (differing_frames, frames): (usize, usize),
) -> String {
    let differ = differ_of(differences, samples, "sample");
    format!("{differ}, in {} of {}", grouped(differing_frames), count(frames, "frame"))
}

/// What was `wrong` with rows, and `why` the run then broke off.
pub(crate) fn broken_off(wrong: &str, why: &str) -> String {
    format!("{wrong}, and the run broke off before that was looked into: {why}")
}

fn table(defect: &Defect, account: &Account) -> String {
    format!("{}: {}", place(defect), evidence(defect, account))
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
        Doubt::DamageUncounted { counted, sent } => format!(
            "the board counts {} of the {} that were sent to it, and something on the way may have made the others whole",
            grouped(counted),
            count(sent, "damaged packet")
        ),
    }
}
