//! The station's side of a lane: starts its process, hears what it reports, and kills its group when it falls silent
//! or takes too long.

use std::fs::{self, File};
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender, SyncSender};
use std::thread;
use std::time::{Duration, Instant};

use halfrow::verdict::StoppedBy;

use super::message::MOST_LINE;
use super::{Control, FILE_MIB, LaneJob, Message, Ruling};
use crate::process_group::{command, killed, killed_until, waited};
use crate::record::{BlobError, BoardSeen, StepRecord, made_within};
use crate::said::{Said, Saying};

/// How often the supervisor checks whether anybody wants the run to end.
const LOOK: Duration = Duration::from_millis(50);
/// The most of a look that counts as waited: a busy computer stays below, and one that stood still is far beyond.
const LONGEST_LOOK: Duration = Duration::from_millis(500);
/// How long a lane may take to end once it is told to, or has nothing left to do.
const GRACE: Duration = Duration::from_secs(10);

/// How many lines may wait to be taken; after that the lane waits.
const MOST_WAITING: usize = 4;
/// How many characters are shown of a line that makes no sense.
const MOST_SHOWN: usize = 200;

/// What the lane reports, in the run's spool.
pub(crate) const EVENTS: &str = "events.jsonl";
/// What it logs.
pub const LOG: &str = "lane.log";
/// Its process id, and when the process began.
const PROCESS: &str = "lane.pid";

/// The variable with the number of threads that a lane judges with, for those who want more than one.
const THREADS: &str = "RAYON_NUM_THREADS";

/// This very program, even if its file has been replaced or removed.
pub(crate) const OWN_PROGRAM: &str = "/proc/self/exe";

/// How long a lane may take, and how much it may report.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// The longest time between two messages.
    pub silence: Duration,
    /// The longest time in all.
    pub whole: Duration,
    /// The most tries of steps.
    pub tries: usize,
}

/// What a lane reported, and how it ended.
#[derive(Debug)]
pub struct LaneReport {
    /// Every try of a step that came to an end.
    pub steps: Vec<StepRecord>,
    /// How long it took from the first step's start to the last step's end; none if no step came to an end.
    pub took: Option<Duration>,
    /// How it ended.
    pub end: End,
}

/// How a lane ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// It did all that it was to do.
    Done,
    /// It could not do the job at all.
    Refused(Said),
    /// Somebody wanted the run to end before its process was started.
    Stopped(StoppedBy),
    /// Its process did not start, or ended before it was done.
    Died(Said),
    /// It was killed because it was silent or took too long.
    Killed(Said),
    /// It should have been killed, but the system could not do it: the process may still have the board.
    Stuck(Said),
}

/// Attends to a lane while it works.
pub trait Attendant {
    /// Who wants it to end, once somebody does.
    fn stop(&mut self) -> Option<StoppedBy>;
    /// Takes a message of the lane.
    fn hear(&mut self, message: &Message);
    /// Whether the board may be judged under the serial number of the run.
    fn rule(&mut self, board: &BoardSeen) -> Ruling;
}

/// Has a process of `program` do `job`; what the process writes goes to the folder `spool`.
pub fn supervise(
    program: &Path,
    job: &LaneJob,
    spool: &Path,
    patience: Patience,
    attendant: &mut dyn Attendant,
) -> LaneReport {
    let (mut steps, mut took) = (Vec::new(), None);
    let end = match Lane::start(program, job, spool) {
        Ok(mut lane) => {
            let end = lane.attended(patience, attendant, &mut steps);
            took = lane.took;
            lane.end(end)
        }
        Err(why) => End::Died(why),
    };
    LaneReport { steps, took, end }
}

struct Lane {
    child: Child,
    /// Dropping it ends the process's stdin.
    orders: Option<Sender<String>>,
    lines: Receiver<String>,
    events: File,
    /// How many bytes may still be written there.
    room: u64,
    /// Whether the lane has said that it is of this program.
    is_own: bool,
    /// When its first step began, and how long it took until the last step's end.
    begun: Option<Instant>,
    took: Option<Duration>,
}

impl Lane {
    fn start(program: &Path, job: &LaneJob, spool: &Path) -> Result<Self, Said> {
        let unusable = |source| Said::of(&BlobError::Folder { path: spool.to_owned(), source });
        made_within(spool).map_err(unusable)?;
        let events = File::create(spool.join(EVENTS)).map_err(unusable)?;
        let log = File::create(spool.join(LOG)).map_err(unusable)?;
        let not_started = |error: io::Error| Said::from(Saying::LaneNotStarted { error: error.to_string() });
        // There are many lanes, and the board is what they wait for.
        let threads = std::env::var_os(THREADS).unwrap_or_else(|| "1".into());
        let mut child = command(program)
            .arg0(std::env::args_os().next().unwrap_or_else(|| program.into()))
            .arg("lane")
            .env(THREADS, threads)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(log)
            .spawn()
            .map_err(not_started)?;
        let (sender, lines) = mpsc::sync_channel(MOST_WAITING);
        let (stdout, stdin) = (child.stdout.take(), child.stdin.take());
        let room = FILE_MIB << 20;
        let mut lane =
            Self { orders: None, child, lines, events, room, is_own: false, begun: None, took: None };
        match hear(stdout, sender).and_then(|()| lane.brief(stdin, job, spool)) {
            Ok(()) => Ok(lane),
            Err(error) => {
                let why = not_started(error);
                lane.end(End::Killed(why.clone()));
                Err(why)
            }
        }
    }

