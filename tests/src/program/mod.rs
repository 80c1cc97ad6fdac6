//! The `halfrow` program, started as a user starts it.

pub mod another_user;
mod built;
pub mod documents;
pub mod held;
mod running;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use serde_json::Value;
use tempfile::TempDir;

pub use documents::error_sentence;
pub use running::Running;

/// How a started program ended.
#[derive(Clone, Debug)]
pub struct Ended {
    /// The exit code; none if a signal ended it.
    pub code: Option<i32>,
    /// All of the standard output.
    pub stdout: String,
    /// All of the standard error.
    pub stderr: String,
}

impl Ended {
    /// Itself: the program must have done what it was called for.
    ///
    /// # Panics
    /// If its exit code is not 0, with all that it printed.
    #[track_caller]
    pub fn succeeded(self) -> Self {
        assert_eq!(self.code, Some(0), "{}{}", self.stdout, self.stderr);
        self
    }

    /// The JSON document on stdout; null if there is none.
    ///
    /// # Panics
    /// If it does not conform to the schema, or if it is a report that differs after it is read back.
    #[must_use]
    pub fn json(&self) -> Value {
        let said = serde_json::from_str(&self.stdout).unwrap_or(Value::Null);
        if !said.is_null() {
            documents::assert_valid(&said);
        }
        said
    }

    /// The result in one sentence: of a run, or of a call that was refused.
    ///
    /// # Panics
    /// Like [`Self::json`].
    #[must_use]
    pub fn headline(&self) -> String {
        documents::headline(&self.json())
    }
}

/// A command that will start `halfrow` with `arguments`, in an environment without any setting for it.
///
/// # Panics
/// If the program cannot be built.
pub fn command<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Command {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    let mut command = Command::new(PROGRAM.get_or_init(built::program));
    let ours = std::env::vars_os().map(|(name, _)| name);
    for name in ours.filter(|name| name.to_string_lossy().starts_with("HALFROW_")) {
        command.env_remove(name);
    }
    command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
    command.env("XDG_CONFIG_HOME", "/nonexistent").stdin(Stdio::null()).args(arguments);
    command
}

/// Runs `command` to its end.
///
/// # Panics
/// If it cannot be started or prints anything but UTF-8.
#[must_use]
pub fn finish(command: &mut Command) -> Ended {
    let output = command.output().unwrap();
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Runs `halfrow` with `arguments` to its end.
///
/// # Panics
/// Like [`command`] and [`finish`].
#[must_use]
pub fn halfrow<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Ended {
    finish(&mut command(arguments))
}

/// A temporary folder that `halfrow` is started in. It is deleted when dropped.
#[derive(Debug)]
pub struct Folder(TempDir);

impl Folder {
    /// An empty folder.
    ///
    /// # Panics
    /// If none can be made.
    #[must_use]
    pub fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// A command that will start `halfrow` in this folder.
    ///
    /// # Panics
    /// Like [`command`].
    #[must_use]
    pub fn command<'a>(&self, arguments: impl IntoIterator<Item = &'a str>) -> Command {
        let mut command = command(arguments);
        command.current_dir(self.path());
        command
    }

    /// Runs `halfrow` in this folder to its end.
    ///
    /// # Panics
    /// Like [`halfrow()`].
    #[must_use]
    pub fn halfrow<'a>(&self, arguments: impl IntoIterator<Item = &'a str>) -> Ended {
        finish(&mut self.command(arguments))
    }

    /// Runs `halfrow` to its end in this folder, where no file can be longer than `blocks` of 512 bytes, as on a full disk.
    ///
    /// # Panics
    /// Like [`halfrow()`].
    #[must_use]
    pub fn halfrow_on_a_full_disk<'a>(
        &self,
        blocks: usize,
        arguments: impl IntoIterator<Item = &'a str>,
    ) -> Ended {
        // POSIX counts in blocks of 512 bytes.
        finish(&mut self.by_shell(&format!("ulimit -f {blocks}; exec \"$@\""), arguments))
    }

    /// A command that will start `halfrow` in this folder by this line of a shell, in which it is `"$@"`.
    ///
    /// # Panics
    /// Like [`command`].
    #[must_use]
    pub fn by_shell<'a>(&self, line: &str, arguments: impl IntoIterator<Item = &'a str>) -> Command {
        let command = self.command(arguments);
        let mut shell = Command::new("sh");
        shell.args(["-c", line, "sh"]).arg(command.get_program()).args(command.get_args());
        self.as_started_by(shell, &command)
    }

    /// `other`, which starts `command`, with the folder and environment of `command`.
    fn as_started_by(&self, mut other: Command, command: &Command) -> Command {
        for (name, value) in command.get_envs() {
            match value {
                Some(value) => other.env(name, value),
                None => other.env_remove(name),
            };
        }
        other.current_dir(self.path()).stdin(Stdio::null());
        other
    }

    /// Writes a file.
    ///
    /// # Panics
    /// If it cannot be written.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path().join(name), content).unwrap();
    }

    /// The content of a file.
    ///
    /// # Panics
    /// If it cannot be read.
    #[must_use]
    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path().join(name)).unwrap()
    }

    /// The content of a text file.
    ///
    /// # Panics
    /// If it cannot be read or is not UTF-8.
    #[must_use]
    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    /// The content of a JSON file.
    ///
    /// # Panics
    /// If it cannot be read or is not JSON.
    #[must_use]
    pub fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.read(name)).unwrap()
    }

    /// The names of everything in a folder inside this one, or in this one for `.`, sorted.
    ///
    /// # Panics
    /// If it cannot be listed.
    #[must_use]
    pub fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path().join(folder)).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Default for Folder {
    fn default() -> Self {
        Self::new()
    }
}
