//! Mock boards behind sockets, which the lanes of the demonstration reach like a fixture.

use std::io::{self, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use halfrow::link::{self, Link};
use parking_lot::Mutex;
use rand::TryRng as _;
use rand::rngs::SysRng;

/// How long to wait for bytes from either end.
const WAIT: Duration = Duration::from_millis(2);
/// The most bytes that are read at once.
const MOST: usize = 64 * 1024;

/// The faults of the boards that are not right: one part of each kind that a technician may see. The suspect names it,
/// or the finding if a row never comes or the cable fails. A new fault of the mock belongs here only if it shows a
/// page that none of these does.
const FAULTS: [&str; 8] = [
    "fault=stuck-data,bit=7",
    "fault=dead-tap,tap=4",
    "fault=row-factor,row=40",
    "fault=tap-offset",
    "fault=kernel-word",
    "fault=lost-row,row=17",
    "fault=no-rounding",
    // A cable is no fault of the board, so the run is ERROR.
    "fault=disconnect,packet=60",
];
/// One in this many boards is not right.
const ONE_OF: u8 = 4;

/// The place of one board, into which another one can be put.
#[derive(Clone, Debug)]
pub(super) struct Fixture {
    pub(super) address: SocketAddr,
    board: Arc<Mutex<String>>,
}

impl Fixture {
    /// Starts a fixture with a board that is right. It lasts as long as the program.
    pub(super) fn start() -> io::Result<Self> {
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let fixture = Self { address: listener.local_addr()?, board: Arc::new(Mutex::new(target(""))) };
        let board = Arc::clone(&fixture.board);
        thread::Builder::new().name("fixture".to_owned()).spawn(move || {
            // After a connection that breaks, the next one is served.
            listener.incoming().flatten().for_each(|stream| drop(served(stream, &board)));
        })?;
        Ok(fixture)
    }

    /// Puts another board in, most often a good one.
    pub(super) fn exchange(&self) {
        let [which, fault] = drawn();
        let fault = if which % ONE_OF == 0 { FAULTS.get(usize::from(fault) % FAULTS.len()) } else { None };
        *self.board.lock() = target(fault.unwrap_or(&""));
    }
}

fn target(fault: &str) -> String {
    let build = "mock,pace=real,speed=1000000";
    if fault.is_empty() { build.to_owned() } else { format!("{build},{fault}") }
}

/// Random bytes; always the same ones if the system has no randomness.
pub(super) fn drawn<const N: usize>() -> [u8; N] {
    let mut drawn = [1; N];
    let _ = SysRng.try_fill_bytes(&mut drawn);
    drawn
}

/// Carries bytes between a connection and the board that is in the fixture, until either is gone.
fn served(mut stream: TcpStream, board: &Mutex<String>) -> anyhow::Result<()> {
    let target = board.lock().parse()?;
    let mut link = link::open(&target)?.link;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(WAIT))?;
    let mut buffer = vec![0; MOST];
    loop {
        match stream.read(&mut buffer) {
            Ok(0) => return Ok(()),
            Ok(read) => put(&mut *link, buffer.get(..read).unwrap_or_default(), &mut stream)?,
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                put(&mut *link, &[], &mut stream)?;
            }
            Err(error) => return Err(error.into()),
        }
    }
}

/// Sends all of `bytes` to the board, and to the connection whatever the board answers meanwhile.
fn put(link: &mut dyn Link, mut bytes: &[u8], stream: &mut TcpStream) -> anyhow::Result<()> {
    loop {
        let mut answer = Vec::new();
        let taken = link.exchange(bytes, &mut answer, WAIT)?;
        bytes = bytes.get(taken..).unwrap_or_default();
        stream.write_all(&answer)?;
        if bytes.is_empty() {
            return Ok(());
        }
    }
}
