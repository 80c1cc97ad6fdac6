//! How often somebody failed to identify themselves, so that nobody guesses for long.

use std::collections::{HashMap, VecDeque};
use std::hash::Hash;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};
use std::time::{Duration, Instant};

const WINDOW: Duration = Duration::from_secs(60);
/// The most clients whose failures are kept. When there are more, the others wait as if they had failed.
const MOST: usize = 10_000;

/// When each client failed.
#[derive(Debug)]
pub(super) struct Failures<Who> {
    /// How many failures within [`WINDOW`] are followed by a wait.
    last: usize,
    of: HashMap<Who, VecDeque<Instant>>,
}

impl<Who: Eq + Hash> Failures<Who> {
    /// No failures yet; after `last` of them within a minute there is a wait.
    pub(super) fn new(last: usize) -> Self {
        Self { last, of: HashMap::new() }
    }

    /// Counts an attempt of `who`. It is a failure until [`Self::succeeded`] says otherwise, because many attempts may be made at
    /// once. Returns how long they must wait first, if they must.
    pub(super) fn attempt(&mut self, who: Who, now: Instant) -> Option<Duration> {
        self.of.retain(|_, failed| {
            failed.retain(|at| now.saturating_duration_since(*at) < WINDOW);
            !failed.is_empty()
        });
        if self.of.len() >= MOST && !self.of.contains_key(&who) {
            return Some(WINDOW);
        }
        let failed = self.of.entry(who).or_default();
        match failed.front().filter(|_| failed.len() >= self.last) {
            Some(first) => Some(WINDOW.saturating_sub(now.saturating_duration_since(*first))),
            None => {
                failed.push_back(now);
                None
            }
        }
    }

    /// One attempt of `who` was no failure.
    pub(super) fn succeeded(&mut self, who: &Who) {
        self.of.get_mut(who).and_then(VecDeque::pop_back);
    }
}

/// The client at `peer`: this computer, an IPv4 address, or the /64 network of an IPv6 address, in which a computer has as many
/// addresses as it likes.
pub(in crate::web) fn network(peer: IpAddr) -> IpAddr {
    match peer.to_canonical() {
        IpAddr::V6(address) if !address.is_loopback() => {
            IpAddr::V6(Ipv6Addr::from_bits(address.to_bits() & !u128::from(u64::MAX)))
        }
        // All of 127.0.0.0/8 is this computer, too.
        address if address.is_loopback() => IpAddr::V4(Ipv4Addr::LOCALHOST),
        address => address,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_failure_of_a_minute_is_followed_by_a_wait_for_that_one_alone() {
        let (mut failures, start) = (Failures::new(10), Instant::now());
        let after = |seconds| start + Duration::from_secs(seconds);
        for second in 0..10 {
            assert_eq!(failures.attempt("one", after(second)), None, "{second}");
        }
        assert_eq!(failures.attempt("one", after(20)), Some(Duration::from_secs(40)));
        assert_eq!(failures.attempt("other", after(20)), None);
        failures.succeeded(&"one");
        failures.succeeded(&"other");
        assert_eq!(failures.attempt("one", after(20)), None);
        assert_eq!(failures.attempt("one", after(20)), Some(Duration::from_secs(40)));
        assert_eq!(failures.attempt("one", after(60)), None);
    }

    #[test]
    fn whoever_has_many_names_waits_as_well() {
        let (mut failures, start) = (Failures::new(10), Instant::now());
        for name in 0..MOST {
            assert_eq!(failures.attempt(name, start), None);
        }
        assert_eq!(failures.attempt(MOST, start), Some(WINDOW));
        assert_eq!(failures.attempt(0, start), None);
        assert_eq!(failures.attempt(MOST, start + WINDOW), None);
    }

    #[test]
    fn whoever_has_many_addresses_is_one() {
        let of = |text: &str| network(text.parse().unwrap());
        assert_eq!(of("2001:db8:1:2::1"), of("2001:db8:1:2:ffff::9"));
        assert_ne!(of("2001:db8:1:2::1"), of("2001:db8:1:3::1"));
        assert_eq!(of("::ffff:10.0.0.1"), of("10.0.0.1"));
        assert_ne!(of("10.0.0.1"), of("10.0.0.2"));
        assert_eq!(of("127.0.0.1"), of("127.3.4.5"));
        assert_eq!(of("127.0.0.1"), of("::1"));
    }
}
