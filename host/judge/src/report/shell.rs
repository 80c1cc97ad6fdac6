//! Commands that a reader can run again.

use crate::words::is_unfit;

/// A word of a command for a shell: quoted if the shell would change it. If it holds what a terminal may obey, it is spelt as `$'…'`,
/// which bash reads.
pub fn shell_word(word: &str) -> String {
    let tame = |letter: char| letter.is_ascii_alphanumeric() || "_-./:=,@%+".contains(letter);
    if !word.is_empty() && word.chars().all(tame) {
        return word.to_owned();
    }
    if word.contains(is_unfit) {
        return format!("$'{}'", word.chars().map(spelt).collect::<String>());
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// A character between `$'` and `'`. Bytes, because what a number beyond them means depends on the locale.
fn spelt(letter: char) -> String {
    match letter {
        '\'' | '\\' => format!(r"\{letter}"),
        _ if is_unfit(letter) => {
            letter.encode_utf8(&mut [0; 4]).bytes().map(|byte| format!(r"\x{byte:02x}")).collect()
        }
        _ => letter.into(),
    }
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    #[test]
    fn only_words_that_a_shell_would_touch_are_quoted() {
        assert_eq!(shell_word("mock,fault=flip,rate=1e-4"), "mock,fault=flip,rate=1e-4");
        assert_eq!(shell_word("my frames/*.pgm"), "'my frames/*.pgm'");
        assert_eq!(shell_word("it's"), r"'it'\''s'");
        assert_eq!(shell_word(""), "''");
        assert_eq!(shell_word("a\nb\u{1b}c"), r"$'a\x0ab\x1bc'");
    }

    #[test]
    fn bash_reads_every_word_as_it_was() {
        for word in
            ["it's", "a\nb", "\u{1b}[31mred's\\n", "\t0 \u{7f}f", "\u{85}9\u{202e}gnp.\u{fffe}", "$'é\r'"]
        {
            let line = format!("printf %s {}", shell_word(word));
            assert!(!line.contains(is_unfit), "{line:?}");
            let read = Command::new("bash").args(["-c", &line]).output().unwrap();
            assert_eq!(String::from_utf8(read.stdout).unwrap(), word, "{line}");
        }
    }
}
