//! What a program was built from, as `--version --verbose` prints it.

/// What only the program itself knows about its build.
#[derive(Clone, Copy, Debug)]
pub struct Built {
    /// The Cargo features that were enabled.
    pub features: &'static [&'static str],
    /// The licences of everything that may be built in, one per line, as `scripts/licences` writes them.
    pub licences: &'static str,
}

impl Built {
    /// The lines after the one with name and version.
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

/// Whether a call that asks for the version asks for the details too.
pub(crate) fn is_asked(options: &[String]) -> bool {
    let short = |option: &str| {
        option.strip_prefix('-').is_some_and(|letters| !letters.starts_with('-') && letters.contains('v'))
    };
    options.iter().any(|option| option == "--verbose" || short(option))
}
