//! The names of all faults, with a line on each.

/// What a fault spoils.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The bytes between host and board.
    Wire,
    /// The board itself.
    Board,
}

/// A fault that can be asked for by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultInfo {
    /// The name, as in `fault=late`.
    pub name: &'static str,
    /// What the fault spoils.
    pub place: Place,
    /// What happens, in one line, with the parameters and their defaults.
    pub summary: &'static str,
}

const fn wire(name: &'static str, summary: &'static str) -> FaultInfo {
    FaultInfo { name, place: Place::Wire, summary }
}

const fn board(name: &'static str, summary: &'static str) -> FaultInfo {
    FaultInfo { name, place: Place::Board, summary }
}

const FAULTS: &[FaultInfo] = &[
    wire(
        "flip",
        "one bit of a byte, or of a packet, flips \
         (rate=1e-6 a byte, or byte=N, or packet=N; toward=both, seed=0)",
    ),
    wire(
        "drop",
        "a byte, or a packet, gets lost \
         (rate=1e-6 a byte, or byte=N, or packet=N; toward=both, seed=0)",
    ),
    wire(
        "duplicate",
        "a byte, or a packet, comes twice \
         (rate=1e-6 a byte, or byte=N, or packet=N; toward=both, seed=0)",
    ),
    wire(
        "reorder",
        "a packet is overtaken by the next one (rate=1e-3 a packet, or packet=N; toward=both, seed=0)",
    ),
    wire(
        "stall",
        "the stream stands still \
         (packet=40, or byte=N, or every=N bytes, or rate=P a packet; seconds=5, toward=both, seed=0)",
    ),
    wire(
        "lose",
        "a packet that is not short gets lost \
         (rate=1e-3 of those, or packet=N of them; size=100, toward=both, seed=0)",
    ),
    wire(
        "truncate",
        "a packet loses its end \
         (rate=1e-3 a packet, or byte=N, or packet=N; toward=both, seed=0)",
    ),
    wire(
        "disconnect",
        "the wire breaks for good \
         (packet=40, or byte=N, or rate=P a packet; toward=both, seed=0)",
    ),
    board("stuck-data", "a data line of the line memory is stuck (bit=5, value=1)"),
    board("stuck-address", "an address line of the line memory is stuck (bit=3, value=0)"),
    board("row-factor", "a bit of a row's table entry is flipped (row=3, bit=18, hidden=false)"),
    board("kernel-word", "a bit of a kernel word is flipped (node=16, weight=g4, bit=12, hidden=false)"),
    board("tap-offset", "all taps come from beside their columns (columns=1)"),
    board("no-rounding", "the weighted sum is truncated instead of rounded"),
    board("dead-tap", "a tap carries zero, or another tap's sample (tap=4, reads=0 to 6)"),
    board("late", "samples leave one pixel clock later than claimed"),
    board("wrong-latency-claim", "the claimed latency is one pixel clock too long"),
    board("lost-row", "a row goes in and never comes out (row=3)"),
    board(
        "stale-table",
        "after a commit, rows are made with the tables before it and say so (two table banks)",
    ),
    board(
        "stale-table-hidden",
        "after a commit, rows are made with the tables before it and deny it (two table banks)",
    ),
    board("drifting-table", "a bit of a table entry flips some rows after a commit (after=8, row=3, bit=18)"),
    board("wrong-datapath", "the board claims another datapath id"),
];

/// All faults, those of the wire first.
#[must_use]
pub fn catalogue() -> &'static [FaultInfo] {
    FAULTS
}
