//! When a request that is not answered is sent again, and when it is given up.

use std::time::Duration;

/// What comes next for a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// It is sent.
    Send,
    /// Its answer is waited for.
    Wait(Duration),
    /// It is given up.
    GiveUp,
}

/// The tries of a request, on a clock that stands still while nothing is waited for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Retry {
    attempts: u32,
    attempt: u32,
    /// When the present try is over; none until it is sent.
    until: Option<Duration>,
}

impl Retry {
    /// A request that may be tried `attempts` times.
    pub(super) fn new(attempts: u32) -> Self {
        Self { attempts, attempt: 0, until: None }
    }

    /// The present try, from 0.
    pub(super) fn attempt(&self) -> u32 {
        self.attempt
    }

    /// What to do at `now`, without an answer.
    pub(super) fn next(&mut self, now: Duration) -> Next {
        match self.until {
            Some(until) if until > now => return Next::Wait(until - now),
            Some(_) => (self.attempt, self.until) = (self.attempt + 1, None),
            None => {}
        }
        if self.attempt < self.attempts { Next::Send } else { Next::GiveUp }
    }

    /// The answer to the present try is waited for until `then`.
    pub(super) fn wait_until(&mut self, then: Duration) {
        self.until = Some(then);
    }

    /// An earlier request is still being answered, and this one waits in the queue after it, as if it had not been tried before.
    pub(super) fn begin_anew(&mut self) {
        self.attempt = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn a_silence_is_waited_out_try_by_try() {
        let (mut retry, mut now, mut sent) = (Retry::new(3), SECOND, Vec::new());
        loop {
            match retry.next(now) {
                Next::Send => {
                    sent.push((retry.attempt(), now.as_secs()));
                    retry.wait_until(now + 10 * SECOND);
                }
                // Something comes after 6 s, but no answer.
                Next::Wait(wait) => now += wait.min(6 * SECOND),
                Next::GiveUp => break,
            }
        }
        assert_eq!((sent, now.as_secs()), (vec![(0, 1), (1, 11), (2, 21)], 31));
    }

    #[test]
    fn a_request_that_waits_behind_another_has_all_its_tries() {
        let mut retry = Retry::new(2);
        retry.wait_until(SECOND);
        assert_eq!(retry.next(SECOND), Next::Send);
        retry.wait_until(2 * SECOND);
        retry.begin_anew();
        retry.wait_until(5 * SECOND);
        assert_eq!(retry.next(2 * SECOND), Next::Wait(3 * SECOND));
        assert_eq!((retry.next(5 * SECOND), retry.attempt()), (Next::Send, 1));
        retry.wait_until(6 * SECOND);
        assert_eq!(retry.next(6 * SECOND), Next::GiveUp);
    }
}
