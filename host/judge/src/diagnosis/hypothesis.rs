//! A single defect, and how much of the observed differences it explains.

use std::ops::Range;

use super::witnesses::Witness;
use crate::result::Defect;

/// How many rows must speak for or against a defect before it can be given up.
const PATIENCE: usize = 8;
/// The share below which a defect is then given up.
const HOPELESS: f64 = 0.1;

/// The row that a board with a defect would have given.
#[derive(Clone, Debug)]
pub(super) struct Prediction {
    samples: Vec<u16>,
    known: Range<usize>,
}

impl Prediction {
    /// A row of which only the columns `known` follow from the defect.
    pub(super) fn partly(samples: Vec<u16>, known: Range<usize>) -> Self {
        Self { samples, known }
    }

    /// A row about which the defect says nothing.
    pub(super) fn unknown() -> Self {
        Self { samples: Vec::new(), known: 0..0 }
    }
}

impl From<Vec<u16>> for Prediction {
    fn from(samples: Vec<u16>) -> Self {
        let known = 0..samples.len();
        Self { samples, known }
    }
}

/// What a defect makes of a row; none if the row stays as it should be.
type Predict<'a> = dyn Fn(&Witness<'_>) -> Option<Prediction> + 'a;

/// A single defect that the board may have.
pub(super) struct Hypothesis<'a> {
    /// The defect.
    pub(super) defect: Defect,
    predict: Box<Predict<'a>>,
}

impl<'a> Hypothesis<'a> {
    /// A defect that turns a row into what `predict` gives, or leaves it as it should be.
    pub(super) fn new(defect: Defect, predict: impl Fn(&Witness<'_>) -> Option<Prediction> + 'a) -> Self {
        Self { defect, predict: Box::new(predict) }
    }

    /// How much of `rows` it explains. A defect that explains next to nothing of the rows that it touches is given up early.
    pub(super) fn score<'w, 'r: 'w>(&self, rows: impl Iterator<Item = &'w Witness<'r>>) -> Score {
        let mut score = Score::default();
        let mut touched = Score::default();
        let mut tried = 0;
        for row in rows {
            let Some(prediction) = (self.predict)(row) else {
                score.differing += row.differences;
                continue;
            };
            let of_row = Score::of_row(&prediction, row);
            score.add(of_row);
            touched.add(of_row);
            tried += usize::from(of_row != Score::default());
            if tried >= PATIENCE && touched.share() < HOPELESS {
                break;
            }
        }
        score
    }
}

/// How well a defect explains rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Score {
    /// Samples that differ from the reference.
    pub(super) differing: usize,
    /// How many of those the defect predicts exactly.
    pub(super) explained: usize,
    /// Samples that the defect would change but that are right.
    pub(super) contradicted: usize,
}

impl Score {
    /// How well a prediction fits its row.
    pub(super) fn of_row(prediction: &Prediction, row: &Witness<'_>) -> Self {
        let samples = prediction.samples.iter().zip(row.found).zip(row.expected);
        let known = samples.take(prediction.known.end).skip(prediction.known.start);
        let mut score = Self::default();
        for ((predicted, found), expected) in known {
            let differs = found != expected;
            score.differing += usize::from(differs);
            score.explained += usize::from(differs && predicted == found);
            score.contradicted += usize::from(!differs && predicted != found);
        }
        score
    }

    fn add(&mut self, other: Self) {
        self.differing += other.differing;
        self.explained += other.explained;
        self.contradicted += other.contradicted;
    }

    /// The share that is explained, 0 to 1. Contradicted samples count against it.
    pub(super) fn share(&self) -> f64 {
        match self.differing + self.contradicted {
            0 => 0.0,
            all => self.explained as f64 / all as f64,
        }
    }

    /// Whether every differing sample is explained and none contradicted.
    pub(super) fn is_exact(&self) -> bool {
        self.differing > 0 && self.explained == self.differing && self.contradicted == 0
    }
}
