//! Bursts that wait for free records, and what RECORDS says of them.

use std::ops::Range;
use std::time::Duration;

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Burst, BurstState, Records, RefusalCode, Request};

use super::bursts::{Awaited, Held, LONGEST_IDLE, PATIENCE, Told};
use super::quoted::other_signatures;
use super::{Rules, broken};
use crate::board::Response;
use crate::result::{Answer, CheckName, Rule};
use crate::run::findings::{During, End};

/// How many records are freed each time that a burst waits for free ones.
const TAKEN: [u32; 4] = [5, 1, 9, 4];
/// How long a burst is left waiting for a free record, try by try. A frame is held back only if its blanking has passed by then,
/// which a host does not see, and a board whose clock is slow or not known takes its time over it.
const LEFT_WAITING: [Duration; 3] = [Duration::ZERO, LONGEST_IDLE, PATIENCE];
/// The most records that a burst fills: a slow board would take too long to make more frames.
pub(in crate::run) const MOST_FILLED: u32 = 1024;
/// So many frames that a burst does not end on its own, though it would if only the lower bits of the number counted.
const MANY: u32 = 1 << 24 | 1;
/// Records that fit into a packet.
const AT_ONCE: u32 = Records::MOST as u32;

impl Rules<'_, '_> {
    /// Bursts that wait for the host to take records: what is refused meanwhile, and which records are sent again.
    pub(super) fn waiting(&mut self) -> Result<(), End> {
        let kept = self.capabilities.bursts.map_or(0, |bursts| u32::from(bursts.records));
        if kept > AT_ONCE { self.of_many_records(kept) } else { self.of_few_records(kept) }
    }

    /// For boards whose records all fit into a packet, which so shows how a burst waits. It is left waiting for longer if a
    /// frame that was held back does not say so.
    fn of_few_records(&mut self, kept: u32) -> Result<(), End> {
        for left_waiting in LEFT_WAITING {
            if self.held_back(kept, left_waiting)? {
                break;
            }
            self.drop_rows()?;
        }
        Ok(())
    }

    /// A burst that waits for free records again and again, each time at least as long as `left_waiting`. Returns whether all
    /// frames that waited say so, which they must after the longest of these times.
    fn held_back(&mut self, kept: u32, left_waiting: Duration) -> Result<bool, End> {
        let taken = TAKEN.map(|taken| taken.min(kept));
        let all = kept + taken.iter().sum::<u32>();
        let Some(burst) = self.small_burst(MANY) else { return Ok(true) };
        let burst = self.start(burst)?;
        let (mut from, mut held) = (0, Vec::new());
        for taken in taken {
            self.look(&burst, from, kept, Awaited::under_way(kept))?;
            if from == 0 {
                self.busy_with_burst(&burst)?;
                // Now fewer frames than were asked for first.
                self.set_frames(&burst, all)?;
            }
            let (frames, held_back) = (from..from + kept, Held::Only(&held));
            let ended = Told::ended(&burst, frames.clone());
            let under_way = Told { state: BurstState::UnderWay, held: held_back, ..ended };
            if !self.tells_held(&under_way, left_waiting)? {
                return Ok(false);
            }
            self.never_told(frames)?;
            self.leave_waiting(&burst, from, left_waiting)?;
            held.push(from + kept);
            from += taken;
        }
        self.look(&burst, from, kept, Awaited::ended(all - from))?;
        let ended = |from| Told { held: Held::Only(&held), ..Told::ended(&burst, from..all) };
        if !self.tells_held(&ended(from), left_waiting)? {
            return Ok(false);
        }
        self.stays(&burst, 2 * all)?;
        for from in from..=all {
            self.must_tell(Rule::Records, &ended(from))?;
        }
        self.never_told(all..all)?;
        Ok(true)
    }

    /// RECORDS must give the records that are `told`. Returns whether those of frames that waited, and no others, say so; after
    /// the longest time they must.
    fn tells_held(&mut self, told: &Told<'_>, left_waiting: Duration) -> Result<bool, End> {
        self.must_tell(Rule::Records, &Told { held: Held::Any, ..told.clone() })?;
        match self.must_tell(Rule::Records, told) {
            Err(end) if end.is_failed() && left_waiting < PATIENCE => Ok(false),
            told => told.map(|()| true),
        }
    }

