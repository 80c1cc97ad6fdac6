//! Commands that a reader can run again.

/// A word of a command for a POSIX shell: quoted if the shell would change it.
pub fn shell_word(word: &str) -> String {
    let tame = |letter: char| letter.is_ascii_alphanumeric() || "_-./:=,@%+".contains(letter);
    if !word.is_empty() && word.chars().all(tame) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_words_that_a_shell_would_touch_are_quoted() {
        assert_eq!(shell_word("mock,fault=flip,rate=1e-4"), "mock,fault=flip,rate=1e-4");
        assert_eq!(shell_word("my frames/*.pgm"), "'my frames/*.pgm'");
        assert_eq!(shell_word("it's"), r"'it'\''s'");
        assert_eq!(shell_word(""), "''");
    }
}
