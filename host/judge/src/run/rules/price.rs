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
const ALWAYS: Cost = Cost { requests: 1048.0, bytes: 192_300.0 };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::grouped;

    /// The page gives requests in tens, and bytes in tens of kilobytes.
    #[test]
    fn the_page_of_the_rules_names_their_price() {
        let page = include_str!("../../../../../docs/rules.md");
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        let told = |costs: &[Cost]| {
            let requests: f64 = costs.iter().map(|cost| cost.requests).sum();
            let bytes: f64 = costs.iter().map(|cost| cost.bytes).sum();
            (grouped(10 * (requests / 10.0).round() as u32), 10 * (bytes / 10_000.0).round() as u32)
        };
        let ((most, most_bytes), (least, least_bytes)) = (told(&[ALWAYS, BURSTS, TRAP]), told(&[ALWAYS]));
        for said in [
            format!(" some {most} requests (a PASS"),
            format!(" {most_bytes} kB on a board that has everything"),
            format!(" some {least} requests and {least_bytes} kB on a board without bursts"),
            format!(" adds a request and some {} bytes", 100 * (BANK.bytes / 100.0).round() as u32),
        ] {
            assert!(page.contains(&said), "docs/rules.md does not say `{said}`");
        }
    }
}
