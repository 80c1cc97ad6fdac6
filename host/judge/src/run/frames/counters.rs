//! The board's counters, compared with what the host saw.

use super::observations::Observations;
use crate::board::{Board, Status};
use crate::result::{CheckName, Counter, Finding, LatencyReport};
use crate::run::findings::{Attempt, End};

/// What a board counts that a link can have caused as well.
pub(crate) const MOVED_BY_LINKS: [Counter; 4] =
    [Counter::RowsRepeated, Counter::RowsUnneeded, Counter::Refusals, Counter::ForeignPackets];

/// Compares the board's counters, which it told when it had `answered` so many requests, with what the host saw and what the
/// `attempt` let it count. Some must agree over any link, however poor; the others are compared only where nothing was lost or
/// late.
pub(crate) fn counters(
    board: &Board,
    (status, answered): (&Status, u64),
    seen: &Observations,
    attempt: &Attempt,
) -> Result<Finding, End> {
    let rows = attempt.rows_counted;
    let expected = u32::try_from(rows).unwrap_or(u32::MAX);
    let generation = seen.frames.last().map_or(0, |frame| frame.generation.into());
    let next_row = board.acknowledged();
    let repeated = status.rows_repeated.max(attempt.repeats_counted);
    let is_calm = is_calm(board, status);
    let over_any_link = [
        (Counter::RowsIn, expected),
        (Counter::RowsOut, expected),
        (Counter::SamplesOver, 0),
        (Counter::NextRowIn, next_row),
        (Counter::NextRowOut, next_row),
        (Counter::Generation, generation),
        (Counter::RowsRepeated, repeated),
    ];
    let if_calm = MOVED_BY_LINKS.map(|counter| (counter, 0)).into_iter().filter(|_| is_calm);
    let mut counts = over_any_link.into_iter().chain(if_calm);
    if let Some((counter, right)) = counts.find(|(counter, right)| counter.in_status(status) != *right) {
        let counted = counter.in_status(status);
        return Err(miscounted(Finding::CounterWrong { counter, counted, right, rule: None }));
    }
    packets_counted(status, answered)?;
    rows_numbered(status, board.packets_numbered())?;
    latencies_counted(status, seen)?;
    if let Some(finding) = &seen.wrong_pauses {
        return Err(miscounted(finding.clone()));
    }
    let damaged_unseen = if board.tally().retries == 0 { status.damaged() } else { 0 };
    Ok(Finding::CountersRight { rows, damaged_unseen })
}

/// Whether nothing was lost or late, as seen by the host and by the board.
fn is_calm(board: &Board, status: &Status) -> bool {
    saw_no_trouble(board) && status.damaged() == 0 && board.had_each_packet_once(status)
}

fn saw_no_trouble(board: &Board) -> bool {
    let tally = board.tally();
    tally.retries + tally.strays + tally.damaged_in == 0
}

/// Whether some counters are not compared only because the board says that its link is poor, while the host saw no trouble.
pub(crate) fn leaves_counters_out(board: &Board, status: &Status) -> bool {
    saw_no_trouble(board) && !is_calm(board, status)
}

/// Whether a board counts fewer packets than its other counters imply, which no link can cause.
pub(crate) fn is_contradictory(status: &Status) -> bool {
    packets_counted(status, 1).is_err()
}

/// Whether it counts what only a link can have caused, since the host gave no reason for it.
pub(crate) fn is_moved_by_links(status: &Status) -> bool {
    MOVED_BY_LINKS.iter().any(|counter| counter.in_status(status) != 0)
}

/// Checks the count of packets: each row that was taken or not needed, each refusal and each of the `answered` requests
/// came in a packet of its own. Foreign packets are refused, or are acknowledgements.
fn packets_counted(status: &Status, answered: u64) -> Result<(), End> {
    let not_answered = [status.rows_in, status.rows_unneeded, status.refusals.max(status.foreign_packets)];
    let least = answered + not_answered.into_iter().map(u64::from).sum::<u64>();
    let right = u32::try_from(least).unwrap_or(u32::MAX);
    if status.packets >= right {
        return Ok(());
    }
    let (counter, counted) = (Counter::Packets, status.packets);
    Err(miscounted(Finding::CounterWrong { counter, counted, right, rule: None }))
}

/// Checks the numbers of ROW_OUT packets, of which the host saw `counted`. They begin at 0, no two packets have the same one,
/// and a later row's packet has a greater one, so over a link that loses nothing they have no gap.
pub(crate) fn rows_numbered(status: &Status, counted: u32) -> Result<(), End> {
    let right = Counter::RowsNumbered.in_status(status);
    if counted <= right {
        return Ok(());
    }
    Err(miscounted(Finding::CounterWrong { counter: Counter::RowsNumbered, counted, right, rule: None }))
}

fn latencies_counted(status: &Status, seen: &Observations) -> Result<(), End> {
    let (counted_least, counted_most) = (status.least_latency, status.most_latency);
    match seen.latency {
        Some(LatencyReport { least, most, .. }) if (counted_least, counted_most) != (least, most) => {
            Err(miscounted(Finding::LatencyMiscounted { least, most, counted_least, counted_most }))
        }
        _ => Ok(()),
    }
}

fn miscounted(finding: Finding) -> End {
    End::failed(CheckName::Counters, finding)
}
