//! Parameters of sentences, as people read them.

use halfrow::result::LateRows;
use jiff::Timestamp;
use serde::Deserialize as _;
use serde_json::Value;

use super::super::Words;
use super::ENGLISH;
use crate::clock;

/// Parameters that are seconds.
const TIMES: [&str; 4] = ["at", "seconds", "deadline", "waited"];
/// Parameters that are counts. Other numbers identify something.
const COUNTS: [&str; 10] = [
    "bytes",
    "differences",
    "echoes",
    "entries",
    "nodes",
    "packets",
    "requests",
    "retries",
    "rows",
    "samples",
];
/// Parameters that are several names in one text.
const LISTS: [&str; 5] = ["builds", "channels", "holders", "known", "names"];

impl Words {
    /// The parameter of this name as people read it, together with others that qualify it; none if there is none.
    pub(super) fn named(&self, name: &str, parameters: &Value) -> Option<String> {
        let value = at(parameters, name);
        let own = || Some(self.alone(name, value?));
        match name {
            "others" => Some(self.others(value.and_then(Value::as_u64).unwrap_or_default())),
            "differing_frames" => Some(self.in_frames(parameters)),
            "frame" => self.rules_frame(value?, parameters).or_else(own),
            "is_one_row" => Some(self.one_row(parameters)),
            "rows" => self.some_rows(parameters).or_else(own),
            // Earlier records call the entries of tables `rows`.
            "entries" if value.is_none() => self.named("rows", parameters),
            "bit" => self.one_of_bits(parameters).or_else(own),
            "value" => self.measured(parameters).or_else(own),
            "verdict" => self.verdict(value?).or_else(own),
            "when" => moment(value?).or_else(own),
            "board.no_hardware" => Some(self.no_hardware(parameters).to_owned()),
            "doing" => self.refused_by_plant(value?).or_else(own),
            "table" => self.table(value?).or_else(own),
            "link" => self.link(value?).or_else(own),
            _ => own(),
        }
    }

    /// What was measured, in its unit.
    fn measured(&self, parameters: &Value) -> Option<String> {
        let unit = self.unit(parameters.get("unit")?.as_str()?);
        let value = self.value(parameters.get("value")?);
        Some(if unit.is_empty() { value } else { format!("{value} {unit}") })
    }

    /// A unit as people write it. What is counted has none.
    pub(in crate::web) fn unit<'a>(&'a self, name: &'a str) -> &'a str {
        match name {
            "1" => "",
            "us" => "µs",
            "clocks" => self.say("unit.clocks"),
            name => name,
        }
    }

    /// A verdict as a lane says it.
    fn verdict(&self, verdict: &Value) -> Option<String> {
        let word = match verdict.as_str()? {
            "PASS" => self.say("state.pass"),
            "FAIL" => self.say("state.fail"),
            "ERROR" => self.say("state.error"),
            _ => return None,
        };
        Some(word.to_owned())
    }

    /// The statement that the judged board was no hardware.
    fn no_hardware(&self, parameters: &Value) -> &str {
        match parameters.get("board").and_then(Value::as_str) {
            Some("mock") => self.say("told.of-mock"),
            Some("sim") => self.say("told.of-simulation"),
            Some("replay") => self.say("told.of-recording"),
            _ => "",
        }
    }

    /// What a plant refuses. What only persons at a command ask for stays English.
    fn refused_by_plant(&self, doing: &Value) -> Option<String> {
        let words = match doing.as_str()? {
            "a connection" => self.say("told.a-connection"),
            "a run" => self.say("told.a-run"),
            look if look.starts_with("to tell ") || look.starts_with("to be ") => self.say("told.a-look"),
            _ => return None,
        };
        Some(words.to_owned())
    }

    /// The name of a link, where it is more than what the link is plugged into.
    fn link(&self, link: &Value) -> Option<String> {
        let link = link.as_str()?;
        if let Some(address) = link.strip_prefix("the connection to ") {
            return Some(self.fill("told.connection", &[("address", address)]));
        }
        let (path, rate) = link.strip_prefix("the serial port ")?.rsplit_once(" (")?;
        Some(self.fill("told.serial-port", &[("path", path), ("baud", rate.strip_suffix(" baud)")?)]))
    }

    /// The memory of a table.
    fn table(&self, table: &Value) -> Option<String> {
        let words = match table.as_str()? {
            "rows" => self.say("told.rows-table"),
            "kernel" => self.say("told.kernel-memory"),
            _ => return None,
        };
        Some(words.to_owned())
    }

    /// The statement that this many other defects explain everything as well.
    fn others(&self, others: u64) -> String {
        match others {
            0 => String::new(),
            1 => self.say("told.another").to_owned(),
            more => self.fill("told.others", &[("others", &more.to_string())]),
        }
    }

