//! What a run found, as a code with parameters.

use serde::{Deserialize, Serialize};

use super::{
    Account, Answer, BoardKind, BrokenOff, BurstCount, ClockSeen, Corner, Counter, Defect, Doubt,
    EqualAtSpeed, FlippedBit, LateRows, NoBurst, NumberedRow, Problem, RepeatedRow, Repetition, Rule,
};

/// What a check or a whole run came to. In JSON `{"code": …, "parameters": …}`; a [`Problem`] has its own code.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", content = "parameters", rename_all = "kebab-case")]
pub enum Finding {
    /// This computer finds the golden samples.
    GoldenSamplesFound {
        /// How many.
        samples: usize,
        /// The path of the model that found them.
        path: String,
    },
    /// The board is one that can be judged.
    BoardIdentified {
        /// Its name.
        name: String,
        /// The wire's version.
        wire: u8,
        /// The one of its datapaths by which it is judged.
        datapath: u16,
    },
    /// What was echoed came back as it went.
    EchoesReturned {
        /// Bytes in all.
        bytes: usize,
        /// In so many echoes.
        echoes: usize,
    },
    /// Tables were uploaded.
    TablesUploaded {
        /// Row factors, or entries of a grid. Earlier reports say `rows`.
        #[serde(alias = "rows")]
        entries: usize,
        /// Nodes of the kernel.
        nodes: usize,
        /// As this generation.
        generation: u8,
    },
    /// The datapath's ports read what was uploaded.
    TablesReadBack {
        /// How many ports.
        ports: usize,
    },
    /// All samples are the reference's.
    FramesEqual {
        /// Frames.
        frames: usize,
        /// Samples.
        samples: usize,
    },
    /// Every row takes the claimed latency.
    LatencyRight {
        /// It, in pixel clocks.
        clocks: u32,
    },
    /// The tables are still what was uploaded.
    TablesUnchanged {},
    /// No frame came to use the judged tables.
    TablesUnused {},
    /// The board counts what went through it.
    CountersRight {
        /// Rows each way.
        rows: usize,
        /// Damaged packets that the board counts although nothing had to be sent again.
        damaged_unseen: u32,
    },
    /// Frames that the board made on its own are the reference's, at the full pixel clock.
    EqualAtSpeed(EqualAtSpeed),
    /// They are the reference's, but the enable was off in some.
    PausedAtSpeed {
        /// Frames.
        frames: u32,
        /// Those with pauses.
        paused: u32,
    },
    /// The pixel clock that the board makes is not the one that it names.
    ClockNotAsNamed {
        /// The one that it names, in hertz.
        clock_hz: u32,
        /// What was seen of it.
        seen: ClockSeen,
    },
    /// The board made no frames on its own.
    NothingAtSpeed {
        /// Why.
        reason: NoBurst,
    },
    /// The board refuses, keeps and ends what it must.
    RulesKept {
        /// Requests that it answered as it must.
        requests: usize,
    },
    /// Whether it does was left out of the run.
    RulesLeftOut {},
    /// The run ended before.
    NotReached {},
    /// Everything was judged, and all of it is right.
    AllRight {
        /// Frames.
        frames: usize,
        /// Samples.
        samples: usize,
        /// The latency of every row, in pixel clocks.
        latency: u32,
        /// What stood behind the target.
        board: BoardKind,
        /// How often the board went away and came back.
        reconnections: usize,
    },
    /// The board says of itself what no board can be.
    CapabilityImpossible {
        /// The capability, by its name in `protocol/WIRE.md`.
        capability: String,
        /// What the board says.
        value: u16,
        /// What is legal, as the end of a sentence.
        legal: String,
    },
    /// Echoed bytes came back as others, under a CRC of the board's.
    EchoWrong {},
    /// A table does not read back as it was uploaded.
    TableReadsWrong {
        /// What is wrong with it.
        defect: Box<Defect>,
        /// How well that explains what was read.
        account: Account,
    },
    /// A table's CRC is wrong although all entries are right.
    TableCrcWrong {},
    /// The board finds another CRC when it commits tables that read back right.
    CommitCrcWrong {},
    /// A table is no longer what it was when it was committed.
    TablesChanged {
        /// How.
        found: Box<Finding>,
    },
    /// A row names other tables than were committed for it.
    GenerationWrong {
        /// The row.
        row: usize,
        /// Its frame.
        frame: u16,
        /// The generation that it names.
        named: u8,
        /// The one that was committed.
        committed: u8,
    },
    /// Samples are not the reference's.
    SamplesDiffer {
        /// How many.
        differences: usize,
        /// Of so many.
        samples: usize,
        /// In so many frames.
        differing_frames: usize,
        /// Of so many.
        frames: usize,
        /// The likeliest cause.
        suspect: Option<Box<Defect>>,
        /// Other causes that explain all of it as well.
        #[serde(default)]
        others: usize,
    },
    /// By the board's own CRC, rows were changed before they entered the core.
    RowsEnteredChanged {
        /// How many.
        rows: usize,
        /// The first of them.
        row: usize,
        /// Its frame.
        frame: u16,
        /// The one bit that is flipped in the first of them, if the CRC tells one.
        flipped: Option<FlippedBit>,
    },
    /// The board's CRC of the samples that entered is wrong, also for rows in which every output is right.
    EntryMiscounted {
        /// How many.
        rows: usize,
        /// The first of them.
        row: usize,
        /// Its frame.
        frame: u16,
    },
    /// Frames that the board made on its own have other signatures than the reference's.
    DiffersAtSpeed {
        /// How many.
        wrong: u32,
        /// Of so many.
        frames: u32,
        /// The first of them, counted from the first of the burst.
        first: u32,
        /// What making it again has shown.
        repetition: Repetition,
        /// The likeliest cause.
        suspect: Option<Box<Defect>>,
        /// Other causes that explain all of it as well.
        #[serde(default)]
        others: usize,
    },
    /// A frame that the board made on its own has the right signature, and something else that it counts is wrong.
    MiscountedAtSpeed {
        /// The frame, counted from the first of the burst.
        frame: u32,
        /// What.
        count: BurstCount,
        /// What the board counts.
        counted: u32,
        /// What it should.
        right: u32,
    },
    /// What was found of frames that the board made on its own with settings that no plan has.
    InCorner {
        /// The settings.
        corner: Corner,
        /// What was found.
        found: Box<Finding>,
    },
    /// No frame followed in a burst.
    BurstStalled {
        /// The frame that was waited for, counted from the first of the burst.
        frame: u32,
        /// Frames of the burst.
        frames: u32,
        /// How long it was waited for, in seconds.
        seconds: f64,
    },
    /// A burst ended before its last frame.
    BurstEndedEarly {
        /// Frames that came.
        came: u32,
        /// Frames of the burst.
        frames: u32,
    },
    /// Rows take another latency than the board claims.
    LatencyWrong(LateRows),
    /// A counter of the board's is not what it should be.
    CounterWrong {
        /// Which.
        counter: Counter,
        /// What the board counts.
        counted: u32,
        /// What it should; of packets at least, of rows numbered at most.
        right: u32,
        /// The rule that the run tried when the board counted so; none if it tried no single one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rule: Option<Rule>,
    },
    /// The board counts pauses for a row that are not the gaps of its seed.
    GapsMiscounted {
        /// The row, the first of them.
        row: usize,
        /// Its frame.
        frame: u16,
        /// Board clocks by the board's count.
        counted: u16,
        /// And by the seed.
        expected: u16,
    },
    /// The board's extremes of latency are not those of its rows.
    LatencyMiscounted {
        /// The least that a row names.
        least: u32,
        /// The most.
        most: u32,
        /// The least by the counters.
        counted_least: u32,
        /// The most by them.
        counted_most: u32,
    },
    /// A row came back under a place that was never sent.
    RowMisplaced {
        /// The row that it names.
        row: u16,
        /// The frame.
        frame: u16,
    },
    /// A row went into the board and never came out, twice.
    RowSwallowed {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
        /// The row that was lost when the frame was played again.
        again: u16,
    },
    /// A row came twice, and not the same both times.
    RowCopyDiffers {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
    },
    /// A row came that the board was never given.
    RowNeverSent {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
        /// The row's number in the session.
        sequence: u32,
    },
    /// A request was not answered as the wire's rules have it.
    RuleBroken {
        /// The rule.
        rule: Rule,
        /// The request.
        request: String,
        /// What must be said to it.
        right: Answer,
        /// What was said.
        found: Answer,
    },
    /// Two different `ROW_OUT` packets have the same number.
    RowNumberedTwice(NumberedRow),
    /// A row was sent twice, and names the same number of repeats both times.
    RowRepeatsStand(RepeatedRow),
    /// A row left the board after a later one.
    RowOutOfOrder {
        /// The row that came too late.
        row: u16,
        /// Its frame.
        frame: u16,
    },
    /// A row did not come back, and the frame did when it was played again.
    RowLostOnce {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
    },
    /// A row did not come back, and neither did other packets.
    RowLostAmongOthers {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
    },
    /// What was wrong may come from the link, and was right in another session.
    RightInAnotherSession {
        /// What was wrong.
        found: Box<Finding>,
        /// Why it may come from the link.
        doubt: Doubt,
    },
    /// What is wrong may come from the link, in every session.
    WrongOverDoubtfulLink {
        /// What is wrong.
        found: Box<Finding>,
        /// Why it may come from the link.
        doubt: Doubt,
    },
    /// What was wrong may come from the link, and the look in another session broke off.
    SecondLookBrokenOff(Box<BrokenOff>),
    /// No frame came back.
    NothingJudged {},
    /// The board computes another datapath than this program judges.
    DatapathUnknown {
        /// The board's.
        datapath: u16,
        /// The one that is judged.
        known: u16,
    },
    /// Hardware is required, and this is none.
    HardwareRequired {
        /// What it is.
        board: BoardKind,
    },
    /// The board that came back is not the one that went away.
    BoardExchanged {},
    /// The board went away and did not come back.
    BoardStayedAway {
        /// How it went.
        reason: Box<Problem>,
        /// How long it was waited for, in seconds.
        seconds: f64,
    },
    /// An error of the station, the link or the call.
    #[serde(untagged)]
    Problem(Box<Problem>),
}
