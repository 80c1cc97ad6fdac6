//! What trying the rules costs: little of it depends on the board, and nothing on the plan.

use crate::run::prices::Prices;

/// Requests that are waited for, one after the other, on a board that has everything.
const REQUESTS: f64 = 1470.0;
/// Bytes on the wire of all packets, those there and those back.
const BYTES: f64 = 300_000.0;
/// Bytes of a row that fills an output bank, comes, and comes again.
const BYTES_A_BANK: f64 = 560.0;

/// All of them, in seconds.
pub(in crate::run) fn price(prices: &Prices<'_>) -> f64 {
    let banks = f64::from(prices.capabilities.row_banks_out);
    (REQUESTS + banks) * prices.rates.round_trip
        + (BYTES + banks * BYTES_A_BANK) / prices.rates.bytes_per_second
}
