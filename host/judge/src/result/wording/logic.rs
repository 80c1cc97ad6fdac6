//! Words for logic that computes something else.

use super::{LOGIC, Words};
use crate::result::{ClampEnd, Instead, KernelSwitch, NamedBlanking};
use crate::words::count;

pub(super) fn tap_offset(columns: i64) -> Words {
    let side = if columns < 0 { "left" } else { "right" };
    let distance = match columns.unsigned_abs() {
        1 => "one column".to_owned(),
        more => format!("{more} columns"),
    };
    Words {
        part: "tap offset",
        place: format!("the window's read address, {distance} to the {side}"),
        defect: "every tap read from there".to_owned(),
        designer: "Check the offset between the source column and the line memory's read address.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn tap_dead(tap: &str, reads: Option<&str>) -> Words {
    let reads = reads.map_or_else(|| "stuck at 0".to_owned(), |other| format!("reading {other}"));
    let defect = format!("this tap {reads}");
    Words {
        part: "dead tap",
        place: format!("tap {tap} {reads}"),
        defect,
        designer: format!("Check the window's register of tap {tap}, and its way to the multipliers."),
        technician: LOGIC,
    }
}

pub(super) fn base_colour() -> Words {
    Words {
        part: "colour",
        place: "the base column's colour".to_owned(),
        defect: "samples of the row's other colour taken instead".to_owned(),
        designer: "Check the parity that chooses between the base columns n and n - 1.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn output_rounding() -> Words {
    Words {
        part: "rounding",
        place: "the output's rounding".to_owned(),
        defect: "the fraction of the sum dropped without adding a half (2^13)".to_owned(),
        designer: "Check the constant that is added to the weighted sum.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn weight_rounding() -> Words {
    Words {
        part: "weight rounding",
        place: "the rounding of interpolated weights".to_owned(),
        defect: "their fraction dropped without adding a half (2^7)".to_owned(),
        designer: "Check the constant that is added between two kernel nodes.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn rounding() -> Words {
    Words {
        part: "rounding",
        place: "the rounding of outputs and of interpolated weights".to_owned(),
        defect: "the fractions of both dropped without adding a half".to_owned(),
        designer: "Check the constants that are added to the weighted sum and between two kernel nodes."
            .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn weights_unsigned() -> Words {
    Words {
        part: "weights",
        place: "the sign of the kernel's weights".to_owned(),
        defect: "each weight below 0 taken as 65536 more".to_owned(),
        designer: "Check that the words of the kernel are taken as two's complement.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn weights_toward_zero() -> Words {
    Words {
        part: "weight rounding",
        place: "the rounding of interpolated weights, toward zero".to_owned(),
        defect: "the fraction of negative products between two nodes dropped toward zero instead of down"
            .to_owned(),
        designer: "Check the shift by 8 between two kernel nodes: it is arithmetic, and a division is none."
            .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn source_rounding() -> Words {
    Words {
        part: "rounding",
        place: "the rounding of source coordinates".to_owned(),
        defect: "their last bits dropped without adding a half".to_owned(),
        designer:
            "Check the constant that is added to the source coordinate S: 2^11, or 2^14 where a grid makes S."
                .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn base_column_right() -> Words {
    Words {
        part: "colour",
        place: "the side of the base column".to_owned(),
        defect: "the column right of the source as base where the one left of it has the other colour"
            .to_owned(),
        designer: "Check the choice between the base columns n and n - 1: both are left of the source."
            .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn edge_colour() -> Words {
    Words {
        part: "colour",
        place: "the samples beyond the row's ends".to_owned(),
        defect: "the nearest sample there, whatever its colour".to_owned(),
        designer:
            "Check which column stands in for one beyond the row's ends: the nearest of the same colour."
                .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn clamp(end: ClampEnd) -> Words {
    let beyond = match end {
        ClampEnd::Low => "below 0",
        ClampEnd::High => "above the largest sample",
        ClampEnd::Both => "beyond either end",
    };
    Words {
        part: "clamp",
        place: format!("the output's clamp, {beyond}"),
        defect: "such sums left to wrap".to_owned(),
        designer: "Check the comparison that clamps the output to 0 and 2^B - 1.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn centre_ignored(instead: Instead) -> Words {
    Words {
        part: "setting",
        place: "the setting of the optical centre".to_owned(),
        defect: not_taken(instead, "the middle of the row"),
        designer: "Check when the centre that CONFIGURE sets reaches the source columns.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn centre_off(halves: i32) -> Words {
    let side = if halves < 0 { "left" } else { "right" };
    let distance = match halves.unsigned_abs() {
        1 => "half a column".to_owned(),
        more => format!("{:.1} columns", f64::from(more) / 2.0),
    };
    Words {
        part: "setting",
        place: format!("the optical centre, {distance} too far to the {side}"),
        defect: format!("C {halves:+} taken instead of C, which is twice the centre's column"),
        designer: "Check where C enters the source columns: it is twice a column, and may be odd.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn depth_ignored(instead: Instead) -> Words {
    Words {
        part: "setting",
        place: "the setting of the depth".to_owned(),
        defect: not_taken(instead, "12 bits"),
        designer: "Check when the depth that CONFIGURE sets reaches the output's clamp.".to_owned(),
        technician: LOGIC,
    }
}

fn not_taken(instead: Instead, usual: &str) -> String {
    match instead {
        Instead::Usual => format!("{usual} taken instead"),
        Instead::FirstFrame => "that of the run's first frame kept".to_owned(),
        Instead::FrameBefore => "that of the frame before kept".to_owned(),
    }
}

pub(super) fn pairs_exchanged() -> Words {
    Words {
        part: "colour",
        place: "the pairs of columns".to_owned(),
        defect: "the two outputs of every pair of columns exchanged".to_owned(),
        designer: "Check the order in which samples are packed and unpacked.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn pair_bytes(first_in_front: bool) -> Words {
    let (place, defect) = if first_in_front {
        (
            "each pair's first sample in front",
            "every pair of outputs packed from the first one's highest bit on",
        )
    } else {
        ("each pair's bytes reversed", "the three bytes of every pair of outputs in reverse order")
    };
    Words {
        part: "packing",
        place: format!("the packing of corrected rows, {place}"),
        defect: defect.to_owned(),
        designer:
            "Check how ROW_OUT packs two samples: 24 bits, the first in the low 12, the lowest byte in front \
                   (protocol/WIRE.md)."
                .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn kernel_switch(KernelSwitch { row, frame, column, before, after }: KernelSwitch) -> Words {
    Words {
        part: "kernel switch",
        place: format!("the switch of the kernel's bank, within row {row} of frame {frame}"),
        defect: format!(
            "the kernel of generation {before} up to the column before {column}, and that of generation {after} from there on"
        ),
        designer: "Check that a row keeps the kernel that it entered with up to its last output: its second half leaves while the next \
                   row enters."
            .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn least_blanking(NamedBlanking { named, right }: NamedBlanking) -> Words {
    let pause = count(named, "pixel clock");
    Words {
        part: "blanking",
        place: format!("a pause of {pause} between two rows, which the board names as the least"),
        defect: format!("rows are wrong after such a pause, and right after one of {}", count(right, "pixel clock")),
        designer: "Check how many pixel clocks the datapath needs from one row to the next, and name so many in CAPABILITIES \
                   (least_blanking, for narrow rows of a grid grid_blanking)."
            .to_owned(),
        technician: LOGIC,
    }
}
