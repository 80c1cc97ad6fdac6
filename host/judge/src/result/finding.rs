//! What a run found, as a code with parameters.

use serde::{Deserialize, Serialize};

use super::{
    Account, Answer, Asked, BoardKind, BrokenOff, BurstCount, ClockSeen, Corner, Counter, Defect, Doubt,
    EqualAtSpeed, FlippedBit, LateRows, MissingRow, NoBurst, NumberedRow, PlacedRow, Problem, RepeatedRow,
    Repetition, RowsTried, Rule, Shortfall,
};

/// What a check or a whole run came to. In JSON `{"code": …, "parameters": …}`; a [`Problem`] has its own code.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", content = "parameters", rename_all = "kebab-case")]
pub enum Finding {
    /// This computer reproduces the reference samples that this program was built with.
    GoldenSamplesFound {
        /// How many.
        samples: usize,
        /// The path of the model that found them.
        path: String,
    },
    /// The board told what it is, and it can be judged.
    BoardIdentified {
        /// Its name.
        name: String,
        /// The wire's version.
        wire: u8,
        /// The one of its datapaths by which it is judged.
        datapath: u16,
    },
    /// All bytes that were sent as echoes came back unchanged.
    EchoesReturned {
        /// Bytes in all.
        bytes: usize,
        /// In so many echoes.
        echoes: usize,
    },
    /// The tables were sent to the board, which took them.
    TablesUploaded {
        /// Row factors, or entries of a grid. Earlier reports say `rows`.
        #[serde(alias = "rows")]
        entries: usize,
        /// Nodes of the kernel.
        nodes: usize,
        /// As this generation.
        generation: u8,
    },
    /// Every read port of the tables returns what was uploaded.
    TablesReadBack {
        /// How many ports.
        ports: usize,
    },
    /// All samples that the board returned are equal to the reference.
    FramesEqual {
        /// Frames.
        frames: usize,
        /// Samples.
        samples: usize,
    },
    /// Every row takes exactly the latency that the board claims.
    LatencyRight {
        /// It, in pixel clocks.
        clocks: u32,
    },
    /// After the last frame, the tables are still what was uploaded.
    TablesUnchanged {},
    /// The run ended before a frame used the tables to be judged.
    TablesUnused {},
    /// The board's counters agree with what was sent and received.
    CountersRight {
        /// Rows each way.
        rows: usize,
        /// Damaged packets that the board counts although nothing had to be sent again.
        damaged_unseen: u32,
    },
    /// All frames that the board made on its own at the full pixel clock are equal to the reference.
    EqualAtSpeed(EqualAtSpeed),
    /// All frames that the board made on its own are right, but not at the full pixel clock: some had pauses.
    PausedAtSpeed {
        /// Frames.
        frames: u64,
        /// Those with pauses.
        paused: u64,
    },
    /// The pixel clock that the board makes is not the one that it names.
    ClockNotAsNamed {
        /// The one that it names, in hertz.
        clock_hz: u32,
        /// What was seen of it.
        seen: ClockSeen,
    },
    /// The board made no frames on its own, so nothing was tested at the full pixel clock.
    NothingAtSpeed {
        /// Why.
        reason: NoBurst,
    },
    /// The board follows the rules of the wire protocol: it refuses, keeps and ends what it must.
    RulesKept {
        /// Requests that it answered as it must.
        requests: usize,
    },
    /// The run left out the test of the protocol rules.
    RulesLeftOut {},
    /// The run ended before this check.
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
    /// The board claims a capability that no board can have.
    CapabilityImpossible {
        /// The capability, by its name in `protocol/WIRE.md`.
        capability: String,
        /// What the board says.
        value: u16,
        /// What is legal, as the end of a sentence.
        legal: String,
    },
    /// The board returned other bytes than it was sent, with a CRC that it had computed over them itself.
    EchoWrong {},
    /// A table does not read back as it was uploaded.
    TableReadsWrong {
        /// What is wrong with it.
        defect: Box<Defect>,
        /// How well that explains what was read.
        account: Account,
    },
    /// The board gives a wrong CRC of a table, although all entries read back right.
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
    /// Samples that the board returned differ from the reference.
    SamplesDiffer {
        /// How many.
        differences: usize,
        /// Of so many.
        samples: usize,
        /// In so many frames.
        differing_frames: usize,
        /// Of so many.
        frames: usize,
        /// The rows of the rules that they are in; none if they are in streamed frames.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        tried: Option<Box<RowsTried>>,
        /// The likeliest cause.
        suspect: Option<Box<Defect>>,
        /// Other causes that explain all of it as well.
        #[serde(default)]
        others: usize,
        /// What the cause leaves unexplained, if anything.
        #[serde(default)]
        short: Option<Shortfall>,
    },
    /// The board's own CRC shows that rows were changed before they entered the core.
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
    /// The board's CRC of the samples that entered the core is wrong, even for rows that came out right.
    EntryMiscounted {
        /// How many.
        rows: usize,
        /// The first of them.
        row: usize,
        /// Its frame.
        frame: u16,
    },
    /// Frames that the board made on its own at the full pixel clock differ from the reference.
    DiffersAtSpeed {
        /// How many.
        wrong: u64,
        /// Of so many.
        frames: u64,
        /// The first of them, counted from the first of the burst.
        first: u64,
        /// What making it again has shown.
        repetition: Repetition,
        /// The likeliest cause.
        suspect: Option<Box<Defect>>,
        /// Other causes that explain all of it as well.
        #[serde(default)]
        others: usize,
        /// What the cause leaves unexplained, if anything.
        #[serde(default)]
        short: Option<Box<Shortfall>>,
    },
    /// A frame that the board made on its own has the right samples, but the board counted something wrongly.
    MiscountedAtSpeed {
        /// The frame, counted from the first of the burst.
        frame: u64,
        /// What.
        count: BurstCount,
        /// What the board counts.
        counted: u32,
        /// What it should.
        right: u32,
    },
    /// A frame that the board made on its own was wrong with settings that no streamed frame has.
    InCorner {
        /// The settings.
        corner: Corner,
        /// What was found.
        found: Box<Finding>,
    },
    /// The board stopped sending frames in the middle of a burst.
    BurstStalled {
        /// The frame that was waited for, counted from the first of the burst.
        frame: u32,
        /// Frames of the burst.
        frames: u32,
        /// How long it was waited for, in seconds.
        seconds: f64,
    },
    /// The board ended a burst before its last frame.
    BurstEndedEarly {
        /// Frames that came.
        came: u32,
        /// Frames of the burst.
        frames: u32,
    },
    /// Rows take another latency than the board claims.
    LatencyWrong(LateRows),
    /// One of the board's counters is wrong.
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
    /// For one row, the board counts another length of pauses than it was told to make.
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
    /// The least and greatest latency that the board counts are not those of its rows.
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
    /// A row came back with the place of a row that was never sent.
    RowMisplaced(PlacedRow),
    /// Twice, a row went into the board and never came out.
    RowSwallowed {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
        /// The row that was lost when the frame was played again.
        again: u16,
    },
    /// The board sent a row twice, and the copies differ in more than the count of repeats.
    RowCopyDiffers(PlacedRow),
    /// The board returned a row that it was never given.
    RowNeverSent {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
        /// The row's number in the session.
        sequence: u32,
        /// Whether its frame is one that the rules were tried with, which are numbered by themselves.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        rules: bool,
    },
    /// The board answered a request otherwise than the rules of the wire protocol demand.
    RuleBroken {
        /// The rule.
        rule: Rule,
        /// The request.
        request: String,
        /// What must be said to it.
        right: Answer,
        /// What was said.
        found: Answer,
        /// The request as it was sent; none in reports of versions that did not tell, and where no single packet broke the rule.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        asked: Option<Box<Asked>>,
    },
    /// Two different `ROW_OUT` packets have the same number.
    RowNumberedTwice(NumberedRow),
    /// The board sent a row again without counting up the number of repeats in it.
    RowRepeatsStand(RepeatedRow),
    /// A row, which is named, left the board after a row that should follow it.
    RowOutOfOrder(PlacedRow),
    /// A row did not come back, but the whole frame did when it was sent again.
    RowLostOnce {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
    },
    /// A row did not come back, and other packets were lost or late as well.
    RowLostAmongOthers {
        /// The row.
        row: u16,
        /// Its frame.
        frame: u16,
    },
    /// A row did not come back however often its frame was sent again, and nothing else was lost.
    RowLostEachTime(MissingRow),
    /// A row did not come back, however often it was asked for. It was no row of the frames to be judged, so that its frame was not
    /// sent again.
    RowStayedAway(PlacedRow),
    /// Something was wrong, but was right in another session, so the link may have caused it.
    RightInAnotherSession {
        /// What was wrong.
        found: Box<Finding>,
        /// Why it may come from the link.
        doubt: Doubt,
    },
    /// Something was wrong in every session, but the link may have caused it.
    WrongOverDoubtfulLink {
        /// What is wrong.
        found: Box<Finding>,
        /// Why it may come from the link.
        doubt: Doubt,
    },
    /// Something was wrong that the link may have caused, and the second look in another session broke off.
    SecondLookBrokenOff(Box<BrokenOff>),
    /// No frame came back, so nothing was judged.
    NothingJudged {},
    /// The board computes a datapath that this program does not know.
    DatapathUnknown {
        /// The board's.
        datapath: u16,
        /// The one that every board must compute, whatever further one it has.
        known: u16,
    },
    /// The plan or call requires hardware, and this is a simulated board or a recording.
    HardwareRequired {
        /// What it is.
        board: BoardKind,
    },
    /// The board that came back is not the one that went away.
    BoardExchanged {},
    /// The board went away during the run and did not come back.
    BoardStayedAway {
        /// How it went.
        reason: Box<Problem>,
        /// How long it was waited for, in seconds.
        seconds: f64,
    },
    /// The link, the station or the call failed, and the board was not judged.
    #[serde(untagged)]
    Problem(Box<Problem>),
}
