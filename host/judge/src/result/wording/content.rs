//! Words for what a board makes and signs at the full pixel clock otherwise than AT-SPEED.md says.

use super::{LOGIC, Words};
use crate::result::{ContentKind, MadeAs};

pub(super) fn records_late() -> Words {
    Words {
        part: "records",
        place: "the records of frames at speed".to_owned(),
        defect: "the record of each frame holding the signature of the frame before".to_owned(),
        designer:
            "Check when a frame's signature is written into its record, and which record RECORDS reads."
                .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn wrong(row: usize, kind: ContentKind, made: MadeAs) -> Words {
    let kind = name(kind);
    let rows = match made {
        MadeAs::Kind { .. } | MadeAs::Toggle { .. } | MadeAs::Steps { .. } => {
            format!(", in rows of the kind {kind}")
        }
        MadeAs::SeedOf { .. } | MadeAs::OtherFrame { .. } | MadeAs::OtherRow { .. } => String::new(),
    };
    Words {
        part: "content generator",
        place: format!("the generator of the content at speed{rows}"),
        defect: format!("row {row}, whose content is {kind}, made as {} and corrected rightly", other(made)),
        designer: "Check the content that the board makes against AT-SPEED.md's section \"Content\"; the datapath corrects it \
                   rightly."
            .to_owned(),
        technician: LOGIC,
    }
}

pub(super) fn signature_wrong(row: usize) -> Words {
    Words {
        part: "signature",
        place: format!("the signature of rows at speed, seen in row {row}"),
        defect: "the samples that the board kept of the row are right, and the signature that it kept with them is not their CRC"
            .to_owned(),
        designer: "Check the unit that signs rows: over which samples, in which order and from which state it computes the CRC-32 \
                   (AT-SPEED.md, section \"Signature\")."
            .to_owned(),
        technician: LOGIC,
    }
}

const fn name(kind: ContentKind) -> &'static str {
    match kind {
        ContentKind::Noise => "noise",
        ContentKind::Swing => "swing",
        ContentKind::Toggle => "toggle",
        ContentKind::Steps => "steps",
    }
}

fn other(made: MadeAs) -> String {
    match made {
        MadeAs::Kind { kind } => name(kind).to_owned(),
        MadeAs::Toggle { p, high } => {
            let level = if high { "high" } else { "low" };
            format!("toggle with p = {p} and the first columns {level}")
        }
        MadeAs::Steps { one_in } => format!("steps with an edge at one in {one_in} draws"),
        MadeAs::SeedOf { bits } => format!("that of the seed's low {bits} bits alone"),
        MadeAs::OtherFrame { frames } => {
            format!("that of the frame {}", if frames < 0 { "before" } else { "after" })
        }
        MadeAs::OtherRow { rows } => format!("that of the row {}", if rows < 0 { "above" } else { "below" }),
    }
}
