//! Words for what frames at the full pixel clock have shown, and for samples that change on their way into the core.

use super::places;
use super::{LOGIC, TIMING, Words};
use crate::result::{
    BurstCount, ClockSeen, Corner, EqualAtSpeed, Finding, FlippedBit, NoBurst, Repetition, Streamed,
};
use crate::words::{count, differ_of, grouped, hertz, span, verb};

/// What to do about frames that are wrong only at the full pixel clock.
pub(super) const CHECK_TIMING: &str =
    "Check the timing of the datapath at this clock, and its supply while every clock carries a sample.";

pub(super) fn changed_on_entry(
    (rows, first, frame): (usize, usize, u16),
    flipped: Option<FlippedBit>,
) -> Words {
    let bit = flipped_bit(flipped);
    let others = if rows > 1 { format!(", the first of {rows}") } else { String::new() };
    Words {
        part: "row's way in",
        place: format!(
            "the way of a row from its packet to the core, row {first} of frame {frame}{others}{bit}"
        ),
        defect:
            "the board's own CRC of the samples that entered the core differs from that of the samples that \
                 were sent"
                .to_owned(),
        designer: "Check the banks that rows wait in, and the unpacking of samples in front of them."
            .to_owned(),
        technician: LOGIC,
    }
}

/// `, in bit 11 of column 5`
pub(super) fn flipped_bit(flipped: Option<FlippedBit>) -> String {
    flipped
        .map_or_else(String::new, |FlippedBit { column, bit }| format!(", in bit {bit} of column {column}"))
}

pub(super) fn tables_late(rows: usize) -> Words {
    let rows = if rows == 1 { "the first row".to_owned() } else { format!("the first {rows} rows") };
    Words {
        part: "stale tables",
        place: "the change of table banks between two frames".to_owned(),
        defect: format!("{rows} of a frame made with the tables of the frame before"),
        designer:
            "Check when the switch of table banks takes effect if a frame follows another without a pause."
                .to_owned(),
        technician: TIMING,
    }
}

pub(super) fn only_at_speed(row: Option<usize>, samples: usize, bits: &[u32]) -> Words {
    let (bits, kept) = seen(row, samples, bits);
    Words {
        part: "timing",
        place: format!("a path that fails at the full pixel clock{bits}"),
        defect: format!(
            "frames that were sent row by row are right, and the same frames without a pause are not{kept}"
        ),
        designer: CHECK_TIMING.to_owned(),
        technician: TIMING,
    }
}

pub(super) fn seen_at_speed(row: Option<usize>, samples: usize, bits: &[u32]) -> Words {
    let (bits, kept) = seen(row, samples, bits);
    Words {
        part: "timing or logic",
        place: format!("a fault at full speed that may also occur row by row{bits}"),
        defect: format!("the frame that was wrong at full speed could not be compared with the same frame sent row by row{kept}"),
        designer: "If streamed frames of this size with these tables are right, check the timing of the datapath at this clock, \
                   and its supply; otherwise look for what depends on size, centre, depth and tables too."
            .to_owned(),
        technician: TIMING,
    }
}

pub(super) fn row_lost_too(row: Option<usize>, samples: usize, bits: &[u32], lost: usize) -> Words {
    let (bits, kept) = seen(row, samples, bits);
    Words {
        part: "row player or timing",
        place: format!("a fault at full speed, of a board that does not bring row {lost} back row by row either{bits}"),
        defect: format!(
            "when the frame that was wrong at full speed was sent row by row, row {lost} of it did not come back{kept}"
        ),
        designer: "Check the row banks and the row player with frames of this size, these tables and this row: the board may lose \
                   it inside, at any clock."
            .to_owned(),
        technician: TIMING,
    }
}

/// The bits in which a path was seen to fail, and the row that was kept.
fn seen(row: Option<usize>, samples: usize, bits: &[u32]) -> (String, String) {
    let Some(row) = row else { return (String::new(), String::new()) };
    (
        format!(", seen in {} of the corrected samples", places::bits(bits)),
        format!(
            "; the board kept row {row}, in which {} {}",
            count(samples, "sample"),
            verb(samples, "differ")
        ),
    )
}

/// What the board names as its clock, and what was seen of it.
pub(super) fn clock_not_as_named(clock_hz: u32, seen: ClockSeen) -> String {
    format!("the board names a pixel clock of {}, but {}", hertz(clock_hz), seen_of_clock(seen))
}

/// A finding with the settings with which it was made.
pub(super) fn in_corner(corner: Corner, found: &Finding) -> String {
    let Corner { width, height, bits, centre2, grid } = corner;
    format!(
        "with frames of {width} x {height}, {bits} bits, centre {:.1}, random {} and kernels: {}",
        f64::from(centre2) / 2.0,
        if grid { "grids, row factors" } else { "tables" },
        found.sentence()
    )
}

/// What the board counts otherwise than it should.
pub(super) fn miscounted(frame: u64, what: BurstCount, counted: u32, right: u32) -> String {
    if what == BurstCount::Records {
        return format!("the board gives {} for {} at speed", words(what, counted), count(right, "frame"));
    }
    let (counted, right) = (words(what, counted), grouped(right));
    format!("the board counts {counted} for frame {frame} at speed; the right number is {right}")
}

pub(super) fn differs(
    (wrong, frames): (u64, u64),
    first: u64,
    repetition: &Repetition,
    suspicion: Option<String>,
) -> String {
    let suspicion = suspicion.map_or_else(String::new, |suspicion| format!("; {suspicion}"));
    format!(
        "{} at speed, the first is frame {}{}{suspicion}",
        differ_of(wrong, frames, "frame"),
        grouped(first),
        shown(repetition)
    )
}

