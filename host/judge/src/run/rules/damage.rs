//! Packets that must have no effect, since the link has damaged them.

use halfrow_protocol::message::{Entries, Request};

use super::{FIRST_FACTOR, Rules, of_board, payload};
use crate::board::Said;
use crate::result::Rule;
use crate::run::findings::End;

/// A row factor that nothing else writes.
const UNWRITTEN: u32 = 0x1a5;

impl Rules<'_, '_> {
    /// A row factor stays as it was written, though packets that would write another one came with a flipped bit.
    pub(super) fn damage(&mut self) -> Result<(), End> {
        let [kept, other] = [1, UNWRITTEN].map(u32::to_le_bytes);
        let write = |bytes| Request::TableWrite(Entries { span: FIRST_FACTOR, bytes });
        self.replied(Rule::Damage, &write(&kept), Vec::new())?;
        self.run.board.give_damaged(&write(&other));
        let read = Request::TableRead(FIRST_FACTOR);
        let said = self.run.board.ask(read.kind(), &payload(&read));
        if matches!(&said, Ok(Said::Replied(entry)) if entry.ends_with(&other)) {
            // Whatever else a link has done, only a damaged packet can have written this.
            self.run.board.excuse_repeats().map_err(of_board)?;
        }
        self.judge(Rule::Damage, read.kind(), said, &Said::Replied(payload(&write(&kept))))
    }
}
