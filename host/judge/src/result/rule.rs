//! The wire's rules that a run tries on purpose, and what a board says to it.

use serde::{Deserialize, Serialize};

/// A rule of protocol/WIRE.md or fpga/AT-SPEED.md that a run tries on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// A request that is cut short, or has a field without meaning, is refused.
    Payload,
    /// A kind that is no request is refused.
    Kind,
    /// Bytes behind a request's fields are skipped, and what means nothing in a row's place is not looked at.
    Skipped,
    /// A configuration out of range is refused, and the field named; the one in front stays as it was.
    Configuration,
    /// A span that is not in a table is refused.
    Span,
    /// A table's entry out of range is refused, and nothing of its packet is written.
    Entry,
    /// An entry is written where it belongs, and read from there.
    Address,
    /// A packet with a flipped bit, of another version or of another length than it names has no effect.
    Damage,
    /// A request is answered once.
    Once,
    /// A packet of another session is refused, and has no effect.
    Session,
    /// A board that another host holds refuses a greeting, and says for how long.
    Held,
    /// A greeting opens the next session, once, in which nothing is left of the one before but tables and configuration.
    NewSession,
    /// A RESET with level 1 closes the session, one with another level does not, and neither of the first two drops tables.
    Closed,
    /// A commit of tables that read back otherwise is refused.
    CommitCrc,
    /// A commit that names tables which are active or pending is answered, generation 0 is refused, and another is not both.
    Generation,
    /// A commit whose grid the board cannot have is refused, and one whose grid reads back otherwise.
    Shape,
    /// A commit takes effect with its frame, and not before.
    CommitFrame,
    /// What would touch tables of a pending commit is refused.
    Pending,
    /// RESET forgets a pending commit.
    Forgotten,
    /// A row out of place is refused.
    RowPlace,
    /// The window is as far ahead as a board has banks for rows.
    Window,
    /// A row beyond the window is refused.
    Credit,
    /// What must not be done with rows inside is refused.
    Inside,
    /// Rows come back in place whatever was refused between them.
    Rows,
    /// Samples that are greater than their depth are counted, and go in as they are.
    Samples,
    /// A row comes again as often as it is asked for, until it is acknowledged.
    Again,
    /// As many rows come as there are banks for them, and each is kept until it is acknowledged.
    Banks,
    /// Rows of the greatest width come back right.
    Wide,
    /// Rows have their number, however great.
    RowNumber,
    /// A burst that cannot be is refused.
    Burst,
    /// What must not be done while a burst is under way is refused.
    UnderWay,
    /// Records are kept until the host has them, and told again.
    Records,
    /// A burst ends where it is told to.
    Ended,
    /// A RESET ends a burst wherever it is.
    Cut,
    /// Every frame repeats the first where a burst is to.
    Repeated,
    /// The first row with another signature than expected is kept.
    Trap,
    /// A board without configuration or tables is not ready.
    NotReady,
    /// RESET leaves tables as they are at power-up.
    PowerUp,
}

/// What is said to a request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Answer {
    /// A refusal.
    Refused {
        /// The refusal's code (WIRE.md, section 6).
        code: u8,
        /// Its detail.
        detail: u16,
    },
    /// A reply.
    Replied {
        /// Its payload in hexadecimal, the first bytes.
        payload: String,
    },
    /// Credit for rows.
    Credit {
        /// How many beyond the row that is waited for.
        rows: u32,
    },
    /// A session.
    Session {
        /// Its number.
        number: u8,
    },
    /// It took what it was given.
    Taken {},
    /// How far a burst is.
    Burst {
        /// Whether it has ended.
        ended: bool,
        /// The records that are there.
        records: usize,
    },
    /// A row as it must be.
    Row {
        /// Its place in its frame.
        row: usize,
        /// The frame.
        frame: u16,
    },
    /// A row that is not as it must be, in samples, latency, pauses or generation.
    OtherRow {},
    /// An answer that came twice.
    Twice {},
    /// Nothing, although requests behind it are answered.
    Nothing {},
}

/// One of two `ROW_OUT` packets that have the same number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NumberedRow {
    /// The row of the second one.
    pub row: u16,
    /// Its frame.
    pub frame: u16,
    /// The number in both headers.
    pub number: u16,
}

/// A row that was sent again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RepeatedRow {
    /// The row.
    pub row: u16,
    /// Its frame.
    pub frame: u16,
    /// Its `repeats`, both times.
    pub repeats: u16,
}
