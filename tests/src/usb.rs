//! Mock boards behind chips on the USB of a kernel that `scripts/in-linux` boots.

mod qemu;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use halfrow::target::Target;
use halfrow_ft2232h::{ChannelMode, Chip, ChipOptions, Eeprom, FarEnd, Plugged, Unplugged};
use halfrow_mock::Wire;

use crate::program::{Ended, error_sentence, halfrow};
use crate::scenario::Scenario;

pub use qemu::{QEMU_CHIP, QemuBoard, plug_qemu_chip, unplug_qemu_chip};

/// What cannot be seen in fewer pixels than the paper's.
const FULL_SIZE: &[&str] = &[
    "the paper's system",
    "the paper's system with seven taps",
    "the highest address line",
    "a pipeline that is too long",
    "a false claim of latency",
    "the last row lost",
    "a table that drifts at the very end",
    "a row factor in the only bank",
    "a frame wider than the board",
];

/// What takes ten seconds and more.
const SLOW: &[&str] = &["the highest frame", "a serial line", "a distant board"];

/// A mock board at a chip's pins. Its wire's clock is kept at the real time.
struct MockAtChip(Wire);

impl MockAtChip {
    /// The mock board that `options`, as of a target, describe.
    fn new(options: &str) -> Self {
        let target: Target = format!("mock{options}").parse().unwrap();
        let options: Vec<_> =
            target.options.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        Self(Wire::from_options(&options).unwrap())
    }
}

impl FarEnd for MockAtChip {
    fn exchange(
        &mut self,
        to_board: &[u8],
        to_host: &mut Vec<u8>,
        now: Duration,
    ) -> Result<usize, Unplugged> {
        let mut taken = 0;
        loop {
            let before = to_host.len();
            let wait = now.saturating_sub(self.0.now());
            // A wire that breaks is a plug that is pulled.
            let moved = self.0.exchange(&to_board[taken..], to_host, wait).map_err(|_| Unplugged)?;
            taken += moved;
            if moved == 0 && to_host.len() == before {
                return Ok(taken);
            }
        }
    }
}

/// A chip with the mock board that `options`, as of a target, describe.
///
/// # Panics
/// If there is no such board.
#[must_use]
pub fn chip(chip: ChipOptions, options: &str) -> Chip {
    Chip::new(chip, Box::new(MockAtChip::new(options)))
}

/// The mock board that `options` describe behind a FIFO, plugged in.
///
/// # Panics
/// If there is no such board, or no port for it.
#[must_use]
pub fn plug(options: &str) -> Plugged {
    Plugged::new(chip(ChipOptions::default(), options), 0).unwrap()
}

/// A chip whose channel B is a UART.
#[must_use]
pub fn uart() -> ChipOptions {
    ChipOptions { eeprom: Eeprom::new(ChannelMode::Uart, ChannelMode::Uart), ..ChipOptions::default() }
}

/// The serial port that the kernel's driver makes of a channel, 0 for A, once it is there.
///
/// # Panics
/// If the driver makes none.
#[must_use]
pub fn serial_port(board: &Plugged, channel: u8) -> PathBuf {
    let interface = format!("/sys/bus/usb/devices/{}:1.{channel}", board.bus_name());
    let port = || {
        let entries = fs::read_dir(&interface).into_iter().flatten().flatten();
        let mut names = entries.map(|entry| Path::new("/dev").join(entry.file_name()));
        names.find(|path| path.to_string_lossy().contains("ttyUSB") && path.exists())
    };
    wait_until("the driver's serial port", || port().is_some());
    port().unwrap()
}

/// Judges the board `target` with a small frame.
#[must_use]
pub fn verify(target: &str) -> Ended {
    halfrow(["verify", "--json", "--board", target, "--width", "128", "--height", "16"])
}

/// What the run, or the call that was refused, says.
#[must_use]
pub fn sentence(ended: &Ended) -> String {
    let said = ended.json();
    said["headline"].as_str().map_or_else(|| error_sentence(&said), str::to_owned)
}

/// Whether a scenario comes out the same in 128 x 72 pixels.
#[must_use]
pub fn is_small(scenario: &&Scenario) -> bool {
    !FULL_SIZE.contains(&scenario.name)
}

/// Whether it also takes a few seconds only.
#[must_use]
pub fn is_quick(scenario: &&Scenario) -> bool {
    is_small(scenario) && !SLOW.contains(&scenario.name)
}

/// Runs each of `scenarios` on a board of its own, which `plug` makes of its options and `target` names, with fewer pixels if
/// that is `smaller`, and prints how long each took.
///
/// # Panics
/// When one of them comes to anything else than it should.
pub fn run_all<'a, B>(
    scenarios: impl IntoIterator<Item = &'a Scenario>,
    target: &str,
    smaller: bool,
    plug: impl Fn(&str) -> B,
) {
    let mut surprises = Vec::new();
    for scenario in scenarios {
        let begun = Instant::now();
        let _board = plug(scenario.options);
        surprises.extend(scenario.judge(target, &format!("mock behind {target}: "), smaller).err());
        println!("{:6.1} s  {}", begun.elapsed().as_secs_f64(), scenario.name);
    }
    let surprises: Vec<_> = surprises.iter().map(ToString::to_string).collect();
    assert!(surprises.is_empty(), "{}", surprises.join("\n"));
}

/// Waits until `is_done`.
///
/// # Panics
/// When that takes longer than anything in such a kernel should.
pub fn wait_until(what: &str, is_done: impl Fn() -> bool) {
    let begun = Instant::now();
    while !is_done() {
        assert!(begun.elapsed() < Duration::from_secs(20), "still waiting: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
