//! Which defects explain the differences best.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use super::hypothesis::{Hypothesis, Score};
use super::witnesses::Witnesses;
use crate::result::{Account, CONVINCING, Defect, Reading, Suspect, wording};

/// Differing rows on which every hypothesis is tried.
const SCREENED: usize = 48;
/// Hypotheses that go on to the final test if none explains all of these rows.
const FINALISTS: usize = 6;
/// Hypotheses that go on, at most, if they explain all of these rows.
const MOST_FINALISTS: usize = 128;
/// Differing rows of the final test.
const EXAMINED: usize = 192;
/// The most suspects that are named.
pub(super) const NAMED: usize = 3;
/// The least share that a suspect must explain.
const LEAST_SHARE: f64 = 0.2;

/// A defect and its score.
#[derive(Clone)]
pub(super) struct Ranked {
    /// The defect.
    pub(super) defect: Defect,
    /// Its score on the rows from the first difference of the run on.
    pub(super) score: Score,
    /// Samples before that which the defect would have changed. If there are any, it can only have set in during the run.
    before: usize,
}

/// The hypotheses that explain something, the best first. Of those that explain equally much, the one proposed earlier comes
/// first.
pub(super) fn rank(witnesses: &Witnesses<'_>, hypotheses: Vec<Hypothesis<'_>>) -> Vec<Ranked> {
    let mut screened: Vec<_> = hypotheses
        .into_iter()
        .map(|hypothesis| (hypothesis.score(witnesses.sample(SCREENED)), hypothesis))
        .filter(|(score, _)| score.share() >= LEAST_SHARE)
        .collect();
    screened.sort_by(|(a, _), (b, _)| by_share(a, b));
    // A hypothesis that contradicts a few of these rows contradicts more of all rows. So if any explains them all, the others
    // cannot win.
    let exact = screened.iter().take_while(|(score, _)| score.is_exact()).count();
    let finalists = if exact > 0 { exact.min(MOST_FINALISTS) } else { FINALISTS };
    let finals = screened.into_iter().take(finalists).map(|(_, hypothesis)| {
        let score = hypothesis.score(witnesses.sample(EXAMINED));
        let before = hypothesis.score(witnesses.sample_before(EXAMINED)).contradicted;
        Ranked { defect: hypothesis.defect, score, before }
    });
    merge(finals.collect(), Vec::new())
}

/// Both lists as one, the best first, each part once.
pub(super) fn merge(mut ranked: Vec<Ranked>, more: Vec<Ranked>) -> Vec<Ranked> {
    ranked.extend(more);
    ranked.sort_by(|a, b| {
        by_share(&a.score, &b.score)
            .then((a.before > 0).cmp(&(b.before > 0)))
            .then(b.score.explained.cmp(&a.score.explained))
    });
    let mut places = BTreeSet::new();
    ranked.retain(|candidate| places.insert(wording::place(&candidate.defect)));
    ranked
}

fn by_share(a: &Score, b: &Score) -> Ordering {
    b.share().total_cmp(&a.share())
}

/// The suspects to name. `summary` comes first if nothing explains most of the differences.
pub(super) fn suspects(ranked: &[Ranked], summary: impl FnOnce() -> Suspect) -> Vec<Suspect> {
    let alike = ranked.iter().take_while(|candidate| candidate.is_as_good_as(ranked.first())).count();
    let named = if alike > 0 { alike } else { ranked.len() };
    let (defects, others) = entries(ranked.iter().take(named), alike);
    let mut suspects: Vec<_> = defects
        .iter()
        .filter(|candidate| candidate.is_worth_naming())
        .map(|candidate| suspect(candidate, others))
        .collect();
    if suspects.first().is_none_or(|best| best.explained < CONVINCING) {
        suspects.insert(0, summary());
    }
    suspects.truncate(NAMED);
    suspects
}

/// The candidates, with those that are bits of one word merged into one. The first `alike` candidates explain everything that they
/// foretell; those that foretell less than the first are left out. Also returns how many explain everything in addition to the
/// first.
fn entries<'r>(ranked: impl Iterator<Item = &'r Ranked>, alike: usize) -> (Vec<Ranked>, usize) {
    let mut words: Vec<Ranked> = Vec::new();
    for (place, candidate) in ranked.enumerate() {
        let is_lesser = place < alike && candidate.explains_less_than(words.first());
        let same_word = words.iter_mut().filter(|_| place < alike).find_map(|word| word.same_word(candidate));
        match same_word {
            Some((reading, bit)) => reading.alike.push(bit),
            None if is_lesser => {}
            None => words.push(candidate.clone()),
        }
    }
    let others = words.len().saturating_sub(1);
    (words, if alike > 0 { others } else { 0 })
}

impl Ranked {
    /// Its reading of a word and the bit of the other candidate, if that breaks the same word.
    fn same_word(&mut self, other: &Self) -> Option<(&mut Reading, u32)> {
        let (own, of_other) = (&mut self.defect, &other.defect);
        match (own, of_other) {
            (
                Defect::RowFactorBitWrong { row, reading, .. },
                Defect::RowFactorBitWrong { row: other, bit, .. },
            ) if row == other => Some((reading, *bit)),
            (
                Defect::GridEntryBitWrong { column, row, reading, .. },
                Defect::GridEntryBitWrong { column: at, row: other, bit, .. },
            ) if (&*column, &*row) == (at, other) => Some((reading, *bit)),
            (
                Defect::KernelWordBitWrong { node, weight, reading, .. },
                Defect::KernelWordBitWrong { node: other, weight: of, bit, .. },
            ) if (&*node, &*weight) == (other, of) => Some((reading, *bit)),
            _ => None,
        }
    }

    /// Whether it explains most of the differences or, of fewer, more than it would spoil.
    fn is_worth_naming(&self) -> bool {
        let Score { explained, contradicted, .. } = self.score;
        let share = self.score.share();
        share >= CONVINCING || share >= LEAST_SHARE && contradicted < explained
    }

    fn explains_less_than(&self, best: Option<&Self>) -> bool {
        best.is_some_and(|best| self.score.explained < best.score.explained)
    }

    /// Whether it explains everything, as the best does, and agrees with the best on whether the defect was there from the run's
    /// beginning on.
    fn is_as_good_as(&self, best: Option<&Self>) -> bool {
        self.score.is_exact() && best.is_some_and(|best| (best.before > 0) == (self.before > 0))
    }
}

fn suspect(Ranked { defect, score, before }: &Ranked, others: usize) -> Suspect {
    let &Score { differing, explained, contradicted } = score;
    let account = Account::Samples { differing, explained, contradicted, others, set_in: *before > 0 };
    Suspect { defect: defect.clone(), account, explained: score.share() }
}
