//! What all tests use: a plan, serial numbers, the program, and a view of what it stored.

use std::fmt::Debug;
use std::fs::{self, File};
use std::hash::{BuildHasher as _, RandomState};
use std::io::Write as _;
use std::iter;
use std::net::{TcpListener, TcpStream};
use std::ops::{Deref, DerefMut};
use std::os::unix::fs::FileTypeExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use halfrow_station::progress::Progress;
use halfrow_station::store::{By, Reason};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use tempfile::TempDir;

/// A plan whose runs take a moment; `scripts` and `packages` read it, too.
pub(crate) const PLAN: &str = include_str!("quick.toml");

/// [`PLAN`] for a product whose serial numbers are `letters` and a number with a check digit as in an ISBN-10.
pub(crate) fn guarded_plan(product: &str, letters: &str) -> String {
    let pattern = format!("^{letters}(?<number>[0-9]{{9}}[0-9X])$");
    PLAN.replace("CAM-T", product).replace("^CAT[0-9]{5}$", &pattern).replace("\"none\"", "\"mod11\"")
}

/// Why a person does something.
pub(crate) fn reason(text: &str) -> Reason {
    Reason::of(text).unwrap()
}

/// An engineer with a reason.
pub(crate) fn engel(reason: &Reason) -> By<'_> {
    By { operator: "engel", reason }
}

/// Tells nobody how far something has come.
pub(crate) fn untold(_: Progress) {}

/// Milliseconds since 1970.
pub(crate) fn now_ms() -> i64 {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap();
    now.as_millis().try_into().unwrap()
}

/// A folder for a station, on a disk: the usual temporary folder may be in memory.
pub(crate) fn folder() -> TempDir {
    tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap()
}

/// The same call under a umask that closes nothing, whatever that of the tests is.
pub(crate) fn unmasked(call: &Command) -> Command {
    let mut open = Command::new("sh");
    open.args(["-c", "umask 0; exec \"$0\" \"$@\""]).arg(call.get_program()).args(call.get_args());
    open.envs(call.get_envs().filter_map(|(name, value)| Some((name, value?))));
    open
}

/// A shell script of this name in `folder`.
pub(crate) fn script(folder: &Path, name: &str, lines: &str) -> PathBuf {
    program_of(folder, name, &format!("#!/bin/sh\n{lines}"))
}

/// A program of this name and text in `folder`. Another process writes it: one that another test starts just then would have it
/// open, too, and a file that somebody may write to cannot be executed.
pub(crate) fn program_of(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    let write = "rm -f \"$0\" && printf %s \"$1\" > \"$0\" && chmod 755 \"$0\"";
    assert!(Command::new("sh").args(["-c", write]).arg(&path).arg(text).status().unwrap().success());
    path
}

/// How long to wait for what must happen: the limit only ends hangs.
pub(crate) const HANG: Duration = Duration::from_secs(120);

/// Waits until `is_so`, which `what` names.
pub(crate) fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    until_found(what, || if is_so() { Ok(()) } else { Err("not so") });
}

/// Waits until `look` finds what `what` names; before that it returns what there is instead.
pub(crate) fn until_found<T, E: Debug>(what: &str, mut look: impl FnMut() -> Result<T, E>) -> T {
    let begun = Instant::now();
    loop {
        match look() {
            Ok(found) => return found,
            Err(instead) => assert!(begun.elapsed() < HANG, "still waiting for {what}: {instead:?}"),
        }
        thread::sleep(Duration::from_millis(20));
    }
}

