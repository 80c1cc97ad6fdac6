//! The price of trying the rules. It depends on the board's capabilities, not on the plan.

use crate::run::at_speed::known_bursts;
use crate::run::plan::prices::Prices;

/// What a group of rules takes.
struct Cost {
    /// Requests that are waited for, one after the other.
    requests: f64,
    /// Bytes on the wire of all packets, in both directions.
    bytes: f64,
}

/// For every board.
const ALWAYS: Cost = Cost { requests: 1040.0, bytes: 190_500.0 };
/// For bursts.
const BURSTS: Cost = Cost { requests: 458.0, bytes: 123_500.0 };
/// For the trap.
const TRAP: Cost = Cost { requests: 171.0, bytes: 28_000.0 };
/// For each output bank: a row that fills it, comes back, and comes back again.
const BANK: Cost = Cost { requests: 1.0, bytes: 560.0 };

/// The price of all rules, in seconds.
pub(in crate::run) fn price(prices: &Prices<'_>) -> f64 {
    let capabilities = prices.capabilities;
    let bursts = known_bursts(capabilities).ok();
    let parts = [
        (ALWAYS, 1),
        (BURSTS, bursts.is_some().into()),
        (TRAP, bursts.is_some_and(|bursts| bursts.trap).into()),
        (BANK, capabilities.row_banks_out),
    ];
    let seconds = |(Cost { requests, bytes }, times)| {
        f64::from(times) * (requests * prices.rates.round_trip + bytes / prices.rates.bytes_per_second)
    };
    parts.into_iter().map(seconds).sum()
}
