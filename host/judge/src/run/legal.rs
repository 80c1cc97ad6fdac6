//! What a board may say of itself: `protocol/WIRE.md` section 3 and `fpga/DATAPATH.md`.

use halfrow_protocol::message::Grids;

use crate::board::{Capabilities, Datapath};
use crate::result::Finding;

/// What a capability may be.
struct Rule {
    /// Its name in WIRE.md.
    name: &'static str,
    /// What is legal, as the end of a sentence.
    legal: &'static str,
    value: fn(&Capabilities) -> u16,
    holds: fn(&Capabilities) -> bool,
}

/// The widest row and the highest frame that the datapath is defined for.
const WIDEST: u16 = 2592;
const HIGHEST: u16 = 2048;
/// The narrowest row.
const NARROWEST: u16 = 64;
/// L = 3 + p: what an output may need beside its column, and the pipeline.
const LATENCY: std::ops::RangeInclusive<u8> = 3..=super::MAX_LATENCY;

/// The fewest entries of a bank that takes grids, and the id of the datapath that they are of.
const LEAST_ENTRIES: u16 = 2048;
const OF_GRIDS: u16 = 2;

/// The grids that a board takes; none of a datapath that is not known.
pub(crate) fn grids(board: &Capabilities) -> Option<Grids> {
    board.grids.filter(|grids| grids.further_datapath == OF_GRIDS)
}

/// Of datapath 1, and of 2 beside it.
const RULES: [Rule; 14] = [
    Rule {
        name: "max_width",
        legal: "rows have an even number of samples, 64 to 2592",
        value: |board| board.max_width,
        holds: |board| (NARROWEST..=WIDEST).contains(&board.max_width) && board.max_width.is_multiple_of(2),
    },
    Rule {
        name: "max_height",
        legal: "frames have 1 to 2048 rows",
        value: |board| board.max_height,
        holds: |board| (1..=HIGHEST).contains(&board.max_height),
    },
    Rule {
        name: "depths",
        legal: "a board has at least one of 8, 10 and 12 bits",
        value: |board| board.depths.into(),
        holds: |board| [8, 10, 12].into_iter().any(|bits| board.sample_depths().has(bits)),
    },
    Rule {
        name: "taps",
        legal: "a datapath has 5 or 7",
        value: |board| board.taps.into(),
        holds: |board| matches!(board.taps, 5 | 7),
    },
    Rule {
        name: "latency",
        legal: "L is 3 to 32",
        value: |board| board.latency.into(),
        holds: |board| LATENCY.contains(&board.latency),
    },
    Rule {
        name: "ring",
        legal: "M is a power of two that holds the widest row",
        value: |board| board.ring,
        holds: |board| board.ring.is_power_of_two() && board.ring >= board.max_width,
    },
    Rule {
        name: "table_banks",
        legal: "a board has 1 or 2",
        value: |board| board.table_banks.into(),
        holds: |board| matches!(board.table_banks, 1 | 2),
    },
    Rule {
        name: "row_banks_in",
        legal: "a board has at least 2",
        value: |board| board.row_banks_in.into(),
        holds: |board| board.row_banks_in >= 2,
    },
    Rule {
        name: "row_banks_out",
        legal: "a board has at least 2",
        value: |board| board.row_banks_out.into(),
        holds: |board| board.row_banks_out >= 2,
    },
    Rule {
        name: "step_ports",
        legal: "a datapath that reads row factors has at least one port for them",
        value: |board| board.step_ports.into(),
        holds: |board| board.step_ports >= 1,
    },
    Rule {
        name: "kernel_ports",
        legal: "a datapath that reads nodes has at least one port for them",
        value: |board| board.kernel_ports.into(),
        holds: |board| board.kernel_ports >= 1,
    },
    Rule {
        name: "records",
        legal: "a board that makes bursts keeps at least 2",
        value: |board| board.bursts.map_or(0, |bursts| bursts.records),
        holds: |board| board.bursts.is_none_or(|bursts| bursts.records >= 2),
    },
    Rule {
        name: "entries",
        legal: "a board that takes grids has at least 2048 entries, and as many as rows",
        value: |board| grids(board).map_or(0, |grids| grids.entries),
        holds: |board| grids(board).is_none_or(|it| it.entries >= board.max_height.max(LEAST_ENTRIES)),
    },
    Rule {
        name: "ks",
        legal: "a board that takes grids has nodes every 2^5 or every 2^6 columns",
        value: |board| grids(board).map_or(0, |grids| grids.ks.into()),
        holds: |board| grids(board).is_none_or(|grids| grids.takes(5) || grids.takes(6)),
    },
];

/// Why no board of `datapath` can have these capabilities, if none can.
pub(super) fn impossible(datapath: Datapath, capabilities: &Capabilities) -> Option<Finding> {
    let rules = match datapath {
        Datapath::RowFactors | Datapath::Grids => &RULES,
    };
    let broken = rules.iter().find(|rule| !(rule.holds)(capabilities))?;
    let (Rule { name, legal, .. }, value) = (broken, (broken.value)(capabilities));
    let (capability, legal) = ((*name).to_owned(), (*legal).to_owned());
    Some(Finding::CapabilityImpossible { capability, value, legal })
}
