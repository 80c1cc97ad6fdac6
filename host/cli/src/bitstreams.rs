//! The boards for which this project has bitstreams: what `halfrow boards` lists about them, and what loads them.

use serde::Serialize;

/// A board of `fpga/boards`.
#[derive(Debug, Serialize)]
pub(crate) struct BitstreamBoard {
    /// The name of its folder in `fpga/boards`.
    pub(crate) name: &'static str,
    /// Its FPGA.
    pub(crate) device: &'static str,
    /// The kinds of target that reach it, as in `--board`.
    pub(crate) links: &'static [&'static str],
    /// The command that makes its bitstreams, to be run in the project's folder.
    pub(crate) build: &'static str,
    /// The file that it makes and that is loaded, in the project's folder.
    pub(crate) bitstream: &'static str,
    /// The target with which the board is judged when it is loaded; `PATH` stands for the path of a serial port.
    pub(crate) target: &'static str,
    /// The board's name in openFPGALoader.
    pub(crate) loader_name: &'static str,
    /// Another program that loads it, for users without openFPGALoader; without the file's name.
    pub(crate) other_loader: &'static str,
}

/// All boards. The loader's names are those of openFPGALoader 0.10 (`--list-boards`).
pub(crate) const BOARDS: [BitstreamBoard; 2] = [
    BitstreamBoard {
        name: "minispartan6plus",
        device: "XC6SLX25-3-FTG256",
        links: &["usb", "serial"],
        build: "fpga/boards/minispartan6plus/build fifo|uart [sensor]",
        bitstream: "target/minispartan6plus/fifo/top.bit",
        target: "usb",
        loader_name: "minispartan6",
        other_loader: "xc3sprog -c ftdi",
    },
    BitstreamBoard {
        name: "ulx3s",
        device: "LFE5U-12F, 25F, 45F or 85F, CABGA381",
        links: &["serial", "usb"],
        build: "fpga/boards/ulx3s/build uart|fifo [sensor] [--device 12|25|45|85]",
        bitstream: "target/ulx3s/uart-25/top.bit",
        target: "serial:PATH,board=ulx3s",
        loader_name: "ulx3s",
        other_loader: "fujprog",
    },
];

impl BitstreamBoard {
    /// The board of that name.
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        BOARDS.iter().find(|board| board.name == name)
    }

    /// All names, for a sentence.
    pub(crate) fn names() -> String {
        BOARDS.map(|board| board.name).join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_board_is_judged_at_a_target_that_can_be_opened() {
        for board in &BOARDS {
            let target = board.target.replace("PATH", "/dev/ttyUSB99").parse().unwrap();
            halfrow::link::check(&target).unwrap_or_else(|error| panic!("{}: {error}", board.name));
        }
    }
}
