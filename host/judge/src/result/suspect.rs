//! A suspected defect, and how well it explains what was seen.

use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

use super::{Defect, wording};

/// The part to which a pattern of differences points.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Suspect {
    /// What is suspected, and where.
    pub defect: Defect,
    /// How well it explains what was seen.
    pub account: Account,
    /// The share of the differing samples, or of the wrong words of a table, that it explains exactly, 0 to 1.
    pub explained: f64,
}

/// The least share of the samples that the first suspect must explain to be believed.
pub(crate) const CONVINCING: f64 = 0.5;

/// How well a defect explains what was seen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum Account {
    /// Samples that were examined.
    Samples {
        /// How many differ from the reference.
        differing: usize,
        /// How many of these the defect gives, to the bit.
        explained: usize,
        /// Samples that the defect would change and that are right.
        contradicted: usize,
        /// How many other defects explain everything equally well.
        others: usize,
        /// Whether the defect would also have changed earlier rows, which came back right: it began during the run.
        set_in: bool,
    },
    /// Words of a table that was read back.
    Words {
        /// How many read back as another word.
        wrong: usize,
        /// How many of these the defect gives.
        explained: usize,
        /// How many other stuck lines would read the same.
        others: usize,
    },
    /// Signatures of frames that the board made itself.
    Signatures {
        /// Frames whose signature is not the reference's.
        wrong: usize,
        /// How many of these the defect gives.
        explained: usize,
    },
    /// The defect says where the differences lie, and explains none of them.
    Nothing,
}

/// What a suspect leaves unexplained of the samples that were examined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shortfall {
    /// How many differ from the reference.
    pub differing: usize,
    /// How many of these the defect gives, to the bit.
    pub explained: usize,
    /// Samples that the defect would change and that are right.
    pub contradicted: usize,
}

/// What a finding says of the suspect that stands first.
#[derive(Default)]
pub(crate) struct Lead {
    /// Its defect, if there is any suspect.
    pub(crate) suspect: Option<Box<Defect>>,
    /// How many others explain everything equally well.
    pub(crate) others: usize,
    /// What it leaves unexplained.
    pub(crate) short: Option<Shortfall>,
}

impl Lead {
    /// Of `suspects`, the likeliest first.
    pub(crate) fn of(suspects: &[Suspect]) -> Self {
        suspects.first().map_or_else(Self::default, |first| Self {
            suspect: Some(Box::new(first.defect.clone())),
            others: first.others(),
            short: first.shortfall(),
        })
    }
}

impl Suspect {
    /// A suspect that says where the differences lie, and explains none of them.
    pub(crate) fn explaining_nothing(defect: Defect) -> Self {
        Self { defect, account: Account::Nothing, explained: 0.0 }
    }

    /// A suspect that gives the signatures of `explained` of `wrong` frames that the board made itself.
    pub(crate) fn of_signatures(defect: Defect, wrong: usize, explained: usize) -> Self {
        let account = Account::Signatures { wrong, explained };
        Self { defect, account, explained: explained as f64 / wrong as f64 }
    }

    /// What it leaves unexplained; none if it explains everything, or names no defect that could.
    #[must_use]
    pub fn shortfall(&self) -> Option<Shortfall> {
        match self.account {
            Account::Samples { differing, explained, contradicted, .. }
                if explained < differing || contradicted > 0 =>
            {
                Some(Shortfall { differing, explained, contradicted })
            }
            Account::Samples { .. }
            | Account::Words { .. }
            | Account::Signatures { .. }
            | Account::Nothing => None,
        }
    }

    /// How many other defects explain everything equally well; with any, this one is not certain.
    #[must_use]
    pub fn others(&self) -> usize {
        match self.account {
            Account::Samples { others, .. } | Account::Words { others, .. } => others,
            Account::Signatures { .. } | Account::Nothing => 0,
        }
    }

    /// Whether it is a known defect, rather than only a description of where the differences lie.
    #[must_use]
    pub fn is_known(&self) -> bool {
        !matches!(self.defect, Defect::NoneKnown { .. })
    }

    /// The kind of the suspected part, in lower case.
    #[must_use]
    pub fn part(&self) -> &'static str {
        wording::part(&self.defect)
    }

    /// Where it is: row, node and weight, bit, as far as it is known.
    #[must_use]
    pub fn place(&self) -> String {
        wording::place(&self.defect)
    }

    /// Why it is suspected, in one sentence without a full stop.
    #[must_use]
    pub fn evidence(&self) -> String {
        wording::evidence(&self.defect, &self.account)
    }

    /// Where the designer of the board should look next, in one sentence.
    #[must_use]
    pub fn designer(&self) -> String {
        wording::designer(&self.defect)
    }

    /// What a technician should do with this board.
    #[must_use]
    pub fn technician(&self) -> String {
        match self.account {
            Account::Samples { .. } if self.explained < CONVINCING => wording::if_unsure(&self.defect),
            _ => wording::technician(&self.defect),
        }
    }
}

impl Serialize for Suspect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut suspect = serializer.serialize_struct("Suspect", 8)?;
        suspect.serialize_field("defect", &self.defect)?;
        suspect.serialize_field("account", &self.account)?;
        suspect.serialize_field("explained", &self.explained)?;
        suspect.serialize_field("part", self.part())?;
        suspect.serialize_field("place", &self.place())?;
        suspect.serialize_field("evidence", &self.evidence())?;
        suspect.serialize_field("designer", &self.designer())?;
        suspect.serialize_field("technician", &self.technician())?;
        suspect.end()
    }
}
