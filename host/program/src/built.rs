//! What a program was built from, as `--version --verbose` tells it.

/// What a program alone knows of its build.
#[derive(Clone, Copy, Debug)]
pub struct Built {
    /// The features of Cargo that were asked for.
    pub features: &'static [&'static str],
    /// The licences of all that may be built in, one a line, as `scripts/licences` writes them.
    pub licences: &'static str,
}

impl Built {
    /// The lines that come behind the one with name and version.
    #[must_use]
    pub fn lines(&self) -> String {
        let features = if self.features.is_empty() { "none".to_owned() } else { self.features.join(", ") };
        let mut text = format!(
            "commit: {}\nfeatures: {features}\ntarget: {}\ncompiler: {}\nlicence: {}\nlicences of what is built in:\n",
            halfrow::COMMIT,
            halfrow::TARGET,
            halfrow::RUSTC,
            env!("CARGO_PKG_LICENSE"),
        );
        for licence in self.licences.lines() {
            text += &format!("  {licence}\n");
        }
        text
    }
}

/// Whether a call that asks for the version asks for all of it.
pub(crate) fn is_asked(options: &[String]) -> bool {
    let short = |option: &str| {
        option.strip_prefix('-').is_some_and(|letters| !letters.starts_with('-') && letters.contains('v'))
    };
    options.iter().any(|option| option == "--verbose" || short(option))
}
