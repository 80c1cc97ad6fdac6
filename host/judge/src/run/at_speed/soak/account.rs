//! What a soak has judged so far, and when it is over.

use std::time::Duration;

use crate::progress::Soaked;
use crate::result::{
    BurstCount, CheckName, Defect, Finding, Lead, SoakDifference, SoakInterval, SoakLength, SoakReport,
    Suspect,
};
use crate::run::at_speed::burst::BurstPlan;
use crate::run::at_speed::watched::BurstSeen;
use crate::run::findings::End;
use crate::run::sessions::second_look::{broken_off, unasked};
use crate::verdict::Cause;

use super::played::Played;

/// The longest burst, on the link's clock.
pub(super) const LONGEST_BURST: Duration = Duration::from_secs(60);
/// The longest time between two looks beyond that of the frames in it. If it was longer, this computer or the link stood still, and
/// the board made no more frames than it can keep records of.
const LONGEST_GAP: Duration = Duration::from_secs(1);
/// The most frames of a burst: after these, frame numbers repeat, and content with them.
const MOST_FRAMES: u32 = 1 << 16;

/// A soak that is under way.
pub(super) struct SoakAccount {
    pub(super) report: SoakReport,
    /// Whether a change of tables that comes late would have shown in some burst.
    pub(super) change_would_show: bool,
    /// When it began, on the run's clock.
    begun: Duration,
    /// For how long frames were made and looked at.
    made: Duration,
    /// The last look, on the run's clock.
    looked_at: Duration,
    /// The first difference, with its frame counted from the beginning of the soak.
    first: Option<End>,
    /// The first difference that the link may have caused, since another session did not confirm it.
    first_doubtful: Option<End>,
}

impl SoakAccount {
    /// A soak of length `asked` that begins at `begun` on the run's clock.
    pub(super) fn new(asked: SoakLength, begun: Duration) -> Self {
        let report = SoakReport::new(asked);
        let (change_would_show, made, looked_at) = (false, Duration::ZERO, begun);
        Self { report, change_would_show, begun, made, looked_at, first: None, first_doubtful: None }
    }

    /// The time that is left after `now`, on the run's clock; none if the soak is so many frames long.
    fn time_left(&self, now: Duration) -> Option<Duration> {
        let SoakLength::Time { seconds } = self.report.asked else { return None };
        let beyond = if seconds > 0.0 { Duration::MAX } else { Duration::ZERO };
        let length = Duration::try_from_secs_f64(seconds).unwrap_or(beyond);
        Some(self.begun.saturating_add(length).saturating_sub(now))
    }

    /// The frames that are left; none if the soak has a time.
    fn frames_left(&self) -> Option<u64> {
        let SoakLength::Frames { frames } = self.report.asked else { return None };
        Some(frames.saturating_sub(self.report.frames))
    }

    pub(super) fn is_over(&self, now: Duration) -> bool {
        self.frames_left() == Some(0) || self.time_left(now) == Some(Duration::ZERO)
    }

    /// The most frames of a burst that is planned as `plan` and may take `time`.
    pub(super) fn frames_of_burst(&self, plan: &BurstPlan, time: Duration) -> u32 {
        let left = self.frames_left().map_or(u32::MAX, |left| u32::try_from(left).unwrap_or(u32::MAX));
        plan.frames_in(time).min(MOST_FRAMES).min(left)
    }

    /// The longest time of a burst that begins at `now` on the run's clock.
    pub(super) fn time_of_burst(&self, now: Duration) -> Duration {
        self.time_left(now).map_or(LONGEST_BURST, |left| left.min(LONGEST_BURST))
    }

    /// Whether differences are still looked into.
    pub(super) fn wants_more(&self) -> bool {
        self.first.is_none() || self.has_room()
    }

    fn has_room(&self) -> bool {
        self.report.differences.len() < SoakReport::MOST_DIFFERENCES
    }

