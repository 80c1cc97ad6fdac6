//! The languages of the pages: one file each, all with the same keys. Reports and records stay English.
//!
//! What has a code is translated by its code: the keys of a language's tables `[said]` and `[remedy]` are codes. In English
//! the recorded sentence is shown as it is.

mod check;
mod sentence;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use axum::http::HeaderValue;
use halfrow::words::grouped;

pub(crate) use check::{built_in, faults};
pub(super) use sentence::Sentence;

/// The cookie that keeps a visitor's choice.
pub(super) const COOKIE: &str = "halfrow-language";

/// The words of a language.
#[derive(Debug)]
pub(super) struct Words {
    /// Its code, as in the attribute `lang`.
    pub(super) code: &'static str,
    words: BTreeMap<String, String>,
}

/// Every language: its code and its file. The first is for those who want none of them.
const FILES: [(&str, &str); 3] = [
    ("en", include_str!("../../../lang/en.toml")),
    ("de", include_str!("../../../lang/de.toml")),
    ("zh", include_str!("../../../lang/zh.toml")),
];

static ALL: LazyLock<[Words; 3]> = LazyLock::new(|| FILES.map(|(code, text)| Words::read(code, text)));

impl Words {
    fn read(code: &'static str, text: &str) -> Self {
        // The tests make sure that all files can be read and have the same keys.
        let tables: BTreeMap<String, BTreeMap<String, String>> = toml::from_str(text).unwrap_or_default();
        let keys = tables.into_iter().flat_map(|(table, words)| {
            words.into_iter().map(move |(key, words)| (format!("{table}.{key}"), words))
        });
        Self { code, words: keys.collect() }
    }

    /// The words of this key; the key itself, should a file lack it.
    pub(super) fn say(&self, key: &'static str) -> &str {
        self.words.get(key).map_or(key, String::as_str)
    }

    /// Figures as they are printed, with the language's decimal point.
    pub(super) fn figures(&self, printed: &str) -> String {
        printed.replace('.', self.say("history.decimal"))
    }

    /// A count, its digits in groups of three where there are more than four.
    pub(super) fn count(&self, count: u64) -> String {
        if count < 10_000 {
            count.to_string()
        } else {
            grouped(count).replace(',', self.say("history.thousands"))
        }
    }

    /// The words of this key with the values of their `{names}`.
    pub(super) fn fill(&self, key: &'static str, values: &[(&str, &str)]) -> String {
        let value = |wanted: &str| {
            let found = values.iter().find(|(name, _)| *name == wanted);
            found.map(|(_, value)| (*value).to_owned())
        };
        filled(self.say(key), &value)
    }

    /// The words of a key that is made of a code.
    fn of_code(&self, table: &str, code: &str) -> Option<&str> {
        self.words.get(&format!("{table}.{code}")).map(String::as_str)
    }
}

/// The text with the values of its `{names}`, in a single pass: a value may contain braces.
fn filled(text: &str, value: &dyn Fn(&str) -> Option<String>) -> String {
    let (mut filled, mut rest) = (String::new(), text);
    while let Some((before, name, after)) = next_name(rest) {
        filled += before;
        filled += &value(name).unwrap_or_else(|| format!("{{{name}}}"));
        rest = after;
    }
    filled + rest
}

/// The first `{name}` of a text, with what stands before and after it.
fn next_name(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once('{')?;
    let (name, after) = rest.split_once('}')?;
    Some((before, name, after))
}

/// Every language: its code, and its name in that language.
pub(super) fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    ALL.iter().map(|words| (words.code, words.say("language.name")))
}

/// The words of the language that the visitor chose, or else of the first that the browser prefers.
pub(super) fn of(chosen: Option<&str>, preferred: Option<&HeaderValue>) -> &'static Words {
    let known = |code: &str| ALL.iter().find(|words| code.split('-').next() == Some(words.code));
    let preferred = preferred.and_then(|value| value.to_str().ok()).unwrap_or_default();
    // Browsers send the languages in the order of their weights.
    let mut codes = preferred.split(',').map(|item| item.split(';').next().unwrap_or_default().trim());
    let [first, ..] = &*ALL;
    chosen.and_then(known).or_else(|| codes.find_map(known)).unwrap_or(first)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    use super::*;

    /// Every file below `folder`, as one text.
    fn source(folder: &Path) -> String {
        let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        files
            .map(|path| if path.is_dir() { source(&path) } else { fs::read_to_string(path).unwrap() })
            .collect()
    }

    #[test]
    fn the_pages_use_every_key_and_no_other() {
        let source = source(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/web"));
        let calls = ["say(\"", "fill(\"", "key: \""].into_iter().flat_map(|call| source.split(call).skip(1));
        let used: BTreeSet<_> = calls.filter_map(|rest| rest.split('"').next()).collect();
        assert!(ALL[0].words.len() > 20);
        let known: BTreeSet<_> = ALL[0].words.keys().map(String::as_str).collect();
        let missing: Vec<_> = used.difference(&known).collect();
        let surplus: Vec<_> = known.difference(&used).collect();
        assert!(missing.is_empty() && surplus.is_empty(), "missing {missing:?}, surplus {surplus:?}");
    }

    #[test]
    fn a_choice_comes_before_what_the_browser_prefers() {
        let preferred = HeaderValue::from_static("fr, de-AT;q=0.8, zh;q=0.5");
        assert_eq!(of(None, Some(&preferred)).code, "de");
        assert_eq!(of(Some("zh"), Some(&preferred)).code, "zh");
        assert_eq!(of(Some("xx"), None).code, "en");
    }
}
