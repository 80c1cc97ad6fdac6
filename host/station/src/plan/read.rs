//! What the parts of a plan mean together.

use std::ops::RangeInclusive;
use std::path::Path;
use std::time::Duration;

use toml::Spanned;

use super::files::Files;
use super::limits::{Blame, Limit, MEASUREMENTS, Maker, Measurement, SAMPLES_DIFFERING};
use super::mock::BARCODE;
use super::serial::SerialRule;
use super::tables;
use super::text::{
    BoardText, LimitText, LimitsText, PlanText, SeedText, SerialText, ShiftText, StepKindText, StepText,
    TablesText,
};
use super::{Bad, Judging, Plan, Production, SCHEMA, Seed, Selected, Shift, Step, StepKind};
use crate::input_error::{At, Fault, within};

/// Where all keys are listed.
const KEYS: &str = "`halfrow-station plan schema` lists every key and its values";
/// How long a step may take unless it says otherwise.
const TIMEOUT: Duration = Duration::from_secs(120);
/// The longest time that it may ask for, in seconds.
const MOST_SECONDS: f64 = 86_400.0;
/// The longest part of a link test, in seconds.
const MOST_LINK_SECONDS: f64 = 3600.0;
/// The longest shift, in hours.
const MOST_SHIFT_HOURS: f64 = 168.0;
/// The most tries after the first.
const MOST_RETRIES: u32 = 10;
/// The most repetitions of a step's frames.
const MOST_REPEATS: u32 = 1000;

/// The plan of `text` in the file `path`; its field `text` is left to the caller.
pub(super) fn plan(path: &Path, text: &str) -> Result<Plan, Fault> {
    let read: PlanText = toml::from_str(text).map_err(|error| Fault::of_toml(&error, KEYS))?;
    check_schema(&read)?;
    let [name, version, product] = [&read.plan.name, &read.plan.version, &read.plan.product].map(not_empty);
    let serial = serial(&read)?;
    let builds = builds(&read.board)?;
    let production = production(&read, &serial)?;
    let mut files = Files::beside(path);
    let base = selected(&read, &read.tables, &LimitsText::new(), &mut files)?;
    let variants = variants(&read, &serial, &mut files)?;
    let (files, sha256) = files.hashed(text);
    Ok(Plan {
        sha256,
        text: String::new(),
        name: name?,
        version: version?,
        product: product?,
        serial,
        production,
        builds,
        device: read.board.device,
        again: read.board.again,
        files,
        base,
        variants,
    })
}

/// What the plan of `text` demands of production, whatever has become of its files.
pub(super) fn production_of(text: &str) -> Result<Production, Fault> {
    let read: PlanText = toml::from_str(text).map_err(|error| Fault::of_toml(&error, KEYS))?;
    check_schema(&read)?;
    production(&read, &serial(&read)?)
}

fn production(read: &PlanText, rule: &SerialRule) -> Result<Production, Fault> {
    let shift = read.shift.as_ref().map(|text| shift(text, rule)).transpose()?;
    Ok(Production { require_hardware: read.board.require_hardware, shift })
}

fn serial(read: &PlanText) -> Result<SerialRule, Fault> {
    let SerialText { pattern, check } = &read.serial;
    let rule = SerialRule::new(pattern.get_ref(), *check);
    rule.map_err(|(what, remedy)| Fault::wrong(pattern, what, remedy))
}

fn check_schema(read: &PlanText) -> Result<(), Fault> {
    if *read.schema.get_ref() != SCHEMA {
        let what = format!("this program reads plans of schema {SCHEMA}, not {}", read.schema.get_ref());
        return Err(Fault::wrong(&read.schema, what, "take the halfrow-station that it was written for"));
    }
    Ok(())
}

/// The units that check a shift; their serial numbers must be of the product.
fn shift(text: &ShiftText, rule: &SerialRule) -> Result<Shift, Fault> {
    let bad = match text.bad.get_ref().as_str() {
        BARCODE => Bad::Mock,
        serial => Bad::Unit(serial.to_owned()),
    };
    let units = [Some(&text.good), (bad != Bad::Mock).then_some(&text.bad)];
    for unit in units.into_iter().flatten() {
        rule.read(unit.get_ref())
            .map_err(|error| Fault::input(unit, "the unit that checks a shift", error))?;
    }
    if text.good.get_ref() == text.bad.get_ref() {
        let what = "one unit is both good and bad";
        return Err(Fault::wrong(&text.bad, what, "name two units"));
    }
    let what = format!("no shift has {} hours", text.hours.get_ref());
    let remedy = format!("write 0.1 to {MOST_SHIFT_HOURS} hours");
    let hours = within(&text.hours, 0.1..=MOST_SHIFT_HOURS, what, remedy)?;
    Ok(Shift { good: text.good.get_ref().clone(), bad, lasts: Duration::from_secs_f64(3600.0 * hours) })
}

