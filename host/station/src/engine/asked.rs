//! Units that passed already, which are tested again only if somebody answers that they mean it.

use std::time::{Duration, Instant};

use crate::floor::Accepted;
use crate::store::AgainError;

/// A scanner that reads a label twice, and a form that is sent twice, take less time than anybody who has read the question.
const UNREAD: Duration = Duration::from_secs(1);
/// Later somebody may hold the board for another reason.
const FORGOTTEN: Duration = Duration::from_secs(60);

/// Whether the last scan in a lane led to the question if its unit is to be tested again.
#[derive(Debug, Default)]
pub(super) struct Asked(Option<Question>);

#[derive(Debug)]
struct Question {
    serial: String,
    operator: String,
    at: Instant,
}

impl Asked {
    /// Notes that whoever scanned this was asked at the moment `at`, if `error` asks.
    pub(super) fn note(&mut self, error: &AgainError, of: &Accepted, at: Instant) {
        let Accepted { serial, operator, .. } = of.clone();
        self.0 = matches!(error, AgainError::Asked { .. }).then_some(Question { serial, operator, at });
    }

    /// Whether this, scanned at the moment `at`, is the answer: the same label, by the person who was asked. Whatever it is, the
    /// question is over.
    pub(super) fn is_answered(&mut self, of: &Accepted, at: Instant) -> bool {
        self.0.take().is_some_and(|asked| {
            (&asked.serial, &asked.operator) == (&of.serial, &of.operator)
                && (UNREAD..=FORGOTTEN).contains(&at.saturating_duration_since(asked.at))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accepted(serial: &str, operator: &str) -> Accepted {
        let [product, serial, operator] = ["CAM-T", serial, operator].map(str::to_owned);
        Accepted { plan: 0, product, serial, operator }
    }

    /// docs/station-plans.md: between one second and a minute after the question, by the same person.
    #[test]
    fn a_question_is_answered_by_whoever_was_asked_neither_at_once_nor_much_later() {
        let (when, at) = (String::new(), Instant::now());
        let asks = AgainError::Asked { serial: "S1".to_owned(), when: when.clone(), how: "scan it" };
        let refuses = AgainError::Refused { serial: "S1".to_owned(), when };
        let same = accepted("S1", "weber");
        let is_answered = |error: &AgainError, of: &Accepted, ms| {
            let mut asked = Asked::default();
            asked.note(error, &same, at);
            asked.is_answered(of, at + Duration::from_millis(ms))
        };
        let in_time = [0, 999, 1_000, 60_000, 60_001].map(|ms| is_answered(&asks, &same, ms));
        assert_eq!(in_time, [false, false, true, true, false]);
        for other in [accepted("S2", "weber"), accepted("S1", "braun")] {
            assert!(!is_answered(&asks, &other, 5_000), "{other:?}");
        }
        assert!(!is_answered(&refuses, &same, 5_000));
    }
}
