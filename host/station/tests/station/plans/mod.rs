//! Plans: what is accepted, and what is refused with its line and a remedy.

mod limits;
mod tables;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use halfrow::run::AtSpeed;
use halfrow_station::plan::limits::{Blame, MEASUREMENTS, Measurement};
use halfrow_station::plan::{JSON_SCHEMA, Plan, Seed, StepKind};
use serde_json::Value;

use crate::common::{PLAN, program};

const PAGE: &str = include_str!("../../../../../docs/station-plans.md");
/// A plan that uses every key.
const WHOLE: &str = r#"schema = 1
[plan]
name = "cam-a-final"
version = "7"
product = "CAM-A"
[serial]
pattern = "^CA(?<variant>[WN])(?<number>[0-9]{9}[0-9X])$"
check = "mod11"
[board]
require_hardware = false
builds = ["99bff58a", "00000000"]
device = "if-present"
[tables]
radius = 20.0
width = 64
height = 16
bits = 10
phase = "rggb"
rows = "equation-9"
kernel = "hermite"
[[step]]
kind = "link"
seconds = 0.5
retries = 1
[[step]]
kind = "verify"
frames = ["builtin:noise", "chart.pgm"]
repeat = 2
at_speed = 1.5
seed = "run"
timeout = 60
[[step]]
kind = "verify"
name = "diagnostic tables"
tables = { kernel = "keys" }
frames = ["builtin:noise"]
seed = 7
[limits]
"latency.clocks" = { most = 1004, blames = "board" }
"link.together" = { least = 1.1e6, unit = "B/s", blames = "station" }
"run.seconds" = { most = 60 }
[variant.W]
tables = { radius = 30.0 }
limits = { "latency.clocks" = { most = 1010 } }
[shift]
good = "CAW080442957X"
bad = "CAN0306406152"
hours = 8.0
"#;

fn load(text: &str) -> Result<Plan, String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("chart.pgm"), chart(64)).unwrap();
    fs::write(folder.path().join("wide.pgm"), chart(128)).unwrap();
    let path = folder.path().join("plan.toml");
    fs::write(&path, text).unwrap();
    let place = format!("{}/", folder.path().display());
    let told = |error: &dyn std::error::Error| {
        let chain = std::iter::successors(Some(error), |error| error.source());
        chain.map(ToString::to_string).collect::<Vec<_>>().join(": ").replace(&place, "")
    };
    Plan::load(&path).map_err(|error| told(&error))
}

/// A PGM of 16 rows.
fn chart(width: usize) -> Vec<u8> {
    let mut bytes = format!("P5\n{width} 16\n1023\n").into_bytes();
    bytes.resize(bytes.len() + 2 * width * 16, 1);
    bytes
}

