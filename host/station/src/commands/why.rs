//! Who does something, and why. The audit keeps both.

use clap::Args;

/// Who, and why.
#[derive(Debug, Args)]
pub(super) struct Why {
    /// Why
    #[arg(long)]
    pub(super) reason: String,
    /// Who says so
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    pub(super) operator: String,
}
