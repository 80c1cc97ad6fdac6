//! A program under way, which is sent signals.

use std::io::{BufRead as _, BufReader, Read as _};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use halfrow_tests::program::{Ended, Folder};

/// At 20,000 bytes a second the built-in frames would take an hour.
pub(crate) const SLOW: &str = "mock,pace=real,speed=20000";

/// How long something may take that takes no time, on a machine with much else to do.
const PATIENCE: Duration = Duration::from_secs(60);

/// How often it is looked.
const TICK: Duration = Duration::from_millis(5);

pub(crate) struct Running {
    child: Child,
    log: BufReader<ChildStderr>,
    said: String,
}

impl Running {
    /// Starts `halfrow` in `folder` with every signal as a user's shell leaves it, whatever started the tests.
    pub(crate) fn start<'a>(folder: &Folder, arguments: impl IntoIterator<Item = &'a str>) -> Self {
        Self::start_by(folder, "exec env --default-signal=INT,TERM,HUP \"$@\"", arguments)
    }

    /// Starts `halfrow` as this line of a shell does.
    pub(crate) fn start_by<'a>(
        folder: &Folder,
        line: &str,
        arguments: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let mut child =
            folder.by_shell(line, arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let log = BufReader::new(child.stderr.take().unwrap());
        Self { child, log, said: String::new() }
    }

    /// A run on a slow board that has its session, and so hears signals.
    pub(crate) fn streaming<'a>(folder: &Folder, arguments: impl IntoIterator<Item = &'a str>) -> Self {
        let call = ["verify", "-vv", "--json", "--board", SLOW];
        let mut running = Self::start(folder, call.into_iter().chain(arguments));
        running.until_it_says("session ");
        running
    }

    /// Waits for these words in the log.
    pub(crate) fn until_it_says(&mut self, words: &str) {
        while !self.said.contains(words) {
            assert!(self.log.read_line(&mut self.said).unwrap() > 0, "it ended by itself: {}", self.said);
        }
    }

    pub(crate) fn send(&self, signal: &str) {
        let kill = Command::new("sh").args(["-c", &format!("kill -{signal} {}", self.child.id())]).status();
        assert!(kill.unwrap().success());
    }

    /// Waits for its end.
    pub(crate) fn ended(mut self) -> Ended {
        let begun = Instant::now();
        while self.child.try_wait().unwrap().is_none() {
            if begun.elapsed() > PATIENCE {
                self.child.kill().unwrap();
                panic!("still running {PATIENCE:?} after a signal");
            }
            sleep(TICK);
        }
        self.log.read_to_string(&mut self.said).unwrap();
        let output = self.child.wait_with_output().unwrap();
        Ended {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: self.said,
        }
    }

    /// Stops it where something half written is in `folder`.
    pub(crate) fn stop_amid(&self, folder: &Path) {
        let begun = Instant::now();
        let is_hidden = |name: &str| name.starts_with('.');
        while begun.elapsed() < PATIENCE {
            if has(folder, is_hidden) {
                self.send("STOP");
                while !self.is_stopped() {
                    sleep(TICK);
                }
                if has(folder, is_hidden) {
                    return;
                }
                self.send("CONT");
            }
        }
        panic!("nothing is half written in {}", folder.display());
    }

    fn is_stopped(&self) -> bool {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).unwrap_or_default();
        stat.rsplit(')').next().is_some_and(|rest| rest.trim_start().starts_with('T'))
    }

    /// Kills it, and waits until it is gone.
    pub(crate) fn killed(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

/// Waits until something in `folder` has a name that `is_wanted`.
pub(crate) fn until_there_is(folder: &Path, is_wanted: impl Fn(&str) -> bool) {
    let begun = Instant::now();
    while !has(folder, &is_wanted) {
        assert!(begun.elapsed() < PATIENCE, "nothing came into {}", folder.display());
        sleep(TICK);
    }
}

fn has(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> bool {
    let mut entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.any(|entry| is_wanted(&entry.file_name().to_string_lossy()))
}
