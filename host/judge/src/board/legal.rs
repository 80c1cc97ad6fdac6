//! The capabilities that a board may have: `protocol/WIRE.md` section 3 and `fpga/DATAPATH.md`.

use std::ops::RangeInclusive;

use halfrow_model::{BitDepth, MAX_HEIGHT, MAX_WIDTH, MIN_WIDTH};
use halfrow_protocol::message::Grids;

use super::{BoardError, Bursts, Capabilities, Datapath};

/// The legal values of a capability.
struct Limit {
    /// Its name in WIRE.md.
    name: &'static str,
    /// What is legal, as the end of a sentence.
    legal: fn() -> String,
    value: fn(&Capabilities) -> u16,
    holds: fn(&Capabilities) -> bool,
}

/// The sizes that the datapath is defined for.
const WIDTHS: RangeInclusive<usize> = MIN_WIDTH..=MAX_WIDTH;
const HEIGHTS: RangeInclusive<usize> = 1..=MAX_HEIGHT;
/// L = 3 + p: three samples of look-ahead, and the pipeline.
const MIN_LATENCY: u8 = 3;
/// The largest L that a board may have: the pixel clocks by which a row leaves it later than half a row after it entered.
pub const MAX_LATENCY: u8 = 32;
/// The fewest row banks each way, and the fewest records of bursts.
const TWO: u16 = 2;
/// The fewest entries of a bank that takes grids.
pub(crate) const LEAST_ENTRIES: u16 = 2048;

/// The grids that a board takes; none if they are of an unknown datapath.
pub(crate) fn grids(board: &Capabilities) -> Option<Grids> {
    board.grids.filter(|grids| grids.further_datapath == Datapath::Grids.id())
}

/// The fewest pixel clocks between two rows of `width` samples that `datapath` corrects.
pub(crate) fn row_blanking(board: &Capabilities, width: usize, datapath: Datapath) -> u16 {
    board.least_blanking.max(grid_blanking(board, width, datapath))
}

/// The fewest pixel clocks between two frames of a burst of such rows: the last row of a frame and the first of the next follow
/// each other too.
pub(crate) fn frame_blanking(board: &Capabilities, bursts: Bursts, width: usize, datapath: Datapath) -> u16 {
    bursts.least_frame_blanking.max(grid_blanking(board, width, datapath))
}

/// What narrow rows of a grid need in addition.
fn grid_blanking(board: &Capabilities, width: usize, datapath: Datapath) -> u16 {
    match datapath {
        Datapath::RowFactors => 0,
        Datapath::Grids => grids(board)
            .filter(|grids| width < grids.grid_width.into())
            .map_or(0, |grids| grids.grid_blanking.into()),
    }
}

/// Pixel clocks from the first sample of a frame of a burst to that of the next (AT-SPEED.md, *Time*).
pub(crate) fn frame_clocks((width, height): (usize, usize), blanking: u16, between: u16) -> u64 {
    let (width, height) = (width as u64, height as u64);
    width * height + u64::from(blanking) * height.saturating_sub(1) + u64::from(between)
}

