//! Compares the pixel clock that a board names with the host's clock.

use std::time::Duration;

use halfrow_protocol::message::{BurstState, ClockSource, Records};

use super::USUAL;
use super::burst::BurstPlan;
use super::watched::BurstSeen;
use crate::board::{BoardNature, Fetched};
use crate::result::wording::seen_of_clock;
use crate::result::{CheckName, ClockSeen, Finding, NotExercised};
use crate::run::findings::End;
use crate::run::sessions::second_look::LOOKS;
use crate::run::steps::Run;
use crate::tables::Generation;

/// The shortest time from which a clock is concluded to be slow: a board may take 50 ms until a burst begins (WIRE.md).
const TELLING: Duration = Duration::from_millis(500);
/// The most bursts in which a wrong clock is looked for, since some say nothing about it.
const BURSTS: u32 = 2 * LOOKS;

/// What bounds a burst's pixel clock, on the link's clock.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stopwatch {
    /// When the last packet before the request for the burst came.
    asked: Duration,
    /// Since when no frame has waited, and how many there were by then.
    since: (Duration, u32),
    /// Frames that waited or paused.
    waited: u32,
    /// The frame before which the host had all records, as far as the board knew when it was last asked.
    freed: u32,
}

impl Stopwatch {
    /// For a burst that was requested after `asked` and whose reply had come by `answered`: it began in between.
    pub(super) fn new(asked: Duration, answered: Duration) -> Self {
        Self { asked, since: (answered, 0), waited: 0, freed: 0 }
    }

    /// Notes what `watched` says about the clock. Its last frames, from frame `from` on, were `fetched` with a request
    /// after the packet that came at `before`, and the reply had come by `at`.
    ///
    /// Frames that are made cannot have taken longer than the time since the request for the burst, however late they are
    /// seen. Frames that were not made when the board was asked cannot have taken less than the time until the packet
    /// before that request, however late that packet was seen.
    pub(super) fn note(
        &mut self,
        plan: &BurstPlan,
        watched: &mut BurstSeen,
        fetched: &Fetched,
        from: u32,
        (before, at): (Duration, Duration),
    ) {
        let (made, waited, seen) = (watched.frames, watched.held_back + watched.paused, &mut watched.clock);
        if made > 1 {
            let least = rate(plan.clocks_of(made - 1), at.saturating_sub(self.asked));
            seen.least_hz = seen.least_hz.max(Some(least));
        }
        if std::mem::replace(&mut self.waited, waited) != waited {
            self.since = (at, made);
        }
        let under_way = before.saturating_sub(self.since.0);
        // What is not judged yet was made all the same.
        let may_wait = made - self.freed >= plan.records()
            || fetched.records.len() >= Records::MOST
            || fetched.records.len() > (made - from) as usize;
        if fetched.state == BurstState::UnderWay && !may_wait && under_way >= TELLING {
            let clocks = plan.clocks_of(made - self.since.1 + 1) + u64::from(plan.latency);
            let most = rate(clocks, under_way);
            seen.most_hz = Some(seen.most_hz.map_or(most, |least| least.min(most)));
        }
        self.freed = from;
    }
}

/// `clocks` in `time`, in hertz.
fn rate(clocks: u64, time: Duration) -> u32 {
    (clocks as f64 / time.max(Duration::from_micros(1)).as_secs_f64()) as u32
}

/// The result of looking at a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Weighed {
    /// It may be the named one.
    Right(ClockSeen),
    /// It is not the named one.
    Wrong(ClockSeen),
    /// It once was seen not to be the named one, but too few later looks confirm or refute that.
    Open(ClockSeen),
}

/// Weighs what was `first` seen of a clock that is named as `named` hertz, and what is seen whenever it is looked at
/// `again`. A look that says nothing about the wrong bound neither clears nor confirms the clock: a busy host sees
/// little, which does not make a wrong board right.
fn weigh<E>(
    named: u32,
    first: ClockSeen,
    mut again: impl FnMut() -> Result<ClockSeen, E>,
) -> Result<Weighed, E> {
    let mut wrong = 1;
    for _ in 1..BURSTS {
        let seen = again()?;
        if seen.clears(first, named) {
            return Ok(Weighed::Right(seen));
        }
        wrong += u32::from(!seen.allows(named));
        if wrong == LOOKS {
            return Ok(Weighed::Wrong(seen));
        }
    }
    Ok(Weighed::Open(first))
}

/// The burst in which a clock is looked at again. It need not be longer than a usual one.
fn to_look_again(plan: &BurstPlan) -> BurstPlan {
    plan.of_frames(plan.frames.min(plan.frames_in(USUAL)))
}

