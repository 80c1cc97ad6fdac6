//! The result for one item of the paper: claims compared with what was found, tables of numbers, and pictures.

use serde_json::{Value, json};

use super::Item;
use halfrow::frames::preview::RgbImage;

/// A reproduced item.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// The item.
    pub item: Item,
    /// How it was made, in sentences.
    pub remarks: Vec<String>,
    /// What could not be tried, and how to try it.
    pub open: Vec<String>,
    /// The paper's numbers next to ours.
    pub claims: Vec<Claim>,
    /// All numbers.
    pub tables: Vec<Table>,
    /// The pictures.
    pub pictures: Vec<Picture>,
    /// Whether the pictures belong side by side in groups of three.
    pub in_threes: bool,
}

impl Exhibit {
    /// An empty exhibit.
    pub(super) fn new(item: Item) -> Self {
        Self {
            item,
            remarks: Vec::new(),
            open: Vec::new(),
            claims: Vec::new(),
            tables: Vec::new(),
            pictures: Vec::new(),
            in_threes: false,
        }
    }

    pub(super) fn remark(&mut self, sentence: impl Into<String>) {
        self.remarks.push(sentence.into());
    }
}

/// A number that must be as expected.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// What it is, in a few words.
    pub what: String,
    /// Its unit; empty for a count.
    pub unit: &'static str,
    /// The paper's number, if it has one.
    pub paper: Option<f64>,
    /// What was found.
    pub found: f64,
    /// When it is accepted.
    pub accepted: Accepted,
    /// Whether a miss is the board's fault. Otherwise it is a fault of the reproduction.
    pub judges_board: bool,
}

/// When a number is accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accepted {
    /// No further than this from the paper's.
    Within(f64),
    /// No more than this.
    UpTo(f64),
    /// Less than this.
    Below(f64),
}

impl Claim {
    /// Found − paper.
    #[must_use]
    pub fn deviation(&self) -> Option<f64> {
        self.paper.map(|paper| self.found - paper)
    }

    /// Whether the number is accepted.
    #[must_use]
    pub fn holds(&self) -> bool {
        match self.accepted {
            Accepted::Within(tolerance) => {
                self.deviation().is_some_and(|deviation| deviation.abs() <= tolerance)
            }
            Accepted::UpTo(most) => self.found <= most,
            Accepted::Below(limit) => self.found < limit,
        }
    }

    /// The number as text; a count has no decimals.
    #[must_use]
    pub fn printed(&self) -> String {
        if self.unit.is_empty() { self.found.to_string() } else { format!("{:.4}", self.found) }
    }

    /// When the number is accepted, in words.
    #[must_use]
    pub fn condition(&self) -> String {
        let unit = self.unit;
        let text = match self.accepted {
            Accepted::Within(tolerance) => format!("± {tolerance} {unit}"),
            Accepted::UpTo(most) => format!("at most {most} {unit}"),
            Accepted::Below(limit) => format!("below {limit} {unit}"),
        };
        text.trim_end().to_owned()
    }

    pub(super) fn json(&self) -> Value {
        json!({
            "what": self.what, "unit": self.unit, "paper": self.paper, "found": self.found,
            "deviation": self.deviation(), "accepted": self.condition(), "holds": self.holds(),
            "judges_board": self.judges_board,
        })
    }
}

/// The largest of `values`, which are 0 or more; NaN if one of them is, so that it is never accepted.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| if value > most || value.is_nan() { value } else { most })
}

/// Numbers in rows and columns, one CSV file.
#[derive(Clone, Debug)]
pub struct Table {
    /// The file's name without its extension.
    pub name: &'static str,
    /// What it contains, in one sentence.
    pub caption: String,
    /// The columns' names, with units.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<Cell>>,
    /// Whether it is short enough to be shown on the page.
    pub on_page: bool,
}

/// One cell of a [`Table`].
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Text.
    Text(String),
    /// A number, and how many decimals are printed.
    Number(f64, usize),
}

impl Cell {
    /// The cell as it is printed.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value, decimals) => format!("{value:.decimals$}"),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Text(text) => json!(text),
            Self::Number(..) => self.text().parse::<f64>().map_or(Value::Null, |number| json!(number)),
        }
    }
}

impl Table {
    /// The table as comma-separated values, with the column names first (RFC 4180).
    #[must_use]
    pub fn csv(&self) -> String {
        let quoted = |text: &str| match text.contains([',', '"', '\n']) {
            true => format!("\"{}\"", text.replace('"', "\"\"")),
            false => text.to_owned(),
        };
        let line = |cells: Vec<String>| cells.join(",") + "\r\n";
        let names = self.columns.iter().map(|name| quoted(name)).collect();
        let rows = self.rows.iter().map(|row| line(row.iter().map(|cell| quoted(&cell.text())).collect()));
        std::iter::once(line(names)).chain(rows).collect()
    }

    pub(super) fn json(&self) -> Value {
        let row = |row: &Vec<Cell>| row.iter().map(Cell::json).collect::<Value>();
        let rows: Vec<Value> = self.rows.iter().map(row).collect();
        json!({ "name": self.name, "caption": self.caption, "columns": self.columns, "rows": rows })
    }
}

/// A picture, one file.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The file's name without its extension.
    pub name: String,
    /// What it shows, in one sentence.
    pub caption: String,
    /// The picture itself.
    pub(crate) drawing: Drawing,
}

/// A picture of pixels or of lines.
#[derive(Clone, Debug)]
pub(crate) enum Drawing {
    /// Pixels; each is shown as a square with this many pixels on a side.
    Pixels(RgbImage, usize),
    /// An SVG document.
    Lines(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(paper: Option<f64>, found: f64, accepted: Accepted) -> Claim {
        Claim { what: String::new(), unit: "dB", paper, found, accepted, judges_board: false }
    }

    #[test]
    fn a_number_is_accepted_up_to_its_limit_and_not_beyond() {
        assert!(claim(Some(2.0), 2.25, Accepted::Within(0.25)).holds());
        assert!(!claim(Some(2.0), 1.5, Accepted::Within(0.25)).holds());
        assert!(!claim(None, 2.0, Accepted::Within(0.25)).holds());
        assert!(claim(None, 2.0, Accepted::UpTo(2.0)).holds());
        assert!(!claim(None, 2.0, Accepted::Below(2.0)).holds());
        assert!(!claim(Some(2.0), f64::NAN, Accepted::Within(9.0)).holds());
    }

    #[test]
    fn a_table_is_quoted_as_rfc_4180_says() {
        let table = Table {
            name: "t",
            caption: String::new(),
            columns: vec!["a, b".to_owned(), "c".to_owned()],
            rows: vec![vec![Cell::Text("say \"x\"".to_owned()), Cell::Number(1.0 / 3.0, 3)]],
            on_page: true,
        };
        assert_eq!(table.csv(), "\"a, b\",c\r\n\"say \"\"x\"\"\",0.333\r\n");
        assert_eq!(table.json()["rows"][0][1], 0.333);
    }
}