    /// Lets `time` pass, and that of a frame, without freeing a record. A board that is clocked by its packets is asked
    /// meanwhile.
    fn leave_waiting(&mut self, burst: &Burst, from: u32, time: Duration) -> Result<(), End> {
        if time.is_zero() {
            return Ok(());
        }
        let mut left = time + self.time_of(1);
        while !left.is_zero() {
            let idle = left.min(LONGEST_IDLE);
            self.run.board.idle(idle).during(CheckName::Rules)?;
            self.run.board.records(burst.burst, from).during(CheckName::Rules)?;
            left -= idle;
        }
        Ok(())
    }

    /// For boards with more records: a burst that waits for free records, which no packet shows, so frames may be held
    /// back or not.
    fn of_many_records(&mut self, kept: u32) -> Result<(), End> {
        let Some(burst) = self.small_burst(Burst::ENDLESS) else { return Ok(()) };
        let burst = self.start(burst)?;
        let taken = TAKEN[0].min(kept - AT_ONCE);
        for from in [0, taken] {
            let frames = from..from + AT_ONCE;
            self.look(&burst, from, AT_ONCE, Awaited::under_way(AT_ONCE))?;
            if from == 0 {
                self.busy_with_burst(&burst)?;
            }
            let under_way = Told { state: BurstState::UnderWay, ..Told::ended(&burst, frames) };
            self.must_tell(Rule::Records, &under_way)?;
            self.never_told(from..from + kept)?;
        }
        // One more frame than there are records for, so that the burst has not ended yet.
        let all = Some(taken + kept + 1).filter(|_| kept <= MOST_FILLED);
        self.set_frames(&burst, all.unwrap_or(0))?;
        let from = taken + 1;
        self.look(&burst, from, all.unwrap_or(AT_ONCE), Awaited::ended(AT_ONCE))?;
        let end = all.unwrap_or(from + AT_ONCE);
        let ended = |frames| Told { held: Held::Any, ..Told::ended(&burst, frames) };
        let mut last = from..end;
        for from in (from..end).step_by(Records::MOST) {
            last = from..end.min(from + AT_ONCE);
            self.must_tell(Rule::Records, &ended(last.clone()))?;
        }
        self.stays(&burst, 2 * end)?;
        self.must_tell(Rule::Records, &ended(last))?;
        let Some(all) = all else { return Ok(()) };
        self.must_tell(Rule::Records, &ended(all..all))?;
        self.never_told(all..all)
    }

    fn set_frames(&mut self, burst: &Burst, frames: u32) -> Result<(), End> {
        self.replied(Rule::Ended, &Request::Burst(Burst { frames, ..*burst }), Vec::new())
    }

    /// A burst that has ended must not go on although it is set to `frames`, and its records must stay after a RESET.
    fn stays(&mut self, burst: &Burst, frames: u32) -> Result<(), End> {
        self.set_frames(burst, frames)?;
        self.drop_rows()
    }

    /// RECORDS must give what is `told`. The request frees the records before these.
    pub(super) fn must_tell(&mut self, rule: Rule, told: &Told<'_>) -> Result<(), End> {
        let right = self.records(told);
        let from = told.frames.start.to_le_bytes();
        let said = self.run.board.ask(Kind::Records, &from).map(|said| match said {
            Response::Replied(payload) => Response::Replied(told.held.looked_at(payload)),
            refused => refused,
        });
        if let Ok(Response::Replied(came)) = &said
            && let Some(found) = other_signatures(&right, came, told.frames.start)
        {
            let ended = told.state == BurstState::Ended;
            let right = Answer::Burst { ended, records: told.frames.len() };
            return Err(broken(rule, self.posed(), right, found));
        }
        self.judge(rule, self.posed(), said, &Response::Replied(right))
    }

    /// Requests for records before or beyond `frames` must be refused.
    pub(super) fn never_told(&mut self, frames: Range<u32>) -> Result<(), End> {
        let before = frames.start.checked_sub(1);
        let beyond = (0..u32::BITS).filter_map(|bit| frames.end.checked_add(1 << bit));
        for from in before.into_iter().chain(beyond) {
            self.refused(Rule::Records, &Request::Records { from }, RefusalCode::Range, 0)?;
        }
        Ok(())
    }
}