impl Run<'_> {
    /// What was seen of the clock in the burst `plan`, if the clock is the board's own or comes from outside. Ends a run
    /// whose board makes another clock than it names.
    ///
    /// If the board makes the clock, the burst is made again: a host that was frozen together with its own clock sees a
    /// board do more than it can.
    pub(super) fn judge_clock(
        &mut self,
        plan: &BurstPlan,
        tables: &[Generation],
        watched: &BurstSeen,
    ) -> Result<ClockSeen, End> {
        let Some(clock_hz) = self.named_clock() else { return Ok(ClockSeen::default()) };
        let source = self.board.capabilities.source_of_clock();
        let first = watched.clock;
        if source != Some(ClockSource::Pll) || first.allows(clock_hz) {
            return Ok(first);
        }
        tracing::info!(
            "the board names a pixel clock of {clock_hz} Hz, and {}; looking again",
            seen_of_clock(first)
        );
        let plan = to_look_again(plan);
        match weigh(clock_hz, first, || Ok(self.judge_frames(&plan, tables)?.clock))? {
            Weighed::Wrong(seen) => {
                Err(End::failed(CheckName::AtSpeed, Finding::ClockNotAsNamed { clock_hz, seen }))
            }
            Weighed::Right(seen) | Weighed::Open(seen) => Ok(seen),
        }
    }

    /// The clock that the board names, in hertz, if it can be measured: the board's own, or one from outside.
    fn named_clock(&self) -> Option<u32> {
        let capabilities = &self.board.capabilities;
        let is_real = capabilities.nature != BoardNature::Simulation
            && matches!(capabilities.source_of_clock(), Some(ClockSource::Pixclk | ClockSource::Pll));
        Some(capabilities.clock_hz).filter(|&clock_hz| is_real && clock_hz != 0)
    }

    /// The clock that hardware names and says to be the host's own, which no host gives to hardware.
    fn hidden_clock(&self) -> Option<u32> {
        let capabilities = &self.board.capabilities;
        let is_hidden = capabilities.nature == BoardNature::Hardware
            && capabilities.source_of_clock() == Some(ClockSource::Host);
        Some(capabilities.clock_hz).filter(|&clock_hz| is_hidden && clock_hz != 0)
    }

    /// The clock that the board names as not exercised, for a run without frames that would show it.
    pub(super) fn clock_unseen(&self) -> Option<NotExercised> {
        let clock_hz = self.named_clock().or_else(|| self.hidden_clock())?;
        Some(NotExercised::UnseenClock { clock_hz })
    }

    /// The named clock as not exercised, if it was seen to be another one and that is not the board's fault, or not certain, or
    /// if the board does not say whose it is.
    pub(super) fn clock_not_exercised(&self, seen: ClockSeen) -> Option<NotExercised> {
        if let Some(clock_hz) = self.hidden_clock() {
            return Some(NotExercised::UnseenClock { clock_hz });
        }
        let clock_hz = self.board.capabilities.clock_hz;
        (!seen.allows(clock_hz)).then_some(NotExercised::NamedClock { clock_hz, seen })
    }
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Geometry};
    use halfrow_protocol::message::FrameRecord;

    use super::*;
    use crate::board::{Capabilities, Datapath};
    use crate::run::{Plan, usual_capabilities};

    /// 64 x 8 samples and 8 clocks, so 520 clocks a frame, at 10 kHz.
    fn plan() -> BurstPlan {
        let geometry = Geometry::centred(64, 8, BitDepth::Twelve).unwrap();
        let lens = halfrow_model::Equidistant::from_radius(10.0).unwrap();
        let tables = halfrow_model::TableSet::from_lens(geometry, &lens, None).unwrap();
        let plan = Plan::new(tables, halfrow_model::Interpolant::Hermite.into());
        let board = Capabilities { clock_hz: 10_000, ..usual_capabilities(&plan, BoardNature::Hardware) };
        BurstPlan::new(&geometry, &board, board.bursts.unwrap(), Datapath::RowFactors)
    }

    /// What is seen of a burst that began within the first 10 ms. Each look is: the records that come, how many of them
    /// waited, and when they were asked for and had come, in milliseconds.
    fn seen(looks: &[(u32, u32, u64, u64)]) -> [Option<u32>; 2] {
        let mut stopwatch = Stopwatch::new(Duration::ZERO, Duration::from_millis(10));
        let mut watched = BurstSeen::default();
        for &(come, waited, asked, at) in looks {
            watched.frames += come;
            watched.held_back += waited;
            let from = watched.frames - come;
            let records = vec![FrameRecord::default(); come as usize];
            let fetched = Fetched { state: BurstState::UnderWay, records };
            let times = [asked, at].map(Duration::from_millis);
            stopwatch.note(&plan(), &mut watched, &fetched, from, times.into());
        }
        [watched.clock.least_hz, watched.clock.most_hz]
    }

    /// By hand: 10 frames in 1 s are at least 9·520 clocks a second. In 990 ms fewer than 11 were made, and D = 44 at
    /// most passed besides.
    #[test]
    fn a_clock_lies_between_what_was_made_and_what_was_not() {
        assert_eq!(seen(&[(10, 0, 1000, 1000)]), [Some(4680), Some((11 * 520 + latency()) * 1000 / 990)]);
        // The upper bound does not depend on how late the host looks, or what takes long.
        assert_eq!(seen(&[(10, 0, 1000, 9000)]), [Some(520), Some((11 * 520 + latency()) * 1000 / 990)]);
        assert_eq!(seen(&[(1, 0, 100, 110)]), [None, None]);
    }

    #[test]
    fn frames_that_wait_for_a_host_say_nothing_of_a_slow_clock() {
        // The board keeps 64 records, and does not know yet that any was read.
        assert_eq!(seen(&[(64, 0, 5000, 5010)])[1], None);
        assert_eq!(seen(&[(32, 0, 250, 260), (32, 0, 5000, 5010)])[1], None);
        assert_eq!(seen(&[(10, 1, 5000, 5010)])[1], None);
        // Later frames count again.
        let behind = seen(&[(10, 1, 5000, 5010), (4, 0, 6010, 6010)]);
        assert_eq!(behind[1], Some(5 * 520 + latency()));
    }

    fn latency() -> u32 {
        plan().latency.into()
    }

    #[test]
    fn a_fifth_more_or_less_is_no_other_clock() {
        let allows = |least_hz, most_hz| ClockSeen { least_hz, most_hz }.allows(1000);
        assert!(allows(None, None) && allows(Some(1200), None) && allows(None, Some(834)));
        assert!(!allows(Some(1201), None) && !allows(None, Some(833)));
        let confirms = |least, most| ClockSeen { least_hz: least, most_hz: most }.confirms(1000);
        assert!(
            confirms(Some(900), Some(1100)) && !confirms(Some(900), None) && !confirms(Some(500), Some(1100))
        );
    }

    const NAMED: u32 = 1000;
    const FAST: ClockSeen = ClockSeen { least_hz: Some(1300), most_hz: None };
    const SLOW: ClockSeen = ClockSeen { least_hz: None, most_hz: Some(700) };
    const NOTHING: ClockSeen = ClockSeen { least_hz: None, most_hz: None };
    /// As seen by a host that was busy meanwhile.
    const LITTLE: ClockSeen = ClockSeen { least_hz: Some(500), most_hz: Some(3000) };
    const RIGHT: ClockSeen = ClockSeen { least_hz: Some(950), most_hz: Some(1050) };

    /// The result of `first` and then of `then` over and over.
    fn weighed(first: ClockSeen, then: &[ClockSeen]) -> Weighed {
        let mut then = then.iter().copied().cycle();
        weigh(NAMED, first, || then.next().ok_or(())).unwrap()
    }

    #[test]
    fn a_look_that_says_nothing_of_a_clock_clears_nothing() {
        for wrong in [FAST, SLOW] {
            for nothing in [NOTHING, LITTLE] {
                assert_eq!(weighed(wrong, &[nothing]), Weighed::Open(wrong));
                assert_eq!(weighed(wrong, &[nothing, wrong]), Weighed::Wrong(wrong));
                assert_eq!(weighed(wrong, &[nothing, RIGHT]), Weighed::Right(RIGHT));
            }
            assert_eq!(weighed(wrong, &[wrong]), Weighed::Wrong(wrong));
        }
        // The other bound alone says nothing about the wrong one.
        let least = ClockSeen { most_hz: None, ..RIGHT };
        assert_eq!(weighed(SLOW, &[least]), Weighed::Open(SLOW));
        assert_eq!(weighed(FAST, &[least]), Weighed::Right(least));
    }

    /// 3 s of 10 kHz are 57 frames of 520 clocks.
    #[test]
    fn an_hour_is_not_made_again_for_the_clock() {
        let frames = |asked| to_look_again(&plan().of_frames(asked)).frames;
        assert_eq!([3, 57, 58, 70_000].map(frames), [3, 57, 57, 57]);
    }

    /// A board may say that it made more frames than were asked for.
    #[test]
    fn records_beyond_the_burst_are_no_frames_of_the_clock() {
        let mut stopwatch = Stopwatch::new(Duration::ZERO, Duration::from_millis(10));
        let mut watched = BurstSeen { frames: 2, ..BurstSeen::default() };
        let fetched = Fetched { state: BurstState::Ended, records: vec![FrameRecord::default(); 3] };
        let times = [1000, 1000].map(Duration::from_millis);
        stopwatch.note(&plan(), &mut watched, &fetched, 0, times.into());
        assert_eq!((watched.clock.least_hz, watched.clock.most_hz, stopwatch.freed), (Some(520), None, 0));
    }
}
