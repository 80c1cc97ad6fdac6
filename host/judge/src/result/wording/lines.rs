//! Words for stuck lines, as the samples show them.

use super::places::bits;
use super::{LOGIC, MEMORY, Words, stuck};
use crate::result::{ColumnParity, Counting, LineFault, SampleBus, SampleLines};

pub(super) fn line_memory_data(bit: u32, value: u8) -> Words {
    Words {
        part: "data bit",
        place: format!("line memory, data bit {bit} {}", stuck(value)),
        defect: format!("bit {bit} of every stored sample forced to {value}"),
        designer: format!("Check data line {bit} of the line memory, and the samples' way into it."),
        technician: MEMORY,
    }
}

pub(super) fn output_data(bit: u32, value: u8) -> Words {
    Words {
        part: "output bit",
        place: format!("corrected samples, bit {bit} {}", stuck(value)),
        defect: format!("bit {bit} of every output forced to {value}"),
        designer: format!("Check data line {bit} from the datapath's output to the bank of corrected rows."),
        technician: MEMORY,
    }
}

pub(super) fn of_samples(SampleLines { bus, fault, bits: numbers, columns }: &SampleLines) -> Words {
    let columns = match columns {
        None => "",
        Some(ColumnParity::Even) => " in even columns alone",
        Some(ColumnParity::Odd) => " in odd columns alone",
    };
    let (state, technician) = match fault {
        LineFault::StuckLow => ("stuck at 0", MEMORY),
        LineFault::StuckHigh => ("stuck at 1", MEMORY),
        LineFault::Inverted => ("inverted", LOGIC),
        LineFault::Exchanged => ("exchanged", LOGIC),
        LineFault::JoinedLow => ("connected, where 0 wins", MEMORY),
        LineFault::JoinedHigh => ("connected, where 1 wins", MEMORY),
    };
    let (place, way) = match bus {
        SampleBus::LineMemory => ("line memory", "the samples' way into the line memory and out of it"),
        SampleBus::Output => {
            ("corrected samples", "the way from the datapath's output to the bank of corrected rows")
        }
        SampleBus::BytesIn => ("the bytes of rows on their way in", "the way from the packets to the core"),
        SampleBus::BytesOut => {
            ("the bytes of rows on their way out", "the way from the banks of corrected rows to the packets")
        }
    };
    let lines = bits(numbers);
    Words {
        part: "data lines",
        place: format!("{place}, {lines} {state}{columns}"),
        defect: format!("{lines} {state}{columns}"),
        designer: format!("Check {lines} on {way}: names, pins, and what the columns share."),
        technician,
    }
}

pub(super) fn line_memory_address(bit: u32, counting: Counting) -> Words {
    let counted = match counting {
        Counting::Run => "",
        Counting::Frame => " and addresses counted from each frame's start",
        Counting::Row => " and addresses counted from each row's start",
        Counting::Before => " and the ring's count begun before this run",
    };
    Words {
        part: "address bit",
        place: format!("line memory, address bit {bit}"),
        defect: format!("this line stuck at 0 or at 1{counted}"),
        designer: format!("Check address line {bit} of the line memory, and the counters that drive it."),
        technician: MEMORY,
    }
}

pub(super) fn centre_bit(bit: u32, value: u8) -> Words {
    Words {
        part: "setting",
        place: format!("the setting of the optical centre, bit {bit} {}", stuck(value)),
        defect: format!("bit {bit} of twice the centre's column forced to {value}"),
        designer: format!(
            "Check bit {bit} of the register that holds the centre, and its way to a row's start."
        ),
        technician: MEMORY,
    }
}

pub(super) fn row_table_data(bit: u32, value: u8) -> Words {
    Words {
        part: "row table data",
        place: format!("row table, data bit {bit} {}", stuck(value)),
        defect: format!("bit {bit} of every entry forced to {value}"),
        designer: format!("Check data line {bit} of the row table's memory."),
        technician: MEMORY,
    }
}

pub(super) fn row_table_address(bit: u32, value: u8) -> Words {
    Words {
        part: "row table address",
        place: format!("row table, address bit {bit} {}", stuck(value)),
        defect: format!("every entry read at its own number with bit {bit} forced to {value}"),
        designer: format!("Check address line {bit} of the row table's memory."),
        technician: MEMORY,
    }
}

pub(super) fn row_table_off(entries: isize) -> Words {
    let (side, way) = if entries < 0 { ("before", "behind") } else { ("after", "ahead") };
    Words {
        part: "row table address",
        place: format!("the row table's address, one entry {way}"),
        defect: format!("every entry read as the one {side} it"),
        designer: "Check when the counter that addresses the row table moves on.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn kernel_address(bit: u32, value: u8) -> Words {
    Words {
        part: "kernel address",
        place: format!("kernel memory, address bit {bit} {}", stuck(value)),
        defect: format!("every node read at its own number with bit {bit} forced to {value}"),
        designer: format!("Check address line {bit} of the kernel's memory."),
        technician: MEMORY,
    }
}

pub(super) fn kernel_off(nodes: isize) -> Words {
    let (side, way) = if nodes < 0 { ("before", "behind") } else { ("after", "ahead") };
    Words {
        part: "kernel address",
        place: format!("the kernel's address, one node {way}"),
        defect: format!("every node read as the one {side} it"),
        designer: "Check between which nodes the weights are interpolated: node i and node i + 1.".to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn kernel_data(weight: &str, bit: u32, value: u8) -> Words {
    Words {
        part: "kernel data",
        place: format!("kernel memory, weight {weight}, data bit {bit} {}", stuck(value)),
        defect: format!("bit {bit} of {weight} forced to {value} in every node"),
        designer: format!("Check data line {bit} of the memory that holds weight {weight}."),
        technician: MEMORY,
    }
}
