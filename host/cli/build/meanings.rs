//! What each code means, from the comment of the variant that has it.

use std::path::Path;
use std::{env, fs, io};

use crate::sources::{Sources, Type, Words};

/// The folders with the types that have codes, relative to this package.
const FOLDERS: [&str; 12] = [
    "src",
    "../files/src",
    "../frames/src",
    "../judge/src",
    "../lab/src",
    "../link/src",
    "../program/src",
    "../station/src",
    "../../fpga/mock/src",
    "../../fpga/model/src",
    "../../fpga/sim/src",
    "../../protocol",
];
/// The files that give them their codes.
const CODES: [&str; 4] = [
    "src/commands/codes.rs",
    "../judge/src/result/codes/files.rs",
    "../judge/src/result/codes/links.rs",
    "../program/src/codes.rs",
];
/// The files with the codes of `halfrow-station`, which this program only explains.
const CODES_OF_STATION: [&str; 2] = ["../station/src/codes.rs", "../station/src/commands/refusals.rs"];
/// Types whose variants' names are words in a report, then those whose variants' names are codes. Where both have a name, the
/// meaning of the code counts.
const BY_NAME: [&str; 5] = ["Verdict", "CheckName", "Finding", "Defect", "NotExercised"];

/// Writes `meanings.rs`, with each code, its meaning and the message of its error (empty if it has none); and
/// `codes_of_station.rs`, with each code that only `halfrow-station` has and the names of its parameters.
pub(crate) fn write() -> io::Result<()> {
    let mut sources = Sources::default();
    for folder in FOLDERS {
        sources.read(Path::new(folder))?;
    }
    // The comment of a type describes its code better than the comment of a list.
    let of_constants = sources.constants.iter().filter(|(text, _)| text.contains('-') && !text.contains(' '));
    let mut meanings: Vec<_> = of_constants
        .map(|(code, comment)| (code.clone(), Words { comment: comment.clone(), ..Words::default() }))
        .collect();
    for found in BY_NAME.iter().flat_map(|name| sources.types.iter().filter(move |found| found.name == *name))
    {
        meanings.extend(found.variants.iter().map(|(name, words)| (kebab(name), words.clone())));
    }
    for file in CODES {
        given(&fs::read_to_string(file)?, &sources.types, &mut meanings);
    }
    let mut of_station = Vec::new();
    for file in CODES_OF_STATION {
        let text = fs::read_to_string(file)?;
        given(&text, &sources.types, &mut meanings);
        of_station.extend(
            text.lines().filter_map(coded).map(|(code, names)| format!("    ({code:?}, &{names:?}),\n")),
        );
    }
    let lines: Vec<_> = meanings
        .iter()
        .map(|(code, Words { comment, message })| {
            format!("    ({code:?}, {:?}, {message:?}),\n", plain(comment))
        })
        .collect();
    let folder = env::var("OUT_DIR").map_err(io::Error::other)?;
    fs::write(Path::new(&folder).join("codes_of_station.rs"), format!("&[\n{}]\n", of_station.concat()))?;
    fs::write(Path::new(&folder).join("meanings.rs"), format!("&[\n{}]\n", lines.concat()))
}

/// The code that a line of a list defines, with the names of its parameters.
fn coded(line: &str) -> Option<(&str, Vec<&str>)> {
    let (variant, rest) = line.split_once("=> \"")?;
    let names =
        variant.split_once('[').and_then(|(_, rest)| rest.split_once(']')).map_or("", |(names, _)| names);
    Some((rest.split('"').next()?, names.split(", ").filter(|name| !name.is_empty()).collect()))
}

/// Adds the meanings of the codes that are defined in the source `text`.
fn given(text: &str, types: &[Type], meanings: &mut Vec<(String, Words)>) {
    let inside = text.split("codes! {").nth(1).and_then(|rest| rest.split("\n}").next()).unwrap_or_default();
    // A list names its type first. Of types of that name, the one is taken that has all the variants in the list.
    for part in inside.split("\n    }").flat_map(|part| part.split("\n    ;")) {
        let name = |line: &str| -> String {
            line.trim().chars().take_while(|letter| letter.is_alphanumeric()).collect()
        };
        let coded: Vec<_> = part.lines().filter_map(|line| Some((name(line), coded(line)?.0))).collect();
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

/// The original name of a type that `text` may import under another `name`.
fn imported(text: &str, name: &str) -> String {
    let alias = format!(" as {name}");
    let before = text.split(&alias).next().filter(|_| text.contains(&alias));
    let original = before.and_then(|before| before.rsplit(|letter: char| !letter.is_alphanumeric()).next());
    original.unwrap_or(name).to_owned()
}

/// `SamplesDiffer` becomes `samples-differ`.
fn kebab(name: &str) -> String {
    let letters = name.char_indices().map(|(place, letter)| match letter.is_uppercase() && place > 0 {
        true => format!("-{}", letter.to_lowercase()),
        false => letter.to_lowercase().to_string(),
    });
    letters.collect()
}

/// A comment without the brackets that turn names into links.
fn plain(comment: &str) -> String {
    comment.replace("[`", "`").replace("`]", "`")
}
