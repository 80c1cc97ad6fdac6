//! Faults by name: each breaks one part of the board on purpose.

mod conduct;
mod defects;
mod effect;
mod misread;
mod part;

use halfrow_pipe::{Fault, FaultInfo, Parameter, Place, Range, ValueError, Values};

use crate::core::{NODES, Weight};

pub use conduct::Conduct;
pub(crate) use defects::Defects;
pub use effect::Streamed;
pub use misread::Misread;
pub use part::BoardFault;

/// The default is a row that small frames have too.
const ROW: Parameter = Parameter::new("row", Range::Whole(0, 2047), Some("3"), "the row");
const ENTRY: Parameter =
    Parameter::new("row", Range::Whole(0, 65534), Some("3"), "the row, or the number of a grid's entry");
const FACTOR_BIT: Parameter = Parameter::new("bit", Range::Whole(0, 24), Some("18"), "the bit of the entry");
const HIDDEN: Parameter = Parameter::new(
    "hidden",
    TRUTHS,
    Some("false"),
    "whether only the datapath sees it and reading back shows the right value",
);
const TRUTHS: Range = Range::Words(&["false", "true"]);
const LEVELS: Range = Range::Words(&["0", "1"]);
const OUTPUT_BIT: Parameter = Parameter::new("bit", Range::Whole(0, 11), Some("5"), "the bit");
const TAP: Range = Range::Whole(0, 6);

