//! Which defects explain the differences best, and in which words.

use std::cmp::Ordering;

use super::hypothesis::{Cause, Hypothesis, Score};
use super::witnesses::Witnesses;
use crate::report::Suspect;

/// Differing rows that every hypothesis is tried on.
const SCREENED: usize = 48;
/// Hypotheses that are tried on more when none explains all of these.
const FINALISTS: usize = 6;
/// Hypotheses that are tried on more when they explain all of these.
const MOST_FINALISTS: usize = 128;
/// Differing rows that these are tried on.
const EXAMINED: usize = 192;
/// Suspects that are named.
const NAMED: usize = 3;
/// The least share of a suspect.
const LEAST_SHARE: f64 = 0.2;
/// The least share of a suspect that may be named first.
const CONVINCING: f64 = 0.5;

/// A defect and how well it does.
pub(super) struct Ranked {
    /// The defect.
    pub(super) cause: Cause,
    /// How well it does from the first difference of the run on.
    pub(super) score: Score,
    /// Samples before that which it would have changed: if there are any, it set in during the run.
    before: usize,
}

/// The hypotheses that explain something, the best first. Of those that explain as much, the one proposed earlier leads.
pub(super) fn rank(witnesses: &Witnesses<'_>, hypotheses: Vec<Hypothesis<'_>>) -> Vec<Ranked> {
    let mut screened: Vec<_> = hypotheses
        .into_iter()
        .map(|hypothesis| (hypothesis.score(witnesses.sample(SCREENED)), hypothesis))
        .filter(|(score, _)| score.share() >= LEAST_SHARE)
        .collect();
    screened.sort_by(|(a, _), (b, _)| by_share(a, b));
    // What contradicts a few rows contradicts more, so beside one that explains them all nothing else can win.
    let exact = screened.iter().take_while(|(score, _)| score.is_exact()).count();
    let finalists = if exact > 0 { exact.min(MOST_FINALISTS) } else { FINALISTS };
    let finals = screened.into_iter().take(finalists).map(|(_, hypothesis)| {
        let score = hypothesis.score(witnesses.sample(EXAMINED));
        let before = hypothesis.score(witnesses.sample_before(EXAMINED)).contradicted;
        Ranked { cause: hypothesis.cause, score, before }
    });
    merge(finals.collect(), Vec::new())
}

/// Both lists as one, the best first, each place once.
pub(super) fn merge(mut ranked: Vec<Ranked>, more: Vec<Ranked>) -> Vec<Ranked> {
    ranked.extend(more);
    ranked.sort_by(|a, b| by_share(&a.score, &b.score).then((a.before > 0).cmp(&(b.before > 0))));
    let mut merged: Vec<Ranked> = Vec::new();
    for candidate in ranked {
        if merged.iter().all(|known| known.cause.place != candidate.cause.place) {
            merged.push(candidate);
        }
    }
    merged
}

fn by_share(a: &Score, b: &Score) -> Ordering {
    b.share().total_cmp(&a.share())
}

/// The suspects to name. `summary` stands first when nothing explains most of the differences.
pub(super) fn suspects(ranked: &[Ranked], summary: impl FnOnce() -> Suspect) -> Vec<Suspect> {
    let alike = ranked.iter().take_while(|candidate| candidate.is_as_good_as(ranked.first())).count();
    let named = if alike > 0 { alike } else { ranked.len() };
    let others = alike.saturating_sub(1);
    let mut suspects: Vec<_> = ranked
        .iter()
        .take(named)
        .filter(|candidate| candidate.score.share() >= LEAST_SHARE)
        .map(|candidate| suspect(candidate, others))
        .collect();
    if suspects.first().is_none_or(|best| best.explained < CONVINCING) {
        suspects.insert(0, summary());
    }
    suspects.truncate(NAMED);
    suspects
}

impl Ranked {
    /// Whether both explain everything, and both from the run's beginning on if the best does.
    fn is_as_good_as(&self, best: Option<&Self>) -> bool {
        self.score.is_exact() && best.is_some_and(|best| (best.before > 0) == (self.before > 0))
    }
}

fn suspect(Ranked { cause, score, before }: &Ranked, others: usize) -> Suspect {
    let Cause { part, place, defect, next_step } = cause.clone();
    let onset =
        if *before > 0 { "; it set in during the run, since rows before came back right" } else { "" };
    let evidence = format!("{defect} {}{onset}", account(score, others));
    Suspect { part, place, evidence, next_step, explained: score.share() }
}

/// What the defect gives, as the rest of a sentence. `others` explain everything as well.
fn account(score: &Score, others: usize) -> String {
    let &Score { differing, explained, contradicted } = score;
    if !score.is_exact() {
        let rest = match contradicted {
            0 => String::new(),
            1 => ", but would change one that is right".to_owned(),
            more => format!(", but would change {more} that are right"),
        };
        return format!("gives {explained} of the {differing} differing samples examined{rest}");
    }
    let all = match differing {
        1 => "gives the one differing sample examined, and changes no other".to_owned(),
        _ => format!("gives all {differing} differing samples examined, to the bit, and changes no other"),
    };
    match others {
        0 => all,
        1 => format!("{all}; so does one other defect, so this is not certain"),
        _ => format!("{all}; so do {others} other defects, so this is not certain"),
    }
}
