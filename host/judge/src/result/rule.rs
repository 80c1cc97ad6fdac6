//! The rules of the wire that a run tries on purpose, and the board's answers.

use serde::{Deserialize, Serialize};

macro_rules! rules {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// A rule of protocol/WIRE.md or fpga/AT-SPEED.md that a run tries on purpose.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum Rule {
            $($(#[$doc])* $name,)*
        }

        impl Rule {
            /// All rules.
            pub const ALL: &[Self] = &[$(Self::$name,)*];
        }
    };
}

rules! {
    /// A request that is cut short or has a field without meaning is refused.
    Payload,
    /// A packet whose kind is not a request is refused.
    Kind,
    /// Bytes after a request's fields are skipped, and bits of a row's place that mean nothing are ignored.
    Skipped,
    /// A configuration out of range is refused, naming the field; the earlier configuration stays as it was.
    Configuration,
    /// A span outside a table is refused.
    Span,
    /// A table entry out of range is refused, and nothing of its packet is written.
    Entry,
    /// An entry is written where it belongs, whichever port the request names, and read from there.
    Address,
    /// A packet with a flipped bit, of another version or of another length than it names has no effect.
    Damage,
    /// A request is answered once.
    Once,
    /// An acknowledgement of rows is never answered.
    Unanswered,
    /// A packet of another session is refused, and has no effect.
    Session,
    /// A board that another host holds refuses HELLO, and says for how long, unless that host takes it over.
    Held,
    /// HELLO opens the next session, once; only tables and configuration are left of the one before.
    NewSession,
    /// A refusal carries the session of its request.
    RefusalSession,
    /// RESET closes the session with level 1 alone, and drops tables with level 2 alone.
    Closed,
    /// A commit with another CRC than the tables read back with is refused.
    CommitCrc,
    /// Which generations a commit may name: those of active and pending tables are answered, and 0 is refused.
    Generation,
    /// A commit is refused if the board cannot have its grid, or if its grid reads back otherwise.
    Shape,
    /// A commit with v = 0 is of row factors, whatever its k.
    NoGrid,
    /// A commit takes effect with its frame, not before: then the two banks change places.
    CommitFrame,
    /// What would change the tables of a pending commit is refused.
    Pending,
    /// RESET forgets a pending commit.
    Forgotten,
    /// A row out of place is refused.
    RowPlace,
    /// After a RESET the window is `next_row`, and as many rows more as the board has input banks.
    Window,
    /// A row beyond the window is refused.
    Credit,
    /// What must not be done while rows are inside is refused.
    Inside,
    /// Rows come back in place, whatever was refused between them.
    Rows,
    /// Samples above their depth are counted, and go in as they are.
    Samples,
    /// A row is sent again as often as it is asked for, until it is acknowledged.
    Again,
    /// As many rows come out as there are output banks, and each is kept until it is acknowledged.
    Banks,
    /// Rows of the greatest width come back right.
    Wide,
    /// Rows keep their number, however large it is.
    RowNumber,
    /// An impossible burst is refused.
    Burst,
    /// What must not be done while a burst is under way is refused.
    UnderWay,
    /// Records are kept until the host has them, and sent again when asked for.
    Records,
    /// A burst ends where it is told to.
    Ended,
    /// A RESET ends a burst wherever it is.
    Cut,
    /// Every frame repeats the first in a burst that asks for it.
    Repeated,
    /// The first row whose signature is not the expected one is kept.
    Trap,
    /// A board without configuration or tables is not ready.
    NotReady,
    /// RESET leaves tables as they are at power-up.
    PowerUp,
}

/// An answer to a request.
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
    /// A refusal that names another request than the one that it answers.
    RefusedOther {
        /// The kind that it names (WIRE.md, section 3).
        kind: u8,
        /// The refusal's code.
        code: u8,
        /// Its detail.
        detail: u16,
    },
    /// A reply.
    Replied {
        /// The first bytes of its payload, in hexadecimal; of one that begins as the right one does, what follows, and from which
        /// byte on; of an answer to HELLO that differs in them, build and serial number.
        payload: String,
    },
    /// Credit for rows.
    Credit {
        /// How many, from the row that the board waits for.
        rows: u32,
    },
    /// A session.
    Session {
        /// Its number.
        number: u8,
    },
    /// The board took what it was given.
    Taken {},
    /// The state of a burst.
    Burst {
        /// Whether it has ended.
        ended: bool,
        /// How many records there are.
        records: usize,
    },
    /// The right row.
    Row {
        /// Its number in its frame.
        row: usize,
        /// The frame's number.
        frame: u16,
    },
    /// A row with wrong samples, latency, pauses or generation, or another CRC of what entered the core.
    OtherRow {
        /// What is wrong with it; empty in reports of versions that did not tell.
        #[serde(default, skip_serializing_if = "<[_]>::is_empty")]
        differs: Box<[RowPart]>,
    },
    /// Records in which nothing but signatures is wrong.
    OtherSignatures {
        /// How many of the frames have another signature.
        frames: usize,
        /// The first of these.
        first: u32,
    },
    /// An answer that came twice.
    Twice {},
    /// No answer, although later requests are answered.
    Nothing {},
}

/// The rows that a rule was tried with, up to the one that differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RowsTried {
    /// Samples of each.
    pub width: usize,
    /// How many.
    pub height: usize,
}

/// Something that a board tells of a row, and that is not what it must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum RowPart {
    /// The corrected samples.
    Samples {
        /// How many differ.
        differing: usize,
        /// The first of them, by its column.
        column: usize,
        /// What it is.
        found: u16,
        /// What it must be.
        right: u16,
    },
    /// The latency of its first sample.
    FirstLatency {
        /// In pixel clocks.
        found: u16,
        /// The right one.
        right: u16,
    },
    /// The latency of its last sample.
    LastLatency {
        /// In pixel clocks.
        found: u16,
        /// The right one.
        right: u16,
    },
    /// The generation of its tables.
    Generation {
        /// What it names.
        found: u8,
        /// What was committed.
        right: u8,
    },
    /// How long the enable was off while it was played.
    Pauses {
        /// In board clocks.
        found: u16,
        /// By the seed of the gaps.
        right: u16,
    },
    /// The count of how often it was sent before.
    Repeats {
        /// What it is.
        found: u16,
        /// What it must be.
        right: u16,
    },
    /// The CRC of the samples that entered the core.
    Entered {
        /// What it is; none if it names none.
        found: Option<u32>,
        /// That of the samples that were sent.
        right: u32,
    },
}

/// A row of which a board did something wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlacedRow {
    /// The row.
    pub row: u16,
    /// Its frame.
    pub frame: u16,
    /// Whether its frame is one that the rules were tried with, which are numbered by themselves.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rules: bool,
}

/// Two `ROW_OUT` packets that have the same number, named by the second one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NumberedRow {
    /// The second one's row.
    pub row: u16,
    /// Its frame.
    pub frame: u16,
    /// The number in both headers.
    pub number: u16,
    /// Whether its frame is one that the rules were tried with, which are numbered by themselves.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rules: bool,
}

/// A row that was sent again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RepeatedRow {
    /// The row.
    pub row: u16,
    /// Its frame.
    pub frame: u16,
    /// Its `repeats`, the same both times.
    pub repeats: u16,
    /// Whether its frame is one that the rules were tried with, which are numbered by themselves.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rules: bool,
}

/// A row that alone goes missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MissingRow {
    /// The row.
    pub row: u16,
    /// Its frame.
    pub frame: u16,
    /// The row that the board says it waits for, if it has not taken all.
    pub waits_for: Option<u32>,
}
