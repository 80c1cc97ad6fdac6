//! Reading small text files, and quoting them.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The longest table file, settings file or other small file that is read: many times the largest tables there can be, and notes.
pub const MAX_BYTES: u64 = 1 << 20;

/// Characters of a foreign value that an error quotes.
const QUOTED: usize = 40;

/// Characters of what a reader of TOML or JSON says.
const TOLD: usize = 200;

/// The whole text of the file `path`.
///
/// # Errors
/// The system's, [`io::ErrorKind::InvalidData`] when it is not UTF-8, or longer than
/// `most` bytes.
pub fn read(path: &Path, most: u64) -> io::Result<String> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let reason = format!("it is longer than {most} bytes");
        return Err(io::Error::new(io::ErrorKind::InvalidData, reason));
    }
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes().iter().take(place).filter(|&&byte| byte == b'\n').count();
        let reason = format!("it is no text from byte {place} on, in line {line}");
        io::Error::new(io::ErrorKind::InvalidData, reason)
    })
}

/// `text` without the byte order mark that editors of Windows put before it and show nobody.
pub(crate) fn without_mark(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
}

/// The beginning of `text`, short enough to stand in a sentence.
pub fn quoted(text: &str) -> String {
    beginning(text, QUOTED)
}

/// The beginning of what a reader of TOML or JSON says, which quotes keys and values whole.
pub fn told(text: &str) -> String {
    beginning(text, TOLD)
}

fn beginning(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
    }
}
