//! Hundreds of single faults of the board: which of them the samples show, and which check finds the rest.
//!
//! A fault in a table is first hidden from read-back, so that the samples alone must show it. Those that they do not show are
//! tried once more unhidden, and then the read-back check must find them.

use std::collections::BTreeMap;
use std::fmt;

use halfrow::Plan;
use halfrow::verdict::Verdict;

use crate::dice::Dice;
use crate::parallel;
use halfrow::result::CheckName;

use crate::system::{System, failed_check, judge_by_plan, open};

/// The kinds of faults, and their shares of a campaign, in tenths.
const KINDS: [(Kind, usize); 5] = [
    (Kind::RowFactor, 3),
    (Kind::KernelWord, 3),
    (Kind::DataLine, 1),
    (Kind::AddressLine, 1),
    (Kind::DeadTap, 2),
];

/// A kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A bit of a row's table entry.
    RowFactor,
    /// A bit of a kernel word.
    KernelWord,
    /// A data line of the line memory, stuck at either level.
    DataLine,
    /// An address line of the line memory, stuck at either level.
    AddressLine,
    /// A tap that carries zero or another tap's sample.
    DeadTap,
}

/// How a fault was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// A returned sample was wrong.
    BySamples,
    /// No sample was wrong, but a table read back wrong.
    ByReadBack,
    /// No check fails.
    ByNothing,
}

/// A fault, and how it was found.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its kind.
    pub kind: Kind,
    /// Its options in a target.
    pub options: String,
    /// How often it was drawn.
    pub drawn: usize,
    /// How it was found.
    pub found: Found,
}

/// A finished campaign: every fault that was drawn, once.
#[derive(Clone, Debug)]
pub struct Campaign(pub Vec<Case>);

/// Draws `count` faults by `seed` from all that a board of this system can have, and judges each.
///
/// # Panics
/// When a run ends in anything but PASS or FAIL, since nothing is wrong with the link.
#[must_use]
pub fn run(system: &System, count: usize, seed: u64) -> Campaign {
    let mut dice = Dice::new(seed);
    let mut drawn: BTreeMap<(Kind, String), usize> = BTreeMap::new();
    for index in 0..count {
        let kind = kind_of(index);
        *drawn.entry((kind, kind.draw(system, &mut dice))).or_default() += 1;
    }
    let drawn: Vec<_> = drawn.into_iter().collect();
    Campaign(parallel::map(&drawn, |((kind, options), drawn)| Case {
        kind: *kind,
        options: options.clone(),
        drawn: *drawn,
        found: kind.search(system, &system.plan(), options),
    }))
}

/// The kind of the fault of this number, such that any ten in a row have each kind's share.
fn kind_of(index: usize) -> Kind {
    let mut tenths = KINDS.into_iter().flat_map(|(kind, share)| std::iter::repeat_n(kind, share));
    tenths.nth(index % 10).unwrap()
}

impl Kind {
    /// A fault of this kind, drawn from all that exist.
    fn draw(self, system: &System, dice: &mut Dice) -> String {
        let mut below = |end| dice.below(end);
        match self {
            Self::RowFactor => format!(",fault=row-factor,row={},bit={}", below(system.height), below(25)),
            Self::KernelWord => {
                let weight = ["g0", "r1", "g4", "r5", "g6"][below(5)];
                format!(",fault=kernel-word,node={},weight={weight},bit={}", below(65), below(16))
            }
            Self::DataLine => format!(",fault=stuck-data,bit={},value={}", below(12), below(2)),
            Self::AddressLine => {
                let lines = system.ring.ilog2() as usize;
                format!(",fault=stuck-address,bit={},value={}", below(lines), below(2))
            }
            Self::DeadTap => match (below(7), below(7)) {
                (tap, other) if tap == other => format!(",fault=dead-tap,tap={tap}"),
                (tap, other) => format!(",fault=dead-tap,tap={tap},reads={other}"),
            },
        }
    }

    /// Looks for a fault of this kind, given as options of a target, by a plan of `system`: first in the samples alone, then by
    /// read-back.
    ///
    /// # Panics
    /// When the run ends in anything but PASS or FAIL, or a check fails that has nothing to do with the fault.
    #[must_use]
    pub fn search(self, system: &System, plan: &Plan, options: &str) -> Found {
        let is_in_table = matches!(self, Self::RowFactor | Self::KernelWord);
        let hidden = if is_in_table { ",hidden=true" } else { "" };
        match check_of(system, plan, &format!("{options}{hidden}")) {
            Some(CheckName::Frames | CheckName::AtSpeed) => return Found::BySamples,
            Some(other) => panic!("{options}: the check {other} failed, which looks at no samples"),
            None if !is_in_table => return Found::ByNothing,
            None => {}
        }
        match check_of(system, plan, options) {
            Some(CheckName::ReadBack) => Found::ByReadBack,
            Some(other) => panic!("{options}: {other} failed, and it should have been read-back"),
            None => Found::ByNothing,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::RowFactor => "row factor",
            Self::KernelWord => "kernel word",
            Self::DataLine => "data line",
            Self::AddressLine => "address line",
            Self::DeadTap => "dead tap",
        }
    }
}

fn check_of(system: &System, plan: &Plan, options: &str) -> Option<CheckName> {
    let report = judge_by_plan(plan, open(&format!("{}{options}", system.board)));
    assert_ne!(report.verdict(), Verdict::Error, "{options}: {}", report.headline());
    let check = failed_check(&report);
    assert_eq!(check.is_some(), report.verdict() == Verdict::Fail, "{options}: {}", report.headline());
    check
}

impl Campaign {
    /// The faults that were found this way.
    pub fn that_were(&self, found: Found) -> impl Iterator<Item = &Case> {
        self.0.iter().filter(move |case| case.found == found)
    }

    /// How many draws of a kind were found this way; none stands for all kinds, and for any way.
    fn count(&self, kind: Option<Kind>, found: Option<Found>) -> usize {
        let of_kind = |case: &&Case| kind.is_none_or(|kind| kind == case.kind);
        let found = |case: &&Case| found.is_none_or(|found| found == case.found);
        self.0.iter().filter(of_kind).filter(found).map(|case| case.drawn).sum()
    }

    fn line(&self, f: &mut fmt::Formatter<'_>, name: &str, kind: Option<Kind>) -> fmt::Result {
        let drawn = self.count(kind, None);
        let [samples, read_back, nothing] = [Found::BySamples, Found::ByReadBack, Found::ByNothing]
            .map(|found| self.count(kind, Some(found)));
        let share = 100.0 * samples as f64 / drawn.max(1) as f64;
        writeln!(f, "{name:<14}{drawn:>7}{samples:>10} ({share:5.1} %){read_back:>20}{nothing:>12}")
    }
}

impl fmt::Display for Campaign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<14}{:>7}{:>20}{:>20}{:>12}",
            "fault", "drawn", "by samples alone", "by read-back alone", "by nothing"
        )?;
        for (kind, _) in KINDS {
            self.line(f, kind.name(), Some(kind))?;
        }
        self.line(f, "all", None)?;
        writeln!(f, "{} of them different; the rest are repetitions", self.0.len())?;
        for (found, what) in [(Found::ByReadBack, "by read-back alone"), (Found::ByNothing, "by nothing")] {
            for case in self.that_were(found) {
                writeln!(f, "found {what}: {}", case.options.trim_start_matches(','))?;
            }
        }
        Ok(())
    }
}
