//! Whether a language's file says all that pages say, and no more.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use halfrow::result::{Problem, codes, examples};
use serde_json::Value;
use toml::Spanned;

use super::FILES;
use super::sentence::{BROKEN, BROKEN_AT_SPEED, LATE, LATE_AT_TIMES};
use crate::codes as station;
use crate::input_error::{Fault, InputError};
use crate::said::REMEDIES;

/// The tables whose keys are codes.
const SAID: &str = "said";
const REMEDY: &str = "remedy";

/// The types of the station's errors that operators, or engineers at a page, may see.
const OF_STATION: [&str; 23] = [
    "SerialError",
    "ScanError",
    "Refusal",
    "RunError",
    "StoreError",
    "PlantError",
    "SinkError",
    "ExportError",
    "CertificateError",
    "BlobError",
    "AgainError",
    "DiskError",
    "LabgridError",
    "RecordError",
    "ReasonError",
    "RebindError",
    "NoWaiver",
    "HookError",
    "SecretError",
    "WorkError",
    "Lost",
    "Saying",
    "UnknownBarcode",
];
/// The types of the judge's errors that they may see.
const OF_JUDGE: [&str; 16] = [
    "BoardError",
    "LinkError",
    "OpenError",
    "TargetError",
    "SerialError",
    "TcpError",
    "UsbError",
    "LinkTestError",
    "PrepareError",
    "Misfit",
    "GoldenError",
    "CannotJudge",
    "NotAllJudged",
    "PlanLengthError",
    "NoThread",
    "UsbFailure",
];
/// Codes that belong to none of these types.
const OTHERS: [&str; 2] = ["no-randomness", "program-failed"];

/// A language's file: words by table and key.
type File = BTreeMap<Spanned<String>, BTreeMap<Spanned<String>, Spanned<String>>>;
/// Keys, each with the names that its words may contain.
type Keys = BTreeMap<String, BTreeSet<String>>;

/// Every code that somebody at a page may see, with its parameters.
fn said() -> Keys {
    let of_judge = codes::LISTS.into_iter().flatten().filter(|list| OF_JUDGE.contains(&list.error));
    let of_station = station::LISTS.iter().filter(|list| OF_STATION.contains(&list.error));
    let typed = of_judge.chain(of_station).flat_map(|list| list.codes);
    let typed = typed.map(|(code, names)| (*code, names.iter().map(|name| (*name).to_owned()).collect()));
    let of_system = codes::io_codes().map(|code| (code, BTreeSet::from(["os_error".to_owned()])));
    let others = OTHERS.map(|code| (code, BTreeSet::new()));
    let known = typed.chain(of_system).chain(others).map(|(code, names)| (code.to_owned(), names));
    known.chain(findings()).chain(defects()).chain(not_exercised()).collect()
}

/// The keys of remedies: for findings that ask for something, for defects, and for what the station itself asks for.
fn remedies() -> Keys {
    let asks = |finding: &halfrow::result::Finding| finding.remedy().map(|_| finding.as_problem().code);
    let asking: BTreeSet<_> = examples::findings().iter().filter_map(asks).collect();
    let mut asked: Keys = findings().filter(|(code, _)| asking.contains(code)).chain(defects()).collect();
    let said = said();
    asked.extend(REMEDIES.map(|(code, _)| (code.to_owned(), said.get(code).cloned().unwrap_or_default())));
    for (code, key) in [(LATE, LATE_AT_TIMES), (BROKEN, BROKEN_AT_SPEED)] {
        let names = asked.get(code).cloned();
        asked.extend(names.map(|names| (key.to_owned(), names)));
    }
    asked
}

fn findings() -> impl Iterator<Item = (String, BTreeSet<String>)> {
    examples::findings().into_iter().map(|finding| {
        let Problem { code, parameters, .. } = finding.as_problem();
        (code, parameters.into_iter().map(|(name, _)| name).collect())
    })
}

/// What a PASS did not exercise.
fn not_exercised() -> impl Iterator<Item = (String, BTreeSet<String>)> {
    examples::not_exercised().into_iter().map(|part| {
        let (code, parameters) = part.tagged();
        (code, parameters.into_iter().map(|(name, _)| name).collect())
    })
}

fn defects() -> impl Iterator<Item = (String, BTreeSet<String>)> {
    examples::suspects().into_iter().filter_map(|suspect| {
        let defect = serde_json::to_value(&suspect.defect).ok()?;
        let names = defect.get("parameters").and_then(Value::as_object);
        let names = names.map(|names| names.keys().cloned().collect()).unwrap_or_default();
        Some((defect.get("code")?.as_str()?.to_owned(), names))
    })
}

/// The `{names}` in a text, each up to its first dot.
fn names(text: &str) -> BTreeSet<String> {
    let (mut names, mut rest) = (BTreeSet::new(), text);
    while let Some((_, name, after)) = super::next_name(rest) {
        names.insert(name.split('.').next().unwrap_or_default().to_owned());
        rest = after;
    }
    names
}

/// The keys of the English file, with the names in its words.
fn of_pages() -> BTreeMap<String, Keys> {
    let [(_, english), ..] = FILES;
    let file: BTreeMap<String, BTreeMap<String, String>> = toml::from_str(english).unwrap_or_default();
    let keys =
        |words: BTreeMap<String, String>| words.into_iter().map(|(key, text)| (key, names(&text))).collect();
    file.into_iter().map(|(table, words)| (table, keys(words))).collect()
}