/// "138 frames at 96.0 MHz in 3.0 s, every sample equal"
pub(super) fn equal(at_speed: &EqualAtSpeed) -> String {
    let EqualAtSpeed { frames, clock_hz, seen, seconds, held_back, corners } = *at_speed;
    let clock = match clock_hz {
        0 => " without a pause".to_owned(),
        known => format!(" at {}", named_clock(known, seen)),
    };
    let time = seconds.map_or_else(String::new, |seconds| format!(" in {}", span(seconds)));
    let bounds =
        if seen == ClockSeen::default() { String::new() } else { format!("; {}", seen_of_clock(seen)) };
    let waited = match held_back {
        0 => String::new(),
        some => format!("; {some} of them waited until the records of others were read"),
    };
    let frames = count(frames, "frame");
    format!("{frames}{clock}{time}, every sample equal{bounds}{waited}{}", elsewhere(corners))
}

/// `96.0 MHz` if what was `seen` confirms it, otherwise `a claimed 96.0 MHz`.
pub(crate) fn named_clock(clock_hz: u32, seen: ClockSeen) -> String {
    let claimed = if seen.confirms(clock_hz) { "" } else { "a claimed " };
    format!("{claimed}{}", hertz(clock_hz))
}

/// `its clock was seen to be 91.2 MHz to 103.4 MHz`
pub(crate) fn seen_of_clock(seen: ClockSeen) -> String {
    let between = match (seen.least_hz, seen.most_hz) {
        (Some(least), Some(most)) if least > most => {
            return "its clock was seen not to be steady".to_owned();
        }
        (Some(least), Some(most)) => format!("{} to {}", hertz(least), hertz(most)),
        // The bound saturated: it is no measurement.
        (Some(u32::MAX), None) => "faster than any that can be measured".to_owned(),
        (Some(least), None) => format!("{} or more", hertz(least)),
        (None, Some(most)) => format!("{} or less", hertz(most)),
        (None, None) => return "nothing was seen of it".to_owned(),
    };
    format!("its clock was seen to be {between}")
}

fn elsewhere(corners: u32) -> String {
    match corners {
        0 => String::new(),
        some => format!("; also equal with {} that no streamed frame has", count(some, "setting")),
    }
}

pub(super) fn because(reason: NoBurst) -> String {
    match reason {
        NoBurst::NotAskedFor {} => "it was not asked for".to_owned(),
        NoBurst::LeftOut {} => "it was left out".to_owned(),
        NoBurst::BoardMakesNone {} => "the board makes no frames on its own".to_owned(),
        NoBurst::ContentUnknown { content, known } => {
            format!("the board makes frames of content {content}, and this program knows content {known}")
        }
    }
}

fn shown(repetition: &Repetition) -> String {
    match repetition {
        Repetition::NotNeeded {} => String::new(),
        Repetition::NoTrap {} => ", of which the board kept no row".to_owned(),
        Repetition::AllRight { frames } => {
            format!("; repeated by itself, it was right {}", count(*frames, "time"))
        }
        Repetition::Trapped { frames, row, only_there, streamed, .. } => {
            let streamed = match streamed {
                Streamed::NotTried => String::new(),
                Streamed::Right => "; sent row by row, the same frame is right".to_owned(),
                Streamed::Wrong => "; sent row by row, the same frame is wrong as well".to_owned(),
                Streamed::RowLost { row } => format!("; sent row by row, row {row} of it did not come back"),
            };
            let kept = if *only_there { "; the board kept" } else { ", first in" };
            format!("; {}{kept} row {row}{streamed}", wrong_there(*frames, *only_there))
        }
        Repetition::NothingTrapped { frames, only_there } => {
            format!("; {}, but the board kept no row that differs", wrong_there(*frames, *only_there))
        }
        Repetition::NoSuchRow { frames, only_there } => format!(
            "; {}, and the row that the board kept cannot be one of this burst",
            wrong_there(*frames, *only_there)
        ),
        Repetition::SignedWrong { frames, row, only_there } => format!(
            "; {}, and the board kept row {row}, whose samples are right and whose signature is not their CRC",
            wrong_there(*frames, *only_there)
        ),
        Repetition::Impossible {} => "; it could not be repeated".to_owned(),
    }
}

/// That a frame was wrong at try `frames`. If it was wrong `only_there`, this is no second occurrence.
fn wrong_there(frames: u32, only_there: bool) -> String {
    match (only_there, frames.saturating_sub(1)) {
        (false, _) => format!("repeated, it was wrong again at try {frames}"),
        (true, 0) => "it was the first of its burst".to_owned(),
        (true, right) => format!("the same frame had been right {} before", count(right, "time")),
    }
}

/// What was counted, with its number.
fn words(what: BurstCount, counted: u32) -> String {
    match what {
        BurstCount::Samples => count(counted, "sample"),
        BurstCount::Rows => count(counted, "row"),
        BurstCount::LeastLatency => format!("a minimum latency of {}", count(counted, "pixel clock")),
        BurstCount::MostLatency => format!("a maximum latency of {}", count(counted, "pixel clock")),
        BurstCount::Generation => format!("generation {}", grouped(counted)),
        BurstCount::Records => count(counted, "record"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_count_is_told_as_no_measurement() {
        let seen = |least| seen_of_clock(ClockSeen { least_hz: Some(least), most_hz: None });
        assert_eq!(seen(103_400_000), "its clock was seen to be 103.4 MHz or more");
        assert_eq!(seen(u32::MAX), "its clock was seen to be faster than any that can be measured");
    }
}
