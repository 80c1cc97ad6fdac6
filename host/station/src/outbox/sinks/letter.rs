//! How a parcel is written for sinks that are not a plant.

use serde::Serialize;

use super::SinkError;
use crate::export::{self, Format};
use crate::store::{Parcel, Waiver};

/// The version of a waiver's own document.
const SCHEMA: u32 = 1;

/// A document for a sink.
#[derive(Debug)]
pub(super) struct Letter {
    /// The id of the run or of the waiver, a UUID.
    pub(super) id: String,
    /// What the name of its file ends with.
    pub(super) ending: &'static str,
    /// Its media type.
    pub(super) media: &'static str,
    /// The document.
    pub(super) bytes: Vec<u8>,
}

/// A waiver as a document.
#[derive(Serialize)]
struct WaiverDocument<'a> {
    schema: u32,
    id: &'a str,
    #[serde(flatten)]
    waiver: &'a Waiver,
}

/// The document of this parcel, with its run in this format. A line of the audit has none, because it stays in the house.
///
/// # Errors
/// [`SinkError::Export`]
pub(super) fn letter(parcel: &Parcel, format: Format) -> Result<Option<Letter>, SinkError> {
    Ok(match parcel {
        Parcel::Run { record, text, .. } => Some(Letter {
            id: record.run.id.clone(),
            ending: format.ending(),
            media: format.media(),
            bytes: export::written(record, text.clone().into_bytes(), format)?,
        }),
        Parcel::Waiver { id, waiver } => {
            let document = WaiverDocument { schema: SCHEMA, id, waiver };
            let mut bytes = serde_json::to_vec_pretty(&document).map_err(export::ExportError::from)?;
            bytes.push(b'\n');
            Some(Letter { id: id.clone(), ending: ".waiver.json", media: Format::Record.media(), bytes })
        }
        Parcel::Audit(_) => None,
    })
}
