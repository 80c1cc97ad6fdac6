//! Who is logged in, in which browser.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::users::Identified;
use crate::secret::{self, SecretError};
use crate::web::routes::Who;
use crate::web::visit::User;

/// The most sessions at once.
const MOST: usize = 1000;
/// The most of one person, so that nobody logs others out by logging in again and again.
const MOST_OF_ONE: usize = 50;

/// By how much the file may lag in saying when somebody last did something.
const SAVED_MS: i64 = 60_000;

/// Somebody who is logged in, as the file has them. No cookie can be derived from it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedSession {
    /// The mark of the browser's cookie.
    mark: String,
    name: String,
    is_engineer: bool,
    /// The mark of the badge and the password that they logged in by.
    proof: String,
    /// When they last did something, in milliseconds since 1970, UTC.
    used_ms: i64,
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedSessions {
    #[serde(default)]
    session: Vec<SavedSession>,
}

/// Everybody who is logged in, by the marks of their browsers' cookies. A station that starts again still knows them, so
/// open pages go on.
#[derive(Debug, Default)]
pub(super) struct Sessions {
    known: HashMap<String, (Identified, i64)>,
    file: Option<PathBuf>,
    saved_ms: i64,
}

impl Sessions {
    /// The sessions in the file `path`, which is kept up to date from now on.
    ///
    /// # Errors
    /// [`SecretError`] when others may read it, or it cannot be read.
    pub(super) fn load(path: &Path) -> Result<Self, SecretError> {
        let lines: SavedSessions = match secret::read_or_none(path) {
            Ok(lines) => lines,
            Err(SecretError::Wrong { path, what }) => {
                tracing::warn!("{}: {what}; everybody logs in anew", path.display());
                SavedSessions::default()
            }
            Err(error) => return Err(error),
        };
        let known =
            lines.session.into_iter().map(|SavedSession { mark, name, is_engineer, proof, used_ms }| {
                let who = if is_engineer { Who::Engineer } else { Who::Operator };
                (mark, (Identified { user: User { name, who }, proof }, used_ms))
            });
        Ok(Self { known: known.collect(), file: Some(path.to_owned()), saved_ms: 0 })
    }

    /// Adds somebody who logged in. If they have too many sessions, the one of theirs that has been idle longest ends; if there are
    /// too many in all, whoever has been idle longest is logged out.
    pub(super) fn add(&mut self, mark: String, who: Identified, now_ms: i64) {
        self.make_room(MOST_OF_ONE, |of| of.name == who.user.name);
        self.make_room(MOST, |_| true);
        self.known.insert(mark, (who, now_ms));
        self.save(now_ms);
    }

    /// Ends those of the sessions of whoever `is_meant` that have been idle longest, until one more makes `most`.
    fn make_room(&mut self, most: usize, is_meant: impl Fn(&User) -> bool) {
        let meant = self.known.iter().filter(|(_, (who, _))| is_meant(&who.user));
        let mut idle: Vec<_> = meant.map(|(mark, (_, used_ms))| (*used_ms, mark.clone())).collect();
        idle.sort_unstable();
        let surplus = (idle.len() + 1).saturating_sub(most);
        for (_, mark) in idle.into_iter().take(surplus) {
            self.known.remove(&mark);
        }
    }

    /// Whose cookie has this mark, unless they have been idle for `idle`, which is ended by an act and not by a look.
    pub(super) fn user(
        &mut self,
        mark: &str,
        idle: Duration,
        is_act: bool,
        now_ms: i64,
    ) -> Option<Identified> {
        let idle_ms = i64::try_from(idle.as_millis()).unwrap_or(i64::MAX);
        // What is noted later than now was noted while the clock was ahead.
        self.saved_ms = self.saved_ms.min(now_ms);
        self.known.retain(|_, (_, used)| {
            *used = (*used).min(now_ms);
            now_ms.saturating_sub(*used) < idle_ms
        });
        let (who, used) = self.known.get_mut(mark)?;
        let who = who.clone();
        if is_act {
            *used = now_ms;
            if now_ms.saturating_sub(self.saved_ms) >= SAVED_MS {
                self.save(now_ms);
            }
        }
        Some(who)
    }

    /// Removes somebody who logged out, or may not be logged in any more.
    pub(super) fn remove(&mut self, mark: &str, now_ms: i64) {
        if self.known.remove(mark).is_some() {
            self.save(now_ms);
        }
    }

