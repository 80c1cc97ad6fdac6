//! A program that knows no more of halfrow than its documentation says. It judges a board over a link of its own making, which
//! breaks during the run and is opened again. Prints the verdict, the cause, and how often the link came back.

use std::error::Error;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use halfrow::frames::Builtin;
use halfrow::link::LinkError;
use halfrow::model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};
use halfrow::target::BoardKind;
use halfrow::{Candidate, FrameSource, Link, Plan, RunOptions};
use halfrow_mock::{Board, Options};

/// Calls until the first link breaks, which is in the middle of the frames.
const LIFE: usize = 30;

/// A board that keeps its state while nobody is connected.
type Shared = Arc<Mutex<Board>>;

/// A link of this program's own: it hands bytes straight to the board, and breaks after some calls.
struct OwnLink {
    board: Shared,
    now: Duration,
    calls_left: usize,
}

impl Link for OwnLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        self.calls_left = self
            .calls_left
            .checked_sub(1)
            .ok_or_else(|| LinkError::Closed { link: self.name(), at: self.now })?;
        let mut board = self.board.lock().unwrap_or_else(PoisonError::into_inner);
        board.receive(outgoing, self.now);
        let answered = !board.outgoing().is_empty();
        incoming.append(board.outgoing());
        self.now += if answered || !outgoing.is_empty() { Duration::from_micros(10) } else { wait };
        Ok(outgoing.len())
    }

    fn now(&self) -> Duration {
        self.now
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn is_exclusive(&self) -> bool {
        true
    }

    fn name(&self) -> String {
        "a link from outside".to_owned()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let lens = Equidistant::from_radius(10.0)?;
    let tables = TableSet::from_lens(Geometry::centred(64, 8, BitDepth::Twelve)?, &lens, None)?;
    let plan = Plan::new(tables, Interpolant::Hermite.into())
        .seen_through(lens)
        .frames([Builtin::Noise, Builtin::Street].map(FrameSource::Builtin));

    let board: Shared = Arc::new(Mutex::new(Board::new(&Options::default(), None)?));
    let opened = Arc::new(AtomicUsize::new(0));
    let link = |calls_left| OwnLink { board: Arc::clone(&board), now: Duration::ZERO, calls_left };
    let (again, count) = (Arc::clone(&board), Arc::clone(&opened));
    let candidate = Candidate::new("outside", BoardKind::Hardware, link(LIFE)).reopened_by(move || {
        // The first try comes too early, as when the system does not know a device yet.
        match count.fetch_add(1, Ordering::Relaxed) {
            0 => Err("not there yet"),
            _ => Ok(OwnLink { board: Arc::clone(&again), now: Duration::ZERO, calls_left: usize::MAX }),
        }
    });
    let options = RunOptions { reconnect: Some(Duration::from_secs(30)), ..RunOptions::default() };
    let finished = halfrow::verify(&plan, candidate, &options, &halfrow::progress::Silent)?;
    let report = &finished.report;
    println!("{} {} {}", report.verdict(), report.cause, report.link.reconnections.len());
    eprintln!("{}; {} tries to open the link again", report.headline(), opened.load(Ordering::Relaxed));
    Ok(())
}