/// What is wrong with the language's file at `path`, which has this text.
///
/// # Errors
/// [`InputError`] when it is no such file at all.
pub(crate) fn faults(path: &Path, text: &str) -> Result<Vec<InputError>, InputError> {
    let file: File = toml::from_str(text).map_err(|error| {
        Fault::of_toml(&error, "a language has tables of words, as lang/en.toml has").in_file(path, text)
    })?;
    let mut wanted = of_pages();
    let is_english = file.contains_key("language") && !file.contains_key(SAID) && !file.contains_key(REMEDY);
    let is_english = is_english && FILES.iter().any(|(code, own)| *code == "en" && *own == text);
    if !is_english {
        wanted.extend([(SAID.to_owned(), said()), (REMEDY.to_owned(), remedies())]);
    }
    let mut found = Vec::new();
    for (table, keys) in &wanted {
        of_table(table, keys, &file, &mut found);
    }
    for (table, _) in file.iter().filter(|(table, _)| !wanted.contains_key(table.get_ref())) {
        let what = format!("no page has the table `[{}]`", table.get_ref());
        found.push(Fault::wrong(table, what, "leave it out"));
    }
    Ok(found.into_iter().map(|fault| fault.in_file(path, text)).collect())
}

/// What is wrong with one table.
fn of_table(table: &str, keys: &Keys, file: &File, found: &mut Vec<Fault>) {
    let Some((head, words)) = file.get_key_value(table) else {
        let what = format!("the table `[{table}]` is missing");
        return found.push(Fault::wrong(0, what, format!("add it with its {} keys", keys.len())));
    };
    let is_of_codes = [SAID, REMEDY].contains(&table);
    for (key, names_of_key) in keys {
        let Some(text) = words.get(key.as_str()) else {
            let what = format!("`{key}` is missing in `[{table}]`");
            let remedy = if names_of_key.is_empty() {
                "add its words".to_owned()
            } else {
                format!("add its words, which may have {} in them", braced(names_of_key))
            };
            found.push(Fault::wrong(head, what, remedy));
            continue;
        };
        let used = names(text.get_ref());
        // The words of a code may leave out a figure; those of a page must have all of them.
        let is_right = used.is_subset(names_of_key) && (is_of_codes || used == *names_of_key);
        if !is_right {
            let what = format!("the words of `{key}` have {} in them", braced(&used));
            let remedy = format!("{} is what there is", braced(names_of_key));
            found.push(Fault::wrong(text, what, remedy));
        }
    }
    for (key, _) in words.iter().filter(|(key, _)| !keys.contains_key(key.get_ref())) {
        let what = format!("no page says `{}` of `[{table}]`", key.get_ref());
        found.push(Fault::wrong(key, what, "leave it out, or correct the key"));
    }
}

fn braced(names: &BTreeSet<String>) -> String {
    if names.is_empty() {
        return "nothing in braces".to_owned();
    }
    names.iter().map(|name| format!("{{{name}}}")).collect::<Vec<_>>().join(", ")
}

/// The languages that are part of the program, each as its file would be.
pub(crate) fn built_in() -> impl Iterator<Item = (PathBuf, &'static str)> {
    FILES.into_iter().map(|(code, text)| (PathBuf::from(format!("lang/{code}.toml")), text))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Vec<String> {
        faults(Path::new("xx.toml"), text).unwrap().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn every_language_says_all_that_pages_say_and_every_code_that_is_seen_there() {
        assert!(said().len() > 180 && remedies().len() > 50, "{} {}", said().len(), remedies().len());
        assert!(REMEDIES.iter().all(|(code, _)| said().contains_key(*code)), "{REMEDIES:?}");
        let found: Vec<_> = built_in().flat_map(|(path, text)| faults(&path, text).unwrap()).collect();
        let found: Vec<_> = found.iter().map(ToString::to_string).collect();
        assert!(found.is_empty(), "{}", found.join("\n"));
    }

    /// Each with the line that it is in.
    #[test]
    fn a_translators_mistake_is_told_with_its_line() {
        let (_, german) = built_in().find(|(path, _)| path.ends_with("de.toml")).unwrap();
        let line = |text: &str, part: &str| 1 + text.lines().position(|line| line.starts_with(part)).unwrap();
        assert_eq!(of(german), Vec::<String>::new());
        let without = german.replacen("missing = ", "mising = ", 1);
        let [missing, surplus] = &of(&without)[..] else { panic!("{:?}", of(&without)) };
        assert!(
            missing.starts_with(&format!("xx.toml:{}: `missing` is missing", line(&without, "[trouble]"))),
            "{missing}"
        );
        assert!(
            surplus.starts_with(&format!("xx.toml:{}: no page says `mising`", line(&without, "mising"))),
            "{surplus}"
        );
        for (right, wrong) in [("{seconds}", "{second}"), ("{attempts}", "{versuche}")] {
            let renamed = german.replacen(right, wrong, 1);
            let [one] = &of(&renamed)[..] else { panic!("{right}: {:?}", of(&renamed)) };
            let at = 1 + renamed.lines().position(|line| line.contains(wrong)).unwrap();
            assert!(one.starts_with(&format!("xx.toml:{at}: ")) && one.contains(wrong), "{one}");
        }
        let surplus = format!("{german}[more]\nx = \"y\"\n");
        assert!(of(&surplus)[0].contains("no page has the table `[more]`"), "{:?}", of(&surplus));
        let lost = german.replacen("lane-busy = ", "# lane-busy = ", 1);
        assert!(
            of(&lost)[0].contains(
                "`lane-busy` is missing in `[said]`; add its words, which may have {lane}, {serial}"
            ),
            "{:?}",
            of(&lost)
        );
        assert!(
            faults(Path::new("xx.toml"), "[trouble]\nx = \"\n")
                .unwrap_err()
                .to_string()
                .starts_with("xx.toml:2:")
        );
    }
}
