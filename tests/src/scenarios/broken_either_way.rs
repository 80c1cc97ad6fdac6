//! Broken boards that a run tells of in the same words, whether they correct by one factor a row or by a grid.

use super::expect;
use crate::scenario::Scenario;

/// What is broken, the options that break it, and the sentence that names it.
const ROWS: &[(&str, &str, &str)] = &[
    ("a data line", ",fault=stuck-data", "data bit 5 stuck at 1"),
    ("an address line", ",fault=stuck-address", "line memory, address bit 3"),
    ("a kernel word", ",fault=kernel-word", "kernel node 16, weight g4, bit 12"),
    (
        "a kernel word that reads back right",
        ",fault=kernel-word,hidden=true",
        "kernel node 16, weight g4, bit 12",
    ),
    ("a window beside its place", ",fault=tap-offset", "one column to the right"),
    ("no rounding", ",fault=no-rounding", "the output's rounding"),
    ("a dead tap", ",fault=dead-tap", "tap G4 stuck at 0"),
    ("a tap that copies another", ",fault=dead-tap,tap=1,reads=5", "tap R1 reading R5"),
    ("a centre that is not taken", ",fault=centre-ignored", "the setting of the optical centre"),
    ("a bit of the centre", ",fault=stuck-centre", "the setting of the optical centre, bit 3 stuck at 0"),
    (
        "a bit of the centre that leads beyond the row",
        ",fault=stuck-centre,bit=12,value=1",
        "the setting of the optical centre, bit 12 stuck at 1",
    ),
    ("a lost row", ",fault=lost-row", "row 3 of frame 0 went into the board and never came out"),
    ("stale tables", ",fault=stale-table", "names the tables of generation 0"),
    ("stale tables under a new name", ",fault=stale-table-hidden", "the choice of the table bank"),
    ("a row that changes on its way in", ",fault=spoilt-row", "not in the computation"),
    (
        "a path that is too slow",
        ",fault=slow-path,one-in=2000",
        "fails at the full pixel clock, seen in bit 5",
    ),
    (
        "a bit that flips when warm",
        ",fault=warm-bit,row=1,bit=11",
        "first in row 1; sent row by row, the same frame is right",
    ),
    ("tables that change late", ",fault=late-swap", "the change of table banks between two frames"),
    ("a pause that is not counted", ",fault=hidden-pause", "a maximum latency of"),
    (
        "a false claim of the pixel clock",
        ",fault=wrong-clock-claim",
        "the board names a pixel clock of 1 Hz, but its clock was seen to be",
    ),
    ("packets of any session", ",fault=any-session", "a packet of another session must have no effect"),
    (
        "an acknowledgement that frees every bank",
        ",fault=greedy-ack",
        "the board must keep row_banks_out rows until they are acknowledged",
    ),
    (
        "a damaged packet that frees every bank",
        ",fault=damaged-ack",
        "(rule: a damaged packet must have no effect)",
    ),
    ("a row that denies that it came before", ",fault=stuck-repeats", "twice with `repeats` = 0"),
    (
        "any host at any time",
        ",fault=never-held",
        "a board must be held for 10 s after its holder's last packet",
    ),
    (
        "counters of the session before",
        ",fault=counters-kept",
        "rows in; the right number is 0 (rule: a greeting must open the next session",
    ),
    ("ROW_OUT packets that are counted anew", ",fault=packets-anew", "by the board's own packet numbers"),
    (
        "rows in any place",
        ",fault=rows-anywhere",
        "took it without an answer (rule: a row out of place must be refused)",
    ),
    (
        "entries in front of a wrong one that are written",
        ",fault=unkept-rule,instead=partial-write",
        "a table entry out of range must be refused, and nothing of its packet written",
    ),
    (
        "a wrong entry named by its place in the packet",
        ",fault=unkept-rule,instead=place-in-packet",
        "as `range`, detail 2, but it refused it as `range`, detail 1",
    ),
    (
        "a refused acknowledgement",
        ",fault=unkept-rule,instead=ack-refused",
        "the board must leave ROW_ACK unanswered, but it refused it as `session`",
    ),
    (
        "any row behind one that waits",
        ",fault=unkept-rule,instead=any-follower",
        "took it without an answer (rule: a row out of place must be refused)",
    ),
    (
        "an acknowledgement of rows that were never sent",
        ",fault=unkept-rule,instead=ack-beyond",
        "as the first row that is not acknowledged (next_row_out)",
    ),
    (
        "a close that is counted as a session",
        ",fault=unkept-rule,instead=counted-close",
        "a greeting must open the next session",
    ),
    ("a window of 16 bits", ",fault=unkept-rule,instead=short-window", "next_row 65534"),
    (
        "gaps that go on in the next frame",
        ",fault=unkept-rule,instead=gaps-go-on",
        "(rule: a configuration must be set as it is, or refused without effect)",
    ),
    (
        "a read that is too long, refused without its first entry",
        ",fault=unkept-rule,instead=unnamed-read",
        "the board must refuse TABLE_READ as `range`, detail 1, but it refused it as `range`",
    ),
    (
        "weights without their sign",
        ",fault=misread,instead=unsigned-weights",
        "the sign of the kernel's weights",
    ),
    (
        "weights rounded toward zero",
        ",fault=misread,instead=weights-toward-zero",
        "the rounding of interpolated weights, toward zero",
    ),
    (
        "source coordinates that are not rounded",
        ",fault=misread,instead=unrounded-source",
        "the rounding of source coordinates",
    ),
    (
        "an edge of the wrong colour",
        ",fault=misread,instead=nearest-edge",
        "the samples beyond the row's ends",
    ),
    ("pairs in reverse", ",fault=misread,instead=reversed-pairs", "each pair's bytes reversed"),
    ("entries in reverse", ",fault=misread,instead=reversed-entries", "row table, the order of its bytes"),
    ("a commit that is not checked", ",fault=unchecked-commit", "the board must refuse COMMIT"),
];

/// A scenario of each, with these arguments of `verify`.
pub(super) fn broken_either_way(arguments: &'static [&'static str]) -> impl Iterator<Item = Scenario> {
    let rows = ROWS.iter();
    rows.map(move |&(name, options, sentence)| expect("FAIL", 1, name, options, arguments, sentence))
}
