//! A place that is held by a process, which gives it back when its stdin ends.

use std::io::{BufRead as _, BufReader, Read};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

use halfrow::target::Target;

use super::error::{HelperReply, Port};
use super::{LabgridError, Place};
use crate::process_group::{killed, waited};

/// How often to check whether anybody wants the run to end.
const LOOK: Duration = Duration::from_millis(20);

/// A place that the lane has.
#[derive(Debug)]
pub struct AcquiredPlace {
    /// Its board, as this computer reaches it.
    pub target: Target,
    holder: Holder,
    place: Place,
}

impl Place {
    /// Acquires the place; `None` if `is_stopped` comes first.
    ///
    /// # Errors
    /// [`LabgridError`]
    pub fn hold(&self, is_stopped: &dyn Fn() -> bool) -> Result<Option<AcquiredPlace>, LabgridError> {
        self.wait_until_left();
        let (holder, lines) = Holder::start(self.call("hold")).map_err(|source| self.not_started(source))?;
        let answer = self.answered(&lines, is_stopped);
        if let Ok(Some(HelperReply::Held(port))) = &answer {
            return Ok(Some(AcquiredPlace { target: reached(port), holder, place: self.clone() }));
        }
        self.leave(holder);
        match answer? {
            Some(HelperReply::Refused(why)) => Err(why.of(self.name.clone())),
            Some(HelperReply::Held(_) | HelperReply::Freed) | None => Ok(None),
        }
    }

    /// Gives the place back if this lane still has it from an earlier run that did not.
    ///
    /// # Errors
    /// [`LabgridError`]
    pub fn free(&self) -> Result<(), LabgridError> {
        let (mut holder, lines) =
            Holder::start(self.call("free")).map_err(|source| self.not_started(source))?;
        let answer = self.answered(&lines, &|| false);
        drop(holder.stdin.take());
        holder.left(&self.name, self.labgrid.deadline);
        match answer? {
            Some(HelperReply::Refused(why)) => Err(why.of(self.name.clone())),
            Some(HelperReply::Held(_) | HelperReply::Freed) | None => Ok(()),
        }
    }

