//! What a test could not try here, told so that it is seen.

use std::io::Write as _;

/// Says past the harness, which keeps what passing tests print, that `what` was not tested, and why.
#[allow(clippy::disallowed_methods)]
pub fn not_tested(what: &str, why: &str) {
    let _ = writeln!(std::io::stderr(), "NOT TESTED: {what}: {why}");
}
