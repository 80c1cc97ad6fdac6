//! Thousands of poor links: none makes a sound board fail, none lets a broken one pass, and none hangs a run.
//!
//! Most runs have the mock's virtual clock, where a second of silence costs nothing. The others run in real time, many at once:
//! over a pseudo-terminal, and over TCP through a proxy.

mod draw;
mod kept;
mod table;

use std::time::Duration;

use halfrow::verdict::Verdict;

use crate::parallel;
use crate::patience::come_to_an_end_within;
use crate::proxy::{Proxy, Suffers};
use crate::served::Served;
use crate::system::System;

pub use draw::{draw, real, real_and_short, virtual_};
pub use kept::SavedResults;

/// How many runs in real time go on at once: they mostly wait.
const AT_ONCE: usize = 48;

/// How a run reaches its board.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// On the mock's virtual clock; the fault of its wire, as options of a target.
    Virtual(String),
    /// In real time over a pseudo-terminal, with a fault likewise.
    SerialPort(String),
    /// In real time over TCP, through a proxy.
    Tcp {
        /// What happens to bytes to the board.
        to_board: Suffers,
        /// What happens to bytes to the host.
        to_host: Suffers,
    },
}

/// A run as drawn.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its number in the campaign.
    pub index: usize,
    /// The kind of link, in a few words.
    pub kind: &'static str,
    /// The link.
    pub way: Way,
    /// Lens and frames.
    pub system: System,
    /// The board's fault as options of a target; empty for a sound one.
    pub broken: String,
    /// The seed of the proxy.
    pub seed: u64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Came {
    /// With a verdict.
    To(Verdict),
    /// Not within its bound.
    Nowhere,
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// What was run.
    pub case: Case,
    /// How it ended.
    pub came: Came,
    /// The result in one sentence.
    pub headline: String,
}

/// All runs of a campaign.
#[derive(Clone, Debug)]
pub struct PoorLinks(pub Vec<Run>);

/// Judges the boards of all `cases`, each within `bound` of wall-clock time. Those that `kept` knows are not judged again.
#[must_use]
pub fn run(cases: &[Case], bound: Duration, kept: &SavedResults) -> PoorLinks {
    let judge = |case: &Case| {
        let (came, headline) = kept.of(case.index).unwrap_or_else(|| {
            let ended = case.judge_within(bound);
            kept.keep(case.index, &ended);
            ended
        });
        Run { case: case.clone(), came, headline }
    };
    let (waiting, computing): (Vec<_>, Vec<_>) =
        cases.iter().cloned().partition(|case| !matches!(case.way, Way::Virtual(_)));
    let mut runs = parallel::map(&computing, judge);
    runs.extend(parallel::map_by(AT_ONCE, &waiting, judge));
    PoorLinks(runs)
}

impl Case {
    /// Judges the board on a thread of its own, which is left running if it does not end in time.
    fn judge_within(&self, bound: Duration) -> (Came, String) {
        let case = self.clone();
        match come_to_an_end_within(bound, move || case.judge()) {
            Some((verdict, headline)) => (Came::To(verdict), headline),
            None => (Came::Nowhere, format!("no end within {} s", bound.as_secs_f64())),
        }
    }

    fn judge(&self) -> (Verdict, String) {
        let (system, broken) = (&self.system, &self.broken);
        let report = match &self.way {
            Way::Virtual(link) => system.judge(&format!("{link}{broken}")),
            Way::SerialPort(link) => {
                let served = Served::on_a_serial_port(&format!("{}{link}{broken}", system.board));
                system.judge_at(&served.target())
            }
            Way::Tcp { to_board, to_host } => {
                let served = Served::on_a_tcp_port("127.0.0.1", &format!("{}{broken}", system.board));
                let proxy = Proxy::before(served.address(), *to_board, *to_host, self.seed);
                system.judge_at(proxy.target())
            }
        };
        (report.verdict(), report.headline())
    }
}

impl Run {
    fn is_broken(&self) -> bool {
        !self.case.broken.is_empty()
    }

    /// Whether the verdict is wrong: PASS for a broken board, or FAIL for a sound one.
    #[must_use]
    pub fn is_false(&self) -> bool {
        self.came == Came::To(if self.is_broken() { Verdict::Pass } else { Verdict::Fail })
    }
}

impl PoorLinks {
    /// The runs whose verdict is wrong.
    pub fn false_verdicts(&self) -> impl Iterator<Item = &Run> {
        self.0.iter().filter(|run| run.is_false())
    }

    /// The runs that did not end.
    pub fn hangs(&self) -> impl Iterator<Item = &Run> {
        self.0.iter().filter(|run| run.came == Came::Nowhere)
    }

    /// The runs that should have passed: of a sound board over a link whose stalls are within the host's patience.
    pub fn needless_errors(&self) -> impl Iterator<Item = &Run> {
        self.0.iter().filter(|run| {
            run.case.kind == draw::SHORT_STALLS && !run.is_broken() && run.came != Came::To(Verdict::Pass)
        })
    }
}