    /// The process's answer; `None` if `is_stopped` comes first.
    fn answered(
        &self,
        lines: &Receiver<Line>,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<Option<HelperReply>, LabgridError> {
        let begun = Instant::now();
        let mut complaint = String::new();
        loop {
            match lines.recv_timeout(LOOK) {
                Ok(Line::Said(line)) => match serde_json::from_str(&line) {
                    Ok(answer) => return Ok(Some(answer)),
                    Err(_) => return Err(self.failed(line)),
                },
                Ok(Line::Complained(line)) if line.trim().is_empty() => {}
                Ok(Line::Complained(line)) => complaint = line,
                Err(RecvTimeoutError::Disconnected) => return Err(self.failed(complaint)),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if is_stopped() {
                return Ok(None);
            }
            if begun.elapsed() > self.labgrid.deadline {
                let seconds = self.labgrid.deadline.as_secs_f64();
                return Err(LabgridError::Late { place: self.name.clone(), seconds });
            }
        }
    }

    fn program(&self) -> String {
        self.labgrid.program.display().to_string()
    }

    fn not_started(&self, source: std::io::Error) -> LabgridError {
        LabgridError::NotStarted { program: self.program(), source }
    }

    fn failed(&self, said: String) -> LabgridError {
        let said = if said.trim().is_empty() { "it said nothing".to_owned() } else { said };
        LabgridError::Failed { program: self.program(), said }
    }

    /// Has the place given back without waiting for that; whoever holds it next waits.
    fn leave(&self, mut holder: Holder) {
        drop(holder.stdin.take());
        let (name, deadline) = (self.name.clone(), self.labgrid.deadline);
        let left =
            thread::Builder::new().name("labgrid".to_owned()).spawn(move || holder.left(&name, deadline));
        match left {
            Ok(left) => *self.leaving.lock() = Some(left),
            Err(error) => tracing::warn!("nobody waits for {} to be given back: {error}", self.name),
        }
    }

    /// Waits until an earlier run has given the place back, or failed to.
    pub(super) fn wait_until_left(&self) {
        let leaving = self.leaving.lock().take();
        if leaving.is_some_and(|leaving| leaving.join().is_err()) {
            tracing::error!("a thread of {} ended early; look at what it said before", self.name);
        }
    }
}

impl AcquiredPlace {
    /// Why the place is not held any more, if what held it has ended by itself. If it was killed, the place is still acquired.
    pub(crate) fn lost(&mut self) -> Option<LabgridError> {
        let status = self.holder.child.try_wait().ok()??;
        let status = status.code().map(|_| status.to_string())?;
        Some(LabgridError::Lost { place: self.place.name.clone(), status })
    }

    /// Gives the place back. Only the next hold of the place waits for that.
    pub fn give_back(self) {
        self.place.leave(self.holder);
    }
}

/// The target of a raw port. Deadlines are computed from the speed that its exporter states for the line behind it; it
/// sets nothing.
fn reached(port: &Port) -> Target {
    let Port { host, port, speed } = port;
    let host = if host.contains(':') && !host.starts_with('[') { format!("[{host}]") } else { host.clone() };
    let options = speed.iter().map(|speed| ("baud".to_owned(), speed.to_string())).collect();
    Target { kind: "tcp".to_owned(), address: Some(format!("{host}:{port}")), options }
}

/// A line that the process wrote.
#[derive(Debug)]
enum Line {
    Said(String),
    Complained(String),
}

/// The process that holds the place.
#[derive(Debug)]
struct Holder {
    child: Child,
    stdin: Option<ChildStdin>,
}

impl Holder {
    /// Starts it. What it writes can be received until the receiver is dropped.
    fn start(mut call: Command) -> std::io::Result<(Self, Receiver<Line>)> {
        call.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = call.spawn()?;
        let (sender, lines) = mpsc::channel();
        let heard = [
            child.stdout.take().map(|stdout| read(stdout, Line::Said, sender.clone())),
            child.stderr.take().map(|stderr| read(stderr, Line::Complained, sender)),
        ];
        let mut holder = Self { stdin: child.stdin.take(), child };
        for thread in heard.into_iter().flatten() {
            thread.inspect_err(|_| {
                killed(&mut holder.child);
            })?;
        }
        Ok((holder, lines))
    }

    /// Waits for the end of the process, whose stdin is closed.
    fn left(mut self, place: &str, deadline: Duration) {
        let Some(status) = waited(&mut self.child, deadline) else {
            tracing::warn!(
                "labgrid did not take {place} back in time; the lane's next run does it, or `labgrid-client -p {place} release`"
            );
            killed(&mut self.child);
            return;
        };
        if !status.success() {
            tracing::debug!("what held {place} ended with {status}");
        }
    }
}

/// Passes on what the process writes, to its end, so that it never waits for a reader.
fn read(
    from: impl Read + Send + 'static,
    line: fn(String) -> Line,
    to: Sender<Line>,
) -> std::io::Result<thread::JoinHandle<()>> {
    thread::Builder::new().name("labgrid's words".to_owned()).spawn(move || {
        let lines = BufReader::new(from).lines().map_while(Result::ok);
        // Nobody listens any more once there is an answer.
        lines.for_each(|text| drop(to.send(line(text))));
    })
}

#[cfg(test)]
mod tests {
    use nix::unistd::{Pid, getpgid};

    use super::*;
    use crate::labgrid::Labgrid;

    /// An IPv6 address before a port is in brackets (RFC 3986, section 3.2.2).
    #[test]
    fn a_port_is_reached_where_its_exporter_says_and_its_deadlines_know_the_line_behind_it() {
        for (answer, target) in [
            (r#"{"host": "bench", "port": 4001, "speed": 115200}"#, "tcp:bench:4001,baud=115200"),
            (r#"{"host": "fd00::7", "port": 4001, "speed": null}"#, "tcp:[fd00::7]:4001"),
            (r#"{"host": "[fd00::7]", "port": 4001}"#, "tcp:[fd00::7]:4001"),
        ] {
            let port = serde_json::from_str(answer).unwrap();
            assert_eq!(reached(&port).to_string(), target);
        }
    }

    /// Ctrl-C goes to the whole group of the station, and the run is to end before its board is given back.
    #[test]
    fn what_has_the_place_is_in_a_group_of_its_own() {
        // It ends at once, and keeps its group until it is waited for.
        let labgrid = Labgrid { program: "cat".into(), coordinator: None, deadline: Duration::from_secs(60) };
        let place = Place::new("cam-1".to_owned(), "4", "1", labgrid);
        let (mut holder, _) = Holder::start(place.call("hold")).unwrap();
        let process = Pid::from_raw(holder.child.id().cast_signed());
        assert_eq!(getpgid(Some(process)), Ok(process));
        drop(holder.stdin.take());
        holder.left("cam-1", Duration::from_secs(60));
    }
}
