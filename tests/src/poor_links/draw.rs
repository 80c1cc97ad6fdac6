//! Which links and boards a campaign tries.

use std::time::Duration;

use super::{Case, Way};
use crate::dice::Dice;
use crate::proxy::Suffers;
use crate::system::System;

/// The longest packet on the wire, so that no packet is stalled more than twice.
const LONGEST_PACKET: usize = 4200;

/// Stalls that a host must outlast: four of the longest fit into its patience for one answer, two each way.
pub(super) const SHORT_STALLS: &str = "short stalls";
const LONG_STALLS: &str = "long stalls";
const LOSSES: &str = "whole packets";

/// Faults that occur at a rate.
const AT_A_RATE: [&str; 7] = ["flip", "drop", "duplicate", "reorder", "truncate", "stall", "disconnect"];

/// The paper's width and a few rows: the longest rows, and still short runs.
const WIDE: System = System { height: 4, ..System::PAPER };
/// Some seventy rows.
const MIDDLE: System = System { width: 128, height: 72, radius: 73.78, board: "mock", ring: 2048 };

/// The cases of `indexes` in the campaign of `seed`, each by `draw_one`. Each is drawn independently, so that a campaign can go
/// on from anywhere.
#[must_use]
pub fn draw(
    seed: u64,
    indexes: std::ops::Range<usize>,
    draw_one: fn(&mut Dice) -> (&'static str, Way, System),
) -> Vec<Case> {
    let one = |index: usize| {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(index as u64);
        let mut dice = Dice::new(seed);
        let (kind, way, system) = draw_one(&mut dice);
        let broken = match (index % 2, dice.below(3)) {
            (0, _) => String::new(),
            (_, 0) => format!(",fault=lost-row,row={}", dice.below(system.height)),
            _ => ",fault=no-rounding".to_owned(),
        };
        Case { index, kind, way, system, broken, seed }
    };
    indexes.map(one).collect()
}

/// A run on the virtual clock: small frames up to full ones, and any link.
pub fn virtual_(dice: &mut Dice) -> (&'static str, Way, System) {
    let system = match dice.below(400) {
        0 => System::PAPER,
        1..20 => WIDE,
        20..60 => MIDDLE,
        _ => System::TINY,
    };
    let toward = dice.one_of(&["board", "host", "both"]);
    let seed = dice.below(1 << 31);
    // From the bytes of one row to those of some rows.
    let row = system.width * 3 / 2 + 40;
    let every = row + dice.below(12 * row);
    let (kind, fault) = match dice.below(4) {
        0 => {
            let (every, seconds) = (LONGEST_PACKET + every, dice.magnitude(-2.0, 0.4));
            (SHORT_STALLS, format!("stall,every={every},seconds={seconds}"))
        }
        1 => (LONG_STALLS, format!("stall,every={every},seconds={}", dice.magnitude(-1.0, 1.5))),
        2 => {
            let (size, rate) = (30 + dice.below(row), dice.magnitude(-3.0, 0.0));
            (LOSSES, format!("lose,size={size},rate={rate:e}"))
        }
        _ => {
            let name = dice.one_of(&AT_A_RATE);
            let seconds = match name {
                "stall" => format!(",seconds={}", dice.magnitude(-3.0, 1.0)),
                _ => String::new(),
            };
            (name, format!("{name},rate={:e}{seconds}", dice.magnitude(-6.0, -2.0)))
        }
    };
    (kind, Way::Virtual(format!(",fault={fault},toward={toward},seed={seed}")), system)
}

/// A run in real time: over a pseudo-terminal or through a proxy.
pub fn real(dice: &mut Dice) -> (&'static str, Way, System) {
    real_up_to(dice, 0.4, -0.3)
}

/// Like [`real`], over links on which nothing takes long.
pub fn real_and_short(dice: &mut Dice) -> (&'static str, Way, System) {
    real_up_to(dice, -0.7, -1.5)
}

/// A run in real time with stalls up to 10^`longest` seconds and losses at a rate up to 10^`most`.
fn real_up_to(dice: &mut Dice, longest: f64, most: f64) -> (&'static str, Way, System) {
    let system = System::TINY;
    let every = LONGEST_PACKET + dice.below(20_000);
    let seconds = dice.magnitude(-1.3, longest);
    let (least, rate) = (30 + dice.below(200), dice.magnitude(-2.5, most));
    let toward = dice.below(3);
    let kind = dice.one_of(&[SHORT_STALLS, LOSSES]);
    if dice.below(2) == 0 {
        let fault = match kind {
            SHORT_STALLS => format!("stall,every={every},seconds={seconds}"),
            _ => format!("lose,size={least},rate={rate}"),
        };
        let (toward, seed) = (["board", "host", "both"][toward], dice.below(1 << 31));
        return (kind, Way::SerialPort(format!(",fault={fault},toward={toward},seed={seed}")), system);
    }
    let time = Duration::from_secs_f64(seconds);
    let repeats = Suffers::Repeats { later: 1 + dice.below(40), rate: rate / 10.0 };
    let (kind, suffers) = match (kind, dice.below(2)) {
        (SHORT_STALLS, both) => (kind, Suffers::Stalls { every, time, both: both > 0 }),
        (_, 0) => (kind, Suffers::Loses { least, rate }),
        _ => ("late copies", repeats),
    };
    let unless = |other| if toward == other { Suffers::Nothing } else { suffers };
    (kind, Way::Tcp { to_board: unless(1), to_host: unless(0) }, system)
}
