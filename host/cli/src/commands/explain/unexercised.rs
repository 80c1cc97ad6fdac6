//! What to do about what a PASS leaves open.

use halfrow::result::NotExercised;

/// Why nobody is to blame for a part that stays untested.
pub(super) const fn fault(part: &NotExercised) -> &'static str {
    match part {
        NotExercised::CameraPins {} => "nobody's: no run can test it",
        NotExercised::SameBoard {} => "nobody's: the run could not tell it",
        _ => "nobody's: the run did not test it",
    }
}

/// What to do to have it tested, or what to know where no run tests it.
#[expect(clippy::too_many_lines, reason = "one arm a code")]
pub(super) const fn act(part: &NotExercised) -> &'static str {
    match part {
        NotExercised::InputBits { .. }
        | NotExercised::OutputBits { .. }
        | NotExercised::OneCentre { .. }
        | NotExercised::CentreBits { .. }
        | NotExercised::Depths { .. } => {
            "Stream all built-in frames, without --tables, --centre-x and --bits, so that the run varies centre and depth, and \
             leave the frames at speed in."
        }
        NotExercised::ColumnAddress { .. } => {
            "Judge frames as wide as the board takes, or leave the frames at speed in: some of these are as wide."
        }
        NotExercised::LineMemoryAddress { .. }
        | NotExercised::RowTableAddress { .. }
        | NotExercised::RowFactorBits { .. }
        | NotExercised::KernelNodes { .. } => {
            "Judge larger frames, or tables of a lens that bends more, and leave the frames at speed in."
        }
        NotExercised::Taps { .. } => {
            "Judge a kernel that uses these taps, such as sharp7 on a board with seven of them, or leave the frames at speed in."
        }
        NotExercised::FullSpeed {} => {
            "Leave the frames at speed in: no `--at-speed 0`, no --within. A board that makes no frames on its own, or pauses in \
             them, cannot be tested so."
        }
        NotExercised::TableChangeAtSpeed {} => {
            "Judge two frames at speed or more, with tables of a lens that bends their first row, or of a grid that leaves room \
             for a decoy; a board with one bank of tables cannot be tested so."
        }
        NotExercised::NamedClock { .. } => {
            "Check the clock that is fed to the board and the one that its capabilities name, then run again with more \
             seconds at speed (--at-speed)."
        }
        NotExercised::UnseenClock { .. } => {
            "Run `halfrow verify` with its frames at speed left in: a soak measures no clock. If a physical board says that its \
             clock is the host's, correct what it says of itself (tag 0e of CAPABILITIES in protocol/WIRE.md)."
        }
        NotExercised::Rules {} => "Run `halfrow verify` without --within: a soak leaves the rules out.",
        NotExercised::Grids {} => {
            "Judge tables of a grid (`--projection exact`), or leave the frames at speed in: some of these have grids."
        }
        NotExercised::FurtherRecords { .. } => {
            "Nothing: no run fills more records, since a slow board would make its user wait."
        }
        NotExercised::CountersOfPoorLinks {} => {
            "Test the cable alone with `halfrow link`, then run again over a link that damages and loses nothing."
        }
        NotExercised::SameBoard {} => {
            "Make sure that nobody changed the board while it was away, or run again without a break; build an ECP5 with \
             `--serial` to give it a serial number."
        }
        NotExercised::IdleTime { .. } => {
            "Keep this computer awake (`systemd-inhibit`) and the program running, look at the report for times when the board was \
             away, and run again."
        }
        NotExercised::CameraPins {} => {
            "Look at lamps 3 to 6 and at the picture with a camera connected, as docs/first-board.md says: the frames of a \
             run enter and leave inside the FPGA."
        }
    }
}
