//! The settings file: options that a station always uses, in TOML.
//!
//! A value is taken from the first of these that gives it:
//!
//! 1. the flag on the command line,
//! 2. the environment variable `HALFROW_KEY`, the key in capitals,
//! 3. the settings file,
//! 4. the built-in default.
//!
//! This module reads the file. `settings.example.toml` lists every key.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::de::{Error, IgnoredAny};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use halfrow::call::{self, MOST_SECONDS, NoTime};
use halfrow::files::text::{self, quoted, told};
use halfrow_model::Short;

/// A settings file's values. Text is as on the command line and is not checked here. A relative path starts at the folder in
/// which the program was started.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// The board's target.
    pub board: Option<String>,
    /// The table file.
    pub tables: Option<PathBuf>,
    /// The kernel: an interpolant's name or a kernel file.
    pub kernel: Option<String>,
    /// The frames to stream: files, or `builtin:NAME`.
    pub frame: Option<Vec<String>>,
    /// Whether pictures in colour are cropped and scaled to the tables' size.
    pub fit: Option<bool>,
    /// The folder that reports are written to.
    pub report: Option<PathBuf>,
    /// Whether existing files may be replaced.
    pub overwrite: Option<bool>,
    /// The longest that a run may take, in seconds: more than 0, and finite.
    #[serde(deserialize_with = "time_limit")]
    pub timeout: Option<f64>,
    /// The share of packets that may be sent again before a link is too poor to judge over, 0 to 100 percent.
    #[serde(deserialize_with = "percent")]
    pub retry_limit: Option<f64>,
    /// How long a board that goes away may stay away, in seconds: 0 or more, and finite.
    #[serde(deserialize_with = "seconds")]
    pub reconnect: Option<f64>,
    /// How long the board makes frames on its own at the full pixel clock, in seconds: 0 or more, and finite.
    #[serde(deserialize_with = "seconds")]
    pub at_speed: Option<f64>,
    /// Whether to refuse anything but hardware.
    pub require_hardware: Option<bool>,
    /// The seed of everything random in a run.
    pub seed: Option<u64>,
}

/// A settings file that cannot be used. All of these are usage errors.
#[derive(Debug, thiserror::Error)]
pub enum SettingsError {
    /// The settings file could not be read, or is not text.
    #[error(
        "cannot read the settings file {}; check that it exists and that you may read it, name another with \
         --settings, or do without one by HALFROW_SETTINGS=/dev/null",
        path.display()
    )]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The settings file has a key that does not exist.
    #[error("{}, line {line}: there is no setting {key:?}; use one of {known}", path.display(), known = known_keys().join(", "))]
    UnknownKey {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The key.
        key: String,
    },
    /// The settings file is not TOML, or has a value that its key does not take.
    #[error("{}, line {line}: {reason}; correct or remove that line", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
}

impl Settings {
    /// The settings in the file `explicit`, which must exist. Without it, those in `halfrow/settings.toml` in
    /// `$XDG_CONFIG_HOME`, or else in `~/.config`, if it exists and may be read. Otherwise no settings.
    ///
    /// # Errors
    /// [`SettingsError`] when the file cannot be read, is no TOML, or has a key or a value that settings do not have.
    pub fn load(explicit: Option<&Path>) -> Result<Self, SettingsError> {
        match explicit {
            Some(path) => Self::read(path),
            None => Self::read_standard(Self::file(None)),
        }
    }

    /// The file that [`Self::load`] looks for, whether it exists or not.
    #[must_use]
    pub fn file(explicit: Option<&Path>) -> Option<PathBuf> {
        explicit.map(PathBuf::from).or_else(|| standard_path(|name| std::env::var_os(name)))
    }

    /// The keys that have a value.
    #[must_use]
    pub fn keys(&self) -> Vec<&'static str> {
        self.given().into_iter().filter_map(|(key, is_given)| is_given.then_some(key)).collect()
    }

    /// Every key of a settings file, and whether it has a value.
    fn given(&self) -> [(&'static str, bool); 13] {
        [
            ("board", self.board.is_some()),
            ("tables", self.tables.is_some()),
            ("kernel", self.kernel.is_some()),
            ("frame", self.frame.is_some()),
            ("fit", self.fit.is_some()),
            ("report", self.report.is_some()),
            ("overwrite", self.overwrite.is_some()),
            ("timeout", self.timeout.is_some()),
            ("retry_limit", self.retry_limit.is_some()),
            ("reconnect", self.reconnect.is_some()),
            ("at_speed", self.at_speed.is_some()),
            ("require_hardware", self.require_hardware.is_some()),
            ("seed", self.seed.is_some()),
        ]
    }

    fn read(path: &Path) -> Result<Self, SettingsError> {
        let text = text::read(path, text::MAX_BYTES)
            .map_err(|source| SettingsError::Io { path: path.to_owned(), source })?;
        Self::parse(path, &text)
    }

    fn read_standard(path: Option<PathBuf>) -> Result<Self, SettingsError> {
        use io::ErrorKind::{NotADirectory, NotFound, PermissionDenied};
        match path.map(|path| Self::read(&path)) {
            None => Ok(Self::default()),
            // Nobody named this file, and a file in another user's home says nothing about what this user wants.
            Some(Err(SettingsError::Io { path, source })) if source.kind() == PermissionDenied => {
                tracing::warn!(
                    "the settings file {} may not be read, and is passed over; HALFROW_SETTINGS=/dev/null does so \
                     without a word",
                    path.display()
                );
                Ok(Self::default())
            }
            Some(Err(SettingsError::Io { source, .. }))
                if matches!(source.kind(), NotFound | NotADirectory) =>
            {
                Ok(Self::default())
            }
            Some(read) => read,
        }
    }

    fn parse(path: &Path, text: &str) -> Result<Self, SettingsError> {
        let refused = |error: toml::de::Error| SettingsError::Value {
            path: path.to_owned(),
            line: line(text, &error.span().unwrap_or_default()),
            reason: told(error.message()),
        };
        let keys: BTreeMap<Spanned<String>, IgnoredAny> = toml::from_str(text).map_err(refused)?;
        let unknown = keys.into_keys().filter(|key| !known_keys().contains(&key.get_ref().as_str()));
        match unknown.min_by_key(|key| key.span().start) {
            None => toml::from_str(text).map_err(refused),
            Some(key) => Err(SettingsError::UnknownKey {
                path: path.to_owned(),
                line: line(text, &key.span()),
                key: quoted(key.get_ref()),
            }),
        }
    }
}

