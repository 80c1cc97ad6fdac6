//! Rows whose expected signatures are wrong on purpose, so that the board's trap keeps them.

use halfrow_model::{Content, Frame, row_signature};
use halfrow_protocol::Kind;
use halfrow_protocol::message::{Burst, BurstMode, Expect, RefusalCode, Request};
use halfrow_protocol::samples::pack;
use rand_pcg::Pcg64Mcg;

use super::bursts::{Awaited, PATIENCE};
use super::compared::Compared;
use super::rows::{FRAME, GENERATION};
use super::small::TALL as TALL_ROWS;
use super::{Rules, longer, rows_of_rules};
use crate::board::Capabilities;
use crate::reference::correct;
use crate::result::{CheckName, Rule};
use crate::run::at_speed::known_bursts;
use crate::run::drawn::drawn_factors;
use crate::run::findings::{During, End};
use crate::run::plan::parts::of_height;
use crate::run::plan::variations::Build;
use crate::tables::Generation;

/// The reply to TRAP when no row was kept.
pub(super) const NOTHING_KEPT: [u8; 1] = [0];
/// The most rows of the tallest frame: its tables and signatures take 30 ms at 3 Mbaud.
const MOST_ROWS: usize = 1023;
/// The generation with which it is made: none of the others that are active in the rules.
const TALL: u8 = 0xc3;

/// Rows of the tallest frame whose height has every bit set.
fn rows_of_tallest(capabilities: &Capabilities) -> usize {
    let most = usize::from(capabilities.max_height).min(MOST_ROWS);
    (1 << (most + 1).ilog2()) - 1
}

/// Rows of the tallest frame that a board makes for the rules.
pub(in crate::run) fn tallest_of_rules(capabilities: &Capabilities, has_trap: bool) -> usize {
    if has_trap {
        rows_of_tallest(capabilities).max(TALL_ROWS.min(capabilities.max_height.into()))
    } else {
        rows_of_rules(capabilities).0
    }
}

impl Rules<'_, '_> {
    /// Expects each bit of a signature wrong once, in one row or another.
    pub(super) fn trap(&mut self) -> Result<(), End> {
        if !self.has_trap() {
            return Ok(());
        }
        self.configure(self.small.tall())?;
        let past = Expect { first: self.capabilities.max_height - 1, bytes: &[[0; Expect::BYTES]; 2] };
        self.refused(Rule::Trap, &Request::Expect(past), RefusalCode::Range, past.first)?;
        let made = self.small.made(0, self.height, GENERATION);
        let Some(frame) = self.trapped_frame(&made) else { return Ok(()) };
        let rows: Vec<_> = (0..frame.height()).map(|row| frame.row(row)).collect();
        let signatures: Vec<_> = rows.iter().map(|row| row_signature(row)).collect();
        self.expect_apart(&signatures)?;
        self.trapping()?;
        self.replied(Rule::Trap, &Request::Trap, NOTHING_KEPT.to_vec())?;
        self.bytes_replied(Rule::Skipped, Kind::Trap, &longer(&Request::Trap), NOTHING_KEPT.to_vec())?;
        for bit in 0..u32::BITS {
            let row = bit as usize % rows.len();
            let mut expected = signatures.clone();
            expected[row] ^= 1 << bit;
            // Of two wrong rows only the first is kept.
            if let Some(last) = expected.last_mut().filter(|_| row + 1 < rows.len()) {
                *last = !*last;
            }
            self.run.board.expect(&expected).during(CheckName::Rules)?;
            self.trapping()?;
            self.kept(row, rows[row])?;
        }
        let last = (u32::BITS - 1) as usize % rows.len();
        // A burst that does not set the trap leaves what is in it.
        if let Some(burst) = self.small_burst(2) {
            let burst = self.start(burst)?;
            self.look(&burst, 0, burst.frames, Awaited::ended(burst.frames))?;
            self.kept(last, rows[last])?;
        }
        self.drop_rows()?;
        self.replied(Rule::Trap, &Request::Trap, NOTHING_KEPT.to_vec())?;
        // Expected signatures stay, whatever happens.
        self.trapping()?;
        self.kept(last, rows[last])?;
        self.tall_trapped()
    }

    fn trap_burst(&self) -> Option<Burst> {
        self.small_burst(2).map(|burst| Burst { mode: BurstMode::Trapped, ..burst })
    }

