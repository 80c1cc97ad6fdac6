//! Bursts: frames that the board makes and signs by itself (AT-SPEED.md).

use std::time::Duration;

use halfrow_protocol::message::{Burst, BurstState, Expect, FrameRecord, Reply, Request};
use halfrow_protocol::{Kind, samples};

use super::deadlines::Step;
use super::{Board, BoardError, Tally};

/// Records that a board had ready.
#[derive(Clone, Debug)]
pub(crate) struct Fetched {
    /// The state of the burst.
    pub(crate) state: BurstState,
    /// One for each frame, from the requested one on.
    pub(crate) records: Vec<FrameRecord>,
}

/// The row that a trap kept.
#[derive(Clone, Debug)]
pub(crate) struct Trapped {
    /// The row of the frame.
    pub(crate) row: usize,
    /// Its signature, as computed by the board.
    pub(crate) signature: u32,
    /// Its samples.
    pub(crate) samples: Vec<u16>,
}

impl Board {
    /// Starts `burst`, or changes the number of frames of the running burst with the same number.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn burst(&mut self, burst: &Burst) -> Result<(), BoardError> {
        let request = Request::Burst(*burst);
        self.conversation
            .request(&request, Step::Request, |reply| matches!(reply, Reply::Burst).then_some(()))
    }

    /// The records of `burst` that are ready, from the frame `from` on. The board may forget earlier ones.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer, or answers for another burst.
    pub(crate) fn records(&mut self, burst: u32, from: u32) -> Result<Fetched, BoardError> {
        self.conversation.request(&Request::Records { from }, Step::Request, |reply| match reply {
            Reply::Records(found) if (found.burst, found.from) == (burst, from) => {
                Some(Fetched { state: found.state, records: found.records().collect() })
            }
            _ => None,
        })
    }

    /// What `error` means if it came in place of the records of the last burst. If the link delivered a request twice, the late
    /// copy may have restarted an earlier burst.
    pub(crate) fn of_last_burst(&self, error: BoardError) -> BoardError {
        match error {
            BoardError::Unexpected { kind: Kind::Records } if self.repeated_changes() > 0 => {
                BoardError::OtherBurst { again: self.repeated_changes() }
            }
            other => other,
        }
    }

    /// Uploads the signatures that the rows of a repeating frame must have, from its row 0 on.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn expect(&mut self, signatures: &[u32]) -> Result<(), BoardError> {
        for (index, signatures) in signatures.chunks(Expect::MOST).enumerate() {
            let bytes: Vec<_> = signatures.iter().map(|signature| signature.to_le_bytes()).collect();
            let first = (index * Expect::MOST) as u16;
            let request = Request::Expect(Expect { first, bytes: &bytes });
            self.conversation
                .request(&request, Step::Request, |reply| matches!(reply, Reply::Expect).then_some(()))?;
        }
        Ok(())
    }

    /// The row that was trapped, if one was.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn trap(&mut self) -> Result<Option<Trapped>, BoardError> {
        self.conversation.request(&Request::Trap, Step::Request, |reply| match reply {
            Reply::Trap(kept) => Some(kept.map(|row| {
                let mut samples = vec![0; row.width.into()];
                samples::unpack(row.packed, &mut samples);
                Trapped { row: row.row.into(), signature: row.signature, samples }
            })),
            _ => None,
        })
    }

    /// Lets `time` pass on the link's clock, whatever comes meanwhile. Returns earlier if the link ends a wait early.
    ///
    /// # Errors
    /// [`BoardError`] when the link breaks, or the run was stopped.
    pub(crate) fn idle(&mut self, time: Duration) -> Result<(), BoardError> {
        if !self.moves_within(time)? {
            return Ok(());
        }
        let begun = self.now();
        while let Some(left) = time.checked_sub(self.conversation.since(begun)).filter(|left| !left.is_zero())
            && self.moves_within(left)?
        {}
        Ok(())
    }

    /// Waits until a byte has moved, at most for `time`. Returns whether one has.
    fn moves_within(&mut self, time: Duration) -> Result<bool, BoardError> {
        let moved = |Tally { bytes_in, bytes_out, .. }| (bytes_in, bytes_out);
        let before = moved(self.tally());
        let doing = || "waiting for frames that the board makes".to_owned();
        self.conversation.exchange(time, doing, |_| {})?;
        Ok(moved(self.tally()) != before)
    }
}
