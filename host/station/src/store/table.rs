//! Tables row by row, in the order of their keys, read a page at a time.

use std::collections::VecDeque;
use std::fmt;

use super::StoreError;
use super::database::{Database, DatabaseError, Value};

/// How many rows are read at a time.
const PAGE: usize = 1_000;

/// A row, each value as text with its column.
pub type Row = Vec<(String, String)>;

/// The key of a row. Both engines sort rows in the order of these keys.
pub(crate) type Key = Vec<KeyValue>;

/// The value of one column of a key.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum KeyValue {
    /// A whole number.
    Whole(i64),
    /// A text, in the order of its bytes.
    Text(String),
}

impl fmt::Display for KeyValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(whole) => whole.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

impl<'a> From<&'a KeyValue> for Value<'a> {
    fn from(value: &'a KeyValue) -> Self {
        match value {
            KeyValue::Whole(whole) => Self::Whole(*whole),
            KeyValue::Text(text) => Self::Text(text),
        }
    }
}

/// Reads the rows after a key, or the first ones.
type Read<'a> = Box<dyn FnMut(Option<&Key>) -> Result<Vec<(Key, Row)>, StoreError> + 'a>;

/// All rows of a table.
pub struct Rows<'a> {
    read: Read<'a>,
    ahead: VecDeque<(Key, Row)>,
    last: Option<Key>,
    is_over: bool,
}

impl<'a> Rows<'a> {
    /// The rows that `read` returns.
    pub(super) fn by(read: impl FnMut(Option<&Key>) -> Result<Vec<(Key, Row)>, StoreError> + 'a) -> Self {
        Self { read: Box::new(read), ahead: VecDeque::new(), last: None, is_over: false }
    }
}

impl fmt::Debug for Rows<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Rows").field("last", &self.last).finish_non_exhaustive()
    }
}

impl Iterator for Rows<'_> {
    type Item = Result<(Key, Row), StoreError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ahead.is_empty() && !self.is_over {
            match (self.read)(self.last.as_ref()) {
                Ok(page) => {
                    self.is_over = page.len() < PAGE;
                    self.last = page.last().map(|(key, _)| key.clone());
                    self.ahead = page.into();
                }
                Err(error) => {
                    self.is_over = true;
                    return Some(Err(error));
                }
            }
        }
        self.ahead.pop_front().map(Ok)
    }
}

/// The next rows of the table `name` after the key `after`, in the order of the columns `key`, a list with commas between.
pub(super) fn page(
    reader: &mut dyn Database,
    name: &str,
    key: &str,
    after: Option<&Key>,
) -> Result<Vec<(Key, Row)>, DatabaseError> {
    let columns: Vec<_> = key.split(", ").collect();
    let places: Vec<_> = (1..=columns.len()).map(|place| format!("${place}")).collect();
    let from = after.map(|_| format!("WHERE ({key}) > ({})", places.join(", ")));
    let text = format!("SELECT * FROM {name} {} ORDER BY {key} LIMIT {PAGE}", from.unwrap_or_default());
    let values: Vec<_> = after.into_iter().flatten().map(Value::from).collect();
    reader.all(&text, &values, |row| {
        let row = row.columns()?;
        let of_key = |column: &&str| row.iter().find(|(name, _)| name == column).map(|(_, value)| *value);
        let key = columns.iter().filter_map(of_key).map(key_value).collect::<Result<_, _>>()?;
        Ok((key, row.into_iter().map(|(column, value)| (column, text_of(value))).collect()))
    })
}

fn key_value(value: Value<'_>) -> Result<KeyValue, DatabaseError> {
    match value {
        Value::Whole(whole) => Ok(KeyValue::Whole(whole)),
        Value::Text(text) => Ok(KeyValue::Text(text.to_owned())),
        Value::Null | Value::Real(_) => Err(DatabaseError::Dangling { what: "a key" }),
    }
}

fn text_of(value: Value<'_>) -> String {
    match value {
        Value::Null => "NULL".to_owned(),
        Value::Whole(number) => number.to_string(),
        Value::Real(number) => format!("{number:?}"),
        Value::Text(text) => text.to_owned(),
    }
}
