//! What no frame exercised.

use super::at_speed::seen_of_clock;
use super::places::{named, numbered};
use crate::result::NotExercised;
use crate::words::{hertz, span};

const CAMERA_PINS: &str = "the camera's connector and the pins to the image processor, because frames enter and leave \
                           inside the FPGA";

/// The part in words, to complete the sentence "not exercised: …".
#[must_use]
#[expect(clippy::too_many_lines, reason = "one arm a code")]
pub fn not_exercised(part: &NotExercised) -> String {
    match part {
        NotExercised::InputBits { bits } => format!("{} of the samples going in", numbered("bit", bits)),
        NotExercised::OutputBits { bits } => format!("{} of the corrected samples", numbered("bit", bits)),
        NotExercised::ColumnAddress { lines } => format!("{} of columns", addresses(lines)),
        NotExercised::LineMemoryAddress { lines } => format!("{} of the line memory", addresses(lines)),
        NotExercised::RowTableAddress { lines } => format!("{} of the row table", addresses(lines)),
        NotExercised::RowFactorBits { bits } => format!("{} of the row factors", numbered("bit", bits)),
        NotExercised::KernelNodes { nodes } => format!("kernel {}", numbered("node", nodes)),
        NotExercised::Taps { taps } => named("tap", taps.len(), &taps.join(", ")),
        NotExercised::OneCentre { centre2 } => {
            format!("every optical centre other than column {:.1}", f64::from(*centre2) / 2.0)
        }
        NotExercised::CentreBits { bits } => {
            format!("{} of the optical centre's setting", numbered("bit", bits))
        }
        NotExercised::FullSpeed {} => "frames at the full pixel clock without a pause".to_owned(),
        NotExercised::TableChangeAtSpeed {} => {
            "a change of tables between two frames at the full pixel clock".to_owned()
        }
        NotExercised::NamedClock { clock_hz, seen } => {
            format!("{}, since {}", clock(*clock_hz), seen_of_clock(*seen))
        }
        NotExercised::UnseenClock { clock_hz } => {
            format!("{}, which was not measured", clock(*clock_hz))
        }
        NotExercised::Rules {} => "the protocol rules (what the board must refuse, keep and end)".to_owned(),
        NotExercised::Grids {} => "correction grids (datapath 2)".to_owned(),
        NotExercised::FurtherRecords { filled } => {
            format!("records of bursts after the first {filled}")
        }
        NotExercised::CountersOfPoorLinks {} => {
            "counters that a poor link changes too, because the board counts damaged packets, or another number of \
             packets than were sent".to_owned()
        }
        NotExercised::SameBoard {} => {
            "whether the board that came back is the one that went away, because it has no serial number".to_owned()
        }
        NotExercised::IdleTime { seconds } => {
            format!("{} of the soak, in which no frames were made", span(*seconds as f64))
        }
        NotExercised::CameraPins {} => CAMERA_PINS.to_owned(),
        NotExercised::Depths { bits } => depths(bits),
    }
}

/// `the pixel clock of 96.0 MHz that the board names`
fn clock(clock_hz: u32) -> String {
    format!("the pixel clock of {} that the board names", hertz(clock_hz))
}

/// `samples of 8 or 10 bits`
fn depths(bits: &[u32]) -> String {
    let depths: Vec<_> = bits.iter().map(u32::to_string).collect();
    format!("samples of {} bits", depths.join(" or "))
}

/// `address line 7`, `address lines 0 to 3, 7`
fn addresses(lines: &[usize]) -> String {
    numbered("address line", lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_follow_each_other_are_drawn_together() {
        let words = |lines: &[usize]| not_exercised(&NotExercised::RowTableAddress { lines: lines.into() });
        assert_eq!(words(&[4]), "address line 4 of the row table");
        assert_eq!(words(&[0, 4, 5, 6, 10]), "address lines 0, 4 to 6, 10 of the row table");
    }

    #[test]
    fn a_depth_and_a_centre_are_said_in_their_units() {
        let words = [
            not_exercised(&NotExercised::Depths { bits: vec![8, 10] }),
            not_exercised(&NotExercised::OneCentre { centre2: 1919 }),
        ];
        assert_eq!(words, ["samples of 8 or 10 bits", "every optical centre other than column 959.5"]);
    }
}
