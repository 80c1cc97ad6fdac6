//! Bursts for hours: each has new content, tables and kernel take turns, every second one has the trap set, and
//! differences do not end it.

mod account;
mod played;

use std::time::Duration;

use super::burst::{BurstPlan, LONGEST_LOOK};
use super::watched::{BurstSeen, EndsEarly, MiscountSeen};
use super::{NONE, price, tables_late};
use crate::board::Bursts;
use crate::progress::{Event, Step};
use crate::result::{
    CheckName, Doubt, EqualAtSpeed, Finding, NotExercised, SoakInterval, SoakLength, SoakReport,
};
use crate::run::findings::exercised::Exercised;
use crate::run::findings::{During, End};
use crate::run::plan::{DECOY, JUDGED, Segment};
use crate::run::sessions::second_look::{LOOKS, unasked};
use crate::run::steps::Run;
use crate::tables::{Generation, datapath_of};
use crate::verdict::Cause;
use account::{LONGEST_BURST, SoakAccount};
use played::Played;

/// Whether a burst makes the same frame again and again, so that the board keeps a row of a frame that differs. A
/// difference that occurs once in an hour would not occur again when the frame is made anew.
fn is_trapped(draw: u32) -> bool {
    draw % 2 == 1
}

/// What differed in a burst or in the tables before it, or an answer that no sound board gives.
fn difference(account: &SoakAccount, played: &Result<Played, End>) -> Option<End> {
    let ended = match played {
        Ok(played) => match played.finding() {
            Some(finding) => {
                return Some(account.counted_on(played, End::failed(CheckName::AtSpeed, finding)));
            }
            None => played.ended.as_ref().err(),
        },
        Err(end) => Some(end),
    };
    ended.filter(|end| end.is_failed() || end.is_answer()).cloned()
}

/// Ends a soak in which the burst `plan` brought no frame although `time` was that of the longest burst: it would go on
/// for ever.
fn brought_frames(plan: &BurstPlan, watched: &BurstSeen, time: Duration) -> Result<(), End> {
    if watched.frames > 0 || time < LONGEST_BURST {
        return Ok(());
    }
    let finding = Finding::BurstStalled { frame: 0, frames: plan.frames, seconds: time.as_secs_f64() };
    Err(End::error(CheckName::AtSpeed, Cause::Station, finding))
}

/// The end of a soak with a difference that the link may have caused each time.
fn wrong_over_doubtful_link((found, doubt): (Finding, Doubt)) -> End {
    let finding = Finding::WrongOverDoubtfulLink { found: Box::new(found), doubt };
    End::error(CheckName::AtSpeed, Cause::Station, finding)
}

