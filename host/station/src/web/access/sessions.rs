//! Who is logged in, in which browser, and how often logging in failed.

use std::collections::{HashMap, VecDeque};
use std::net::IpAddr;
use std::time::{Duration, Instant};

use crate::web::visit::User;

/// The most sessions at once.
const MOST: usize = 1000;
/// So many failures within [`WINDOW`] are the last before a wait.
const FAILURES: usize = 10;
const WINDOW: Duration = Duration::from_secs(60);
/// The most addresses of which failures are kept.
const MOST_PEERS: usize = 10_000;

/// Everybody who is logged in, by the cookies of their browsers.
#[derive(Debug, Default)]
pub(super) struct Sessions(HashMap<String, (User, Instant)>);

impl Sessions {
    /// Somebody logged in. Whoever has been idle for longest makes room.
    pub(super) fn add(&mut self, session: String, user: User, now: Instant) {
        if self.0.len() >= MOST {
            let idle = self.0.iter().min_by_key(|(_, (_, used))| *used).map(|(session, _)| session.clone());
            idle.map(|session| self.0.remove(&session));
        }
        self.0.insert(session, (user, now));
    }

    /// Who this is, unless they have been idle for `idle`. An act is no idleness.
    pub(super) fn user(&mut self, session: &str, idle: Duration, is_act: bool, now: Instant) -> Option<User> {
        self.0.retain(|_, (_, used)| now.saturating_duration_since(*used) < idle);
        let (user, used) = self.0.get_mut(session)?;
        if is_act {
            *used = now;
        }
        Some(user.clone())
    }

    /// Somebody logged out, or may not be logged in any more.
    pub(super) fn remove(&mut self, session: &str) {
        self.0.remove(session);
    }
}

/// When logging in failed, by where it was tried from.
#[derive(Debug, Default)]
pub(super) struct Failures(HashMap<IpAddr, VecDeque<Instant>>);

impl Failures {
    /// How long `peer` waits before it may try again; nothing if it need not.
    pub(super) fn wait(&mut self, peer: IpAddr, now: Instant) -> Option<Duration> {
        self.0.retain(|_, failed| {
            failed.retain(|at| now.saturating_duration_since(*at) < WINDOW);
            !failed.is_empty()
        });
        let failed = self.0.get(&peer).filter(|failed| failed.len() >= FAILURES)?;
        failed.front().map(|first| WINDOW.saturating_sub(now.saturating_duration_since(*first)))
    }

    /// It failed.
    pub(super) fn add(&mut self, peer: IpAddr, now: Instant) {
        if self.0.len() < MOST_PEERS || self.0.contains_key(&peer) {
            self.0.entry(peer).or_default().push_back(now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::routes::Who;

    #[test]
    fn the_tenth_failure_of_a_minute_is_followed_by_a_wait_for_that_address_alone() {
        let (mut failures, start) = (Failures::default(), Instant::now());
        let [peer, other] = ["10.0.0.1", "10.0.0.2"].map(|peer| peer.parse().unwrap());
        for second in 0..10 {
            assert_eq!(failures.wait(peer, start), None, "{second}");
            failures.add(peer, start + Duration::from_secs(second));
        }
        let after = |seconds| start + Duration::from_secs(seconds);
        assert_eq!(failures.wait(peer, after(20)), Some(Duration::from_secs(40)));
        assert_eq!(failures.wait(other, after(20)), None);
        assert_eq!(failures.wait(peer, after(60)), None);
    }

    #[test]
    fn idleness_ends_a_session_and_an_act_is_none() {
        let (mut sessions, start) = (Sessions::default(), Instant::now());
        let idle = Duration::from_secs(100);
        let weber = User { name: "Weber".to_owned(), who: Who::Operator };
        sessions.add("s".to_owned(), weber.clone(), start);
        let after = |seconds| start + Duration::from_secs(seconds);
        assert_eq!(sessions.user("s", idle, true, after(90)), Some(weber.clone()));
        assert_eq!(sessions.user("s", idle, false, after(180)), Some(weber));
        assert_eq!(sessions.user("s", idle, false, after(190)), None);
    }
}