    /// The frame that is repeated, as `made` must correct it.
    fn trapped_frame(&self, made: &Generation) -> Option<Frame> {
        let burst = self.trap_burst()?;
        let Generation { tables, kernel, .. } = made;
        let content = Content { seed: burst.seed, frame: burst.first_frame };
        correct(tables, kernel, &content.frame(tables.geometry(), self.small.phase)).ok()
    }

    /// With `made` active, expects a wrong signature for the last row of a frame, which must be kept.
    pub(super) fn last_row_trapped(&mut self, made: &Generation) -> Result<(), End> {
        let bursts = known_bursts(&self.capabilities).is_ok() && self.has_trap();
        let Some(frame) = self.trapped_frame(made).filter(|_| bursts) else { return Ok(()) };
        let mut expected: Vec<_> = frame.rows().map(row_signature).collect();
        let Some(last) = expected.last_mut() else { return Ok(()) };
        *last = !*last;
        let row = frame.height() - 1;
        self.run.board.expect(&expected).during(CheckName::Rules)?;
        self.trapping()?;
        self.kept(row, frame.row(row))
    }

    /// On a board with a trap, expects of the rows from `row` on what they have only by a rare chance, and what is right of
    /// those before. Returns the frame that is repeated.
    pub(super) fn expect_others_from(&mut self, row: usize) -> Result<Option<Frame>, End> {
        let made = self.small.made(0, self.height, GENERATION);
        let Some(frame) = self.trapped_frame(&made).filter(|_| self.has_trap()) else { return Ok(None) };
        let mut expected: Vec<_> = frame.rows().map(row_signature).collect();
        expected.iter_mut().skip(row).for_each(|signature| *signature = !0);
        self.run.board.expect(&expected).during(CheckName::Rules)?;
        Ok(Some(frame))
    }

    /// The same in a frame whose height has every bit set and is at most the greatest, unless two such frames take the
    /// board seconds.
    fn tall_trapped(&mut self) -> Result<(), End> {
        let rows = rows_of_tallest(&self.capabilities);
        let own = of_height(&self.small.geometry, rows);
        let mut draws = Pcg64Mcg::new(u128::from(self.small.seed) | 1 << 67);
        let Some(tables) = drawn_factors(own, Build::of(&self.capabilities).ring, &mut draws) else {
            return Ok(());
        };
        let made = Generation { number: TALL, tables, kernel: self.small.tables[0].kernel.clone() };
        self.configure(rows)?;
        if self.time_of(2) > PATIENCE {
            return Ok(());
        }
        self.run.board.upload(&made.tables, &made.kernel).during(CheckName::Rules)?;
        let Some(first_row) = made.upper(1) else { return Ok(()) };
        self.configure(1)?;
        let Generation { number, tables, kernel } = &first_row;
        self.run.board.commit(tables, kernel, FRAME, *number).during(CheckName::Rules)?;
        self.frames(Rule::Rows, Compared::default().with(&self.small, [FRAME], &first_row))?;
        self.configure(rows)?;
        self.last_row_trapped(&made)
    }

    /// Gives the board these signatures, those after the first row in a request of their own.
    fn expect_apart(&mut self, signatures: &[u32]) -> Result<(), End> {
        let bytes: Vec<_> = signatures.iter().map(|signature| signature.to_le_bytes()).collect();
        let (head, rest) = bytes.split_at(1);
        for (first, bytes) in [(0, head), (1, rest)] {
            let expect = Request::Expect(Expect { first, bytes });
            self.bytes_replied(Rule::Trap, Kind::Expect, &longer(&expect), Vec::new())?;
        }
        Ok(())
    }

    /// Has the board repeat a frame, with the trap set for the signatures that it was given.
    pub(super) fn trapping(&mut self) -> Result<(), End> {
        let Some(burst) = self.trap_burst() else { return Ok(()) };
        let burst = self.start(burst)?;
        self.look(&burst, 0, burst.frames, Awaited::ended(burst.frames)).map(drop)
    }

    /// Row `row` of the first frame must have been kept, with `samples`.
    pub(super) fn kept(&mut self, row: usize, samples: &[u16]) -> Result<(), End> {
        let mut kept = vec![1, 0, 0, 0, 0];
        kept.extend((row as u16).to_le_bytes());
        kept.extend((samples.len() as u16).to_le_bytes());
        kept.extend(row_signature(samples).to_le_bytes());
        pack(samples, &mut kept);
        self.replied(Rule::Trap, &Request::Trap, kept)
    }
}
