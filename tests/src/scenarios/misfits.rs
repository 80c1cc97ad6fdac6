//! Calls that fit no board, or not this one: refused before anything is written, without a verdict.

use super::expect;
use crate::scenario::{SMALLER, Scenario};

/// Frames, tables and targets that do not go together.
pub const MISFITS: &[Scenario] = &[
    refused("a frame wider than the board", ",max-width=128", &[], "which takes 128 x 2048 at most"),
    refused(
        "a frame higher than the board",
        ",max-height=64",
        &["--width", "64", "--height", "65"],
        "64 x 65 do not fit",
    ),
    refused("a depth that the board lacks", ",depths=8+10", SMALLER, "the board has no 12-bit samples"),
    refused(
        "a kernel of seven taps on five",
        ",taps=five",
        &["--width", "128", "--height", "72", "--radius", "73.78", "--kernel", "keys"],
        "the kernel needs seven taps",
    ),
];

const fn refused(
    name: &'static str,
    options: &'static str,
    arguments: &'static [&'static str],
    sentence: &'static str,
) -> Scenario {
    expect("", 2, name, options, arguments, sentence)
}
