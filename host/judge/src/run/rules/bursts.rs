//! Bursts that must be refused, that wait for the host or that end early, and what they leave.

use std::ops::Range;
use std::time::Duration;

use halfrow_model::Signer;
use halfrow_protocol::Kind;
use halfrow_protocol::message::{
    Burst, BurstMode, BurstState, Entries, Expect, FrameRecord, Records, RefusalCode, Request, RowPlace, Span,
};

use super::{FIRST_FACTOR, Rules, longer};
use crate::board::{BoardError, Fetched, frame_clocks};
use crate::result::{Answer, CheckName, Rule};
use crate::run::at_speed::{clock_hz, content, known_bursts, signer};
use crate::run::findings::{During, End};
use crate::tables::Generation;

/// Frames of a burst that must be right: every board has records for two.
const FEW: u32 = 2;
/// How long a burst may stand still in addition to the time that its frames take.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);
/// The longest that a row takes a board (WIRE.md, 2), whatever its clock.
const LONGEST_ROW: Duration = Duration::from_millis(100);
/// The longest time between two looks at a burst: no link ends a shorter wait early.
pub(super) const LONGEST_IDLE: Duration = Duration::from_millis(250);
/// A blanking between frames is not tried if fewer than this many pass in a second.
const LEAST_RATE: u32 = 100;
/// Bytes that are sent to the board between the beginning of a burst and its end, so that each is cut at another place.
const BYTES_TO_CUT: [usize; 8] = [0, 5, 11, 40, 77, 130, 211, 400];
/// Keeps the seed of bursts apart from that of frames.
const FAR: u32 = 0xa5a5_0000;

/// What RECORDS must say of a burst.
#[derive(Clone, Copy)]
pub(super) struct Awaited {
    ended: bool,
    records: usize,
}

impl Awaited {
    /// It must have at least `records` records, and may be under way.
    pub(super) fn under_way(records: u32) -> Self {
        Self { ended: false, records: records as usize }
    }

    /// It must have ended. The records are compared elsewhere.
    pub(super) fn ended(records: u32) -> Self {
        Self { ended: true, records: records as usize }
    }

    fn is_met_by(self, came: Self) -> bool {
        if self.ended { came.ended } else { came.records >= self.records }
    }
}

impl From<Awaited> for Answer {
    fn from(Awaited { ended, records }: Awaited) -> Self {
        Self::Burst { ended, records }
    }
}

/// The records that RECORDS must give, and no others.
#[derive(Clone)]
pub(super) struct Told<'a> {
    pub(super) burst: &'a Burst,
    pub(super) frames: Range<u32>,
    pub(super) state: BurstState,
    pub(super) held: Held<'a>,
}

impl<'a> Told<'a> {
    /// Those of `frames` of a `burst` that has ended, none of which waited for a free record.
    pub(super) fn ended(burst: &'a Burst, frames: Range<u32>) -> Self {
        Self { burst, frames, state: BurstState::Ended, held: Held::Only(&[]) }
    }
}

/// Which frames waited for a free record.
#[derive(Clone, Copy)]
pub(super) enum Held<'a> {
    /// Nobody knows, so it is not compared.
    Any,
    /// These.
    Only(&'a [u32]),
}

impl Held<'_> {
    fn has(self, frame: u32) -> bool {
        matches!(self, Self::Only(frames) if frames.contains(&frame))
    }

    /// A reply to RECORDS without what is not compared: pauses, which a board cannot help, and flags but that of a frame that
    /// waited, where that is known.
    pub(super) fn looked_at(self, mut payload: Vec<u8>) -> Vec<u8> {
        let records = payload.get_mut(Records::HEAD..).unwrap_or_default();
        for record in records.as_chunks_mut().0 {
            let told = FrameRecord::from(*record);
            let held_back = told.held_back && matches!(self, Self::Only(_));
            *record = FrameRecord { pauses: 0, held_back, ..told }.to_bytes();
        }
        payload
    }
}

impl Rules<'_, '_> {
    pub(super) fn bursts(&mut self) -> Result<(), End> {
        self.bursts_refused()?;
        self.blankings()?;
        self.waiting()?;
        self.ended_early()?;
        self.cut()?;
        self.repeating()
    }

    /// A burst of `frames` small frames with a name of its own; none if the board makes no bursts.
    pub(super) fn small_burst(&self, frames: u32) -> Option<Burst> {
        let bursts = known_bursts(&self.capabilities).ok()?;
        Some(Burst {
            burst: self.run.bursts + 1,
            frames,
            seed: self.small.seed ^ FAR,
            first_frame: 0xfffe,
            frame_blanking: bursts.least_frame_blanking,
            mode: BurstMode::Fresh,
        })
    }

    /// Starts a burst, and returns it.
    pub(super) fn start(&mut self, burst: Burst) -> Result<Burst, End> {
        self.run.bursts += 1;
        self.replied(Rule::Burst, &Request::Burst(burst), Vec::new())?;
        Ok(burst)
    }

