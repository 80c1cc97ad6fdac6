//! The report as JSON, for programs.

use crate::result::Report;

/// The report, indented, with a line feed at the end. `schema`, `command`, `verdict`, `exit_code` and `board.kind` come first.
///
/// # Errors
/// The encoder's. No value that a [`Report`] can hold causes one.
pub fn render(report: &Report) -> Result<String, serde_json::Error> {
    let mut text = serde_json::to_string_pretty(report)?;
    text.push('\n');
    Ok(text)
}