#[test]
fn a_plan_says_what_is_done_with_each_variant() {
    let plan = load(WHOLE).unwrap();
    assert_eq!(
        (plan.name.as_str(), plan.version.as_str(), plan.product.as_str()),
        ("cam-a-final", "7", "CAM-A")
    );
    let steps = |serial: &str| {
        let (serial, selected) = plan.select(serial).unwrap();
        (serial.variant, selected)
    };
    let (narrow, of_narrow) = steps("CAN080442957X");
    let (wide, of_wide) = steps("CAW080442957X");
    assert_eq!((narrow.as_str(), wide.as_str()), ("N", "W"));
    let names: Vec<_> = of_narrow.steps.iter().map(|step| (step.name.as_str(), step.retries)).collect();
    assert_eq!(names, [("identity", 0), ("link", 1), ("verify", 0), ("diagnostic tables", 0)]);
    let latency = |limits: &[halfrow_station::plan::limits::Limit]| {
        let limit = limits.iter().find(|limit| limit.measurement.name == "latency.clocks").unwrap();
        (limit.most, limit.blames)
    };
    assert_eq!(latency(&of_narrow.limits), (Some(1004.0), Blame::Board));
    assert_eq!(latency(&of_wide.limits), (Some(1010.0), Blame::Board));
    let judging = |selected: &halfrow_station::plan::Selected, step: usize| match &selected.steps[step].kind {
        StepKind::Verify(judging) => judging.clone(),
        kind => panic!("{}", kind.name()),
    };
    assert_ne!(judging(of_narrow, 2).chosen.tables, judging(of_wide, 2).chosen.tables);
    assert_ne!(judging(of_narrow, 2).chosen.kernel, judging(of_narrow, 3).chosen.kernel);
    assert_eq!((judging(of_wide, 2).seed, judging(of_wide, 3).seed), (Seed::Run, Seed::Fixed(7)));
    let at_speed = [2, 3].map(|step| judging(of_wide, step).plan(0).at_speed);
    assert_eq!(at_speed, [AtSpeed::For(Duration::from_millis(1500)), AtSpeed::Usual]);
    assert_eq!([2, 3].map(|step| judging(of_wide, step).plan(0).repeat), [2, 1]);
    assert_eq!(of_wide.steps[2].timeout, Duration::from_secs(60));
    let limited = |selected: &halfrow_station::plan::Selected| {
        let mut names: Vec<_> = selected.limits.iter().map(|limit| limit.measurement.name).collect();
        names.sort_unstable();
        names
    };
    let all = ["latency.clocks", "link.together", "run.seconds"];
    assert_eq!((limited(of_narrow), limited(of_wide)), (all.to_vec(), all.to_vec()));
    assert_eq!(plan.production.shift.as_ref().unwrap().lasts, Duration::from_secs(8 * 3600));
}

#[test]
fn what_differs_from_what_holds_without_it_is_what_the_plan_says() {
    let text = WHOLE.replace("seconds = 0.5", "seconds = 0.25").replace("at_speed = 1.5", "at_speed = 0.0");
    let plan = load(&text.replace("blames = \"station\"", "blames = \"nobody\"")).unwrap();
    let selected = plan.variant("N");
    assert!(matches!(selected.steps[1].kind, StepKind::Link { each } if each == Duration::from_millis(250)));
    let StepKind::Verify(judging) = &selected.steps[2].kind else { panic!("{selected:?}") };
    assert_eq!(judging.plan(0).at_speed, AtSpeed::Off, "no frames of the board's own");
    let limit = selected.limits.iter().find(|limit| limit.measurement.name == "link.together").unwrap();
    assert_eq!(limit.blames, Blame::Nobody);
}

/// The hash is that of the text and of the files that it names. The expected one is computed from the same bytes by `sha256sum`.
#[test]
fn the_hash_changes_with_the_text_and_with_every_file_that_it_names() {
    let plan = load(WHOLE).unwrap();
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("chart.pgm"), chart(64)).unwrap();
    let sum = |bytes: &[u8]| {
        let path = folder.path().join("bytes");
        fs::write(&path, bytes).unwrap();
        let output = Command::new("sha256sum").arg(&path).output().unwrap();
        String::from_utf8(output.stdout).unwrap()[..64].to_owned()
    };
    let expected = sum(format!("{WHOLE}\nchart.pgm\0{}", sum(&chart(64))).as_bytes());
    assert_eq!(plan.sha256, expected);
    assert_ne!(load(&WHOLE.replace("version = \"7\"", "version = \"8\"")).unwrap().sha256, expected);
    fs::write(folder.path().join("plan.toml"), WHOLE).unwrap();
    let mut other = chart(64);
    *other.last_mut().unwrap() ^= 1;
    fs::write(folder.path().join("chart.pgm"), other).unwrap();
    assert_ne!(Plan::load(&folder.path().join("plan.toml")).unwrap().sha256, expected);
}