    fn bursts_refused(&mut self) -> Result<(), End> {
        let Some(right) = self.small_burst(1) else { return Ok(()) };
        let mut wrong = vec![(0, Burst { burst: 0, ..right })];
        let blanking = right.frame_blanking;
        wrong.extend(blanking.checked_sub(1).map(|frame_blanking| (4, Burst { frame_blanking, ..right })));
        wrong.extend((blanking > 0).then_some((4, Burst { frame_blanking: 0, ..right })));
        if self.capabilities.table_banks < 2 {
            wrong.push((5, Burst { mode: BurstMode::Alternating, ..right }));
        }
        if !self.has_trap() {
            wrong.push((5, Burst { mode: BurstMode::Trapped, ..right }));
        }
        for (field, burst) in wrong {
            self.refused(Rule::Burst, &Request::Burst(burst), RefusalCode::Range, field)?;
        }
        let unnamed = Request::Burst(Burst { burst: 0, ..right });
        for (rule, request) in [(Rule::Burst, unnamed), (Rule::Records, Request::Records { from: u32::MAX })]
        {
            let kind = request.kind();
            let longer = self.bytes_refused(Rule::Skipped, kind, &longer(&request), RefusalCode::Range, 0);
            self.or_plain(longer, |rules| rules.refused(rule, &request, RefusalCode::Range, 0))?;
        }
        Ok(())
    }

    /// Frames with blankings between them that have one high bit set.
    fn blankings(&mut self) -> Result<(), End> {
        for bit in u8::BITS..u16::BITS {
            let Some(burst) = self.small_burst(FEW) else { return Ok(()) };
            let frame_blanking = burst.frame_blanking | 1 << bit;
            if clock_hz(&self.capabilities) / u32::from(frame_blanking) < LEAST_RATE {
                return Ok(());
            }
            let burst = self.start(Burst { frame_blanking, ..burst })?;
            self.look(&burst, 0, FEW, Awaited::ended(FEW))?;
            self.must_tell(Rule::Burst, &Told::ended(&burst, 0..FEW))?;
        }
        Ok(())
    }

    pub(super) fn has_trap(&self) -> bool {
        self.capabilities.bursts.is_some_and(|bursts| bursts.trap)
    }

    /// The record of frame `n` of `burst`, made at the full pixel clock with `made`, whose frames `signer` signs.
    fn record(&self, (made, signer): (&Generation, &mut Signer), burst: &Burst, n: u32) -> FrameRecord {
        let geometry = made.tables.geometry();
        FrameRecord {
            signature: signer.sign(&made.tables, content(burst, n), &mut Vec::new()),
            samples: (geometry.width() * geometry.height()) as u32,
            rows: geometry.height() as u16,
            least_latency: self.small.latency(geometry),
            most_latency: self.small.latency(geometry),
            pauses: 0,
            generation: made.number,
            held_back: false,
        }
    }

    /// The right reply of RECORDS.
    pub(super) fn records(&self, told: &Told<'_>) -> Vec<u8> {
        let Told { burst, frames, state, held } = told;
        let made = self.small.made(0, self.small.rows(), super::rows::GENERATION);
        let mut signer = signer(&made);
        let records = frames.clone().map(|n| {
            let held_back = held.has(n);
            FrameRecord { held_back, ..self.record((&made, &mut signer), burst, n) }.to_bytes()
        });
        let mut said = Vec::new();
        said.extend(burst.burst.to_le_bytes());
        said.extend(frames.start.to_le_bytes());
        said.extend([*state as u8, frames.len() as u8]);
        said.extend(records.flatten());
        said
    }

    /// How long `frames` frames of the configured size take on the board's clock.
    pub(super) fn time_of(&self, frames: u32) -> Duration {
        let between = self.capabilities.bursts.map_or(0, |bursts| bursts.least_frame_blanking);
        let clocks = frame_clocks((self.width, self.height), self.capabilities.least_blanking, between);
        Duration::from_secs_f64(f64::from(frames) * clocks as f64 / f64::from(clock_hz(&self.capabilities)))
    }

    /// Looks at `burst` from frame `from` on until it is as `awaited`, which takes about as long as `frames` frames, or stands
    /// still.
    pub(super) fn look(
        &mut self,
        burst: &Burst,
        from: u32,
        frames: u32,
        awaited: Awaited,
    ) -> Result<Fetched, End> {
        let time = self.time_of(frames);
        let patience = time + PATIENCE + self.longest_unseen(frames);
        let (mut idle, mut stood, mut most) = (time.min(LONGEST_IDLE), Duration::ZERO, 0);
        loop {
            let fetched = self.run.board.records(burst.burst, from).during(CheckName::Rules)?;
            let has_ended = fetched.state == BurstState::Ended;
            let came = Awaited { ended: has_ended, records: fetched.records.len() };
            if awaited.is_met_by(came) {
                return Ok(fetched);
            }
            if came.records > most {
                (stood, most) = (Duration::ZERO, came.records);
            }
            if stood >= patience {
                return Err(super::broken(Rule::Ended, Kind::Records, awaited.into(), came.into()));
            }
            self.run.board.idle(idle).during(CheckName::Rules)?;
            (stood, idle) = (stood + idle, (2 * idle).min(LONGEST_IDLE));
        }
    }

