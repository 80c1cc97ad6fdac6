//! The flags of the settings that the libraries name in words: the only place where a remedy gets its flag.

use halfrow::result::Problem;

/// Phrases in the libraries' sentences, each with its flag or the command to run. No phrase is part of another. A phrase is an
/// instruction that reads well alone, with any figure after it, or a noun that keeps its meaning wherever it stands.
pub const FLAGS: [(&str, &str); 26] = [
    ("allow it to be overwritten", "--overwrite"),
    ("another place for the recording", "--record"),
    ("another place for the report", "--report"),
    ("a recording to make", "--record"),
    ("a time to judge within", "--within"),
    ("make tables of the frame's size", "--width, --height"),
    ("use smaller frames and tables", "--width, --height"),
    ("record a run with `halfrow verify`", "--record"),
    ("take the board over", "--take-over"),
    ("raise the retry limit", "--retry-limit"),
    ("within its time limit", "--timeout"),
    ("name a real board", "--board"),
    ("repeat them less often", "--repeat"),
    ("Name at least one frame", "--frame"),
    ("difference maps of a report", "--report"),
    ("Name a real board", "--board"),
    ("name the layout", "--raw"),
    ("crop and scale it", "--fit"),
    ("name the phase", "--phase"),
    ("name the bits", "--bits"),
    ("name the size of the frames", "--width, --height"),
    ("the lens pitch and the optical centre", "--lens-pitch, --centre-x, --centre-y"),
    ("leave out the exact projection", "--projection"),
    ("limit the entries of a grid", "--entries"),
    ("set the nodes of a grid", "--nodes-every"),
    ("Cargo's feature `sim`", "cargo run --release --features sim"),
];

/// Parameters that are parts of a sentence, and so may name a setting. Any other is what a user or a file calls something.
const OF_SENTENCES: [&str; 3] = ["reason", "remedy", "why"];

/// `text` with the flag after each setting that it names, as in `take the board over (--take-over)`.
#[must_use]
pub(crate) fn named(text: &str) -> String {
    named_outside(text, &[])
}

/// Like [`named`], without a change to any of `names`.
fn named_outside(text: &str, names: &[&str]) -> String {
    let masked = names
        .iter()
        .filter(|name| FLAGS.iter().any(|(setting, _)| name.contains(setting)))
        .fold(text.to_owned(), |text, name| text.replace(name, &"_".repeat(name.len())));
    let settings = FLAGS.iter().flat_map(|(setting, flag)| {
        masked.match_indices(setting).map(move |(place, _)| (place + setting.len(), flag))
    });
    let mut settings: Vec<_> = settings.collect();
    settings.sort_unstable();
    let mut text = text.to_owned();
    for (end, flag) in settings.into_iter().rev() {
        text.insert_str(end, &format!(" ({flag})"));
    }
    text
}

/// `problem` and its causes with the flag after each setting that their words name, but not inside of a name.
#[must_use]
pub(crate) fn named_in(problem: Problem) -> Problem {
    let chain = std::iter::once(&problem).chain(&problem.causes);
    let parameters = chain.flat_map(|problem| problem.parameters.clone());
    let names: Vec<_> = parameters
        .filter(|(name, _)| !OF_SENTENCES.contains(&name.as_str()))
        .filter_map(|(_, value)| value.as_str().map(str::to_owned))
        .collect();
    let names: Vec<_> = names.iter().map(String::as_str).collect();
    let named = |problem: Problem| Problem {
        message: named_outside(&problem.message, &names),
        remedy: problem.remedy.as_deref().map(|remedy| named_outside(remedy, &names)),
        ..problem
    };
    let causes = problem.causes.iter().cloned().map(named).collect();
    Problem { causes, ..named(problem) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remedy_gets_its_flag() {
        assert_eq!(
            named("wait until it is done, or take the board over"),
            "wait until it is done, or take the board over (--take-over)"
        );
        assert_eq!(named("check the cable"), "check the cable");
    }
}
