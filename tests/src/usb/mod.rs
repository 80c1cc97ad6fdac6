//! Mock boards behind USB chips, in a kernel that `scripts/in-linux` boots.

mod qemu;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use halfrow::target::Target;
use halfrow_ft2232h::{ChannelMode, Chip, ChipOptions, Eeprom, FarEnd, Plugged, Unplugged};
use halfrow_mock::Board;
use halfrow_pipe::Pipe;

use crate::patience::wait_until;
use crate::program::{Ended, halfrow};
use crate::scenario::Scenario;
use crate::scenarios::{BROKEN_BOARDS, MISFITS, SOUND_BOARDS};

pub use qemu::{QEMU_CHIP, QemuBoard, QemuChipOut};

/// How many bytes a board has sent to its host.
#[derive(Clone, Debug, Default)]
pub struct BytesSent(Arc<AtomicU64>);

impl BytesSent {
    /// More than the handshake, tables and echoes of a small run: rows flow.
    const ROWS: u64 = 100_000;

    /// Waits until rows flow, in a run that is long enough for that.
    ///
    /// # Panics
    /// If they never do.
    pub fn wait_for_rows(&self) {
        wait_until("rows to flow", || self.0.load(Ordering::Relaxed) > Self::ROWS);
    }
}

/// A mock board at a chip's pins. Its wire's clock follows real time.
struct MockAtChip {
    pipe: Pipe<Board>,
    said: BytesSent,
}

impl MockAtChip {
    /// The mock board that `options`, like those of a target, describe.
    fn new(options: &str) -> Self {
        let target: Target = format!("mock{options}").parse().unwrap();
        let options: Vec<_> =
            target.options.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        Self { pipe: halfrow_mock::connect(&options).unwrap(), said: BytesSent::default() }
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
            let wait = now.saturating_sub(self.pipe.now());
            // A wire that breaks counts as a pulled plug.
            let moved = self.pipe.exchange(&to_board[taken..], to_host, wait).map_err(|_| Unplugged)?;
            taken += moved;
            self.said.0.fetch_add((to_host.len() - before) as u64, Ordering::Relaxed);
            if moved == 0 && to_host.len() == before {
                return Ok(taken);
            }
        }
    }
}

/// A chip with the mock board that `options`, like those of a target, describe.
///
/// # Panics
/// If there is no such board.
#[must_use]
pub fn chip(chip: ChipOptions, options: &str) -> Chip {
    Chip::new(chip, Box::new(MockAtChip::new(options)))
}

/// A plugged-in FIFO chip with the mock board that `options` describe.
///
/// # Panics
/// If there is no such board, or no port for it.
#[must_use]
pub fn plug(options: &str) -> Plugged {
    plug_and_watch(options).0
}

/// Like [`plug`], with the count of what it sends.
///
/// # Panics
/// Like [`plug`].
#[must_use]
pub fn plug_and_watch(options: &str) -> (Plugged, BytesSent) {
    let board = MockAtChip::new(options);
    let said = board.said.clone();
    let chip = Chip::new(ChipOptions::default(), Box::new(board));
    (Plugged::new(chip, 0).unwrap(), said)
}

/// A chip whose channel B is a UART.
#[must_use]
pub fn uart() -> ChipOptions {
    ChipOptions { eeprom: Eeprom::new(ChannelMode::Uart, ChannelMode::Uart), ..ChipOptions::default() }
}

/// The serial port that the kernel's driver makes of a channel, 0 for A; waits for it.
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

/// Judges the board at `target` with small frames.
#[must_use]
pub fn verify(target: &str) -> Ended {
    halfrow(["verify", "--json", "--board", target, "--width", "128", "--height", "16"])
}

/// The scenarios about a board that are not of the paper's size. None is about a link: QEMU's chip stays plugged in when the link
/// behind it breaks.
pub fn of_boards() -> impl Iterator<Item = &'static Scenario> {
    [SOUND_BOARDS, &BROKEN_BOARDS, MISFITS].into_iter().flatten().filter(|scenario| scenario.has_own_size())
}

/// Whether a scenario takes a few seconds only.
#[must_use]
pub fn is_quick(scenario: &&Scenario) -> bool {
    scenario.has_own_size() && !scenario.is_slow
}

/// Runs each of `scenarios` on its own board, which `plug` makes by its options and `target` names, and prints how long each
/// took.
///
/// # Panics
/// When one of them does not end as expected, or there is none.
#[allow(clippy::print_stdout)]
pub fn run_all<'a, B>(
    scenarios: impl IntoIterator<Item = &'a Scenario>,
    plug: impl Fn(&str) -> B,
    target: impl Fn(&B) -> String,
) {
    let mut scenarios = scenarios.into_iter().peekable();
    assert!(scenarios.peek().is_some(), "no scenario would pass for all of them");
    let mut surprises = Vec::new();
    for scenario in scenarios {
        let begun = Instant::now();
        let board = plug(scenario.options);
        let target = target(&board);
        surprises.extend(scenario.judge(&target, &format!("mock behind {target}: ")).err());
        println!("{:6.1} s  {}", begun.elapsed().as_secs_f64(), scenario.name);
    }
    let surprises: Vec<_> = surprises.iter().map(ToString::to_string).collect();
    assert!(surprises.is_empty(), "{}", surprises.join("\n"));
}