    /// Begins a burst at `now` on the run's clock.
    pub(super) fn begin_burst(&mut self, now: Duration) {
        self.looked_at = now;
    }

    /// Adds the time since the last look to that in which frames were made, up to `most`.
    fn look(&mut self, now: Duration, most: Duration) {
        self.made += now.saturating_sub(self.looked_at).min(most);
        self.looked_at = now;
    }

    /// Adds the time that the host waited after a burst, so that its frames took theirs, beyond what the last look has added.
    pub(super) fn pass(&mut self, time: Duration) {
        self.made += time.saturating_sub(LONGEST_GAP);
    }

    /// Adds what came up to `now` of the burst `plan`. `watched` is what was seen of it in all; `before` is what was already
    /// counted.
    pub(super) fn add(
        &mut self,
        plan: &BurstPlan,
        before: &mut SoakInterval,
        watched: &BurstSeen,
        now: Duration,
    ) -> Soaked {
        let BurstSeen { frames, wrong, miscounted, .. } = *watched;
        let all = SoakInterval { frames: frames.into(), wrong: wrong.into(), miscounted: miscounted.into() };
        let new = all.without(*before);
        *before = all;
        self.look(now, plan.time_of(new.frames as u32) + LONGEST_GAP);
        let time = now.saturating_sub(self.begun);
        self.report.frames += new.frames;
        self.report.wrong += new.wrong;
        self.report.miscounted += new.miscounted;
        self.report.chart.add(time, new);
        let SoakReport { frames, wrong, miscounted, asked, .. } = self.report;
        Soaked { time, frames, wrong: wrong + miscounted, of: asked }
    }

    /// Keeps `end`, the difference in the burst that was just played, seen at `at` on the run's clock.
    pub(super) fn keep(&mut self, played: &Played, at: Duration, end: End) {
        let end = self.counted_on(played, end);
        let (suspects, first) = match &end {
            End::Failed { suspects, .. } => (suspects.clone(), &mut self.first),
            End::Error { .. } => (Vec::new(), &mut self.first_doubtful),
        };
        let finding = end.finding().clone();
        match first {
            None => *first = Some(end),
            Some(first) => tell_more(first, &suspects),
        }
        if self.has_room() {
            let seconds = at.saturating_sub(self.begun).as_secs_f64();
            let (seed, generation) = (played.plan.seed(), played.generation());
            let difference = SoakDifference { seconds, seed, generation, finding, suspects };
            self.report.differences.push(difference);
        }
    }

    /// A difference in the burst that was just played, with its frame counted from the beginning of the soak.
    pub(super) fn counted_on(&self, played: &Played, mut end: End) -> End {
        let before = self.report.frames - u64::from(played.watched.frames);
        let End::Failed { finding, .. } = &mut end else { return end };
        match finding {
            // The frame of such a finding is how many the burst has.
            Finding::MiscountedAtSpeed { count: BurstCount::Records, .. } => {}
            Finding::DiffersAtSpeed { first: frame, .. } | Finding::MiscountedAtSpeed { frame, .. } => {
                *frame += before;
            }
            _ => {}
        }
        end
    }

    /// Keeps a difference that the link may have caused and that could not be tried in another session.
    pub(super) fn leave_open(&mut self, end: End) {
        self.first_doubtful.get_or_insert(end);
    }