/// The user's own settings file, by the XDG base directory specification: a relative `$XDG_CONFIG_HOME` is ignored.
fn standard_path(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let folder = variable("XDG_CONFIG_HOME").map(PathBuf::from).filter(|folder| folder.is_absolute());
    let home =
        || variable("HOME").filter(|home| !home.is_empty()).map(|home| Path::new(&home).join(".config"));
    Some(folder.or_else(home)?.join("halfrow").join("settings.toml"))
}

/// The line that `span` begins on, from 1.
fn line(text: &str, span: &Range<usize>) -> usize {
    text.bytes().take(span.start).filter(|&byte| byte == b'\n').count() + 1
}

fn seconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    time(deserializer, call::seconds, "0 or more")
}

fn time_limit<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    time(deserializer, call::time_limit, "more than 0")
}

fn time<'de, D: Deserializer<'de>>(
    deserializer: D,
    read: fn(&'static str, Option<f64>) -> Result<Option<Duration>, NoTime>,
    legal: &str,
) -> Result<Option<f64>, D::Error> {
    let seconds = f64::deserialize(deserializer)?;
    let wrong = |_| {
        let shown = Short(seconds);
        D::Error::custom(format!(
            "{shown} is no time in seconds, which is {legal} and at most {MOST_SECONDS:e}"
        ))
    };
    read("", Some(seconds)).map_err(wrong)?;
    Ok(Some(seconds))
}

fn percent<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    let percent = f64::deserialize(deserializer)?;
    if (0.0..=100.0).contains(&percent) {
        Ok(Some(percent))
    } else {
        Err(D::Error::custom(format!("{} is no share in percent, which is 0 to 100", Short(percent))))
    }
}

fn known_keys() -> [&'static str; 13] {
    Settings::default().given().map(|(key, _)| key)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standard(variables: &[(&str, &str)]) -> Option<PathBuf> {
        standard_path(|wanted| {
            variables.iter().find(|(name, _)| *name == wanted).map(|(_, value)| OsString::from(value))
        })
    }

    #[test]
    fn the_standard_file_is_in_the_users_configuration_folder() {
        let at = |path| Some(PathBuf::from(path));
        assert_eq!(standard(&[("XDG_CONFIG_HOME", "/x"), ("HOME", "/h")]), at("/x/halfrow/settings.toml"));
        assert_eq!(standard(&[("HOME", "/h")]), at("/h/.config/halfrow/settings.toml"));
    }

    #[test]
    fn an_empty_or_relative_configuration_folder_counts_for_nothing() {
        let at_home = Some(PathBuf::from("/h/.config/halfrow/settings.toml"));
        assert_eq!(standard(&[("XDG_CONFIG_HOME", ""), ("HOME", "/h")]), at_home);
        assert_eq!(standard(&[("XDG_CONFIG_HOME", "x"), ("HOME", "/h")]), at_home);
        assert_eq!(standard(&[("HOME", "")]), None);
        assert_eq!(standard(&[]), None);
    }

    #[test]
    fn a_standard_file_that_is_not_there_sets_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("halfrow/settings.toml");
        assert_eq!(Settings::read_standard(Some(missing)).unwrap(), Settings::default());
        let file = tempfile::NamedTempFile::new().unwrap();
        let below_a_file = file.path().join("settings.toml");
        assert_eq!(Settings::read_standard(Some(below_a_file)).unwrap(), Settings::default());
        assert_eq!(Settings::read_standard(None).unwrap(), Settings::default());
    }

    #[test]
    fn a_standard_file_that_is_wrong_is_not_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        std::fs::write(&path, "bord = 'mock'\n").unwrap();
        let refused = Settings::read_standard(Some(path));
        assert!(matches!(refused, Err(SettingsError::UnknownKey { line: 1, .. })));
    }

    #[test]
    fn a_key_is_given_that_has_a_value() {
        for key in known_keys() {
            let values = ["'x'", "['x']", "true", "1"];
            let read =
                values.iter().find_map(|value| toml::from_str::<Settings>(&format!("{key} = {value}")).ok());
            assert_eq!(read.unwrap().keys(), [key]);
        }
    }

    #[test]
    fn the_list_of_keys_is_that_of_the_fields() {
        let refused = toml::from_str::<Settings>("none = 0").unwrap_err();
        let listed: Vec<_> = refused.message().split('`').skip(3).step_by(2).collect();
        assert_eq!(listed, known_keys());
    }
}