/// What is done with the boards of each variant that is named.
fn variants(
    read: &PlanText,
    serial: &SerialRule,
    files: &mut Files,
) -> Result<Vec<(String, Selected)>, Fault> {
    let mut variants = Vec::new();
    for (name, variant) in &read.variant {
        if !serial.has_variants() {
            let what = format!("no serial number says that it is of the variant {}", name.get_ref());
            let remedy = "give the pattern a group (?<variant>…), or leave the variant out";
            return Err(Fault::wrong(name, what, remedy));
        }
        let tables = read.tables.under(&variant.tables);
        variants.push((name.get_ref().clone(), selected(read, &tables, &variant.limits, files)?));
    }
    Ok(variants)
}

fn not_empty(word: &Spanned<String>) -> Result<String, Fault> {
    match word.get_ref().trim() {
        "" => Err(Fault::wrong(word, "there is no name here", "write one, which reports will have")),
        word => Ok(word.to_owned()),
    }
}

/// The builds that may be judged, of which there must be one at least.
fn builds(board: &BoardText) -> Result<Vec<String>, Fault> {
    if board.builds.get_ref().is_empty() {
        let what = "no build of the board may be judged";
        let remedy = "name the builds that are released, as `halfrow info` prints them";
        return Err(Fault::wrong(&board.builds, what, remedy));
    }
    let build = |build: &Spanned<String>| {
        let text = build.get_ref();
        let is_build = text.len() == 8 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
        is_build.then(|| text.clone()).ok_or_else(|| {
            let what = format!("`{text}` is no build");
            let remedy = "write the eight hexadecimal digits, in lower case, that `halfrow info` prints";
            Fault::wrong(build, what, remedy)
        })
    };
    board.builds.get_ref().iter().map(build).collect()
}

/// Steps and limits with these tables; the limits `instead` replace the plan's.
fn selected(
    plan: &PlanText,
    tables: &TablesText,
    instead: &LimitsText,
    files: &mut Files,
) -> Result<Selected, Fault> {
    let Some(first) = plan.step.first() else {
        let remedy = "write a [[step]] with kind = \"verify\"";
        return Err(Fault::wrong(&plan.schema, "the plan has no step", remedy));
    };
    if !plan.step.iter().any(|step| *step.kind.get_ref() == StepKindText::Verify) {
        let what = "no step judges the board";
        return Err(Fault::wrong(&first.kind, what, "add a [[step]] with kind = \"verify\""));
    }
    let identity =
        Step { name: "identity".to_owned(), kind: StepKind::Identity, retries: 0, timeout: TIMEOUT };
    let mut steps = vec![identity];
    for text in &plan.step {
        let step = step(text, tables, files)?;
        if steps.iter().any(|other| other.name == step.name) {
            let at = text.name.as_ref().map_or(text.kind.at(), At::at);
            let what = format!("two steps are called {}", step.name);
            return Err(Fault::wrong(at, what, "give each a `name` of its own"));
        }
        steps.push(step);
    }
    let kept = plan.limits.iter().filter(|(name, _)| !instead.contains_key(*name));
    let limits = kept.chain(instead).map(|(name, text)| limit(name, text, &steps));
    Ok(Selected { limits: limits.collect::<Result<_, _>>()?, steps })
}

fn step(text: &StepText, tables: &TablesText, files: &mut Files) -> Result<Step, Fault> {
    let (kind, name) = match text.kind.get_ref() {
        StepKindText::Link => (link(text)?, "link"),
        StepKindText::Verify => (verify(text, tables, files)?, "verify"),
    };
    let name = text.name.as_ref().map_or_else(|| Ok(name.to_owned()), not_empty)?;
    let retries = whole(text.retries.as_ref(), 0, 0..=MOST_RETRIES)?;
    let timeout = seconds(text.timeout.as_ref(), TIMEOUT, MOST_SECONDS)?;
    Ok(Step { name, kind, retries, timeout })
}

