//! Results for other programs. Every format is made from the record alone, so a run has the same bytes every time.

mod junit;
mod openhtf;
mod table;

use std::io;

use clap::ValueEnum;
use quick_junit::SerializeError;
use serde::Deserialize;

pub use table::Table;

use crate::record::Record;
use crate::store::{Snapshot, StoreError};

/// What one run is written as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
#[value(rename_all = "lower")]
pub enum Format {
    /// The record, those very bytes
    #[default]
    Record,
    /// JUnit XML
    Junit,
    /// A table with a line for each measurement
    Csv,
    /// The JSON of OpenHTF 1.6
    OpenHtf,
}

impl Format {
    /// The format of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::from_str(name, false).ok()
    }

    /// The name by which [`Self::named`] finds it.
    #[must_use]
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }

    /// What people call it.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Record => "JSON",
            Self::Junit => "JUnit",
            Self::Csv => "CSV",
            Self::OpenHtf => "OpenHTF",
        }
    }

    /// What the names of its files end with, after the run's id.
    #[must_use]
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Record => ".json",
            Self::Junit => ".xml",
            Self::Csv => ".csv",
            Self::OpenHtf => ".openhtf.json",
        }
    }

    /// Its media type.
    #[must_use]
    pub const fn media(self) -> &'static str {
        match self {
            Self::Record | Self::OpenHtf => "application/json",
            Self::Junit => "application/xml",
            Self::Csv => "text/csv; charset=utf-8",
        }
    }
}

/// A run that cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The store.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The run cannot be written as XML.
    #[error("the run cannot be written as XML; report this with its record")]
    Xml(#[from] SerializeError),
    /// The run cannot be written as JSON.
    #[error("the run cannot be written as JSON; report this with its record")]
    Json(#[from] serde_json::Error),
    /// The export could not be written where it goes.
    #[error("the table cannot be written; check that there is space where it goes")]
    Write(#[source] io::Error),
}

/// The run whose record has this hash, in this format. It ends with a newline.
///
/// # Errors
/// [`ExportError`]
pub fn run(of: &Snapshot, hash: &str, format: Format) -> Result<Vec<u8>, ExportError> {
    let (record, bytes) = of.record(hash)?;
    written(&record, bytes, format)
}

/// The run of this record in this format; `bytes` are the record's own.
///
/// # Errors
/// [`ExportError`], but none of the store.
pub fn written(record: &Record, bytes: Vec<u8>, format: Format) -> Result<Vec<u8>, ExportError> {
    match format {
        Format::Record => Ok(bytes),
        Format::Junit => Ok(junit::render(record)?.into_bytes()),
        Format::Csv => {
            let mut table = Table::begin(Vec::new())?;
            table.add(record)?;
            Ok(table.end())
        }
        Format::OpenHtf => {
            let mut bytes = serde_json::to_vec_pretty(&openhtf::of(record))?;
            bytes.push(b'\n');
            Ok(bytes)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::BoardSeen;
    use crate::record::tests::pass;
    use crate::said::Said;

    /// Whoever has only the export must be able to find the board, the run, and what judged it.
    #[test]
    fn every_format_says_which_board_it_was_and_what_judged_it() {
        let text = |word: &str| format!("the {word}");
        let mut record = Record { program: text("program"), ..pass() };
        let device = Some(text("device"));
        record.board =
            Some(BoardSeen { kind: text("kind"), name: text("name"), device, build: text("build") });
        (record.run.variant, record.run.product, record.run.serial) =
            (text("variant"), text("product"), text("serial"));
        (record.run.station, record.run.lane, record.run.operator) =
            (text("station"), text("lane"), text("operator"));
        (record.run.target, record.run.id) = (text("target"), text("run"));
        record.conclusion.finding = Some(Said { code: text("code"), ..Said::uncoded(text("finding")) });
        (record.plan.name, record.plan.version, record.plan.sha256) =
            (text("plan"), text("version"), text("hash"));
        for format in [Format::Junit, Format::Csv, Format::OpenHtf] {
            let bytes = written(&record, Vec::new(), format).unwrap();
            let said = String::from_utf8(bytes).unwrap();
            let is_missing = |word: &&str| !said.contains(&text(word));
            let words = [
                "run", "product", "serial", "variant", "plan", "version", "hash", "station", "lane",
                "operator", "target", "kind", "device", "build", "program", "code",
            ];
            assert_eq!(words.into_iter().filter(is_missing).collect::<Vec<_>>(), [""; 0], "{format:?}");
        }
    }
}