/// Puts a named pipe, whose reader waits for a writer, in the place of a file.
pub(crate) fn replaced_by_pipe(path: &Path) {
    fs::remove_file(path).unwrap();
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

/// The writing end of the FIFO at `path`, as soon as a reader has opened it. The reader waits until it is dropped.
pub(crate) fn held_up(path: &Path) -> File {
    until(&format!("a FIFO at {}", path.display()), || {
        fs::metadata(path).is_ok_and(|found| found.file_type().is_fifo())
    });
    let (sender, opened) = mpsc::channel();
    let fifo = path.to_owned();
    thread::spawn(move || sender.send(File::options().write(true).open(fifo)));
    opened.recv_timeout(HANG).unwrap().unwrap()
}

/// A port that was free may be taken by the time that a server asks for it, but not every time.
pub(crate) const PORTS_TRIED: usize = 5;

/// A free port, below those that Linux gives to whoever names none, so that hardly anybody gets it while its server is away.
pub(crate) fn free_port() -> u16 {
    let drawn = || 10_000 + u16::try_from(RandomState::new().hash_one(()) % 20_000).unwrap();
    iter::repeat_with(drawn).find(|port| TcpListener::bind(("127.0.0.1", *port)).is_ok()).unwrap()
}

/// A server that `begin` starts at a port of 127.0.0.1, as soon as it listens, and the port. One that ends did not get its port.
pub(crate) fn listening(name: &str, mut begin: impl FnMut(u16) -> Child) -> (Killed, u16) {
    for _ in 0..PORTS_TRIED {
        let port = free_port();
        let mut server = Killed(begin(port));
        let mut ended = None;
        until(&format!("{name} to listen at port {port}"), || {
            ended = server.try_wait().unwrap();
            ended.is_some() || is_listening(&server, port)
        });
        if ended.is_none() {
            return (server, port);
        }
    }
    panic!("{name} is not installed, or does not start");
}

/// Whether this process itself listens at this port of 127.0.0.1: another one may have taken it, and be the one that answers.
fn is_listening(process: &Child, port: u16) -> bool {
    let place = format!("0100007F:{port:04X}");
    let table = fs::read_to_string("/proc/net/tcp").unwrap();
    let sockets: Vec<_> = table.lines().filter_map(|line| listened(line, &place)).collect();
    let Ok(open) = fs::read_dir(format!("/proc/{}/fd", process.id())) else { return false };
    open.flatten().filter_map(|file| fs::read_link(file.path()).ok()).any(|file| sockets.contains(&file))
}

/// The socket of a line of /proc/net/tcp that listens at `place`, as proc(5) names it among a process's files.
fn listened(line: &str, place: &str) -> Option<PathBuf> {
    const LISTEN: &str = "0A";
    let fields: Vec<_> = line.split_whitespace().collect();
    let [_, local, _, state, _, _, _, _, _, inode, ..] = fields.as_slice() else { return None };
    (*local == place && *state == LISTEN).then(|| format!("socket:[{inode}]").into())
}

/// A board that accepts the connection and stays silent.
pub(crate) fn silent_board() -> (TcpListener, String) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    (listener, target)
}

/// The next connection to `listener`.
pub(crate) fn accepted(listener: &TcpListener) -> TcpStream {
    listener.set_nonblocking(true).unwrap();
    until_found("a connection", || listener.accept()).0
}

/// Says that something is over when it is dropped, however the test ends.
pub(crate) struct Over<'a>(pub(crate) &'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Sends a process a signal.
pub(crate) fn signal(process: u32, signal: Signal) {
    kill(Pid::from_raw(process.cast_signed()), signal).unwrap();
}

/// What proc_pid_stat(5) says of a process, from its state on; nothing if there is none. The name before that may contain
/// anything.
pub(crate) fn stat(process: u32) -> Vec<String> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let from_state = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    from_state.split_whitespace().map(str::to_owned).collect()
}

/// Whether there is a process of this number that has not ended. Who ends may still wait for its parent, or for the first process,
/// which need not look after it in a container.
pub(crate) fn exists(process: u32) -> bool {
    stat(process).first().is_some_and(|state| state != "Z")
}

/// The process of the lane whose run has this spool, once it is noted there.
pub(crate) fn lane_process(spool: &Path) -> Option<u32> {
    let noted = fs::read_to_string(spool.join("lane.pid")).ok()?;
    noted.split_whitespace().next()?.parse().ok()
}

/// A process that is killed when it is dropped.
pub(crate) struct Killed(pub(crate) Child);

impl Killed {
    /// Ends it as a service is ended.
    pub(crate) fn end(mut self) {
        signal(self.id(), Signal::SIGTERM);
        assert_eq!(self.wait().unwrap().code(), Some(143));
    }
}

impl Deref for Killed {
    type Target = Child;

    fn deref(&self) -> &Child {
        &self.0
    }
}

impl DerefMut for Killed {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.0
    }
}

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A lane with a mock board.
pub(crate) const LANE: &str = "[[lane]]\nname = \"1\"\nboard = \"mock\"\nplans = [\"plan.toml\"]\n";

/// Writes [`PLAN`] and the settings of a station of this name, which stores in `data`, into `folder`; returns the latter's path.
pub(crate) fn settings(folder: &Path, name: &str, data: &str, more: &str) -> PathBuf {
    fs::write(folder.join("plan.toml"), PLAN).unwrap();
    let path = folder.join("station.toml");
    fs::write(&path, format!("schema = 1\n[station]\nname = \"{name}\"\ndata = \"{data}\"\n{more}")).unwrap();
    path
}