/// What is replaced in the plan, by what, the line that is then wrong, and how that is told.
const BAD: [(&str, &str, u32, &str); 39] = [
    ("schema = 1", "schema = 2", 1, "this program reads plans of schema 1, not 2; take the"),
    ("schema = 1", "schema = 1\nschma = 1", 2, "unknown field `schma`"),
    ("version = \"7\"", "version = \"7\"\nversion = \"8\"", 5, "duplicate key"),
    ("version = \"7\"", "version = 7", 4, "invalid type: integer `7`, expected a string; correct the line"),
    ("product = \"CAM-A\"", "product = \" \"", 5, "there is no name here; write one"),
    ("version = \"7\"\n", "", 2, "missing field `version`; correct the line"),
    ("pattern = \"^", "pattern = \"", 7, "the pattern CA(?<variant>"),
    ("[0-9]{9}", "[0-9{9}", 7, ""),
    ("check = \"mod11\"", "check = \"mod12\"", 8, "unknown variant `mod12`, expected one of `none`, `mod11`"),
    ("require_hardware = false", "require_hardware = 0", 10, "invalid type: integer `0`, expected a boolean"),
    (
        "builds = [\"99bff58a\", \"00000000\"]",
        "builds = []",
        11,
        "no build of the board may be judged; name the",
    ),
    ("99bff58a", "99BFF58A", 11, "`99BFF58A` is no build; write the eight"),
    ("if-present", "perhaps", 12, "unknown variant `perhaps`, expected one of `required`"),
    ("radius = 20.0", "radius = -1.0", 14, "what the plan says of tables cannot be used: "),
    (
        "radius = 20.0",
        "radius = 20.0\nlens = \"l.yml\"",
        14,
        "tables are said by `lens` and by `radius`; keep one",
    ),
    ("radius = 20.0", "file = \"t.json\"", 15, "a file of tables has a size of its own; leave"),
    ("width = 64", "width = 63", 14, "what the plan says of tables cannot be used: "),
    ("bits = 10", "bits = 9", 17, "a sample has no 9 bits; write 8, 10 or 12"),
    ("kernel = \"hermite\"", "kernel = \"hermit\"", 20, "the file hermit cannot be read: No such"),
    ("seconds = 0.5", "seconds = 0", 23, "0 seconds are none that a step can take; write a number"),
    ("retries = 1", "retries = 11", 24, "11 is out of range; write a whole number from 0 to 10"),
    ("seconds = 0.5", "frames = [\"builtin:noise\"]", 23, "a step `link` has no `frames`; leave it out"),
    ("\"builtin:noise\", \"chart.pgm\"", "\"builtin:nose\"", 27, "`builtin:nose` cannot be used: "),
    ("chart.pgm", "no.pgm", 27, "the file no.pgm cannot be read: No such"),
    (
        "chart.pgm",
        "wide.pgm",
        27,
        "the frame wide.pgm cannot be used: wide.pgm is 128 x 16, and the tables are for 64 x 16; make tables",
    ),
    ("at_speed = 1.5", "at_speed = -1.0", 29, "-1 seconds are none that a step can take; write"),
    ("seed = \"run\"", "seed = \"rum\"", 30, "`rum` is no seed; write \"run\""),
    ("seed = \"run\"", "seed = -1", 30, "this is no seed; write \"run\", or a whole number from 0 on"),
    ("name = \"diagnostic tables\"\n", "", 33, "two steps are called verify; give each a `name`"),
    (
        "\"latency.clocks\" = { most = 1004",
        "\"latency.clock\" = { most = 1004",
        39,
        "nothing is measured that is called latency.clock; name one of run.seconds, link.round_trip, link.to_board, link.to_host, \
         link.together, link.retries, latency.clocks, latency.microseconds, verify.retries, verify.seconds",
    ),
    (
        "\"run.seconds\" = { most = 60 }",
        "\"frames.samples_differing\" = { most = 3 }",
        41,
        "no sample may differ, whatever",
    ),
    ("unit = \"B/s\"", "unit = \"kB/s\"", 40, "link.together is measured in B/s, not in kB/s; write"),
    ("{ most = 60 }", "{ most = 60, blames = \"board\" }", 41, "a cable or a computer changes"),
    ("least = 1.1e6", "least = nan", 40, "NaN is no limit; write a number"),
    ("{ most = 60 }", "{ most = 60, least = 61 }", 41, "nothing is at least 61 and at most 60; exchange"),
    ("(?<variant>[WN])", "[WN]", 42, "no serial number says that it is of the variant W; give the pattern"),
    (
        "bad = \"CAN0306406152\"",
        "bad = \"CAN0306406153\"",
        47,
        "the unit that checks a shift cannot be used: the check digit of `CAN0306406153` is wrong",
    ),
    ("bad = \"CAN0306406152\"", "bad = \"CAW080442957X\"", 47, "one unit is both good and bad; name"),
    ("hours = 8.0", "hours = 0.0", 48, "no shift has 0 hours; write 0.1 to 168 hours"),
];

