//! Reading small text files, and quoting them.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The longest table file, settings file or other small file that is read, in bytes: many times the largest possible tables with
/// notes.
pub const MAX_BYTES: u64 = 1 << 20;

/// Characters of a value from a file that an error quotes.
const QUOTED: usize = 40;

/// Characters of a TOML or JSON parser's message that an error quotes.
const TOLD: usize = 200;

/// The whole text of the file `path`, of at most `most` bytes.
///
/// # Errors
/// The system's, or [`io::ErrorKind::InvalidData`] when it is not UTF-8 or is longer than `most` bytes.
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
        let reason = match place {
            0 => "it is not a text file".to_owned(),
            _ => format!("it is not text from byte {place} on, in line {line}"),
        };
        io::Error::new(io::ErrorKind::InvalidData, reason)
    })
}

/// `text` without the byte order mark that Windows editors put before it without showing it.
pub fn without_mark(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
}

/// The beginning of `text`, short enough for a sentence.
pub fn quoted(text: &str) -> String {
    beginning(text, QUOTED)
}

/// The beginning of a TOML or JSON parser's message, which quotes keys and values in full.
pub fn told(text: &str) -> String {
    beginning(text, TOLD)
}

fn beginning(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
    }
}