/// The faults of the board.
pub const FAULTS: &[Fault<BoardFault>] = &[
    fault(
        "stuck-data",
        "a data line of the line memory is stuck",
        &[
            Parameter::new("bit", Range::Whole(0, 11), Some("5"), "the line"),
            Parameter::new("value", LEVELS, Some("1"), "the level that it is stuck at"),
        ],
        |values| {
            Ok(BoardFault::StuckData {
                bit: values.whole("bit")?,
                value: values.choice("value", &[false, true])?,
            })
        },
    ),
    fault(
        "stuck-address",
        "an address line of the line memory is stuck",
        &[
            Parameter::new("bit", Range::Whole(0, 13), Some("3"), "the line"),
            Parameter::new("value", LEVELS, Some("0"), "the level that it is stuck at"),
        ],
        |values| {
            Ok(BoardFault::StuckAddress {
                bit: values.whole("bit")?,
                value: values.choice("value", &[false, true])?,
            })
        },
    ),
    fault(
        "row-factor",
        "a bit of a row's or a grid's table entry is flipped",
        &[ENTRY, FACTOR_BIT, HIDDEN],
        |values| {
            Ok(BoardFault::RowFactor {
                row: values.whole("row")?,
                bit: values.whole("bit")?,
                hidden: values.choice("hidden", &[false, true])?,
            })
        },
    ),
    fault(
        "kernel-word",
        "a bit of a kernel word is flipped",
        &[
            Parameter::new("node", Range::Whole(0, NODES as i64 - 1), Some("16"), "the word's node"),
            Parameter::new("weight", Range::Words(&Weight::NAMES), Some("g4"), "the word's weight"),
            Parameter::new("bit", Range::Whole(0, 15), Some("12"), "the bit of the word"),
            HIDDEN,
        ],
        |values| {
            Ok(BoardFault::KernelWord {
                node: values.whole("node")?,
                weight: values.choice("weight", &Weight::ALL)?,
                bit: values.whole("bit")?,
                hidden: values.choice("hidden", &[false, true])?,
            })
        },
    ),
    fault(
        "tap-offset",
        "all taps come from beside their columns",
        &[Parameter::new("columns", Range::Whole(-3, 3), Some("1"), "how many columns to the right")],
        |values| Ok(BoardFault::TapOffset { columns: values.whole("columns")? }),
    ),
    fault("no-rounding", "the weighted sum is truncated instead of rounded", &[], |_| {
        Ok(BoardFault::NoRounding)
    }),
    fault(
        "dead-tap",
        "a tap carries zero, or another tap's sample",
        &[
            Parameter::new("tap", TAP, Some("4"), "the tap, from G0 to G6"),
            Parameter::new("reads", TAP, None, "the tap whose sample it carries; without it, zero"),
        ],
        |values| {
            let reads = values.is_given("reads").then(|| values.whole("reads")).transpose()?;
            Ok(BoardFault::DeadTap { tap: values.whole("tap")?, reads })
        },
    ),
    fault("late", "samples leave one pixel clock later than claimed", &[], |_| Ok(BoardFault::Late)),
    fault("wrong-latency-claim", "the claimed latency is one pixel clock too long", &[], |_| {
        Ok(BoardFault::WrongLatencyClaim)
    }),
    fault("centre-ignored", "the optical centre is the middle of the row, whatever is set", &[], |_| {
        Ok(BoardFault::CentreIgnored)
    }),
    fault(
        "stuck-centre",
        "a bit of the optical centre's setting is stuck",
        &[
            Parameter::new("bit", Range::Whole(0, 12), Some("3"), "the bit of twice the column"),
            Parameter::new("value", LEVELS, Some("0"), "the level that it is stuck at"),
        ],
        |values| {
            Ok(BoardFault::StuckCentre {
                bit: values.whole("bit")?,
                value: values.choice("value", &[false, true])?,
            })
        },
    ),
    fault("lost-row", "a row goes in and never comes out", &[ROW], |values| {
        Ok(BoardFault::LostRow { row: values.whole("row")? })
    }),
    fault(
        "stale-table",
        "after a commit, rows are made with the tables before it and say so, given two table banks",
        &[],
        |_| Ok(BoardFault::StaleTable { hidden: false }),
    ),
    fault(
        "stale-table-hidden",
        "after a commit, rows are made with the tables before it and deny it, given two table banks",
        &[],
        |_| Ok(BoardFault::StaleTable { hidden: true }),
    ),
    fault(
        "drifting-table",
        "a bit of a table entry flips some rows after a commit",
        &[
            Parameter::new(
                "after",
                Range::Whole(0, u32::MAX as i64),
                Some("8"),
                "rows of the generation that are played before",
            ),
            ENTRY,
            FACTOR_BIT,
        ],
        |values| {
            Ok(BoardFault::DriftingTable {
                after: values.whole("after")?,
                row: values.whole("row")?,
                bit: values.whole("bit")?,
            })
        },
    ),
    fault("unchecked-commit", "a commit is taken whatever CRC it names", &[], |_| {
        Ok(BoardFault::UncheckedCommit)
    }),
    fault("any-session", "packets are carried out whatever session they name", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::AnySession))
    }),
    fault("never-held", "another host takes the board, whoever holds it", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::NeverHeld))
    }),
    fault("counters-kept", "a new session goes on with the counters of the one before", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::CountersKept))
    }),
    fault("packets-anew", "the count of ROW_OUT packets starts again after a RESET", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::PacketsAnew))
    }),
    fault("rows-anywhere", "rows are taken in any place of their frame", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::RowsAnywhere))
    }),
    fault("greedy-ack", "a ROW_ACK frees every output bank, whatever rows it names", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::GreedyAck))
    }),
    fault("damaged-ack", "a packet whose CRC is wrong frees every output bank", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::DamagedAck))
    }),
    fault("stuck-repeats", "a row that is sent again says that it was never sent before", &[], |_| {
        Ok(BoardFault::Conduct(Conduct::StuckRepeats))
    }),
    fault(
        "unkept-rule",
        "a rule of the wire is not kept that no frame shows",
        &[Parameter::new(
            "instead",
            Range::Words(&Conduct::UNKEPT_NAMES),
            Some("partial-write"),
            "what the board does instead",
        )],
        |values| Ok(BoardFault::Conduct(values.choice("instead", &Conduct::UNKEPT)?.1)),
    ),
    fault("wrong-datapath", "the board claims another datapath id", &[], |_| Ok(BoardFault::WrongDatapath)),
    fault("wrong-clock-claim", "the board claims a pixel clock of 1 Hz, made by its PLL", &[], |_| {
        Ok(BoardFault::WrongClockClaim)
    }),
    fault(
        "spoilt-row",
        "a bit of a row flips between its packet and the core",
        &[
            ROW,
            Parameter::new("column", Range::Whole(0, 2591), None, "the column; without it, the middle one"),
            OUTPUT_BIT,
        ],
        |values| {
            Ok(BoardFault::SpoiltRow {
                row: values.whole("row")?,
                column: values.is_given("column").then(|| values.whole("column")).transpose()?,
                bit: values.whole("bit")?,
            })
        },
    ),
    fault(
        "slow-path",
        "in a burst, a bit of the output flips at a rate in rows that follow another without a pause",
        &[
            OUTPUT_BIT,
            Parameter::new(
                "one-in",
                Range::Whole(1, u32::MAX as i64),
                Some("100000"),
                "outputs of which one flips, on average",
            ),
            Parameter::new("seed", Range::Whole(1, u32::MAX as i64), Some("2"), "the seed of the draws"),
        ],
        |values| {
            Ok(BoardFault::SlowPath {
                bit: values.whole("bit")?,
                one_in: values.whole("one-in")?,
                seed: values.whole("seed")?,
            })
        },
    ),
    fault(
        "warm-bit",
        "in a burst, the first output of a row has a flipped bit once the board is warm",
        &[
            Parameter::new("after", Range::Whole(0, u32::MAX as i64), Some("2"), "frames that warm it"),
            ROW,
            OUTPUT_BIT,
        ],
        |values| {
            Ok(BoardFault::WarmBit {
                after: values.whole("after")?,
                row: values.whole("row")?,
                bit: values.whole("bit")?,
            })
        },
    ),
    fault(
        "late-swap",
        "in a burst, the table bank changes a row late when frames are as close as they may be, given two banks",
        &[],
        |_| Ok(BoardFault::LateSwap),
    ),
    fault(
        "hidden-pause",
        "in a burst, the output stands still for a clock in a row, which is not counted as a pause",
        &[ROW],
        |values| Ok(BoardFault::HiddenPause { row: values.whole("row")? }),
    ),
    fault(
        "misread",
        "the board does otherwise than a sentence of the pages says that define it",
        &[Parameter::new(
            "instead",
            Range::Words(&Misread::NAMES),
            Some("unsigned-weights"),
            "what the board does instead",
        )],
        |values| Ok(BoardFault::Misread(values.choice("instead", &Misread::ALL)?)),
    ),
];

const fn fault(
    name: &'static str,
    what: &'static str,
    parameters: &'static [Parameter],
    make: fn(&Values) -> Result<BoardFault, ValueError>,
) -> Fault<BoardFault> {
    Fault::new(name, Place::Board, what, parameters, make)
}

/// All faults that a mock board and the pipe to it can have; those of the pipe come first.
pub fn catalogue() -> impl Iterator<Item = FaultInfo> {
    let pipe = halfrow_pipe::FAULTS.iter().map(|fault| fault.info);
    pipe.chain(FAULTS.iter().map(|fault| fault.info))
}