#[test]
fn every_bad_plan_is_refused_with_file_line_and_remedy() {
    for (good, bad, line, told) in BAD {
        assert!(WHOLE.contains(good), "{good}");
        let said = load(&WHOLE.replacen(good, bad, 1)).map(|plan| plan.name).unwrap_err();
        let expected = format!("plan.toml:{line}: {told}");
        assert!(said.starts_with(&expected), "{bad}\n  said     {said}\n  expected {expected}");
        assert!(said.contains("; "), "no remedy: {said}");
    }
}

#[test]
fn limits_need_a_step_that_measures_and_a_plan_one_that_judges() {
    let link = "[[step]]\nkind = \"link\"\nseconds = 0.5\nretries = 1\n";
    let said = load(&WHOLE.replace(link, "")).map(|plan| plan.name).unwrap_err();
    assert!(said.starts_with("plan.toml:36: no step of the plan measures link.together; add"), "{said}");
    let without = &WHOLE[..WHOLE.find("[[step]]\nkind = \"verify\"").unwrap()];
    let said = load(without).map(|plan| plan.name).unwrap_err();
    assert!(said.starts_with("plan.toml:22: no step judges the board; add"), "{said}");
    let without = &WHOLE[..WHOLE.find("[[step]]").unwrap()];
    let said = load(without).map(|plan| plan.name).unwrap_err();
    assert!(said.starts_with("plan.toml:1: the plan has no step; write"), "{said}");
    let open =
        load(&WHOLE.replace("{ most = 60 }", "{ blames = \"nobody\" }")).map(|plan| plan.name).unwrap_err();
    assert!(open.starts_with("plan.toml:41: a limit without `least` and `most` limits nothing"), "{open}");
}

#[test]
fn a_plan_that_is_not_there_is_named() {
    let said = Plan::load(Path::new("no/plan.toml")).unwrap_err().to_string();
    assert_eq!(said, "no/plan.toml cannot be read; check its name, and who may read it");
}

#[test]
fn a_plan_that_is_checked_prints_its_names_in_their_own_lines() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plan.toml");
    let named =
        |text: String| text.replace("kind = \"verify\"\n", "kind = \"verify\"\nname = \"a\\nPASS\"\n");
    fs::write(&file, named(PLAN.replace("\"quick\"", "\"q\\u001b[8m\\u202e\\nPASS\\u2028x\""))).unwrap();
    let checked = Command::new(program()).args(["plan", "check"]).arg(&file).output().unwrap();
    let said = String::from_utf8(checked.stdout).unwrap();
    assert!(said.contains("plan      q\\u{1b}[8m\\u{202e}\\nPASS\\u{2028}x 1 for CAM-T\n"), "{said}");
    assert!(said.contains("  2 a\\nPASS: 1 x "), "{said}");
}