fn link(text: &StepText) -> Result<StepKind, Fault> {
    let foreign = [
        text.frames.as_ref().map(|key| ("frames", key.at())),
        text.repeat.as_ref().map(|key| ("repeat", key.at())),
        text.at_speed.as_ref().map(|key| ("at_speed", key.at())),
        text.seed.as_ref().map(|key| ("seed", key.at())),
        text.tables.as_ref().map(|_| ("tables", text.kind.at())),
    ];
    if let Some((key, at)) = foreign.into_iter().flatten().next() {
        let what = format!("a step `link` has no `{key}`");
        return Err(Fault::wrong(at, what, "leave it out, or write it into a step `verify`"));
    }
    let each = seconds(text.seconds.as_ref(), Duration::from_millis(500), MOST_LINK_SECONDS)?;
    Ok(StepKind::Link { each })
}

fn verify(text: &StepText, tables: &TablesText, files: &mut Files) -> Result<StepKind, Fault> {
    if let Some(seconds) = &text.seconds {
        let what = "a step `verify` takes as long as its frames do";
        return Err(Fault::wrong(seconds, what, "leave `seconds` out; `timeout` limits it"));
    }
    let tables = text.tables.as_ref().map_or_else(|| tables.clone(), |own| tables.under(own));
    let chosen = tables.choose(files, text.kind.at())?;
    let phase = tables.phase.unwrap_or_default();
    let named = text.frames.as_ref().filter(|names| !names.get_ref().is_empty());
    let Some(names) = named else {
        let remedy =
            "name files, or built-in frames as `halfrow frames` lists them, such as \"builtin:noise\"";
        return Err(Fault::wrong(&text.kind, "the step has no frames", remedy));
    };
    let frames = tables::frames(names.get_ref(), chosen.tables.geometry(), phase, files)?;
    let repeat = whole(text.repeat.as_ref(), 1, 1..=MOST_REPEATS)?;
    let at_speed = text.at_speed.as_ref().map(at_speed).transpose()?;
    let judging = Judging { chosen, phase, frames, repeat, at_speed, seed: seed(text.seed.as_ref())? };
    let fits = judging.plan(0).check_length();
    fits.map_err(|error| Fault::input(names, "so many frames", error))?;
    Ok(StepKind::Verify(Box::new(judging)))
}

impl Judging {
    /// What the judge is asked to do, with the seed `of_run` where the plan leaves the seed to the run.
    #[must_use]
    pub fn plan(&self, of_run: u64) -> halfrow::Plan {
        let seed = match self.seed {
            Seed::Run => of_run,
            Seed::Fixed(seed) => seed,
        };
        let plan = self.chosen.clone().plan(self.phase).frames(self.frames.iter().cloned());
        halfrow::Plan { repeat: self.repeat, at_speed: self.at_speed.into(), seed, ..plan }
    }
}

/// What a seed may be.
const SEED: &str = "write \"run\", or a whole number from 0 on";

fn seed(text: Option<&Spanned<SeedText>>) -> Result<Seed, Fault> {
    let Some(text) = text else { return Ok(Seed::Run) };
    match text.get_ref() {
        SeedText::Number(seed) => Ok(Seed::Fixed(*seed)),
        SeedText::Word(word) if word == "run" => Ok(Seed::Run),
        SeedText::Word(word) => Err(Fault::wrong(text, format!("`{word}` is no seed"), SEED)),
        SeedText::Other(_) => Err(Fault::wrong(text, "this is no seed", SEED)),
    }
}

/// The time for which the board makes frames on its own, which may be 0.
fn at_speed(text: &Spanned<f64>) -> Result<Duration, Fault> {
    match *text.get_ref() {
        0.0 => Ok(Duration::ZERO),
        _ => some_seconds(text, MOST_SECONDS, "0, or "),
    }
}

fn seconds(text: Option<&Spanned<f64>>, otherwise: Duration, most: f64) -> Result<Duration, Fault> {
    text.map_or(Ok(otherwise), |text| some_seconds(text, most, ""))
}