    /// How long a board may work on `frames` frames while RECORDS shows nothing new: on one of them, or on all if they are more
    /// than it shows.
    fn longest_unseen(&self, frames: u32) -> Duration {
        let unseen = if frames > Records::MOST as u32 { frames } else { 1 };
        LONGEST_ROW.saturating_mul(self.height as u32).saturating_mul(unseen)
    }

    pub(super) fn busy_with_burst(&mut self, burst: &Burst) -> Result<(), End> {
        self.busy(Rule::UnderWay)?;
        let place = RowPlace { frame: 0, last: false, ..self.place(0) };
        self.row_refused(Rule::UnderWay, place, RefusalCode::Busy)?;
        let others = (0..u32::BITS).filter(|&bit| burst.burst != 1 << bit);
        let others = others.map(|bit| Burst { burst: burst.burst ^ 1 << bit, ..*burst });
        let mut requests: Vec<_> = others.map(Request::Burst).collect();
        if self.has_trap() {
            requests.push(Request::Expect(Expect { first: 0, bytes: &[] }));
        }
        if self.capabilities.table_banks < 2 {
            let span = Span { count: 0, ..FIRST_FACTOR };
            requests.push(Request::TableWrite(Entries { span, bytes: &[] }));
        }
        for request in requests {
            self.refused(Rule::UnderWay, &request, RefusalCode::Busy, 0)?;
        }
        Ok(())
    }

    /// A burst without an end, which is told to end.
    fn ended_early(&mut self) -> Result<(), End> {
        let Some(burst) = self.small_burst(Burst::ENDLESS) else { return Ok(()) };
        let burst = self.start(burst)?;
        self.look(&burst, 0, FEW, Awaited::under_way(FEW))?;
        self.replied(Rule::Ended, &Request::Burst(Burst { frames: 0, ..burst }), Vec::new())?;
        let ended = self.look(&burst, 0, FEW, Awaited::ended(FEW))?;
        let came = ended.records.len() as u32;
        self.must_tell(Rule::Records, &Told::ended(&burst, 0..came))?;
        // If there are more than fit a packet, it is not known where they end.
        if (came as usize) < Records::MOST { self.never_told(0..came) } else { Ok(()) }
    }

    /// Bursts that are cut by a RESET, each at another place, and after each of them rows and a burst that must be right.
    fn cut(&mut self) -> Result<(), End> {
        for bytes in BYTES_TO_CUT {
            let Some(burst) = self.small_burst(Burst::ENDLESS) else { return Ok(()) };
            self.run.bursts += 1;
            self.run.board.cut(&burst, bytes).during(CheckName::Rules)?;
            // If the request was lost, there is no burst.
            if let Some(came) = self.came_of(&burst)? {
                self.must_tell(Rule::Cut, &Told::ended(&burst, 0..came))?;
            }
            self.right_frames(&[super::rows::FRAME])?;
            self.right_burst(Rule::Cut, BurstMode::Fresh)?;
        }
        Ok(())
    }

    /// How many records there are of `burst`, which a RESET ended; none if the last burst is another. A link may have
    /// delivered the RESET before the burst, and then another one is needed.
    fn came_of(&mut self, burst: &Burst) -> Result<Option<u32>, End> {
        let records = match self.run.board.records(burst.burst, 0) {
            Ok(fetched) if fetched.state == BurstState::UnderWay => {
                self.drop_rows()?;
                self.run.board.records(burst.burst, 0)
            }
            records => records,
        };
        match records {
            Ok(fetched) => Ok(Some(fetched.records.len() as u32)),
            Err(BoardError::Unexpected { .. }) => Ok(None),
            Err(error) => Err(End::board(CheckName::Rules, &error)),
        }
    }

    /// A burst whose records must all be right.
    pub(super) fn right_burst(&mut self, rule: Rule, mode: BurstMode) -> Result<(), End> {
        let Some(burst) = self.small_burst(FEW) else { return Ok(()) };
        let burst = self.start(Burst { mode, ..burst })?;
        self.look(&burst, 0, FEW, Awaited::ended(FEW))?;
        self.must_tell(rule, &Told::ended(&burst, 0..FEW))
    }

    /// A burst that repeats a frame, whose rows must be in no counter.
    fn repeating(&mut self) -> Result<(), End> {
        self.drop_rows()?;
        self.clear()?;
        self.right_burst(Rule::Repeated, BurstMode::Repeating)?;
        let status = self.status()?;
        self.not_counted(None, &status)
    }
}
