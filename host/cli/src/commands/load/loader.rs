//! Runs openFPGALoader as a child process, with a deadline.

use std::io::{self, Read};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, killpg};
use nix::sys::wait::{Id, WaitPidFlag, WaitStatus, waitid};
use nix::unistd::Pid;
use signal_hook::consts::SIGCHLD;

use super::LoadError;
use crate::bitstreams::BitstreamBoard;
use crate::failure::Failure;
use crate::progress::ChildOutput;
use halfrow::report::shell_word;
use halfrow::verdict::{Cause, StoppedBy};

/// The program.
pub(super) const PROGRAM: &str = "openFPGALoader";
/// How often to check on the program.
const LOOK: Duration = Duration::from_millis(10);
/// The most that is kept of its output, in bytes; a longer line is handled in pieces.
const MOST_KEPT: usize = 2000;
/// How many lines of output may be queued. Beyond that, the program has to wait.
const QUEUE: usize = 64;
/// How long to read its last output after it has ended, in case something that it started holds its streams open.
const LAST_WORDS: Duration = Duration::from_secs(2);

/// A call of the loader.
#[derive(Clone, Debug)]
pub(super) struct Call {
    /// Its options.
    options: Vec<String>,
    file: PathBuf,
    /// What to call by hand if the program is not installed, or fails.
    other: String,
    /// The FPGA that the file is for, if that is known.
    device: Option<String>,
}

impl Call {
    /// A call that loads `file`, which was built for the FPGA `device`, into `board`, with the further options `more`.
    pub(super) fn new(board: &BitstreamBoard, device: Option<&str>, file: &Path, more: &[String]) -> Self {
        let mut options = vec!["-b".to_owned(), board.loader_name.to_owned()];
        options.extend(more.iter().cloned());
        let other = format!("{} {}", board.other_loader, shell_word(&file.display().to_string()));
        Self { options, file: file.to_owned(), other, device: device.map(str::to_owned) }
    }

    /// Program, options and file.
    pub(super) fn words(&self) -> Vec<String> {
        let file = self.file.display().to_string();
        [PROGRAM.to_owned()].into_iter().chain(self.options.iter().cloned()).chain([file]).collect()
    }

    /// The call as a line for a shell.
    pub(super) fn line(&self) -> String {
        self.words().iter().map(|word| shell_word(word)).collect::<Vec<_>>().join(" ")
    }

    /// Runs it until it ends, until `deadline` has passed, or until `stopped` returns a reason.
    ///
    /// # Errors
    /// When it did not end successfully.
    pub(super) fn run(
        &self,
        deadline: Duration,
        told: &ChildOutput,
        stopped: &dyn Fn() -> Option<StoppedBy>,
    ) -> Result<(), Failure> {
        let begun = Instant::now();
        let mut loader = Loader::start(self)?;
        let end = loader.attended(begun + deadline, told, stopped);
        let (status, said) = loader.end(told);
        let call = self.line();
        match (end, status) {
            (End::By(by), _) => Err(Failure::of(Cause::Stopped(by).into(), LoadError::Stopped { call, by })),
            (End::Late, _) => {
                let deadline = deadline.as_secs_f64();
                Err(Failure::error(LoadError::LoaderLate { call, deadline, said }))
            }
            (End::Itself, Ok(status)) if status.success() => Ok(()),
            (End::Itself, Ok(status)) => {
                let (device, other) = (self.device.clone(), self.other.clone());
                Err(Failure::error(LoadError::LoaderFailed { call, status, said, device, other }))
            }
            (End::Itself, Err(source)) => Err(Failure::error(LoadError::LoaderNotStarted { call, source })),
        }
    }
}

enum End {
    Itself,
    Late,
    By(StoppedBy),
}

struct Loader {
    child: Child,
    lines: Receiver<String>,
    said: String,
}

