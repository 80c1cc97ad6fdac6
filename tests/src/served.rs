//! Boards behind devices that the test makes, each served by its own thread.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use halfrow::link;
use halfrow_cli::serve::{Hosted, Name, Port, Pty, ServeError, Traffic};

use crate::parallel::end_beside;

/// How long a board is away before it is plugged in again. No outcome depends on it: the old device is gone at once.
const AWAY: Duration = Duration::from_millis(50);

/// How a board comes back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Replug {
    /// As it was: only its cable was pulled.
    Powered,
    /// As this target, just switched on.
    Switched(String),
    /// As this target, behind a port that never went away: only the board lost power.
    Reset(String),
}

/// A board that is served until this is dropped or its wire breaks.
#[derive(Debug)]
pub struct Served {
    target: String,
    ended: Arc<AtomicBool>,
    traffic: Arc<Mutex<Traffic>>,
    thread: Option<JoinHandle<Result<(), ServeError>>>,
}

impl Served {
    /// The board `board`, a target, behind a pseudo-terminal.
    ///
    /// # Panics
    /// If there is no such board or no pseudo-terminal.
    #[must_use]
    pub fn on_a_serial_port(board: &str) -> Self {
        Self::start(board, |board, mut ended, said| {
            let pty = Pty::open()?;
            said.send(format!("serial:{}", pty.path().display())).unwrap();
            pty.serve(board, &mut ended)
        })
    }

    /// Like [`Self::on_a_serial_port`], under the name `path`, and unplugged when `byte` bytes have gone to the host. Shortly
    /// after, it is plugged in again, if `replug` says how.
    ///
    /// # Panics
    /// If there is no such board or no pseudo-terminal.
    #[must_use]
    pub fn unplugged_once(board: &str, path: &Path, byte: u64, replug: Option<Replug>) -> Self {
        let path: PathBuf = path.to_owned();
        Self::start(board, move |board, mut ended, said| {
            let pty = Pty::open()?;
            let name = Name::link(&path, pty.path())?;
            said.send(format!("serial:{}", path.display())).unwrap();
            pty.serve(board, &mut |traffic| traffic.to_host >= byte || ended(traffic))?;
            let switched_on = |other: &str| Hosted::new(link::open(&other.parse().unwrap()).unwrap().link);
            if let Some(Replug::Reset(other)) = &replug {
                *board = switched_on(other);
                return pty.serve(board, &mut ended);
            }
            drop((name, pty));
            let Some(replug) = replug else { return Ok(()) };
            std::thread::sleep(AWAY);
            if let Replug::Switched(other) = replug {
                *board = switched_on(&other);
            }
            let pty = Pty::open()?;
            let _name = Name::link(&path, pty.path())?;
            pty.serve(board, &mut ended)
        })
    }

    /// The board `board` behind a TCP port on `host`.
    ///
    /// # Panics
    /// If there is no such board or no port.
    #[must_use]
    pub fn on_a_tcp_port(host: &str, board: &str) -> Self {
        let place = format!("{host}:0").parse().unwrap();
        Self::start(board, move |board, mut ended, said| {
            let port = Port::listen(&place)?;
            said.send(format!("tcp:{}", port.address()?)).unwrap();
            port.serve(board, &mut ended)
        })
    }

    fn start(
        board: &str,
        serve: impl FnOnce(
            &mut Hosted,
            Box<dyn FnMut(Traffic) -> bool>,
            &Sender<String>,
        ) -> Result<(), ServeError>
        + Send
        + 'static,
    ) -> Self {
        let (said, heard) = channel();
        let ended = Arc::new(AtomicBool::new(false));
        let traffic = Arc::new(Mutex::new(Traffic::default()));
        let board = board.parse().unwrap();
        let thread: JoinHandle<Result<(), ServeError>> = std::thread::spawn({
            let (ended, traffic) = (Arc::clone(&ended), Arc::clone(&traffic));
            move || {
                let mut board = Hosted::new(link::open(&board).unwrap().link);
                let is_over = move |moved| {
                    *traffic.lock().unwrap() = moved;
                    ended.load(Ordering::Relaxed)
                };
                serve(&mut board, Box::new(is_over), &said)
            }
        });
        let Ok(target) = heard.recv() else {
            panic!("no board is served: {:?}", end_beside(Some(thread)));
        };
        Self { target, ended, traffic, thread: Some(thread) }
    }

    /// The bytes moved for the host that it serves now.
    ///
    /// # Panics
    /// When the thread that serves it has panicked.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        *self.traffic.lock().unwrap()
    }

    /// The target that leads to this board.
    #[must_use]
    pub fn target(&self) -> String {
        self.target.clone()
    }

    /// The device's path, or host and port.
    ///
    /// # Panics
    /// Never.
    #[must_use]
    pub fn address(&self) -> &str {
        self.target.split_once(':').unwrap().1
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let result = end_beside(self.thread.take());
        // A board whose wire broke has ended as well as any other.
        if let Some(Err(error)) = result.filter(|it| !matches!(it, Err(ServeError::Board(_))))
            && !std::thread::panicking()
        {
            panic!("the board was served no more: {error:?}");
        }
    }
}
