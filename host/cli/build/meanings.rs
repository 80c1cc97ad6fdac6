//! What each code means, out of the comment of the variant that has it.

use std::path::Path;
use std::{env, fs, io};

use crate::sources::{Sources, Type, Words};

/// Where types with codes are, from the folder of this package.
const FOLDERS: [&str; 10] = [
    "src",
    "../frames/src",
    "../judge/src",
    "../lab/src",
    "../link/src",
    "../program/src",
    "../../fpga/mock/src",
    "../../fpga/model/src",
    "../../fpga/sim/src",
    "../../protocol",
];
/// Where codes are given to them.
const CODES: [&str; 4] = [
    "src/commands/codes.rs",
    "../judge/src/result/codes/files.rs",
    "../judge/src/result/codes/links.rs",
    "../program/src/codes.rs",
];
/// Types whose codes are their variants' names.
const BY_NAME: [&str; 3] = ["Finding", "Defect", "NotExercised"];

/// Writes `meanings.rs`: each code with its meaning, and the message of its error, or nothing.
pub(crate) fn write() -> io::Result<()> {
    let mut sources = Sources::default();
    for folder in FOLDERS {
        sources.read(Path::new(folder))?;
    }
    let mut meanings: Vec<(String, Words)> = Vec::new();
    for found in sources.types.iter().filter(|found| BY_NAME.contains(&found.name.as_str())) {
        meanings.extend(found.variants.iter().map(|(name, words)| (kebab(name), words.clone())));
    }
    for file in CODES {
        given(&fs::read_to_string(file)?, &sources.types, &mut meanings);
    }
    let of_constants = sources.constants.iter().filter(|(text, _)| text.contains('-') && !text.contains(' '));
    meanings.extend(
        of_constants
            .map(|(code, comment)| (code.clone(), Words { comment: comment.clone(), ..Words::default() })),
    );
    let lines: Vec<_> = meanings
        .iter()
        .map(|(code, Words { comment, message })| {
            format!("    ({code:?}, {:?}, {message:?}),\n", plain(comment))
        })
        .collect();
    let folder = env::var("OUT_DIR").map_err(io::Error::other)?;
    fs::write(Path::new(&folder).join("meanings.rs"), format!("&[\n{}]\n", lines.concat()))
}

/// Adds the meanings of the codes that the list `text` gives.
fn given(text: &str, types: &[Type], meanings: &mut Vec<(String, Words)>) {
    let inside = text.split("codes! {").nth(1).and_then(|rest| rest.split("\n}").next()).unwrap_or_default();
    // A list names its types first, and what is known of one is taken where all its variants are known.
    for part in inside.split("\n    }").flat_map(|part| part.split("\n    ;")) {
        let name = |line: &str| -> String {
            line.trim().chars().take_while(|letter| letter.is_alphanumeric()).collect()
        };
        let coded: Vec<_> = part
            .lines()
            .filter_map(|line| Some((name(line), line.split("=> \"").nth(1)?.split('"').next()?)))
            .collect();
        let head = part.lines().find(|line| line.starts_with("    ") && line.ends_with('{')).map(name);
        match head {
            Some(head) => {
                let head = imported(text, &head);
                let has_all = |found: &&Type| {
                    coded.iter().all(|(variant, _)| found.variants.iter().any(|(name, _)| name == variant))
                };
                let found = types.iter().filter(|found| found.name == head).find(has_all);
                for (variant, code) in coded {
                    let words =
                        found.and_then(|found| found.variants.iter().find(|(name, _)| *name == variant));
                    meanings.extend(words.map(|(_, words)| (code.to_owned(), words.clone())));
                }
            }
            None => {
                for (name, code) in coded {
                    let found = types.iter().find(|found| found.name == name);
                    meanings.extend(found.map(|found| (code.to_owned(), found.words.clone())));
                }
            }
        }
    }
}

/// The name that a type has where it is, of one that `text` imports by another.
fn imported(text: &str, name: &str) -> String {
    let alias = format!(" as {name}");
    let before = text.split(&alias).next().filter(|_| text.contains(&alias));
    let original = before.and_then(|before| before.rsplit(|letter: char| !letter.is_alphanumeric()).next());
    original.unwrap_or(name).to_owned()
}

/// `SamplesDiffer` as `samples-differ`.
fn kebab(name: &str) -> String {
    let letters = name.char_indices().map(|(place, letter)| match letter.is_uppercase() && place > 0 {
        true => format!("-{}", letter.to_lowercase()),
        false => letter.to_lowercase().to_string(),
    });
    letters.collect()
}

/// A comment without the marks that make links of names.
fn plain(comment: &str) -> String {
    comment.replace("[`", "`").replace("`]", "`")
}
