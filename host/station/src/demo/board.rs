//! Mock boards behind sockets: the lanes of the demonstration reach them as they would a fixture.

use std::io::{self, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use halfrow::link::{self, Link};
use rand::TryRng as _;
use rand::rngs::SysRng;

/// How long it is waited for bytes from either end.
const WAIT: Duration = Duration::from_millis(2);
/// The most bytes that are read at once.
const MOST: usize = 64 * 1024;

/// What is broken in the boards that are not right: one part of each kind that a technician may see, each told by the suspect or, of a row
/// that never comes and of a cable, by the finding. A new fault of the mock belongs here only if it shows a page that none of these does.
const FAULTS: [&str; 8] = [
    "fault=stuck-data,bit=7",
    "fault=dead-tap,tap=4",
    "fault=row-factor,row=40",
    "fault=tap-offset",
    "fault=kernel-word",
    "fault=lost-row,row=17",
    "fault=no-rounding",
    // A cable: no board's fault, so the run is ERROR.
    "fault=disconnect,packet=60",
];
/// One of so many boards is not right.
const ONE_OF: u8 = 4;

/// The place of one board, into which another one can be put.
#[derive(Clone, Debug)]
pub(super) struct Fixture {
    pub(super) address: SocketAddr,
    board: Arc<Mutex<String>>,
}

impl Fixture {
    /// A fixture with a board that is right. It is there as long as the program.
    pub(super) fn start() -> io::Result<Self> {
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let fixture = Self { address: listener.local_addr()?, board: Arc::new(Mutex::new(target(""))) };
        let board = Arc::clone(&fixture.board);
        thread::Builder::new().name("fixture".to_owned()).spawn(move || {
            // A connection that breaks is the next one's chance.
            listener.incoming().flatten().for_each(|stream| drop(served(stream, &board)));
        })?;
        Ok(fixture)
    }

    /// Puts another board in, most likely a good one.
    pub(super) fn exchange(&self) {
        let [which, fault] = drawn();
        let fault = if which % ONE_OF == 0 { FAULTS.get(usize::from(fault) % FAULTS.len()) } else { None };
        *self.board.lock().unwrap_or_else(PoisonError::into_inner) = target(fault.unwrap_or(&""));
    }
}

fn target(fault: &str) -> String {
    let build = "mock,pace=real,speed=1000000";
    if fault.is_empty() { build.to_owned() } else { format!("{build},{fault}") }
}

/// Drawn bytes; the same ones every time where the system has none.
pub(super) fn drawn<const N: usize>() -> [u8; N] {
    let mut drawn = [1; N];
    let _ = SysRng.try_fill_bytes(&mut drawn);
    drawn
}

/// Carries bytes between a connection and the board that is in the fixture, until either is gone.
fn served(mut stream: TcpStream, board: &Mutex<String>) -> anyhow::Result<()> {
    let target = board.lock().unwrap_or_else(PoisonError::into_inner).parse()?;
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

/// Gives the board all of `bytes`, and the connection what the board answers meanwhile.
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
