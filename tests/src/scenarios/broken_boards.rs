//! Broken boards: every fault of the board is found, and the broken part named.

use super::expect;
use crate::scenario::{SMALLER, Scenario};

/// Every fault of the board that the mock has, with the built-in frames; some once more where they are harder to see, at the
/// paper's size where smaller frames have no such place. `scripts/soak campaign` draws faults at the paper's size.
pub const BROKEN_BOARDS: &[Scenario] = &[
    fails("a data line", ",fault=stuck-data", "data bit 5 stuck at 1"),
    fails("the highest data line", ",fault=stuck-data,bit=11,value=0", "data bit 11 stuck at 0"),
    fails("an address line", ",fault=stuck-address", "line memory, address bit 3"),
    fails_at_full_size(
        "the highest address line",
        ",fault=stuck-address,bit=10,value=1",
        "line memory, address bit 10",
    ),
    fails("a row factor", ",fault=row-factor", "row 3's factor, bit 18"),
    fails("a row factor that reads back right", ",fault=row-factor,hidden=true", "row 3's factor, bit 18"),
    fails("a kernel word", ",fault=kernel-word", "kernel node 16, weight g4, bit 12"),
    fails(
        "a kernel word that reads back right",
        ",fault=kernel-word,hidden=true",
        "kernel node 16, weight g4, bit 12",
    ),
    fails("a window beside its place", ",fault=tap-offset", "one column to the right"),
    fails("a window on the other side", ",fault=tap-offset,columns=-3", "3 columns to the left"),
    fails("no rounding", ",fault=no-rounding", "the output's rounding"),
    fails("a dead tap", ",fault=dead-tap", "tap G4 stuck at 0"),
    fails("a tap that copies another", ",fault=dead-tap,tap=1,reads=5", "tap R1 reading R5"),
    fails("an outer tap that hermite does not use", ",fault=dead-tap,tap=0", "tap G0 stuck at 0"),
    fails("the other outer tap", ",fault=dead-tap,tap=6,reads=5", "tap G6 reading R5"),
    fails("a centre that is not taken", ",fault=centre-ignored", "the setting of the optical centre"),
    fails(
        "a bit of the centre",
        ",fault=stuck-centre",
        "the setting of the optical centre, bit 3 stuck at 0",
    ),
    fails_at_full_size(
        "a bit of the centre that one frame alone has at the other level",
        ",fault=stuck-centre,bit=10,value=1",
        "the setting of the optical centre, bit 10 stuck at 1",
    ),
    fails_at_full_size("a pipeline that is too long", ",fault=late", "row 0 of frame 0 took 973"),
    fails_at_full_size(
        "a false claim of latency",
        ",fault=wrong-latency-claim",
        "than the 973 pixel clocks that the board claims",
    ),
    fails(
        "a bit of the centre that leads beyond the row",
        ",fault=stuck-centre,bit=12,value=1",
        "the setting of the optical centre, bit 12 stuck at 1",
    ),
    fails("a lost row", ",fault=lost-row", "row 3 of frame 0 went into the board and never came out"),
    fails_at_full_size("the last row lost", ",fault=lost-row,row=1079", "row 1079 of frame 0"),
    fails("stale tables", ",fault=stale-table", "names the tables of generation 0"),
    fails("stale tables under a new name", ",fault=stale-table-hidden", "the choice of the table bank"),
    fails(
        "a table that drifts",
        ",fault=drifting-table",
        "the tables changed during the run: row 3's factor, bit 18",
    ),
    fails_at_full_size(
        "a table that drifts at the very end",
        ",fault=drifting-table,after=15119,row=1079,bit=0",
        "the tables changed during the run: row 1079's factor, bit 0",
    ),
    fails_at_full_size(
        "a row factor in the only bank",
        ",table-banks=1,fault=row-factor,row=1079,bit=0,hidden=true",
        "row 1079's factor, bit 0",
    ),
    fails("a row that changes on its way in", ",fault=spoilt-row", "not in the computation"),
    fails(
        "a path that is too slow",
        ",fault=slow-path,one-in=2000",
        "fails at the full pixel clock, seen in bit 5",
    ),
    expect(
        "FAIL",
        1,
        "a path of a bit beyond the depth that is too slow",
        ",fault=slow-path,bit=10,one-in=1",
        &["--width", "128", "--height", "72", "--radius", "73.78", "--bits", "8"],
        "sent row by row, the same frame is right; the suspect is a path that fails at the full pixel clock, seen in bit 10",
    ),
    fails(
        "an address line that only rows behind the frames are long enough for",
        ",fault=stuck-address,bit=9,bursts=no",
        "the suspect is line memory, address bit 9",
    ),
    fails(
        "an address line that no row of the run is long enough for",
        ",fault=stuck-address,bit=9",
        "sent row by row, the same frame is wrong as well; the suspect is line memory, address bit 9",
    ),
    fails(
        "a bit that flips when warm",
        ",fault=warm-bit,row=1,bit=11",
        "first in row 1; sent row by row, the same frame is right",
    ),
    fails("tables that change late", ",fault=late-swap", "the change of table banks between two frames"),
    fails("a pause that is not counted", ",fault=hidden-pause", "a maximum latency of"),
    fails(
        "a false claim of the pixel clock",
        ",fault=wrong-clock-claim",
        "the board names a pixel clock of 1 Hz, but its clock was seen to be",
    ),
    fails("packets of any session", ",fault=any-session", "a packet of another session must have no effect"),
    fails(
        "an acknowledgement that frees every bank",
        ",fault=greedy-ack",
        "the board must keep row_banks_out rows until they are acknowledged",
    ),
    fails(
        "a damaged packet that frees every bank",
        ",fault=damaged-ack",
        "(rule: a damaged packet must have no effect)",
    ),
    fails("a row that denies that it came before", ",fault=stuck-repeats", "twice with `repeats` = 0"),
    fails(
        "any host at any time",
        ",fault=never-held",
        "a board must be held for 10 s after its holder's last packet",
    ),
    fails(
        "counters of the session before",
        ",fault=counters-kept",
        "rows in; the right number is 0 (rule: a greeting must open the next session",
    ),
    fails(
        "ROW_OUT packets that are counted anew",
        ",fault=packets-anew",
        "by the board's own packet numbers",
    ),
    fails(
        "rows in any place",
        ",fault=rows-anywhere",
        "took it without an answer (rule: a row out of place must be refused)",
    ),
    fails(
        "factors in front of a wrong one that are written",
        ",fault=unkept-rule,instead=partial-write",
        "a table entry out of range must be refused, and nothing of its packet written",
    ),
    fails(
        "a wrong factor named by its place in the packet",
        ",fault=unkept-rule,instead=place-in-packet",
        "as `range`, detail 2, but it refused it as `range`, detail 1",
    ),
    fails(
        "a refused acknowledgement",
        ",fault=unkept-rule,instead=ack-refused",
        "the board must leave ROW_ACK unanswered, but it refused it as `session`",
    ),
    fails(
        "any row behind one that waits",
        ",fault=unkept-rule,instead=any-follower",
        "took it without an answer (rule: a row out of place must be refused)",
    ),
    fails(
        "an acknowledgement of rows that were never sent",
        ",fault=unkept-rule,instead=ack-beyond",
        "as the first row that is not acknowledged (next_row_out)",
    ),
    fails(
        "rows taken anywhere, over a link that lost a packet before",
        ",fault=rows-anywhere,fault=drop,packet=100",
        "took it without an answer",
    ),
    fails(
        "a close that is counted as a session",
        ",fault=unkept-rule,instead=counted-close",
        "a greeting must open the next session",
    ),
    fails("a window of 16 bits", ",fault=unkept-rule,instead=short-window", "next_row 65534"),
    fails(
        "gaps that go on in the next frame",
        ",fault=unkept-rule,instead=gaps-go-on",
        "(rule: a configuration must be set as it is, or refused without effect)",
    ),
    fails(
        "a read that is too long, refused without its first entry",
        ",fault=unkept-rule,instead=unnamed-read",
        "the board must refuse TABLE_READ as `range`, detail 1, but it refused it as `range`",
    ),
    expect(
        "ERROR",
        3,
        "a zero behind a piece of 254 bytes that is not sent",
        ",fault=unkept-rule,instead=zero-unsent",
        SMALLER,
        "no answer to ECHO",
    ),
    expect(
        "ERROR",
        3,
        "a zero behind a piece of 254 bytes that is not read",
        ",fault=unkept-rule,instead=zero-unread",
        SMALLER,
        "no answer to ECHO",
    ),
    fails("a commit that is not checked", ",fault=unchecked-commit", "the board must refuse COMMIT"),
    fails(
        "weights without their sign",
        ",fault=misread,instead=unsigned-weights",
        "the sign of the kernel's weights",
    ),
    fails(
        "weights rounded toward zero",
        ",fault=misread,instead=weights-toward-zero",
        "the rounding of interpolated weights, toward zero",
    ),
    fails(
        "source coordinates that are not rounded",
        ",fault=misread,instead=unrounded-source",
        "the rounding of source coordinates",
    ),
    fails("the node after the right one", ",fault=misread,instead=next-node", "one node ahead"),
    fails(
        "an edge of the wrong colour",
        ",fault=misread,instead=nearest-edge",
        "the samples beyond the row's ends",
    ),
    fails("pairs in reverse", ",fault=misread,instead=reversed-pairs", "each pair's bytes reversed"),
    fails(
        "entries in reverse",
        ",fault=misread,instead=reversed-entries",
        "row table, the order of its bytes",
    ),
    expect(
        "ERROR",
        3,
        "long runs that are unstuffed wrong",
        ",fault=misread,instead=long-runs",
        SMALLER,
        "because the board counts each as a damaged packet",
    )
    .or_when_late(&["no answer to ECHO"]),
    expect(
        "ERROR",
        6,
        "another datapath",
        ",fault=wrong-datapath",
        SMALLER,
        "which this program does not know",
    ),
];

const fn fails(name: &'static str, options: &'static str, sentence: &'static str) -> Scenario {
    expect("FAIL", 1, name, options, SMALLER, sentence)
}

const fn fails_at_full_size(name: &'static str, options: &'static str, sentence: &'static str) -> Scenario {
    expect("FAIL", 1, name, options, &[], sentence)
}