impl Loader {
    fn start(call: &Call) -> Result<Self, Failure> {
        let not_run = |source| Failure::error(LoadError::LoaderNotStarted { call: call.line(), source });
        // If SIGCHLD is ignored, as it may have been when this program was started, the exit status of a child is lost.
        signal_hook::flag::register(SIGCHLD, Arc::default()).map_err(not_run)?;
        let mut command = Command::new(PROGRAM);
        command.args(&call.options).arg(&call.file).process_group(0);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|source| match source.kind() {
            io::ErrorKind::NotFound => Failure::call(LoadError::LoaderMissing { other: call.other.clone() }),
            _ => not_run(source),
        })?;
        let (sender, lines) = sync_channel(QUEUE);
        let streams: [Option<Box<dyn Read + Send>>; 2] = [
            child.stdout.take().map(|stream| Box::new(stream) as _),
            child.stderr.take().map(|stream| Box::new(stream) as _),
        ];
        let loader = Self { child, lines, said: String::new() };
        let mut streams = streams.into_iter().flatten();
        match streams.try_for_each(|stream| hear(stream, sender.clone())) {
            Ok(()) => Ok(loader),
            Err(source) => {
                drop(sender);
                let _ = loader.end(&ChildOutput::Nothing);
                Err(not_run(source))
            }
        }
    }

    /// Reads its output until it ends or must end.
    fn attended(
        &mut self,
        deadline: Instant,
        told: &ChildOutput,
        stopped: &dyn Fn() -> Option<StoppedBy>,
    ) -> End {
        loop {
            match self.lines.recv_timeout(LOOK) {
                Ok(line) => self.keep(&line, told),
                // It may close its streams before it ends.
                Err(RecvTimeoutError::Disconnected) => thread::sleep(LOOK),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if self.has_ended() {
                return End::Itself;
            }
            if let Some(by) = stopped() {
                return End::By(by);
            }
            if Instant::now() >= deadline {
                return End::Late;
            }
        }
    }

    fn keep(&mut self, line: &str, told: &ChildOutput) {
        told.line(line);
        if !self.said.is_empty() {
            self.said.push_str(" / ");
        }
        self.said.push_str(line);
        let surplus = self.said.len().saturating_sub(MOST_KEPT);
        let cut = (surplus..=self.said.len()).find(|&place| self.said.is_char_boundary(place));
        self.said.drain(..cut.unwrap_or_default());
    }

    fn id(&self) -> Pid {
        Pid::from_raw(self.child.id().cast_signed())
    }

    /// Whether it has ended. It is not reaped yet: its process id, which is also its group's, could then be reused.
    fn has_ended(&self) -> bool {
        let look = WaitPidFlag::WEXITED | WaitPidFlag::WNOHANG | WaitPidFlag::WNOWAIT;
        waitid(Id::Pid(self.id()), look) != Ok(WaitStatus::StillAlive)
    }

    /// Makes sure that it and its whole process group are gone. Returns its exit status and its last output.
    fn end(mut self, told: &ChildOutput) -> (io::Result<ExitStatus>, String) {
        // This fails if all have ended already.
        let _ = killpg(self.id(), Signal::SIGKILL);
        let status = self.child.wait();
        let limit = Instant::now() + LAST_WORDS;
        // A process that it left in another group may hold the streams open for ever.
        while let Some(left) = limit.checked_duration_since(Instant::now())
            && let Ok(line) = self.lines.recv_timeout(left)
        {
            self.keep(&line, told);
        }
        told.done();
        (status, if self.said.is_empty() { "it said nothing".to_owned() } else { self.said })
    }
}

/// Sends the lines of a stream, on a thread. They end with a line feed or, if they show progress, a carriage return.
fn hear(stream: Box<dyn Read + Send>, lines: SyncSender<String>) -> io::Result<()> {
    let hear = move || {
        let mut line = Vec::new();
        let tell = |line: &mut Vec<u8>| {
            let text = String::from_utf8_lossy(line).trim().to_owned();
            line.clear();
            text.is_empty() || lines.send(text).is_ok()
        };
        for byte in io::BufReader::new(stream).bytes().map_while(Result::ok) {
            let is_end = byte == b'\n' || byte == b'\r';
            if !is_end {
                line.push(byte);
            }
            if (is_end || line.len() == MOST_KEPT) && !tell(&mut line) {
                return;
            }
        }
        tell(&mut line);
    };
    thread::Builder::new().name("loader".to_owned()).spawn(hear).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_an_end_is_told_in_pieces() {
        let (sender, lines) = sync_channel(QUEUE);
        hear(Box::new(io::repeat(b'x').take(1 << 20)), sender).unwrap();
        let pieces: Vec<_> = lines.iter().collect();
        assert!(pieces.iter().all(|piece| piece.len() <= MOST_KEPT), "{}", pieces.len());
        assert_eq!(pieces.concat().len(), 1 << 20);
    }

    #[test]
    fn a_call_can_be_repeated_in_a_shell() {
        let ulx3s = BitstreamBoard::named("ulx3s").unwrap();
        let call =
            Call::new(ulx3s, None, Path::new("it's a/top.bit"), &["--freq".to_owned(), "1e6".to_owned()]);
        assert_eq!(call.line(), r"openFPGALoader -b ulx3s --freq 1e6 'it'\''s a/top.bit'");
        assert_eq!(call.other, r"fujprog 'it'\''s a/top.bit'");
    }
}
