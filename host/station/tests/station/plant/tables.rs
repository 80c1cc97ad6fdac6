//! The tables of a station and of a plant, each read by its own engine.

use std::path::Path;

use super::server::Server;
use crate::history::made::Made;

/// Tables that a plant has of a station, each with the columns by which its rows are sorted.
pub(super) const TABLES: [(&str, &str); 12] = [
    ("plan", "sha256"),
    ("unit", "id"),
    ("run", "id"),
    ("step", "run_id, seq, attempt"),
    ("measurement", "run_id, seq, attempt, name"),
    ("suspect", "run_id, rank"),
    ("attachment", "run_id, name"),
    ("binding", "id"),
    ("waiver", "id"),
    ("audit", "id"),
    ("day_count", "plan_sha256, station, lane, day"),
    ("failure", "run_id, kind, name"),
];

/// A table: its rows, and their values as text.
pub(crate) type Table = Vec<Vec<String>>;

/// The columns of a station's table: their names and types.
pub(super) fn columns(data: &Path, table: &str) -> Vec<(String, String)> {
    let of = |what: &str| {
        crate::common::query(data, &format!("SELECT {what} FROM pragma_table_info('{table}') ORDER BY cid"))
    };
    of("name").into_iter().zip(of("type")).collect()
}

/// The table `name` of the station in `data`.
pub(crate) fn of_station(data: &Path, name: &str, order: &str) -> Table {
    let columns: Vec<_> = columns(data, name).into_iter().map(|(column, _)| column).collect();
    let database = rusqlite::Connection::open(data.join("station.db")).unwrap();
    let text = format!("SELECT {} FROM {name} WHERE {} ORDER BY {order}", columns.join(", "), kept(name));
    let mut statement = database.prepare(&text).unwrap();
    let row = |row: &rusqlite::Row<'_>| (0..columns.len()).map(|at| row.get(at)).collect();
    let rows = statement.query_map([], row).unwrap();
    let text = |value| match value {
        rusqlite::types::Value::Null => "NULL".to_owned(),
        rusqlite::types::Value::Integer(whole) => whole.to_string(),
        rusqlite::types::Value::Real(real) => real_text(real),
        rusqlite::types::Value::Text(text) => text,
        rusqlite::types::Value::Blob(bytes) => format!("{bytes:?}"),
    };
    let rows: Vec<Vec<rusqlite::types::Value>> = rows.map(Result::unwrap).collect();
    rows.into_iter().map(|row| row.into_iter().map(text).collect()).collect()
}

/// The table `name` of the plant, with the columns that the station in `data` has.
pub(crate) fn of_plant(server: &Server, data: &Path, name: &str, order: &str) -> Table {
    let columns = columns(data, name);
    let names: Vec<_> = columns.iter().map(|(column, _)| column.as_str()).collect();
    let rows = server.rows(&format!("SELECT {} FROM {name} ORDER BY {order}", names.join(", ")));
    let text = |(value, (_, kind)): (String, &(String, String))| match kind.as_str() {
        "REAL" if value != "NULL" => real_text(value.parse().unwrap()),
        _ => value,
    };
    rows.into_iter().map(|row| row.into_iter().zip(&columns).map(text).collect()).collect()
}

/// The shortest text that reads back as this number.
fn real_text(real: f64) -> String {
    format!("{real:?}")
}

/// Which rows are sent to a plant: those of runs that ended.
fn kept(table: &str) -> &'static str {
    match table {
        "run" => "state = 'final'",
        "plan" => "sha256 IN (SELECT plan_sha256 FROM run WHERE state = 'final')",
        "unit" => "id IN (SELECT unit_id FROM run WHERE state = 'final')",
        _ => "1 = 1",
    }
}

/// Asserts that the plant has exactly what this station has.
pub(crate) fn is_as(server: &Server, made: &Made) {
    for (name, order) in TABLES {
        let theirs = of_plant(server, made.as_ref(), name, order);
        assert_eq!(theirs, of_station(made.as_ref(), name, order), "{name}");
    }
    let retests = "SELECT * FROM retest ORDER BY unit_id, plan";
    assert_eq!(server.rows(retests), of_station(made.as_ref(), "retest", "unit_id, plan"));
    let records = server.rows("SELECT sha256, text FROM record ORDER BY sha256");
    let hashes =
        crate::common::query(made.as_ref(), "SELECT record_sha256 FROM run WHERE state = 'final' ORDER BY 1");
    assert_eq!(records.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), hashes);
    for row in records {
        let file = std::fs::read(made.folder().blobs().path(&row[0])).unwrap();
        assert_eq!(file, row[1].as_bytes(), "the record of hash {}", row[0]);
    }
}