fn some_seconds(text: &Spanned<f64>, most: f64, or: &str) -> Result<Duration, Fault> {
    let what = format!("{} seconds are none that a step can take", text.get_ref());
    let remedy = format!("write a number of seconds, {or}0.001 to {most}");
    within(text, 0.001..=most, what, remedy).map(Duration::from_secs_f64)
}

fn whole(text: Option<&Spanned<u32>>, otherwise: u32, range: RangeInclusive<u32>) -> Result<u32, Fault> {
    let Some(text) = text else { return Ok(otherwise) };
    let remedy = format!("write a whole number from {} to {}", range.start(), range.end());
    within(text, range, format!("{} is out of range", text.get_ref()), remedy)
}

fn limit(name: &Spanned<String>, text: &LimitText, steps: &[Step]) -> Result<Limit, Fault> {
    let Some(measurement) = Measurement::named(name.get_ref()) else {
        let names = MEASUREMENTS.iter().map(|known| known.name);
        let known: Vec<_> = names.filter(|name| *name != SAMPLES_DIFFERING).collect();
        let what = format!("nothing is measured that is called {}", name.get_ref());
        return Err(Fault::wrong(name, what, format!("name one of {}", known.join(", "))));
    };
    if measurement.name == SAMPLES_DIFFERING {
        let what = "no sample may differ, whatever a plan says";
        return Err(Fault::wrong(name, what, "leave this limit out; a sample that differs is FAIL"));
    }
    let is_made = match measurement.made_by {
        Maker::Run => true,
        Maker::Link => steps.iter().any(|step| matches!(step.kind, StepKind::Link { .. })),
        Maker::Verify => steps.iter().any(|step| matches!(step.kind, StepKind::Verify(_))),
    };
    if !is_made {
        let what = format!("no step of the plan measures {}", measurement.name);
        return Err(Fault::wrong(name, what, "add a [[step]] with kind = \"link\", or leave the limit out"));
    }
    if let Some(unit) = text.unit.as_ref().filter(|unit| unit.get_ref() != measurement.unit) {
        let what =
            format!("{} is measured in {}, not in {}", measurement.name, measurement.unit, unit.get_ref());
        let remedy = format!("write the limit in {}", measurement.unit);
        return Err(Fault::wrong(unit, what, remedy));
    }
    let (least, most) = bounds(name, text)?;
    check_most(measurement, text.most.as_ref())?;
    let blames = text.blames.unwrap_or(measurement.blames);
    if blames == Blame::Board && measurement.blames != Blame::Board {
        let what =
            format!("a cable or a computer changes {}, so it cannot blame the board", measurement.name);
        return Err(Fault::wrong(name, what, "write blames = \"station\" or blames = \"nobody\""));
    }
    Ok(Limit { measurement, least, most, blames })
}

/// Refuses a most value that whatever is measured is beyond: nothing is below 0, and no latency is 0.
fn check_most(measurement: Measurement, most: Option<&Spanned<f64>>) -> Result<(), Fault> {
    let Measurement { name, .. } = measurement;
    let Some(most) = most else { return Ok(()) };
    let value = *most.get_ref();
    let (is_possible, remedy) = if measurement.is_latency() {
        (value > 0.0, "write a number above 0")
    } else {
        (value >= 0.0, "write a number from 0 on")
    };
    if is_possible {
        Ok(())
    } else {
        Err(Fault::wrong(most, format!("{name} is never at most {value}"), remedy))
    }
}

/// The least and the most value, at least one of which is given.
fn bounds(name: &Spanned<String>, text: &LimitText) -> Result<(Option<f64>, Option<f64>), Fault> {
    let number = |bound: &Option<Spanned<f64>>| match bound {
        Some(bound) if !bound.get_ref().is_finite() => {
            let what = format!("{} is no limit", bound.get_ref());
            Err(Fault::wrong(bound, what, "write a number, or leave this side open"))
        }
        bound => Ok(bound.as_ref().map(|bound| *bound.get_ref())),
    };
    match (number(&text.least)?, number(&text.most)?) {
        (None, None) => Err(Fault::wrong(
            name,
            "a limit without `least` and `most` limits nothing",
            "write one of them, or both",
        )),
        (Some(least), Some(most)) if least > most => {
            let what = format!("nothing is at least {least} and at most {most}");
            Err(Fault::wrong(name, what, "exchange `least` and `most`, or correct one"))
        }
        bounds => Ok(bounds),
    }
}
