//! Broken boards that correct by a grid: every fault is found as it is with one factor a row.

use std::sync::LazyLock;

use super::broken_either_way::broken_either_way;
use super::expect;
use crate::scenario::Scenario;

/// Every fault of the board that the mock has, once more with a grid of 5 rows and 7 nodes.
pub static BROKEN_GRIDS: LazyLock<Vec<Scenario>> =
    LazyLock::new(|| OWN.iter().copied().chain(broken_either_way(GRID)).collect());

const OWN: &[Scenario] = &[
    fails("an offset", ",fault=row-factor", "grid row 3, offset, bit 18"),
    fails("an offset that reads back right", ",fault=row-factor,hidden=true", "grid row 3, offset, bit 18"),
    fails("a node", ",fault=row-factor,row=23,bit=24", "grid row 3, node 3, bit 24"),
    fails(
        "a node that reads back right",
        ",fault=row-factor,row=23,bit=14,hidden=true",
        "grid row 3, node 3, bit 14",
    ),
    fails(
        "a node in the only bank",
        ",table-banks=1,fault=row-factor,row=32,bit=17,hidden=true",
        "grid row 2, node 5, bit 17",
    ),
    fails("a pipeline that is too long behind a grid", ",fault=late", "row 0 of frame 0 took 109"),
    fails(
        "a false claim of latency behind a grid",
        ",fault=wrong-latency-claim",
        "than the 109 pixel clocks that the board claims",
    ),
    fails(
        "a grid that drifts",
        ",fault=drifting-table,row=17,bit=3",
        "the tables changed during the run: grid row 2, node 2, bit 3",
    ),
    expect(
        "ERROR",
        3,
        "a zero behind a piece of 254 bytes that a board with grids does not send",
        ",fault=unkept-rule,instead=zero-unsent",
        GRID,
        "packets came damaged: the link loses what is sent over it",
    ),
    expect(
        "ERROR",
        3,
        "a zero behind a piece of 254 bytes that a board with grids does not read",
        ",fault=unkept-rule,instead=zero-unread",
        GRID,
        "because the board counts each as a damaged packet",
    )
    .or_when_late(&["no answer to ECHO"]),
    fails(
        "the node after the right one behind a grid",
        ",fault=misread,instead=next-node",
        "the kernel's address, one node ahead",
    ),
    expect(
        "ERROR",
        3,
        "long runs that are unstuffed wrong by a board with grids",
        ",fault=misread,instead=long-runs",
        GRID,
        "because the board counts each as a damaged packet",
    )
    .or_when_late(&["no answer to ECHO"]),
    expect(
        "ERROR",
        6,
        "another datapath than one of grids",
        ",fault=wrong-datapath",
        GRID,
        "which this program does not know",
    ),
];

/// Frames wide enough to follow each other without blanking.
const GRID: &[&str] = &["--width", "192", "--height", "24", "--radius", "130", "--projection", "exact"];

const fn fails(name: &'static str, options: &'static str, sentence: &'static str) -> Scenario {
    expect("FAIL", 1, name, options, GRID, sentence)
}