impl Run<'_> {
    /// Judges bursts for as long as `length` says, and returns what was exercised. If the board goes away, it is brought back to
    /// where it was after `last`. Differences do not end it.
    pub(in crate::run) fn soak(
        &mut self,
        length: SoakLength,
        last: Option<&Segment>,
    ) -> Result<Exercised, End> {
        let mut account = SoakAccount::new(length, self.clock());
        let bursts = match self.bursts() {
            Ok(bursts) => bursts,
            Err(reason) => {
                self.findings.soak = Some(account.report);
                let finding = Finding::NothingAtSpeed { reason };
                return Err(End::error(CheckName::AtSpeed, Cause::NothingJudged, finding));
            }
        };
        self.progress.step(Step::AtSpeed);
        let ended = self.all_bursts(&mut account, bursts, last);
        let ended = account.end(self.clock(), ended);
        let changes = account.change_would_show;
        let report = account.report;
        let SoakReport { frames, paused, held_back, .. } = report;
        let idle = report.is_idle().then_some(NotExercised::IdleTime { seconds: report.idle_seconds as u64 });
        self.findings.soak = Some(report);
        ended?;
        let mut left = super::untested(changes, paused > 0);
        left.extend(self.clock_unseen());
        left.extend(idle);
        self.note_right(paused, EqualAtSpeed { frames, held_back, ..NONE });
        Ok(Exercised { left, ..Exercised::default() })
    }

    /// The run's clock: the link's, plus the time of earlier links, which broke.
    pub(in crate::run) fn clock(&self) -> Duration {
        self.sessions.earlier() + self.board.now()
    }

    fn all_bursts(
        &mut self,
        account: &mut SoakAccount,
        bursts: Bursts,
        last: Option<&Segment>,
    ) -> Result<(), End> {
        while !account.is_over(self.clock()) {
            match (self.one_burst(account, bursts), last) {
                (Err(end), Some(last)) if end.is_outage() => {
                    self.return_to(last, last.frames.len(), end)?;
                    self.progress.step(Step::AtSpeed);
                }
                (judged, _) => judged?,
            }
        }
        Ok(())
    }

    /// Judges the next burst.
    fn one_burst(&mut self, account: &mut SoakAccount, bursts: Bursts) -> Result<(), End> {
        let draw = account.report.bursts;
        account.report.bursts += 1;
        let mut doubtful = None;
        let settled = self.settle(account, bursts, draw, &mut doubtful);
        if let (Err(_), Some(doubtful)) = (&settled, doubtful) {
            account.leave_open(wrong_over_doubtful_link(doubtful));
        }
        settled
    }

    /// Judges the burst with the draw `draw`. If something differs that the link may have caused, it is put into
    /// `doubtful`, and the burst is made again in another session.
    fn settle(
        &mut self,
        account: &mut SoakAccount,
        bursts: Bursts,
        draw: u32,
        doubtful: &mut Option<(Finding, Doubt)>,
    ) -> Result<(), End> {
        for _ in 0..=LOOKS {
            let played = self.play(account, bursts, draw);
            let Some(found) = difference(account, &played) else {
                let played = played?;
                if played.ended.is_ok()
                    && let Some((found, doubt)) = doubtful.take()
                {
                    let finding = Finding::RightInAnotherSession { found: Box::new(found), doubt };
                    let end = End::error(CheckName::AtSpeed, Cause::Station, finding);
                    account.report.differing_bursts += 1;
                    account.keep(&played, self.clock(), end);
                }
                return played.ended;
            };
            let Some(doubt) = self.doubt_of(&found) else {
                let played = played?;
                if found.is_failed() {
                    self.look_into(account, &played);
                }
                return played.ended;
            };
            tracing::info!("{}; made again, since {}", found.finding().sentence(), doubt.clause());
            *doubtful = Some((unasked(&found), doubt));
            self.open_another_session()?;
        }
        doubtful.take().map_or(Ok(()), |doubtful| Err(wrong_over_doubtful_link(doubtful)))
    }

    /// Has the board make the burst with the draw `draw`, and compares every frame.
    fn play(&mut self, account: &mut SoakAccount, bursts: Bursts, draw: u32) -> Result<Played, End> {
        if Doubt::of_session(self.board).is_some() {
            self.open_another_session()?;
        }
        let tables = self.tables_of_burst(draw)?;
        let plan = price::burst_of(self.plan, &self.board.capabilities, bursts, draw).made_with(&tables);
        let (now, earlier, progress) = (self.board.now(), self.sessions.earlier(), self.progress);
        let time = account.time_of_burst(earlier + now);
        let mut plan = plan.of_frames(account.frames_of_burst(&plan, time));
        if let Some(active) = tables.first().filter(|_| is_trapped(draw) && plan.has_trap()) {
            plan = plan.trapping(0, plan.frames);
            self.expect(&plan, active)?;
        }
        let ends_early = EndsEarly { when_wrong: account.wants_more(), at: Some(now + time) };
        let mut before = SoakInterval::default();
        account.begin_burst(self.clock());
        let mut told = |watched: &BurstSeen, now| {
            progress.event(Event::Soaked(account.add(&plan, &mut before, watched, earlier + now)));
        };
        let (watched, ended) = self.watch(&plan, &tables, ends_early, &mut told);
        let ended = ended.and_then(|()| brought_frames(&plan, &watched, time));
        let until = now + plan.time_of(watched.frames).min(time);
        let from = self.board.now();
        let ended = ended.and_then(|()| self.pass_time(until));
        let passed = self.board.now().min(until).saturating_sub(from);
        told(&watched, self.board.now());
        account.pass(passed);
        account.report.paused += u64::from(watched.paused);
        account.report.held_back += u64::from(watched.held_back);
        account.change_would_show =
            account.change_would_show || tables_late::would_show(&plan, &tables, watched.frames);
        Ok(Played { plan, tables, watched, ended })
    }

    /// Waits until it is `then` on the link's clock. With a computed board frames take no time on that clock, and hours
    /// would never pass.
    fn pass_time(&mut self, then: Duration) -> Result<(), End> {
        let mut left = then.saturating_sub(self.board.now());
        while !left.is_zero() {
            let wait = left.min(LONGEST_LOOK);
            self.board.idle(wait).during(CheckName::AtSpeed)?;
            left -= wait;
        }
        Ok(())
    }

    fn open_another_session(&mut self) -> Result<(), End> {
        let nonce = self.sessions.next_nonce();
        self.board.open_another_session(nonce).during(CheckName::Link)
    }

    /// Diagnoses what differed in a burst.
    fn look_into(&mut self, account: &mut SoakAccount, played: &Played) {
        let Played { plan, tables, watched, .. } = played;
        let miscount = watched.miscount.as_ref();
        let at = watched.wrong_frames.first().map(|first| first.at).or(miscount.map(|miscount| miscount.at));
        let at = at.map_or_else(|| self.clock(), |at| self.sessions.earlier() + at);
        account.report.differing_bursts += 1;
        let end = match miscount {
            _ if !account.wants_more() => return,
            Some(MiscountSeen { finding, .. }) if watched.wrong == 0 => {
                End::failed(CheckName::AtSpeed, finding.clone())
            }
            _ => self.wrong_at_speed(plan, tables, watched),
        };
        account.keep(played, at, end);
    }

    /// The tables and the kernel to judge with and the decoy's. Each are active in two bursts out of four; the others are
    /// in the other bank if there is one.
    fn tables_of_burst(&mut self, draw: u32) -> Result<Vec<Generation>, End> {
        self.sessions.start_afresh(self.board).during(CheckName::AtSpeed)?;
        let tables = &self.plan.tables;
        self.set(tables.geometry(), datapath_of(tables))?;
        let mut tables: Vec<_> =
            self.generations.iter().filter(|it| [DECOY, JUDGED].contains(&it.number)).cloned().collect();
        if (draw / 2).is_multiple_of(2) {
            tables.reverse();
        }
        tables.truncate(self.board.capabilities.table_banks.into());
        let mut active = 0;
        for (place, generation) in tables.iter().enumerate() {
            self.put_aside(generation)?;
            if place == 0 || !self.board.knows_shape_of(&generation.tables) {
                self.activate(generation)?;
                active = place;
            }
        }
        if active > 0
            && let Some(first) = tables.first()
        {
            self.activate(first)?;
        }
        Ok(tables)
    }
}
