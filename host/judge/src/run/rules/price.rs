//! What trying the rules costs: next to nothing of it depends on the board or the plan.

use crate::run::prices::Prices;

/// Requests that are waited for, one after the other, on a board that has everything.
const REQUESTS: f64 = 1460.0;
/// Bytes on the wire of all packets, those there and those back.
const BYTES: f64 = 259_000.0;

/// All of them, in seconds.
pub(in crate::run) fn price(prices: &Prices<'_>) -> f64 {
    REQUESTS * prices.rates.round_trip + BYTES / prices.rates.bytes_per_second
}