    /// In how many of the streamed frames samples differ, or in which rows of the rules.
    fn in_frames(&self, parameters: &Value) -> String {
        let part = |name: &str| at(parameters, name).map_or_else(String::new, |value| self.value(value));
        if parameters.get("tried").is_some() {
            let [width, height] = ["tried.width", "tried.height"].map(part);
            return self.fill("told.in-rules", &[("width", &width), ("height", &height)]);
        }
        let [differing, all] = ["differing_frames", "frames"].map(part);
        self.fill("told.in-frames", &[("differing", &differing), ("all", &all)])
    }

    /// A frame that the rules were tried with, which are numbered by themselves.
    fn rules_frame(&self, frame: &Value, parameters: &Value) -> Option<String> {
        let of_rules = parameters.get("rules").and_then(Value::as_bool)?;
        of_rules.then(|| self.fill("told.rules-frame", &[("frame", &self.value(frame))]))
    }

    /// How many of all rows are late.
    fn some_rows(&self, parameters: &Value) -> Option<String> {
        let LateRows { rows, of_rows, .. } = late(parameters).filter(LateRows::are_some)?;
        Some(
            self.fill(
                "told.some",
                &[("some", &self.count(rows as u64)), ("all", &self.count(of_rows as u64))],
            ),
        )
    }

    /// The statement that every late row is the same one.
    fn one_row(&self, parameters: &Value) -> String {
        let late = late(parameters).filter(LateRows::are_one_row);
        late.map_or_else(String::new, |late| self.fill("told.one-row", &[("row", &late.row.to_string())]))
    }

    /// The bit and those with the same effect, if there are any.
    fn one_of_bits(&self, parameters: &Value) -> Option<String> {
        let alike = at(parameters, "reading.alike")?.as_array()?.iter();
        let mut bits: Vec<_> =
            parameters.get("bit").into_iter().chain(alike).filter_map(Value::as_u64).collect();
        bits.sort_unstable();
        let (last, first) = bits.split_last().filter(|(_, first)| !first.is_empty())?;
        let first = first.iter().map(u64::to_string).collect::<Vec<_>>().join(self.say("told.list"));
        Some(self.fill("told.or", &[("first", &first), ("last", &last.to_string())]))
    }

    /// The parameter of this name by itself. Times are rounded to what matters to people.
    fn alone(&self, name: &str, value: &Value) -> String {
        match value.as_f64().filter(|_| value.is_f64() && TIMES.contains(&name)) {
            Some(seconds) if seconds >= 1.0 => self.figures(&format!("{}", (seconds * 10.0).round() / 10.0)),
            Some(seconds) => self.figures(&format!("{}", (seconds * 1e3).round() / 1e3)),
            None if COUNTS.contains(&name) && value.is_u64() => {
                self.count(value.as_u64().unwrap_or_default())
            }
            None if LISTS.contains(&name) => self.value(value).replace(", ", self.say("told.list")),
            None => self.value(value),
        }
    }

    /// A parameter as people read it.
    fn value(&self, value: &Value) -> String {
        match value {
            Value::Null => "–".to_owned(),
            Value::String(text) if text.is_empty() => "–".to_owned(),
            Value::String(text) => text.clone(),
            Value::Number(number) if number.is_f64() => {
                let rounded = number.as_f64().map(|value| (value * 1e6).round() / 1e6);
                rounded.map_or_else(|| number.to_string(), |value| self.figures(&value.to_string()))
            }
            Value::Array(values) => {
                values.iter().map(|value| self.value(value)).collect::<Vec<_>>().join(self.say("told.list"))
            }
            Value::Object(fields) => {
                let text = |key: &str| fields.get(key).and_then(Value::as_str);
                let own = text("code")
                    .filter(|_| self.code != ENGLISH)
                    .and_then(|code| self.sentence(code, fields.get("parameters").unwrap_or(&Value::Null)));
                let named = || ["message", "name", "code"].into_iter().find_map(text).map(str::to_owned);
                own.or_else(named).unwrap_or_else(|| value.to_string())
            }
            value @ (Value::Bool(_) | Value::Number(_)) => value.to_string(),
        }
    }
}

/// A moment by the station's clock, with its offset: in one hour of the year a time without it is either of two.
fn moment(value: &Value) -> Option<String> {
    let at: Timestamp = value.as_str()?.parse().ok()?;
    Some(clock::local(at.as_millisecond()).strftime("%Y-%m-%d %H:%M %:z").to_string())
}

/// The late rows that these parameters describe, if they do.
pub(super) fn late(parameters: &Value) -> Option<LateRows> {
    LateRows::deserialize(parameters).ok()
}

/// The parameter of this name; `place.row` is the row of the place.
fn at<'a>(parameters: &'a Value, name: &str) -> Option<&'a Value> {
    name.split('.').try_fold(parameters, |value, name| value.get(name))
}
