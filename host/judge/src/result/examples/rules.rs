//! Findings on the rules of the wire.

use crate::result::{Answer, Asked, Field, Finding, Rule};

pub(super) fn on_rules() -> [Finding; 1] {
    let values = [("steps_crc", 305_419_896), ("kernel_crc", 0), ("first_frame", 23_130), ("generation", 85)];
    let fields = values.map(|(name, value)| Field { name: name.to_owned(), value }).to_vec();
    let rest = String::new();
    let asked = Asked { sequence: 513, bytes: 11, fields, rest, pending: None };
    [Finding::RuleBroken {
        rule: Rule::CommitCrc,
        request: "COMMIT".to_owned(),
        right: Answer::Refused { code: 9, detail: 1 },
        found: Answer::Replied { payload: "55".to_owned() },
        asked: Some(Box::new(asked)),
    }]
}
