//! Finds out whether the board swallowed a row that did not come back.
//!
//! A row can be lost or late on the way there and on the way back, so a missing row alone proves nothing. It is the
//! board's fault only if the frame is played again with no other trouble, a row goes missing again, and the board itself
//! says that it took that row, and does not send it when asked.

use std::iter;

use halfrow_model::Geometry;
use halfrow_protocol::MAX_PAYLOAD;
use halfrow_protocol::message::RowPlace;

use crate::board::{BoardError, NumberedFrame, Status, Tally, Unjudged, Unreturned};
use crate::result::{CheckName, Finding, MissingRow};
use crate::run::findings::End;
use crate::run::plan::ScheduledFrame;
use crate::run::steps::Run;
use crate::verdict::Cause;

/// How often a frame is played again until there is no other trouble.
const REPLAYS: usize = 4;
/// How often in succession a missing row is asked for.
const ASKED: u32 = 3;
/// Echoes of the longest packet, before and again after that.
const ECHOES: usize = 4;

/// What playing a frame again showed.
enum Replay {
    /// All rows came back.
    Complete,
    /// A row went missing, but other packets may be missing too.
    Troubled,
    /// A row went missing, and all that was answered before it and after it was in order.
    Alone(MissingRow),
    /// The board swallowed a row.
    Swallowed { row: u16 },
}

impl Run<'_> {
    /// Why the run ends when the row at `place` of `frame`, which has `geometry`, did not come back, however often it was
    /// asked for. It is the last of its frame, and all rows before it were `late`, if that is given: where the player stops,
    /// a row that takes longer than claimed cannot come out as a whole.
    pub(crate) fn row_lost(
        &mut self,
        frame: &ScheduledFrame,
        geometry: &Geometry,
        place: RowPlace,
        late: Option<Finding>,
    ) -> End {
        let RowPlace { frame: number, row: lost, .. } = place;
        let unclear = |finding| End::error(CheckName::Frames, Cause::Station, finding);
        let mut alone = Vec::new();
        for _ in 0..REPLAYS {
            match self.replay(frame, geometry) {
                Err(error) => return End::board(CheckName::Frames, &error),
                Ok(Replay::Swallowed { row }) => {
                    let swallowed = Finding::RowSwallowed { row: lost, frame: number, again: row };
                    let swallowed = End::failed(CheckName::Frames, swallowed);
                    let Some(late) = late.filter(|_| row == lost) else { return swallowed };
                    self.findings.checks.ended(&swallowed);
                    return End::failed(CheckName::Latency, late);
                }
                Ok(Replay::Complete) => {
                    return unclear(Finding::RowLostOnce { row: lost, frame: number });
                }
                Ok(Replay::Alone(row)) => alone.push(row),
                Ok(Replay::Troubled) => {}
            }
        }
        match alone.first() {
            Some(&row) if alone == [row; REPLAYS] && row.row == lost => {
                unclear(Finding::RowLostEachTime(row))
            }
            _ => unclear(Finding::RowLostAmongOthers { row: lost, frame: number }),
        }
    }

    fn replay(&mut self, frame: &ScheduledFrame, geometry: &Geometry) -> Result<Replay, BoardError> {
        let before = self.board.tally();
        self.board.drop_rows()?;
        // That forgets a commit whose frame has not begun. The tables stay.
        if let Some(tables) = self.generation(frame.generation) {
            self.commit_uploaded(&tables, frame.number, geometry.height())?;
        }
        self.board.clear_counters()?;
        let first_row = self.board.acknowledged();
        let Ok(input) = self.plan.render(frame, geometry) else { return Ok(Replay::Troubled) };
        let frame = NumberedFrame { number: frame.number, frame: input };
        let Some(row) = self.board.stream_once(&mut Unjudged(iter::once(frame)))? else {
            return Ok(Replay::Complete);
        };
        let mut echoed = self.echoes_pass()?;
        for _ in 0..ASKED {
            self.board.give(&row.place, &row.samples);
            self.board.status()?;
        }
        echoed &= self.echoes_pass()?;
        let status = self.board.status()?;
        let is_clean = [status.damaged(), status.foreign_packets] == [0; 2];
        if !echoed || !is_clean || !had_no_trouble(before, self.board.tally()) {
            return Ok(Replay::Troubled);
        }
        let reached = self.board.had_each_packet_once(&status);
        let swallowed = reached && was_taken(&status, first_row, &row) && is_withheld(&status, &row);
        if swallowed {
            return Ok(Replay::Swallowed { row: row.place.row });
        }
        Ok(Replay::Alone(MissingRow {
            row: row.place.row,
            frame: row.place.frame,
            waits_for: status.next_row_in.checked_sub(first_row).filter(|&next| next < row.sent),
        }))
    }

    fn echoes_pass(&mut self) -> Result<bool, BoardError> {
        let bytes: Vec<u8> = (0..MAX_PAYLOAD).map(|place| (place % 251) as u8).collect();
        let mut pass = true;
        for _ in 0..ECHOES {
            pass &= self.board.echo(&bytes)?.0;
        }
        Ok(pass)
    }
}

/// Whether, as far as the host can see, nothing was lost, damaged, late or doubled between two tallies.
fn had_no_trouble(before: Tally, after: Tally) -> bool {
    let troubles = |tally: Tally| (tally.retries, tally.strays, tally.damaged_in, tally.line_errors.sum());
    troubles(before) == troubles(after)
}

/// Whether the board says that it took the row, and has everything that it needs to bring it out: a row's second half
/// leaves while the next one enters, or after the last row of a frame.
fn was_taken(status: &Status, first_row: u32, row: &Unreturned) -> bool {
    let is_pushed_out = row.place.last || first_row + row.sent > row.place.row_sequence + 1;
    status.rows_in == row.sent && status.next_row_in == first_row + row.sent && is_pushed_out
}

/// Whether the board says that the row was not acknowledged, and still gives it out neither by itself nor when it is sent
/// again: it counts no rows out besides those that came, or counts each further copy of the row as unneeded.
fn is_withheld(status: &Status, row: &Unreturned) -> bool {
    status.next_row_out == row.place.row_sequence
        && status.rows_repeated == 0
        && (status.rows_out == row.returned || status.rows_unneeded == ASKED)
}
