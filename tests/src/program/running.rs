//! A program that a test watches while it runs.

use std::io::{BufRead as _, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::str::FromStr as _;
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use super::Ended;
use crate::patience::{LIMIT, end_of, wait_until};

/// A program that was started. It is killed when dropped.
#[derive(Debug)]
pub struct Running {
    child: Child,
    stdout: Output,
    stderr: Output,
}

/// What a program prints on one of its streams, line by line as it comes.
#[derive(Debug)]
struct Output {
    lines: Receiver<String>,
    text: String,
}

impl Output {
    fn new(stream: impl Read + Send + 'static) -> Self {
        let (say, lines) = channel();
        thread::spawn(move || {
            let mut stream = BufReader::new(stream);
            let mut line = Vec::new();
            while stream.read_until(b'\n', &mut line).is_ok_and(|length| length > 0) {
                // Reads to the end even if nobody listens: a full pipe would hold the program up.
                let _ = say.send(String::from_utf8_lossy(&line).into_owned());
                line.clear();
            }
        });
        Self { lines, text: String::new() }
    }

    /// The next line; none after the last.
    fn next(&mut self) -> Option<String> {
        let line = self.lines.recv_timeout(LIMIT).ok()?;
        self.text.push_str(&line);
        Some(line)
    }

    fn all(&mut self) -> String {
        while self.next().is_some() {}
        std::mem::take(&mut self.text)
    }
}

impl Running {
    /// Starts `command`.
    ///
    /// # Panics
    /// If it cannot be started.
    #[must_use]
    pub fn start(command: &mut Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (stdout, stderr) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        Self { child, stdout: Output::new(stdout), stderr: Output::new(stderr) }
    }

    /// Waits until it prints `words` on stderr.
    ///
    /// # Panics
    /// If it ends or hangs without having printed them.
    pub fn wait_for(&mut self, words: &str) {
        loop {
            let line = self.stderr.next();
            assert!(line.is_some(), "it never said `{words}`: {}", self.stderr.text);
            if line.is_some_and(|line| line.contains(words)) {
                return;
            }
        }
    }

    /// The next line on stdout.
    ///
    /// # Panics
    /// If it ends or hangs without one.
    #[must_use]
    pub fn line(&mut self) -> String {
        self.stdout.next().unwrap().trim_end().to_owned()
    }

    /// Sends it a signal, such as `TERM`.
    ///
    /// # Panics
    /// If it has ended already.
    pub fn send(&self, signal: &str) {
        let process = Pid::from_raw(self.child.id().cast_signed());
        kill(process, Signal::from_str(&format!("SIG{signal}")).unwrap()).unwrap();
    }

    /// Its process id.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Whether it has ended.
    #[must_use]
    pub fn has_ended(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(Some(_)))
    }

    /// Sends it SIGSTOP, and waits until it is stopped.
    ///
    /// # Panics
    /// If it has ended already.
    pub fn stop(&self) {
        self.send("STOP");
        wait_until("a program to stand still", || {
            let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).unwrap();
            // The state follows the name, which may contain any character.
            stat.rsplit(')').next().is_some_and(|rest| rest.trim_start().starts_with(['T', 'Z']))
        });
    }

    /// Waits until it ends.
    ///
    /// # Panics
    /// If it hangs.
    #[must_use]
    pub fn end(mut self) -> Ended {
        let code = end_of(&mut self.child).code();
        Ended { code, stdout: self.stdout.all(), stderr: self.stderr.all() }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to do.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
