//! A defect that is suspected, and how well it explains what was seen.

use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

use super::{Defect, wording};

/// The part that a pattern of differences points at.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Suspect {
    /// What is suspected, and where.
    pub defect: Defect,
    /// How well it explains what was seen.
    pub account: Account,
    /// The share of the differing samples, or of the wrong words of a table, that it explains exactly, 0 to 1.
    pub explained: f64,
}

/// How well a defect explains what was seen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum Account {
    /// Samples that were examined.
    Samples {
        /// Those that differ from the reference.
        differing: usize,
        /// Those of them that the defect gives, to the bit.
        explained: usize,
        /// Samples that the defect would change and that are right.
        contradicted: usize,
        /// Other defects that explain everything as well.
        others: usize,
        /// Whether rows before the first difference came back right that it would have changed.
        set_in: bool,
    },
    /// Words of a table that was read back.
    Words {
        /// Those that read back as others.
        wrong: usize,
        /// Those of them that the defect gives.
        explained: usize,
        /// Other lines that would read alike.
        others: usize,
    },
    /// Signatures of frames that the board made on its own.
    Signatures {
        /// Frames whose signature is another than the reference's.
        wrong: usize,
        /// Those of them that the defect gives.
        explained: usize,
    },
    /// The defect says where differences lie, and explains none.
    Nothing,
}

impl Suspect {
    /// How many other defects explain everything as well, beside which it is no certain one.
    #[must_use]
    pub fn others(&self) -> usize {
        match self.account {
            Account::Samples { others, .. } | Account::Words { others, .. } => others,
            Account::Signatures { .. } | Account::Nothing => 0,
        }
    }

    /// Whether it is a defect that is known, and not only where the differences lie.
    #[must_use]
    pub fn is_known(&self) -> bool {
        !matches!(self.defect, Defect::NoneKnown { .. })
    }

    /// The kind of part, in lower case.
    #[must_use]
    pub fn part(&self) -> &'static str {
        wording::part(&self.defect)
    }

    /// Where: row, node and weight, bit, as far as it can be told.
    #[must_use]
    pub fn place(&self) -> String {
        wording::place(&self.defect)
    }

    /// Why, in one sentence without a full stop.
    #[must_use]
    pub fn evidence(&self) -> String {
        wording::evidence(&self.defect, &self.account)
    }

    /// Where the designer of the board looks next, in one sentence.
    #[must_use]
    pub fn designer(&self) -> String {
        wording::designer(&self.defect)
    }

    /// What a technician does with this board, in one sentence.
    #[must_use]
    pub fn technician(&self) -> String {
        wording::technician(&self.defect)
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