    /// Writes all sessions to the file. Whoever is lost with it logs in anew, so nothing waits for the disk.
    fn save(&mut self, now_ms: i64) {
        let Some(file) = &self.file else { return };
        self.saved_ms = now_ms;
        let line =
            |(mark, (Identified { user, proof }, used_ms)): (&String, &(Identified, i64))| SavedSession {
                mark: mark.clone(),
                name: user.name.clone(),
                is_engineer: user.who == Who::Engineer,
                proof: proof.clone(),
                used_ms: *used_ms,
            };
        let lines = SavedSessions { session: self.known.iter().map(line).collect() };
        if let Err(error) = secret::write(file, &lines, false) {
            tracing::warn!("{:#}", anyhow::Error::from(error));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identified(name: &str, who: Who) -> Identified {
        Identified { user: User { name: name.to_owned(), who }, proof: format!("{name}'s badge") }
    }

    #[test]
    fn idleness_ends_a_session_and_an_act_is_none() {
        let (mut sessions, idle) = (Sessions::default(), Duration::from_secs(100));
        let weber = identified("Weber", Who::Operator);
        sessions.add("s".to_owned(), weber.clone(), 1_000);
        assert_eq!(sessions.user("s", idle, true, 91_000), Some(weber.clone()));
        assert_eq!(sessions.user("s", idle, false, 181_000), Some(weber));
        assert_eq!(sessions.user("s", idle, false, 191_000), None);
    }

    /// The clock stood an hour ahead until NTP set it.
    #[test]
    fn a_clock_that_was_ahead_keeps_nobody_logged_in_for_longer() {
        const AHEAD: i64 = 3_600_000;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.sessions");
        let (mut sessions, idle) = (Sessions::load(&path).unwrap(), Duration::from_secs(100));
        let weber = identified("Weber", Who::Operator);
        sessions.add("s".to_owned(), weber.clone(), AHEAD);
        assert_eq!(sessions.user("s", idle, false, 1_000), Some(weber.clone()));
        assert_eq!(sessions.user("s", idle, false, 100_999), Some(weber.clone()));
        assert_eq!(sessions.user("s", idle, false, 101_000), None);
        // The acts in the file, too, go by the clock that is right.
        sessions.add("s".to_owned(), weber.clone(), AHEAD);
        sessions.user("s", idle, true, 101_000);
        sessions.user("s", idle, true, 101_000 + SAVED_MS);
        let mut again = Sessions::load(&path).unwrap();
        assert_eq!(again.user("s", idle, false, 100_999 + SAVED_MS + 100_000), Some(weber));
        assert_eq!(again.user("s", idle, false, 101_000 + SAVED_MS + 100_000), None);
    }

    /// docs/station-lanes.md: a person is logged in 50 times at once.
    #[test]
    fn whoever_logs_in_again_and_again_logs_nobody_else_out() {
        let (mut sessions, idle) = (Sessions::default(), Duration::from_secs(3600));
        let [weber, braun] =
            [("Weber", Who::Operator), ("Braun", Who::Engineer)].map(|(name, who)| identified(name, who));
        sessions.add("b".to_owned(), braun.clone(), 0);
        for number in 0..2_000 {
            sessions.add(format!("w{number}"), weber.clone(), 1_000 + number);
            // One that is used.
            assert_eq!(sessions.user("w7", idle, true, 1_000 + number).is_some(), number >= 7, "{number}");
        }
        assert_eq!(sessions.user("b", idle, false, 4_000), Some(braun), "others stay");
        let is_in = |number: &i64| sessions.user(&format!("w{number}"), idle, false, 4_000).is_some();
        let left: Vec<_> = (0..2_000).filter(is_in).collect();
        assert_eq!(left, [7].into_iter().chain(1_951..2_000).collect::<Vec<_>>());
    }

    #[test]
    fn where_too_many_are_logged_in_whoever_has_been_idle_longest_is_logged_out() {
        let (mut sessions, idle) = (Sessions::default(), Duration::from_secs(3600));
        for number in 0..1_001 {
            sessions.add(format!("s{number}"), identified(&format!("{number}"), Who::Operator), number);
        }
        let is_in = |number: i64| sessions.user(&format!("s{number}"), idle, false, 2_000).is_some();
        assert_eq!([0, 1, 1_000].map(is_in), [false, true, true]);
    }

    #[test]
    fn a_station_that_starts_again_knows_who_is_logged_in() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.sessions");
        let idle = Duration::from_secs(3600);
        let [weber, braun] =
            [("Weber", Who::Operator), ("Braun", Who::Engineer)].map(|(name, who)| identified(name, who));
        let mut sessions = Sessions::load(&path).unwrap();
        sessions.add("w".to_owned(), weber.clone(), 0);
        sessions.add("b".to_owned(), braun.clone(), 0);
        sessions.add("gone".to_owned(), weber.clone(), 0);
        sessions.remove("gone", 1);
        sessions.user("b", idle, true, SAVED_MS + 1);
        let mut again = Sessions::load(&path).unwrap();
        assert_eq!(again.user("w", idle, false, 1_000), Some(weber));
        assert_eq!(again.user("gone", idle, false, 1_000), None);
        assert_eq!(again.user("b", idle, false, 3_600_000), Some(braun), "the act counts");
        std::fs::write(&path, "no table").unwrap();
        assert_eq!(Sessions::load(&path).unwrap().user("w", idle, false, 0), None);
        let open = std::os::unix::fs::PermissionsExt::from_mode(0o644);
        std::fs::set_permissions(&path, open).unwrap();
        assert!(matches!(Sessions::load(&path), Err(SecretError::Open { .. })));
    }
}