    /// Ends the soak at `now` on the run's clock with the first of these that applies:
    ///
    /// 1. a difference that is the board's, which nothing later makes right; what `ended` the bursts early is told beside it;
    /// 2. what `ended` the bursts early, together with a difference that could not be tried in another session, if there
    ///    is one;
    /// 3. a difference that the link may have caused;
    /// 4. that there was no frame to judge.
    pub(super) fn end(&mut self, now: Duration, ended: Result<(), End>) -> Result<(), End> {
        let time = now.saturating_sub(self.begun);
        self.report.seconds = time.as_secs_f64();
        self.report.idle_seconds = time.saturating_sub(self.made).as_secs_f64();
        match (self.first.take(), ended, self.first_doubtful.take()) {
            (Some(end), ended, _) => {
                self.report.ended = ended.err().map(|ended| unasked(&ended));
                Err(self.of_all_frames(end))
            }
            (
                None,
                Err(end),
                Some(End::Error { finding: Finding::WrongOverDoubtfulLink { found, doubt }, .. }),
            ) => Err(broken_off(end, *found, doubt)),
            (None, Err(end), _) | (None, Ok(()), Some(end)) => Err(end),
            (None, Ok(()), None) if self.report.frames == 0 => {
                Err(End::error(CheckName::AtSpeed, Cause::NothingJudged, Finding::NothingJudged {}))
            }
            (None, Ok(()), None) => Ok(()),
        }
    }

    /// The first difference, with the counts of all frames of the soak.
    fn of_all_frames(&self, mut end: End) -> End {
        if let End::Failed { finding: Finding::DiffersAtSpeed { wrong, frames, .. }, .. } = &mut end {
            (*wrong, *frames) = (self.report.wrong, self.report.frames);
        }
        end
    }
}

/// Takes over the suspects of another difference if a row of it was seen, and none of the first.
fn tell_more(first: &mut End, seen: &[Suspect]) {
    let names_row = |suspects: &[Suspect]| {
        let has_none = |defect: &Defect| {
            matches!(defect, Defect::OnlyAtSpeed { row: None, .. } | Defect::SeenAtSpeed { row: None, .. })
        };
        suspects.iter().any(|it| !has_none(&it.defect))
    };
    if let End::Failed { finding: Finding::DiffersAtSpeed { suspect, others, short, .. }, suspects, .. } =
        first
        && !names_row(suspects)
        && names_row(seen)
    {
        let lead = Lead::of(seen);
        (*suspect, *others, *short) = (lead.suspect, lead.others, lead.short.map(Box::new));
        *suspects = seen.to_vec();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::Repetition;

    fn is_over(seconds: f64, now: Duration) -> bool {
        SoakAccount::new(SoakLength::Time { seconds }, Duration::ZERO).is_over(now)
    }

    /// Such times come from a deadline that has already passed, or from 0 divided by 0.
    #[test]
    fn what_is_no_time_is_over_at_once_and_what_no_clock_counts_to_never() {
        for seconds in [0.0, -1.0, f64::NEG_INFINITY, f64::NAN] {
            assert!(is_over(seconds, Duration::ZERO), "{seconds}");
        }
        assert!(!is_over(1.0, Duration::ZERO) && is_over(1.0, Duration::from_secs(1)));
        let a_year = Duration::from_secs(365 * 86_400);
        assert!([1e300, f64::INFINITY].iter().all(|&seconds| !is_over(seconds, a_year)));
    }

    /// A board with small frames makes as many of them in a night.
    #[test]
    fn a_difference_has_the_counts_of_all_frames_beyond_those_of_32_bits() {
        let mut account = SoakAccount::new(SoakLength::Time { seconds: 64_000.0 }, Duration::ZERO);
        (account.report.frames, account.report.wrong) = (6_000_000_000, 5_000_000_000);
        let finding = Finding::DiffersAtSpeed {
            wrong: 1,
            frames: 2,
            first: 4_900_000_000,
            repetition: Repetition::NotNeeded {},
            suspect: None,
            others: 0,
            short: None,
        };
        account.first = Some(End::failed(CheckName::AtSpeed, finding));
        let Err(End::Failed { finding, .. }) = account.end(Duration::ZERO, Ok(())) else {
            panic!("it differs")
        };
        let said = finding.sentence();
        let told = "5,000,000,000 of 6,000,000,000 frames differ at speed, the first is frame 4,900,000,000";
        assert!(said.starts_with(told), "{said}");
    }
}