/// `[plant]` of a station whose results go to `url`, however full the disk of the tests is.
pub(crate) fn plant_settings(url: &str) -> String {
    format!("[plant]\nurl = \"{url}\"\nmost_filled = 100\n")
}

/// Serial numbers whose check digits publishers computed: ISBNs of printed books, including The C Programming Language and TeX:
/// The Program.
pub(crate) const SERIALS: [&str; 4] = ["CA0131103628", "CA0201134373", "CA080442957X", "CA0306406152"];

pub(crate) fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_halfrow-station"))
}

/// How a call of the program ended, and what it printed.
#[derive(Debug)]
pub(crate) struct Did {
    pub(crate) code: Option<i32>,
    pub(crate) said: String,
    pub(crate) complained: String,
}

impl From<Output> for Did {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code(), said: text(output.stdout), complained: text(output.stderr) }
    }
}

/// What the program does when it is called so.
pub(crate) fn did(arguments: &[&str]) -> Did {
    Command::new(program()).args(arguments).output().unwrap().into()
}

/// A call of the program with the settings in this folder.
pub(crate) fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(program());
    command.args(arguments).arg("--settings").arg(folder.join("station.toml"));
    command
}

/// What `command` does, which may read this.
pub(crate) fn told(command: &mut Command, said: &str) -> Output {
    let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = pipes.spawn().unwrap();
    // Whatever refuses its call does not read it.
    let _ = child.stdin.take().unwrap().write_all(said.as_bytes());
    child.wait_with_output().unwrap()
}

/// Runs the program while the system refuses this of the file at `path`.
pub(crate) fn did_refused(path: &Path, what: &str, arguments: &[&str]) -> Did {
    let mut call = Command::new("strace");
    call.args(["-f", "-qq", "-o", "/dev/null", "-e", &format!("inject={what}"), "-P"]).arg(path);
    call.arg(program()).args(arguments).output().unwrap().into()
}

/// What the program does when it is called so with the settings in this folder.
pub(crate) fn did_in(folder: &Path, arguments: &[&str]) -> Did {
    command(folder, arguments).output().unwrap().into()
}

/// Puts `is` in the place of `was` wherever that stands in a file, as it must.
pub(crate) fn instead(path: impl AsRef<Path>, was: &str, is: &str) {
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(was), "no `{was}` in {text}");
    fs::write(path, text.replace(was, is)).unwrap();
}

/// Makes the database refuse new entries in the audit.
pub(crate) const NO_AUDIT: &str =
    "CREATE TRIGGER full BEFORE INSERT ON audit BEGIN SELECT RAISE(FAIL, 'the disk is full'); END";

/// Runs `check` on this folder.
pub(crate) fn check(data: &Path) -> Did {
    Command::new(program()).arg("check").arg("--data").arg(data).output().unwrap().into()
}

/// Waits until the log has `count` lines with `of`, and fails if it has more.
pub(crate) fn logged(log: &Path, count: usize, of: &str) {
    until_found(&format!("{count} of {of}"), || {
        let text = fs::read_to_string(log).unwrap_or_default();
        let found = text.lines().filter(|line| line.contains(of)).count();
        assert!(found <= count, "{found} of {of}: {text}");
        if found == count { Ok(()) } else { Err(text) }
    });
}

/// Changes the database of this folder without the program; returns how many rows the last statement changed.
pub(crate) fn change(data: &Path, text: &str) -> usize {
    let database = rusqlite::Connection::open(data.join("station.db")).unwrap();
    database.busy_timeout(HANG).unwrap();
    database.execute_batch(text).unwrap();
    database.changes() as usize
}

/// Reads the database of this folder without the program: the first value of each row.
pub(crate) fn query(data: &Path, text: &str) -> Vec<String> {
    let database = rusqlite::Connection::open(data.join("station.db")).unwrap();
    let mut statement = database.prepare(text).unwrap();
    let rows = statement.query_map([], |row| row.get::<_, rusqlite::types::Value>(0)).unwrap();
    let text = |value| match value {
        rusqlite::types::Value::Text(text) => text,
        rusqlite::types::Value::Integer(number) => number.to_string(),
        other => format!("{other:?}"),
    };
    rows.map(|row| text(row.unwrap())).collect()
}
