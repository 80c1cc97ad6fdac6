//! What is known about a bitstream: the file next to it that `fpga/boards/record` writes when it is built.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::LoadError;
use crate::call_error::CallError;
use halfrow::files::{check_regular, text};
use halfrow::result::sha256;

/// How a bitstream was made. Unknown keys are ignored.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Record {
    /// The board, by its folder in `fpga/boards`.
    pub(super) board: String,
    /// The FPGA that it is for, by the tools' name.
    pub(super) device: String,
    /// The link, `fifo` or `uart`, and other options of the build.
    pub(super) kind: String,
    /// The commit of the sources, in hexadecimal.
    pub(super) commit: String,
    /// Whether the sources differed from the commit.
    pub(super) modified: bool,
    /// What the board reports as its build: eight hexadecimal digits.
    pub(super) build: String,
    /// SHA-256 of the bitstream, in hexadecimal.
    pub(super) sha256: String,
    /// The tools that made it, with versions.
    pub(super) tools: String,
}

/// The path of a bitstream's record.
pub(super) fn place(bitstream: &Path) -> PathBuf {
    let mut name = bitstream.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

/// Why `bitstream` was not read.
fn unread(bitstream: &Path, source: io::Error) -> anyhow::Error {
    let path = bitstream.to_owned();
    match source.kind() {
        io::ErrorKind::NotFound => LoadError::Missing { path, source }.into(),
        _ => CallError::Unreadable { path, source }.into(),
    }
}

/// The record of `bitstream`, if it has one.
///
/// # Errors
/// When the bitstream or its record cannot be read, or the record describes another bitstream.
pub(super) fn read(bitstream: &Path) -> Result<Option<Record>, anyhow::Error> {
    check_regular(bitstream)?;
    let bytes = fs::read(bitstream).map_err(|source| unread(bitstream, source))?;
    let path = place(bitstream);
    check_regular(&path)?;
    let text = match text::read(&path, text::MAX_BYTES) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        read => read.map_err(|source| CallError::Unreadable { path: path.clone(), source })?,
    };
    let record: Record = serde_json::from_str(&text)
        .map_err(|source| LoadError::RecordMalformed { path: path.clone(), source })?;
    if sha256([bytes]) != record.sha256.to_lowercase() {
        let (path, record) = (bitstream.to_owned(), path);
        return Err(LoadError::OtherBitstream { path, record }.into());
    }
    Ok(Some(record))
}
