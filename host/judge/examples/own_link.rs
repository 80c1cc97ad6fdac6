//! Judges a board over a link of this program's own, which hands bytes to a mock board in memory.

use std::error::Error;
use std::time::Duration;

use halfrow::link::mock::{Board, Options};
use halfrow::link::{Candidate, Link, LinkError};
use halfrow::model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};
use halfrow::progress::Silent;
use halfrow::target::BoardKind;
use halfrow::{Plan, RunOptions, Verdict};

/// Bytes take some time to get to the board and back.
const TRANSIT: Duration = Duration::from_micros(10);

struct OwnLink {
    board: Board,
    now: Duration,
}

impl Link for OwnLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        self.board.receive(outgoing, self.now);
        let answer = self.board.outgoing();
        let moved = !outgoing.is_empty() || !answer.is_empty();
        incoming.append(answer);
        // Nothing will come while this call waits, so the time is over at once on this link's clock.
        self.now += if moved { TRANSIT } else { wait };
        Ok(outgoing.len())
    }

    fn now(&self) -> Duration {
        self.now
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn name(&self) -> String {
        "a link of one's own".to_owned()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let lens = Equidistant::from_radius(10.0)?;
    let tables = TableSet::from_lens(Geometry::centred(64, 8, BitDepth::Twelve)?, &lens, None)?;
    let plan = Plan::new(tables, Interpolant::Hermite.into()).seen_through(lens);
    let link = OwnLink { board: Board::new(&Options::default(), None)?, now: Duration::ZERO };
    let candidate = Candidate::new("memory", BoardKind::Mock, link);
    let finished = halfrow::verify(&plan, candidate, &RunOptions::default(), &Silent)?;
    assert_eq!(finished.report.verdict(), Verdict::Pass);
    Ok(())
}
