//! What an earlier session has left in a board is nothing to a run.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use halfrow::board::{Board, NumberedFrame, OpenOptions, ReturnedRow, RowTiming, RowTraffic};
use halfrow::link::{Candidate, Link, LinkError};
use halfrow_model::{Frame, Kernel, Phase, TableSet};
use halfrow_tests::system::{System, open};

use crate::conduct::passes;

/// A link to a board that stays when it is dropped.
#[derive(Clone)]
struct Shared(Arc<Mutex<Box<dyn Link>>>);

impl Shared {
    fn with<T>(&self, act: impl FnOnce(&mut dyn Link) -> T) -> T {
        act(&mut **self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Link for Shared {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        self.with(|link| link.exchange(out, back, wait))
    }

    fn now(&self) -> Duration {
        self.with(|link| link.now())
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.with(|link| link.bytes_per_second())
    }

    fn name(&self) -> String {
        self.with(|link| link.name())
    }
}

/// One frame, of which only the return matters.
struct One(Option<NumberedFrame>);

impl RowTraffic for One {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.0.take()
    }

    fn returned(&mut self, _: &ReturnedRow<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Leaves `tables` active as `generation`, and the counters of a frame.
fn leave(link: Shared, tables: &TableSet, kernel: &Kernel, generation: u8) {
    let geometry = tables.geometry();
    let samples = vec![0; geometry.width() * geometry.height()];
    let frame = Frame::new(geometry.width(), geometry.depth(), Phase::Grbg, samples).unwrap();
    Board::with(Box::new(link), &OpenOptions::default(), |board| {
        board.configure(geometry, RowTiming::default()).unwrap();
        board.upload(tables, kernel).unwrap();
        board.commit(tables, kernel, 0, generation).unwrap();
        board.stream(&mut One(Some(NumberedFrame { number: 0, frame: Arc::new(frame) }))).unwrap();
    })
    .unwrap();
}

/// By a lens of another radius, under each generation that a run has. A board takes a commit of the active one for a repeated packet.
#[test]
fn tables_that_were_left_under_the_generations_of_a_run_are_dropped() {
    let other = System { radius: System::TINY.radius + 5.0, ..System::TINY }.plan();
    for banks in [1, 2] {
        for generation in 1..=3 {
            let candidate = open(&format!("mock,table-banks={banks}"));
            let shared = Shared(Arc::new(Mutex::new(candidate.link)));
            leave(shared.clone(), &other.tables, &other.kernel, generation);
            passes(&System::TINY.judge_candidate(Candidate { link: Box::new(shared), ..candidate }));
        }
    }
}
