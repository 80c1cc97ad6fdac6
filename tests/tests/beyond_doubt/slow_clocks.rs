//! Boards with a slow pixel clock, behind links that say zeros between packets, which mean nothing: they pass.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use halfrow::link::{Candidate, Link, LinkError};
use halfrow::run::{Part, Plan, Selection};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::{BurstState, Records, Request};
use halfrow_protocol::{Packet, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{System, judge_by_plan};

/// 10 kHz.
const CLOCK: u32 = 10_000;
/// What up to three frames of the least width take it, in milliseconds: the longest have 8 rows of some 100 clocks.
const TAKES: u64 = 330;
const FEW: u32 = 3;
/// Between two zeros.
const BETWEEN: Duration = Duration::from_millis(2);

/// A link that says a zero now and then while nothing else is said.
struct Trickles {
    link: Box<dyn Link>,
    /// Milliseconds on its clock, for the board.
    clock: Arc<AtomicU64>,
}

impl Link for Trickles {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        let taken = self.link.exchange(out, back, wait.min(BETWEEN))?;
        self.clock.store(self.link.now().as_millis() as u64, Ordering::Relaxed);
        if taken == 0 && back.is_empty() && wait >= BETWEEN {
            back.push(0);
        }
        Ok(taken)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn name(&self) -> String {
        "a link with zeros between packets".to_owned()
    }
}

/// A sound board that makes few frames as slowly as its clock says. The mock's take no time.
fn slow_board() -> Candidate {
    let clock = Arc::new(AtomicU64::new(0));
    let (now, mut begun) = (Arc::clone(&clock), BTreeMap::new());
    let alter = move |toward, packet: Passing| {
        let now = now.load(Ordering::Relaxed);
        let read = Packet { header: packet.header, payload: &packet.payload };
        match (toward, Request::read(&read), packet.reply()) {
            (Toward::Board, Ok(Request::Burst(burst)), _) if (1..=FEW).contains(&burst.frames) => {
                begun.entry(burst.burst).or_insert(now);
            }
            (Toward::Host, _, Some(Reply::Records(records)))
                if begun.get(&records.burst).is_some_and(|begun| now < begun + TAKES) =>
            {
                let none = Records { state: BurstState::UnderWay, bytes: &[], ..records };
                return vec![packet.saying(&Reply::Records(none))];
            }
            _ => {}
        }
        vec![packet]
    };
    let options = Options { pixel_clock: CLOCK, ..Options::default() };
    let candidate = Altered::new(&options, alter).candidate();
    let link = Box::new(Trickles { link: candidate.link, clock });
    Candidate { link, ..candidate }
}

#[track_caller]
fn passes(plan: &Plan) {
    let report = judge_by_plan(plan, slow_board());
    assert_eq!(report.verdict, Verdict::Pass, "{}", report.headline());
}

#[test]
fn its_frames_at_speed_are_waited_for() {
    passes(&Plan { parts: Some(Selection::least().with(Part::AtSpeed, 3)), ..System::TINY.plan() });
}

#[test]
fn its_bursts_are_waited_for_where_rules_are_tried() {
    passes(&Plan { parts: Some(Selection::least().with(Part::Rules, 1)), ..System::TINY.plan() });
}