/// Of datapath 1, and of datapath 2 in addition.
const LIMITS: [Limit; 15] = [
    Limit {
        name: "max_width",
        legal: || format!("rows have an even number of samples, {MIN_WIDTH} to {MAX_WIDTH}"),
        value: |board| board.max_width,
        holds: |board| WIDTHS.contains(&board.max_width.into()) && board.max_width.is_multiple_of(2),
    },
    Limit {
        name: "max_height",
        legal: || format!("frames have 1 to {MAX_HEIGHT} rows"),
        value: |board| board.max_height,
        holds: |board| HEIGHTS.contains(&board.max_height.into()),
    },
    Limit {
        name: "depths",
        legal: || "a board has at least one of 8, 10 and 12 bits".to_owned(),
        value: |board| board.depths.into(),
        holds: |board| BitDepth::ALL.iter().any(|depth| board.sample_depths().has(depth.bits() as u8)),
    },
    Limit {
        name: "taps",
        legal: || "a datapath has 5 or 7".to_owned(),
        value: |board| board.taps.into(),
        holds: |board| matches!(board.taps, 5 | 7),
    },
    Limit {
        name: "latency",
        legal: || format!("L is {MIN_LATENCY} to {MAX_LATENCY}"),
        value: |board| board.latency.into(),
        holds: |board| (MIN_LATENCY..=MAX_LATENCY).contains(&board.latency),
    },
    Limit {
        name: "ring",
        legal: || "M is a power of two that holds the widest row".to_owned(),
        value: |board| board.ring,
        holds: |board| board.ring.is_power_of_two() && board.ring >= board.max_width,
    },
    Limit {
        name: "table_banks",
        legal: || "a board has 1 or 2".to_owned(),
        value: |board| board.table_banks.into(),
        holds: |board| matches!(board.table_banks, 1 | 2),
    },
    Limit {
        name: "row_banks_in",
        legal: || format!("a board has at least {TWO}"),
        value: |board| board.row_banks_in.into(),
        holds: |board| u16::from(board.row_banks_in) >= TWO,
    },
    Limit {
        name: "row_banks_out",
        legal: || format!("a board has at least {TWO}"),
        value: |board| board.row_banks_out.into(),
        holds: |board| u16::from(board.row_banks_out) >= TWO,
    },
    Limit {
        name: "step_ports",
        legal: || "a datapath that reads row factors has at least one port for them".to_owned(),
        value: |board| board.step_ports.into(),
        holds: |board| board.step_ports >= 1,
    },
    Limit {
        name: "kernel_ports",
        legal: || "a datapath that reads nodes has at least one port for them".to_owned(),
        value: |board| board.kernel_ports.into(),
        holds: |board| board.kernel_ports >= 1,
    },
    Limit {
        name: "clock_source",
        legal: || "a pixel clock is the host's own (0), PIXCLK (1) or a PLL's (2)".to_owned(),
        value: |board| board.clock_source.into(),
        holds: |board| board.source_of_clock().is_some(),
    },
    Limit {
        name: "records",
        legal: || format!("a board that makes bursts keeps at least {TWO}"),
        value: |board| board.bursts.map_or(0, |bursts| bursts.records),
        holds: |board| board.bursts.is_none_or(|bursts| bursts.records >= TWO),
    },
    Limit {
        name: "entries",
        legal: || {
            format!("a board that takes grids has at least {LEAST_ENTRIES} entries, and as many as rows")
        },
        value: |board| grids(board).map_or(0, |grids| grids.entries),
        holds: |board| grids(board).is_none_or(|it| it.entries >= board.max_height.max(LEAST_ENTRIES)),
    },
    Limit {
        name: "ks",
        legal: || "a board that takes grids has nodes every 2^5 or every 2^6 columns".to_owned(),
        value: |board| grids(board).map_or(0, |grids| grids.ks.into()),
        holds: |board| grids(board).is_none_or(|grids| grids.takes(5) || grids.takes(6)),
    },
];

/// Whether a board of a known datapath can have these capabilities. For an unknown one nothing can be said.
///
/// # Errors
/// [`BoardError::Impossible`] for the first that none can have.
pub(crate) fn possible(capabilities: &Capabilities) -> Result<(), BoardError> {
    // A new capability does not compile here until somebody has decided whether [`LIMITS`] needs a line for it.
    let Capabilities {
        datapath: _,
        max_width: _,
        max_height: _,
        depths: _,
        taps: _,
        latency: _,
        ring: _,
        least_blanking: _,
        table_banks: _,
        row_banks_in: _,
        row_banks_out: _,
        step_ports: _,
        kernel_ports: _,
        clock_source: _,
        clock_hz: _,
        bursts: _,
        entered: _,
        grids: _,
        nature: _,
        name: _,
    } = capabilities;
    let limits = match capabilities.known_datapath() {
        Ok(Datapath::RowFactors | Datapath::Grids) => &LIMITS[..],
        Err(_) => &[],
    };
    let broken = limits.iter().find(|limit| !(limit.holds)(capabilities));
    broken.map_or(Ok(()), |Limit { name, legal, value, .. }| {
        let (capability, value, legal) = ((*name).to_owned(), value(capabilities), legal());
        Err(BoardError::Impossible { capability, value, legal })
    })
}
