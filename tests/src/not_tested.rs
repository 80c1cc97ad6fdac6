//! What a test could not try on this machine, reported where it is seen.

use std::io::Write as _;

/// Reports that `what` was not tested, and why, past the harness, which hides what passing tests print.
#[allow(clippy::disallowed_methods)]
pub fn not_tested(what: &str, why: &str) {
    let _ = writeln!(std::io::stderr(), "NOT TESTED: {what}: {why}");
}