    /// Notes the process, so that the next start can find it, and hands it its job.
    fn brief(&mut self, stdin: Option<ChildStdin>, job: &LaneJob, spool: &Path) -> io::Result<()> {
        let id = self.child.id();
        fs::write(spool.join(PROCESS), format!("{id} {}\n", started(id).unwrap_or_default()))?;
        let (orders, given) = mpsc::channel();
        give(stdin, given)?;
        // The lane reads it later.
        let _ = orders.send(serde_json::to_string(job)?);
        self.orders = Some(orders);
        Ok(())
    }

    /// Hears the lane until its last message, its end, or the end of patience.
    fn attended(
        &mut self,
        patience: Patience,
        attendant: &mut dyn Attendant,
        steps: &mut Vec<StepRecord>,
    ) -> End {
        let mut waited = Waited { time: Duration::ZERO, looked: Instant::now() };
        let (mut last, mut asked) = (Duration::ZERO, None);
        loop {
            let line = self.lines.recv_timeout(LOOK);
            waited.look();
            match line {
                Ok(line) => {
                    if let Some(end) = self.take(&line, attendant, steps) {
                        return end;
                    }
                    if steps.len() > patience.tries {
                        steps.truncate(patience.tries);
                        return End::Killed(babbles(&line));
                    }
                    // The answer may have waited for the store.
                    waited.looked = Instant::now();
                    last = waited.time;
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return End::Died(Saying::LaneDied { status: String::new() }.into());
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if asked.is_none()
                && let Some(by) = attendant.stop()
            {
                self.tell(&Control::Stop(by));
                asked = Some(waited.time);
            }
            if let Some(why) = impatient(patience, waited.time, last, asked) {
                return End::Killed(why);
            }
        }
    }

    /// Takes a line of the lane; returns how the lane ended, if that was the last one.
    fn take(
        &mut self,
        line: &str,
        attendant: &mut dyn Attendant,
        steps: &mut Vec<StepRecord>,
    ) -> Option<End> {
        self.write_down(line);
        match serde_json::from_str(line) {
            Err(_) => return Some(End::Killed(babbles(line))),
            Ok(Message::Begun { program }) if program == halfrow::VERSION => self.is_own = true,
            // The record names this program, and another one may judge differently.
            Ok(message) if !self.is_own || matches!(message, Message::Begun { .. }) => {
                let program = halfrow::VERSION.to_owned();
                return Some(End::Refused(Saying::LaneOfOtherProgram { program }.into()));
            }
            Ok(Message::Done) => return Some(End::Done),
            Ok(Message::Refused { why }) => return Some(End::Refused(why)),
            Ok(message) => self.answer(&message, attendant, steps),
        }
        None
    }

    /// Writes a line down, unless the lane has reported too much already. What is lost here is lost only as evidence; the record has
    /// all that counts.
    fn write_down(&mut self, line: &str) {
        let Some(room) = self.room.checked_sub(line.len() as u64 + 1) else { return };
        self.room = room;
        let _ = writeln!(self.events, "{line}");
    }

    /// Takes a message that is not the last, and answers it if it asks something.
    fn answer(&mut self, message: &Message, attendant: &mut dyn Attendant, steps: &mut Vec<StepRecord>) {
        attendant.hear(message);
        match message {
            Message::Step { .. } => _ = self.begun.get_or_insert_with(Instant::now),
            Message::Ended { step } => {
                self.took = self.begun.map(|begun| begun.elapsed());
                steps.push(StepRecord::clone(step));
            }
            Message::Identified { board } => self.tell(&Control::Device(attendant.rule(board))),
            _ => {}
        }
    }

    fn tell(&mut self, control: &Control) {
        if let (Some(orders), Ok(line)) = (&self.orders, serde_json::to_string(control)) {
            // A lane that is gone need not be told.
            let _ = orders.send(line);
        }
    }

    /// Makes sure that the process is gone.
    fn end(mut self, end: End) -> End {
        let is_over = matches!(end, End::Done | End::Refused(_) | End::Died(_));
        let mut own = None;
        if is_over {
            // A process that is to be killed would not end by itself, so its stdin stays open.
            drop(self.orders.take());
            own = waited(&mut self.child, GRACE);
        }
        let is_gone = own.is_some() || killed(&mut self.child).is_some();
        match (end, own) {
            (End::Killed(why), _) if !is_gone => End::Stuck(Saying::LaneStuck { why }.into()),
            (End::Died(_) | End::Done | End::Refused(_), _) if !is_gone => {
                End::Stuck(Saying::LaneEndless.into())
            }
            (End::Died(_), Some(status)) => End::Died(Saying::LaneDied { status: status.to_string() }.into()),
            // It has closed its output. The end of its stdin told it to end.
            (End::Died(_), None) => End::Killed(Saying::LaneDeaf { seconds: GRACE.as_secs_f64() }.into()),
            (end, _) => end,
        }
    }
}

/// Passes on what the lane reports, line by line. A line that is too long is cut, and then makes no sense.
fn hear(stdout: Option<ChildStdout>, to: SyncSender<String>) -> io::Result<()> {
    let hand_on = move || {
        let Some(mut stdout) = stdout.map(BufReader::new) else { return };
        let mut line = Vec::new();
        while let Ok(1..) = stdout.by_ref().take(MOST_LINE as u64).read_until(b'\n', &mut line) {
            let text = String::from_utf8_lossy(line.strip_suffix(b"\n").unwrap_or(&line)).into_owned();
            // Nobody listens any more once the run is over.
            if to.send(text).is_err() {
                return;
            }
            line.clear();
        }
    };
    in_thread(hand_on)
}

/// Passes on to the lane what it is told, line by line, in a thread of its own: a lane that reads nothing must not
/// hold up its supervisor.
fn give(stdin: Option<ChildStdin>, given: Receiver<String>) -> io::Result<()> {
    let hand_on = move || {
        let Some(mut stdin) = stdin else { return };
        // How a lane that is gone ended says more.
        given.into_iter().take_while(|line| writeln!(stdin, "{line}").is_ok()).for_each(drop);
    };
    in_thread(hand_on)
}

fn in_thread(hand_on: impl FnOnce() + Send + 'static) -> io::Result<()> {
    thread::Builder::new().name("lane".to_owned()).spawn(hand_on).map(drop)
}

/// Why a lane that said this is not heard any more.
fn babbles(line: &str) -> Said {
    Saying::LaneBabbles { line: line.chars().take(MOST_SHOWN).collect() }.into()
}

/// How long the lane was waited for. While the supervisor answers, or stands still with its computer, the lane is not to blame.
struct Waited {
    time: Duration,
    looked: Instant,
}

impl Waited {
    /// Counts the time since the last look, as far as a look may have taken it.
    fn look(&mut self) {
        let now = Instant::now();
        self.time += (now - self.looked).min(LONGEST_LOOK);
        self.looked = now;
    }
}

/// Why the lane is waited for no longer, after `time`: it told something `last`, and was asked to end at `asked`.
fn impatient(patience: Patience, time: Duration, last: Duration, asked: Option<Duration>) -> Option<Said> {
    let seconds = |limit: Duration| limit.as_secs_f64();
    if time - last > patience.silence {
        return Some(Saying::LaneSilent { seconds: seconds(patience.silence) }.into());
    }
    if time > patience.whole {
        return Some(Saying::LaneLate { seconds: seconds(patience.whole) }.into());
    }
    let is_deaf = asked.is_some_and(|asked| time - asked > GRACE);
    is_deaf.then(|| Saying::LaneDeaf { seconds: seconds(GRACE) }.into())
}

/// Kills the lane of a run whose station ended before it, if the lane still exists, and waits until it has let go of its board.
pub(crate) fn kill_left_behind(spool: &Path) {
    if let Some(id) = left_behind(spool) {
        killed_until(id, || left_behind(spool).is_none());
    }
}

/// The process of the lane that wrote to this spool, if it has not ended. It is known by its id and by when it began, because ids
/// are reused.
pub(crate) fn left_behind(spool: &Path) -> Option<u32> {
    let noted = fs::read_to_string(spool.join(PROCESS)).ok()?;
    let (id, born) = noted.trim_end().split_once(' ')?;
    let (id, born): (u32, u64) = (id.parse().ok()?, born.parse().ok()?);
    (started(id)? == born).then_some(id)
}

/// When a process began that has not ended, in ticks since the computer was started: fields 3, 20 and 22 of proc_pid_stat(5), whose
/// second field may contain blanks. Whoever should hear of the end of a process may let it wait for years; but the state is that of
/// its first thread alone, and any other one may still have the board.
fn started(id: u32) -> Option<u64> {
    let stat = fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace();
    let has_ended = ["Z", "X"].contains(&fields.next()?);
    let threads: u64 = fields.nth(16)?.parse().ok()?;
    let began = fields.nth(1)?.parse().ok()?;
    (!has_ended || threads > 1).then_some(began)
}