/// Editors on Windows save umlauts this way; the other file is a device without an end.
#[test]
fn a_plan_that_is_no_text_is_told_as_that() {
    let folder = tempfile::tempdir().unwrap();
    let latin = folder.path().join("plan.toml");
    fs::write(&latin, b"schema = 1\n[plan]\nname = \"Pr\xfcfung\"\n").unwrap();
    let refused = Plan::load(&latin).unwrap_err();
    assert!(refused.to_string().ends_with("save it as text in UTF-8"), "{refused}");
    assert_eq!(
        std::error::Error::source(&refused).unwrap().to_string(),
        "it is not text from byte 28 on, in line 3"
    );
    let refused = Plan::load(Path::new("/dev/zero")).unwrap_err();
    assert_eq!(std::error::Error::source(&refused).unwrap().to_string(), "it is longer than 1048576 bytes");
    let key = format!("{} = 1\n", "k".repeat(5000));
    let said = load(&format!("{key}{WHOLE}")).map(|plan| plan.name).unwrap_err();
    assert!(said.len() < 400 && said.starts_with("plan.toml:1: unknown field"), "{said}");
}

fn as_json(text: &str) -> Option<Value> {
    serde_json::to_value(toml::from_str::<toml::Value>(text).ok()?).ok()
}

/// The schema accepts what the program accepts, and refuses what only its form makes wrong.
#[test]
fn the_schema_says_of_plans_what_the_program_does() {
    let schema: Value = serde_json::from_str(JSON_SCHEMA).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let whole = as_json(WHOLE).unwrap();
    let wrong: Vec<_> = validator.iter_errors(&whole).map(|error| error.to_string()).collect();
    assert_eq!(wrong, Vec::<String>::new());
    let by_shape = [
        "unknown field",
        "unknown variant",
        "invalid type",
        "missing field",
        "is out of range",
        "is no build",
        "no build of the board",
        "has no 9 bits",
        "is no seed",
        "has no `frames`",
        "nothing is measured",
        "no sample may",
        "is measured in",
    ];
    let by_shape = |(.., said): &&(&str, &str, u32, &str)| by_shape.iter().any(|part| said.contains(part));
    let bad: Vec<_> = BAD.iter().filter(by_shape).collect();
    assert_eq!(bad.len(), 16);
    for (good, bad, _, said) in bad {
        let plan = as_json(&WHOLE.replacen(good, bad, 1)).unwrap();
        assert!(!validator.is_valid(&plan), "{bad}: {said}");
    }
    let limits = schema["$defs"]["limits"]["properties"].as_object().unwrap();
    let known: Vec<_> =
        MEASUREMENTS.iter().map(|known| known.name).filter(|name| limits.contains_key(*name)).collect();
    assert_eq!(known.len(), limits.len());
    assert_eq!(known.len(), MEASUREMENTS.len() - 1, "all but the samples that differ");
}

#[test]
fn the_plan_of_the_page_is_one_by_the_schema() {
    let plan = PAGE.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let validator = jsonschema::validator_for(&serde_json::from_str(JSON_SCHEMA).unwrap()).unwrap();
    let errors: Vec<_> =
        validator.iter_errors(&as_json(plan).unwrap()).map(|error| error.to_string()).collect();
    assert_eq!(errors, Vec::<String>::new());
}

/// The page, and the schema for whoever writes a plan with it, list the limits that exist and whom each one blames.
#[test]
fn the_page_and_the_schema_tell_what_can_have_a_limit() {
    let schema: Value = serde_json::from_str(JSON_SCHEMA).unwrap();
    let limits = &schema["$defs"]["limits"]["properties"];
    let settable = MEASUREMENTS.iter().filter(|known| known.name != "frames.samples_differing");
    let mut table = String::new();
    for Measurement { name, unit, made_by, blames, meaning } in settable {
        let by = serde_json::to_value(made_by).unwrap();
        let by = by.as_str().unwrap();
        table += &format!("| `{name}` | {unit} | {by} | {blames} | {meaning} |\n");
        assert_eq!(limits[name]["description"], format!("{meaning} (blames: {blames})"));
    }
    assert!(PAGE.contains(&format!("|---|---|---|---|---|\n{table}\n")), "the page has not\n{table}");
}
