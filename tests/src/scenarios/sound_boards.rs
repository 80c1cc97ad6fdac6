//! Sound boards: every build, kernel, depth, phase and size passes.

use super::passes;
use crate::scenario::{On, OnSim, Scenario};

/// Boards without a fault, and links that are only slow.
pub const SOUND_BOARDS: &[Scenario] = &[
    passes("the paper's system", "", &[]),
    passes("the paper's system with seven taps", "", &["--kernel", "keys", "--frame", "builtin:noise"]),
    passes("nearest neighbour", "", &[W, "128", H, "72", R, "73.78", "--kernel", "nearest"])
        .on_sim(OnSim::Nothing),
    passes("linear", "", &[W, "128", H, "72", R, "73.78", "--kernel", "linear"]).on_sim(OnSim::Nothing),
    passes("Keys", "", &[W, "128", H, "72", R, "73.78", "--kernel", "keys"]).on_sim(OnSim::Nothing),
    passes("balanced Hermite", "", &[W, "128", H, "72", R, "73.78", "--kernel", "hermite-balanced"])
        .on_sim(OnSim::Nothing),
    passes("five fitted taps", "", &[W, "128", H, "72", R, "73.78", "--kernel", "sharp5"])
        .on_sim(OnSim::Nothing),
    passes("seven fitted taps", "", &[W, "128", H, "72", R, "73.78", "--kernel", "sharp7"])
        .on_sim(OnSim::Stepped),
    passes("five taps", ",taps=five", &[W, "128", H, "72", R, "73.78", "--kernel", "hermite"]),
    passes("five fitted taps on a board of five", ",taps=five", &[W, "128", H, "16", "--kernel", "sharp5"]),
    passes("8 bits", "", &[W, "128", H, "72", R, "73.78", "--bits", "8"]).on_sim(OnSim::Stepped),
    passes("10 bits", "", &[W, "128", H, "72", R, "73.78", "--bits", "10", "--kernel", "keys"]),
    passes("a board of one depth", ",depths=10", &[W, "128", H, "16", "--bits", "10"]),
    passes("RGGB", "", &[W, "128", H, "72", R, "73.78", "--phase", "rggb"]).on_sim(OnSim::Stepped),
    passes("BGGR", "", &[W, "128", H, "72", R, "73.78", "--phase", "bggr"]).on_sim(OnSim::Nothing),
    passes("GBRG", "", &[W, "128", H, "72", R, "73.78", "--phase", "gbrg"]).on_sim(OnSim::Stepped),
    passes("a centre between two columns", "", &[W, "128", H, "72", R, "73.78", "--centre-x", "40.5"]),
    passes("a centre on a column", "", &[W, "128", H, "72", R, "73.78", "--centre-x", "88"])
        .on_sim(OnSim::Stepped),
    passes("a centre at the left edge", "", &[W, "128", H, "72", R, "73.78", "--centre-x", "0"])
        .on_sim(OnSim::Stepped),
    passes("a centre above the frame", "", &[W, "128", H, "16", R, "73.78", "--centre-y", "-50"])
        .on_sim(OnSim::Stepped),
    passes("rows outside the image circle", "", &[W, "128", H, "72", R, "20"]).on_sim(OnSim::Stepped),
    passes("the smallest frame", "", &[W, "64", H, "1"]).on_sim(OnSim::Stepped),
    passes("the widest frame", ",max-width=2592", &[W, "2592", H, "8", R, "4"]),
    passes("the highest frame", "", &[W, "64", H, "2048", R, "1030", "--frame", "builtin:noise"]).slow(),
    passes(
        "the full sensor behind a grid of 4,096 entries",
        ",max-width=2592,ring=4096,entries=4096",
        SENSOR,
    ),
    passes("a ring that just holds a row", ",max-width=128,ring=128", &[W, "128", H, "72", R, "73.78"]),
    passes("blank clocks between rows", ",least-blanking=7", &[W, "128", H, "72", R, "73.78"]),
    passes("the longest pipeline", ",latency=32", &[W, "64", H, "72", R, "40"]),
    passes("the shortest pipeline", ",latency=4", &[W, "64", H, "72", R, "40"]),
    passes("two banks each way", ",row-banks-in=2,row-banks-out=2", &[W, "128", H, "72", R, "73.78"]),
    passes("a board from before bursts", ",bursts=no,entered=no", &[W, "128", H, "72", R, "73.78"]),
    passes("a board without a trap", ",bursts=untrapped", &[W, "128", H, "72", R, "73.78"]),
    passes("one bank of tables", ",table-banks=1", &[W, "128", H, "72", R, "73.78"]),
    passes("many banks", ",row-banks-in=255,row-banks-out=255", &[W, "128", H, "16"]),
    passes("more banks in than out", ",row-banks-in=16,row-banks-out=2", &[W, "128", H, "16"]),
    passes("more banks out than in", ",row-banks-in=2,row-banks-out=16", &[W, "128", H, "16"]),
    passes("a serial line", ",speed=46080", &[W, "128", H, "16"]).on(On::OwnWire).slow(),
    passes("a distant board", ",speed=1200000,delay=0.01", &[W, "128", H, "16"]).on(On::OwnWire).slow(),
    passes("a pipe without a buffer", ",buffer=0,speed=100000", &[W, "128", H, "16"]).on(On::OwnWire),
    passes("every frame three times", "", &[W, "128", H, "16", "--repeat", "3"]).on_sim(OnSim::Stepped),
    passes("ready to stop at a difference", "", &[W, "128", H, "16", "--fail-fast"]).on_sim(OnSim::Nothing),
    passes("another seed", "", &[W, "128", H, "16", "--seed", "18446744073709551615"]).on_sim(OnSim::Nothing),
];

const SENSOR: &[&str] =
    &[W, "2592", H, "1944", "--projection", "exact", "--entries", "4096", "--frame", "builtin:street"];
const W: &str = "--width";
const H: &str = "--height";
const R: &str = "--radius";
