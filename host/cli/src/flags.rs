//! The flags of the settings that the libraries name in words: the only place where a remedy gets its flag.

/// Phrases in the libraries' sentences, each with its flag or the command to run. No phrase is part of another. A phrase is an
/// instruction that reads well alone, with any figure after it, or a noun that keeps its meaning wherever it stands.
pub const FLAGS: [(&str, &str); 25] = [
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
    ("the lens pitch and the optical centre", "--lens-pitch, --centre-x, --centre-y"),
    ("leave out the exact projection", "--projection"),
    ("limit the entries of a grid", "--entries"),
    ("set the nodes of a grid", "--nodes-every"),
    ("Cargo's feature `sim`", "cargo run --release --features sim"),
];

/// `text` with the flag after each setting that it names, as in `take the board over (--take-over)`.
#[must_use]
pub fn named(text: &str) -> String {
    let mut text = text.to_owned();
    for (setting, flag) in FLAGS {
        text = text.replace(setting, &format!("{setting} ({flag})"));
    }
    text
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
