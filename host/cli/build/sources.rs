//! What the sources of this repository say about their types: comments and messages of types and variants. The sources are read
//! line by line, as rustfmt lays them out.

use std::fs;
use std::io;
use std::path::Path;

/// The words about a type or variant: its comment and its error message.
#[derive(Clone, Debug, Default)]
pub(crate) struct Words {
    /// The comment.
    pub(crate) comment: String,
    /// The text of `#[error("…")]`; empty without one.
    pub(crate) message: String,
}

/// A type: its name, its words, and those of its variants.
#[derive(Debug)]
pub(crate) struct Type {
    pub(crate) name: String,
    pub(crate) words: Words,
    pub(crate) variants: Vec<(String, Words)>,
}

/// What was read from all files.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    pub(crate) types: Vec<Type>,
    /// Constants that are a text or a list of texts: each text, with the constant's comment.
    pub(crate) constants: Vec<(String, String)>,
}

impl Sources {
    /// Reads every source below `folder`.
    pub(crate) fn read(&mut self, folder: &Path) -> io::Result<()> {
        println!("cargo::rerun-if-changed={}", folder.display());
        let mut entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
        entries.sort_by_key(fs::DirEntry::path);
        for entry in entries {
            let path = entry.path();
            if path.is_dir() {
                self.read(&path)?;
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                self.take(&fs::read_to_string(&path)?);
            }
        }
        Ok(())
    }

    fn take(&mut self, text: &str) {
        let (mut words, mut is_inside) = (Words::default(), false);
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            let (indent, code) = (line.len() - line.trim_start().len(), line.trim());
            if let Some(comment) = code.strip_prefix("///") {
                words.comment = format!("{} {}", words.comment, comment.trim()).trim().to_owned();
            } else if code.starts_with("#[") {
                let attribute = whole(code, ")]", &mut lines);
                if code.starts_with("#[error(") {
                    words.message = literals(&attribute).into_iter().next().unwrap_or_default();
                }
            } else {
                let told = std::mem::take(&mut words);
                match named(code) {
                    Some(name) if indent == 0 => {
                        is_inside = code.ends_with('{') && code.contains("enum ");
                        self.types.push(Type { name, words: told, variants: Vec::new() });
                    }
                    _ if indent == 0 && code.contains("const ") && code.contains("&str") => {
                        self.constant(&whole(code, ";", &mut lines), &told);
                    }
                    _ if line == "}" => is_inside = false,
                    _ if is_inside && indent == 4 => self.variant(code, told),
                    _ => {}
                }
            }
        }
    }

    fn variant(&mut self, code: &str, words: Words) {
        let name: String = code.chars().take_while(|letter| letter.is_alphanumeric()).collect();
        if let Some(last) = self.types.last_mut().filter(|_| !name.is_empty()) {
            last.variants.push((name, words));
        }
    }

    fn constant(&mut self, code: &str, words: &Words) {
        self.constants.extend(literals(code).into_iter().map(|text| (text, words.comment.clone())));
    }
}

/// `first` and the lines after it, up to the one that ends in `end`, or for an attribute in `]`.
fn whole<'a>(first: &str, end: &str, lines: &mut impl Iterator<Item = &'a str>) -> String {
    let mut text = first.to_owned();
    let mut last = first.to_owned();
    let ends = |line: &str| line.ends_with(end) || first.starts_with("#[") && line.ends_with(']');
    while !ends(&last) {
        let Some(line) = lines.next() else { break };
        last = line.trim().to_owned();
        text = format!("{text}\n{last}");
    }
    text
}

/// The name of the type whose declaration begins on this line, if one does.
fn named(code: &str) -> Option<String> {
    let public = code.strip_prefix("pub").unwrap_or(code);
    let rest =
        public.strip_prefix('(').and_then(|inside| inside.split_once(')')).map_or(public, |(_, rest)| rest);
    let rest = rest.trim_start();
    let name = ["enum ", "struct "].into_iter().find_map(|word| rest.strip_prefix(word))?;
    Some(name.chars().take_while(|letter| letter.is_alphanumeric()).collect())
}

/// The contents of the string literals in `code`. A backslash at the end of a line joins it to the next.
fn literals(code: &str) -> Vec<String> {
    let (mut found, mut letters) = (Vec::new(), code.chars().peekable());
    while let Some(letter) = letters.next() {
        if letter != '"' {
            continue;
        }
        let mut text = String::new();
        while let Some(letter) = letters.next().filter(|&letter| letter != '"') {
            match letter {
                '\\' if letters.peek() == Some(&'\n') => {
                    while letters.next_if(|letter| letter.is_whitespace()).is_some() {}
                }
                '\\' => text.extend(letters.next()),
                other => text.push(other),
            }
        }
        found.push(text);
    }
    found
}
