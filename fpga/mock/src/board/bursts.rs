//! Bursts as a host requests them.

use std::time::Duration;

use halfrow_protocol::message::{
    self, Burst, BurstMode, Expect, FrameRecord, Records, RefusalCode, Reply, Request, TrappedRow,
};
use halfrow_protocol::{Header, Kind, samples};

use super::{Board, Refused};
use crate::burst::Plan;
use crate::content::CONTENT;
use crate::options::{BurstBuild, Options};

/// Pixel clocks that a burst advances with every packet: a frame of 1920 x 1080. So no packet waits for its reply as long as a
/// whole burst takes, and of small frames there are many at once.
pub(super) const CLOCKS_A_PACKET: u64 = 2_400_000;

/// The capability that a build advertises for bursts.
pub(super) fn capability(options: &Options) -> Option<message::Bursts> {
    (options.bursts != BurstBuild::None).then_some(message::Bursts {
        content: CONTENT,
        records: options.records,
        least_frame_blanking: options.least_frame_blanking,
        trap: options.bursts == BurstBuild::Trapped,
    })
}

impl Board {
    /// Whether the build knows requests of this kind.
    pub(super) fn knows(&self, kind: u8) -> bool {
        match Kind::from_code(kind) {
            Some(Kind::Burst | Kind::Records) => self.options.bursts != BurstBuild::None,
            Some(Kind::Expect | Kind::Trap) => self.options.bursts == BurstBuild::Trapped,
            _ => true,
        }
    }

    /// Whether a row is inside the core. While a burst is under way, one counts as inside.
    pub(super) fn is_busy(&self) -> bool {
        !self.player.banks.is_idle() || self.bursts.is_under_way()
    }

    /// From now on lets a burst advance with every packet until it ends or waits for a record, like a board that is clocked
    /// until it comes to rest.
    pub fn go_on_to_rest(&mut self) {
        self.clocks_a_packet = u64::MAX;
    }

    /// Lets a burst advance.
    pub(super) fn go_on(&mut self) {
        self.bursts.run(&mut self.player, &mut self.tables, self.clocks_a_packet);
    }

    /// Ends a burst whose host has been silent for too long, and closes its session.
    pub(super) fn end_silence(&mut self, now: Duration) {
        if self.bursts.is_under_way() && self.session.is_silent(now) {
            self.bursts.abort();
            self.empty_core();
            self.session.close();
        }
    }

    /// Carries out one of the requests that concern bursts.
    pub(super) fn carry_out_at_speed(
        &mut self,
        header: &Header,
        request: &Request<'_>,
    ) -> Result<(), Refused> {
        let reply = match request {
            Request::Burst(burst) => {
                self.burst(burst)?;
                Reply::Burst
            }
            Request::Expect(expect) => {
                self.expect(expect)?;
                Reply::Expect
            }
            Request::Records { from } => return self.send_records(header, *from),
            _ => {
                self.send_trap(header);
                return Ok(());
            }
        };
        self.answer(header, self.session.number(), &reply);
        Ok(())
    }

    /// Starts a burst, or sets the number of frames of the last one.
    fn burst(&mut self, burst: &Burst) -> Result<(), Refused> {
        let &Burst { burst: name, frames, seed, first_frame, frame_blanking, mode } = burst;
        if name != 0 && name == self.bursts.name() {
            self.bursts.set_frames(frames);
            return Ok(());
        }
        if !self.configured || self.tables.generation() == 0 {
            return Err((RefusalCode::NotReady, 0));
        }
        let Options { least_frame_blanking, table_banks, bursts, .. } = self.options;
        let lacks_mode = match mode {
            BurstMode::Fresh | BurstMode::Repeating => false,
            BurstMode::Alternating => table_banks == 1,
            BurstMode::Trapped => bursts != BurstBuild::Trapped,
        };
        for (is_wrong, field) in [(name == 0, 0), (frame_blanking < least_frame_blanking, 4), (lacks_mode, 5)]
        {
            if is_wrong {
                return Err((RefusalCode::Range, field));
            }
        }
        if self.holds_rows() || self.tables.has_commit() {
            return Err((RefusalCode::Busy, 0));
        }
        self.bursts.start(Plan { burst: name, seed, first_frame, frame_blanking, mode }, frames);
        Ok(())
    }

    /// Answers with the records from the frame `from` on, as many as fit a packet.
    fn send_records(&mut self, header: &Header, from: u32) -> Result<(), Refused> {
        let (burst, state) = (self.bursts.name(), self.bursts.state());
        let records = self.bursts.records_from(from).ok_or((RefusalCode::Range, 0))?;
        let bytes: Vec<_> = records.take(Records::MOST).map(FrameRecord::to_bytes).collect();
        let reply = Reply::Records(Records { burst, from, state, bytes: &bytes });
        self.answer(header, self.session.number(), &reply);
        Ok(())
    }

    /// Takes the signatures that rows are expected to have.
    fn expect(&mut self, expect: &Expect<'_>) -> Result<(), Refused> {
        if self.bursts.is_under_way() {
            return Err((RefusalCode::Busy, 0));
        }
        if usize::from(expect.first) + expect.bytes.len() > self.options.max_height.into() {
            return Err((RefusalCode::Range, expect.first));
        }
        self.bursts.expect(expect.first, expect.signatures());
        Ok(())
    }

    /// Answers with the trapped row, if there is one.
    fn send_trap(&mut self, header: &Header) {
        let mut packed = Vec::new();
        let trapped = self.bursts.trapped().map(|trapped| {
            samples::pack(&trapped.samples, &mut packed);
            (trapped.frame, trapped.row, trapped.signature, trapped.samples.len())
        });
        let row = trapped.map(|(frame, row, signature, width)| TrappedRow {
            frame,
            row,
            width: u16::try_from(width).unwrap_or(u16::MAX),
            signature,
            packed: &packed,
        });
        self.answer(header, self.session.number(), &Reply::Trap(row));
    }
}
