//! Broken boards that correct by a grid: every fault is found as it is with one factor a row.

use super::expect;
use crate::scenario::Scenario;

/// Every fault of the board that the mock has, once more with a grid of 5 rows and 7 nodes.
pub const BROKEN_GRIDS: &[Scenario] = &[
    fails("a data line behind a grid", ",fault=stuck-data", "data bit 5 stuck at 1"),
    fails("an address line behind a grid", ",fault=stuck-address", "line memory, address bit 3"),
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
    fails("a kernel word behind a grid", ",fault=kernel-word", "kernel node 16, weight g4, bit 12"),
    fails(
        "a kernel word that reads back right behind a grid",
        ",fault=kernel-word,hidden=true",
        "kernel node 16, weight g4, bit 12",
    ),
    fails("a window beside its place behind a grid", ",fault=tap-offset", "one column to the right"),
    fails("no rounding behind a grid", ",fault=no-rounding", "the output's rounding"),
    fails("a dead tap behind a grid", ",fault=dead-tap", "tap G4 stuck at 0"),
    fails("a tap that copies another behind a grid", ",fault=dead-tap,tap=1,reads=5", "tap R1 reading R5"),
    fails(
        "a centre that is not taken behind a grid",
        ",fault=centre-ignored",
        "the setting of the optical centre",
    ),
    fails(
        "a bit of the centre behind a grid",
        ",fault=stuck-centre",
        "the setting of the optical centre, bit 3 stuck at 0",
    ),
    fails("a pipeline that is too long behind a grid", ",fault=late", "row 0 of frame 0 took 109"),
    fails(
        "a false claim of latency behind a grid",
        ",fault=wrong-latency-claim",
        "than the 109 pixel clocks that the board claims",
    ),
    fails(
        "a bit of the centre that leads beyond the row behind a grid",
        ",fault=stuck-centre,bit=12,value=1",
        "the setting of the optical centre, bit 12 stuck at 1",
    ),
    fails(
        "a lost row behind a grid",
        ",fault=lost-row",
        "row 3 of frame 0 went into the board and never came out",
    ),
    fails("stale grids", ",fault=stale-table", "names the tables of generation 0"),
    fails("stale grids under a new name", ",fault=stale-table-hidden", "the choice of the table bank"),
    fails(
        "a grid that drifts",
        ",fault=drifting-table,row=17,bit=3",
        "the tables changed during the run: grid row 2, node 2, bit 3",
    ),
    fails(
        "a false claim of the pixel clock behind a grid",
        ",fault=wrong-clock-claim",
        "the board names a pixel clock of 1 Hz, but its clock was seen to be",
    ),
    fails(
        "packets of any session behind a grid",
        ",fault=any-session",
        "a packet of another session must have no effect",
    ),
    fails(
        "an acknowledgement that frees every bank behind a grid",
        ",fault=greedy-ack",
        "the board must keep row_banks_out rows until they are acknowledged",
    ),
    fails(
        "a damaged packet that frees every bank behind a grid",
        ",fault=damaged-ack",
        "(rule: a damaged packet must have no effect)",
    ),
    fails(
        "a row behind a grid that denies that it came before",
        ",fault=stuck-repeats",
        "twice with `repeats` = 0",
    ),
    fails(
        "any host at any time behind a grid",
        ",fault=never-held",
        "a board must be held for 10 s after its holder's last packet",
    ),
    fails(
        "counters of the session before, behind a grid",
        ",fault=counters-kept",
        "rows in; the right number is 0 (rule: a greeting must open the next session",
    ),
    fails(
        "ROW_OUT packets that are counted anew behind a grid",
        ",fault=packets-anew",
        "by the board's own packet numbers",
    ),
    fails(
        "rows in any place behind a grid",
        ",fault=rows-anywhere",
        "took it without an answer (rule: a row out of place must be refused)",
    ),
    fails(
        "factors in front of a wrong one that are written to a board with grids",
        ",fault=unkept-rule,instead=partial-write",
        "a table entry out of range must be refused, and nothing of its packet written",
    ),
    fails(
        "a wrong entry named by its place in the packet, to a board with grids",
        ",fault=unkept-rule,instead=place-in-packet",
        "as `range`, detail 2, but it refused it as `range`, detail 1",
    ),
    fails(
        "a refused acknowledgement of rows of a grid",
        ",fault=unkept-rule,instead=ack-refused",
        "the board must leave ROW_ACK unanswered, but it refused it as `session`",
    ),
    fails(
        "any row behind one that waits, behind a grid",
        ",fault=unkept-rule,instead=any-follower",
        "took it without an answer (rule: a row out of place must be refused)",
    ),
    fails(
        "an acknowledgement of rows that were never sent, behind a grid",
        ",fault=unkept-rule,instead=ack-beyond",
        "as the first row that is not acknowledged (next_row_out)",
    ),
    fails(
        "a close that is counted as a session, behind a grid",
        ",fault=unkept-rule,instead=counted-close",
        "a greeting must open the next session",
    ),
    fails("a window of 16 bits behind a grid", ",fault=unkept-rule,instead=short-window", "next_row 65534"),
    fails(
        "gaps that go on in the next frame of a grid",
        ",fault=unkept-rule,instead=gaps-go-on",
        "(rule: a configuration must be set as it is, or refused without effect)",
    ),
    fails(
        "a read that is too long, refused without its first entry by a board with grids",
        ",fault=unkept-rule,instead=unnamed-read",
        "the board must refuse TABLE_READ as `range`, detail 1, but it refused it as `range`",
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
        "a commit of a grid that is not checked",
        ",fault=unchecked-commit",
        "the board must refuse COMMIT",
    ),
    fails("a row that changes on its way to a grid", ",fault=spoilt-row", "not in the computation"),
    fails(
        "a path that is too slow behind a grid",
        ",fault=slow-path,one-in=2000",
        "fails at the full pixel clock, seen in bit 5",
    ),
    fails(
        "a bit that flips when warm behind a grid",
        ",fault=warm-bit,row=1,bit=11",
        "first in row 1; sent row by row, the same frame is right",
    ),
    fails("grids that change late", ",fault=late-swap", "the change of table banks between two frames"),
    fails("a pause that is not counted behind a grid", ",fault=hidden-pause", "a maximum latency of"),
    fails(
        "weights without their sign behind a grid",
        ",fault=misread,instead=unsigned-weights",
        "the sign of the kernel's weights",
    ),
    fails(
        "weights rounded toward zero behind a grid",
        ",fault=misread,instead=weights-toward-zero",
        "the rounding of interpolated weights, toward zero",
    ),
    fails(
        "source coordinates of a grid that are not rounded",
        ",fault=misread,instead=unrounded-source",
        "the rounding of source coordinates",
    ),
    fails(
        "the node after the right one behind a grid",
        ",fault=misread,instead=next-node",
        "the kernel's address, one node ahead",
    ),
    fails(
        "an edge of the wrong colour behind a grid",
        ",fault=misread,instead=nearest-edge",
        "the samples beyond the row's ends",
    ),
    fails(
        "pairs in reverse behind a grid",
        ",fault=misread,instead=reversed-pairs",
        "each pair's bytes reversed",
    ),
    fails(
        "entries of a grid in reverse",
        ",fault=misread,instead=reversed-entries",
        "row table, the order of its bytes",
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
