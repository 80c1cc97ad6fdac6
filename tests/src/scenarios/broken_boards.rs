//! Broken boards: every fault of the board is found, and the broken part named.

use std::sync::LazyLock;

use super::broken_either_way::broken_either_way;
use super::expect;
use crate::scenario::{SMALLER, Scenario};

/// Every fault of the board that the mock has, with the built-in frames; some once more where they are harder to see, at the
/// paper's size where smaller frames have no such place. `scripts/soak campaign` draws faults at the paper's size.
pub static BROKEN_BOARDS: LazyLock<Vec<Scenario>> =
    LazyLock::new(|| OWN.iter().copied().chain(broken_either_way(SMALLER)).collect());

const OWN: &[Scenario] = &[
    fails("the highest data line", ",fault=stuck-data,bit=11,value=0", "data bit 11 stuck at 0"),
    fails_at_full_size(
        "the highest address line",
        ",fault=stuck-address,bit=10,value=1",
        "line memory, address bit 10",
    ),
    fails("a row factor", ",fault=row-factor", "row 3's factor, bit 18"),
    fails("a row factor that reads back right", ",fault=row-factor,hidden=true", "row 3's factor, bit 18"),
    fails("a window on the other side", ",fault=tap-offset,columns=-3", "3 columns to the left"),
    fails("an outer tap that hermite does not use", ",fault=dead-tap,tap=0", "tap G0 stuck at 0"),
    fails("the other outer tap", ",fault=dead-tap,tap=6,reads=5", "tap G6 reading R5"),
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
    fails_at_full_size("the last row lost", ",fault=lost-row,row=1079", "row 1079 of frame 0"),
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
        "rows taken anywhere, over a link that lost a packet before",
        ",fault=rows-anywhere,fault=drop,packet=100",
        "took it without an answer",
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
    fails("the node after the right one", ",fault=misread,instead=next-node", "one node ahead"),
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
