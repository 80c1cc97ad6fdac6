//! What a station's database consists of, by which one is known that has lost some of it.

use std::collections::BTreeMap;

use super::database::{Database, DatabaseError};

/// That a database has no such table, index or column, which is `table.column`.
pub(crate) fn lacks(what: &str) -> String {
    format!("there is no {what}")
}

/// Tables and indices, by their names.
pub(super) struct Shape {
    /// The columns of each table.
    tables: BTreeMap<String, Vec<String>>,
    /// The table of each index, and the statement that made it; SQLite's own indices have none.
    indices: BTreeMap<String, (String, String)>,
}

impl Shape {
    /// That of this database.
    pub(super) fn of(database: &mut dyn Database) -> Result<Self, DatabaseError> {
        const COLUMNS: &str = "SELECT tables.name, columns.name \
            FROM sqlite_schema AS tables, pragma_table_info(tables.name) AS columns WHERE tables.type = 'table' ORDER BY 1, 2";
        // SQLite puts names in quotes where a table is renamed.
        const INDICES: &str = "SELECT name, tbl_name, replace(coalesce(sql, ''), '\"', '') FROM sqlite_schema \
            WHERE type = 'index'";
        let mut tables = BTreeMap::<_, Vec<_>>::new();
        for (table, column) in database.all(COLUMNS, &[], |row| Ok((row.get::<String>(0)?, row.get(1)?)))? {
            tables.entry(table).or_default().push(column);
        }
        let indices =
            database.all(INDICES, &[], |row| Ok((row.get(0)?, (row.get(1)?, row.get(2)?))))?.into_iter();
        Ok(Self { tables, indices: indices.collect() })
    }

    /// What `here` lacks of this, in words. What it has beyond this is in nobody's way.
    pub(super) fn lost_in(&self, here: &Self) -> Vec<String> {
        let mut lost = Vec::new();
        for table in self.tables.keys() {
            match self.columns_lost_in(here, table) {
                None => lost.push(lacks(table)),
                Some(columns) => {
                    lost.extend(columns.iter().map(|column| lacks(&format!("{table}.{column}"))));
                }
            }
        }
        for (name, index) in &self.indices {
            // The indices of a table that is not whole went with what it lost.
            if self.columns_lost_in(here, &index.0).is_some_and(|columns| columns.is_empty()) {
                match here.indices.get(name) {
                    None => lost.push(lacks(&format!("index {name}"))),
                    Some(other) if other != index => lost.push(format!("the index {name} is another one")),
                    Some(_) => {}
                }
            }
        }
        lost
    }

    /// The columns of this `table` that it lacks in `here`; none if all of it is lost.
    fn columns_lost_in(&self, here: &Self, table: &str) -> Option<Vec<&str>> {
        let has = here.tables.get(table)?;
        let columns = self.tables.get(table).into_iter().flatten();
        Some(columns.filter(|column| !has.contains(column)).map(String::as_str).collect())
    }
}
