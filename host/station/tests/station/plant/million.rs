//! A plant with a million runs: how long each query through its pages takes.

use std::io::Write as _;
use std::time::Instant;

use super::pages::served as pages;
use super::server::Server;
use super::tables::{TABLES, columns};
use crate::history::generated::{Draw, generate};
use crate::history::in_time::{served, wanted_runs};
use crate::history::made::Made;

/// Copies the tables of a station to the plant directly, without its outbox.
fn copied(made: &Made, server: &Server) {
    let station = rusqlite::Connection::open(made.folder().database()).unwrap();
    let mut client = server.client("plant");
    for (table, _) in TABLES.iter().chain(&[("retest", "")]) {
        let columns: Vec<_> = columns(made.as_ref(), table).into_iter().map(|(column, _)| column).collect();
        let columns = columns.join(", ");
        let mut rows = station.prepare(&format!("SELECT {columns} FROM {table}")).unwrap();
        let width = rows.column_count();
        let mut rows = rows.query([]).unwrap();
        let mut to = client.copy_in(&format!("COPY {table} ({columns}) FROM STDIN")).unwrap();
        while let Some(row) = rows.next().unwrap() {
            let values: Vec<_> = (0..width).map(|at| text(row.get_ref(at).unwrap())).collect();
            writeln!(to, "{}", values.join("\t")).unwrap();
        }
        to.finish().unwrap();
    }
    client.batch_execute("VACUUM ANALYZE").unwrap();
}

/// A value in the format of COPY.
fn text(value: rusqlite::types::ValueRef<'_>) -> String {
    match value {
        rusqlite::types::ValueRef::Null => "\\N".to_owned(),
        rusqlite::types::ValueRef::Integer(whole) => whole.to_string(),
        rusqlite::types::ValueRef::Real(real) => real.to_string(),
        other => {
            let text = other.as_str().unwrap();
            text.replace('\\', "\\\\").replace('\t', "\\t").replace('\n', "\\n")
        }
    }
}

#[test]
#[ignore = "for scripts/soak: a figure of a machine that does nothing else"]
fn a_million_runs_of_a_plant_are_looked_at_in_time() {
    let (server, all) = (Server::prepared(), generate(wanted_runs()));
    all.compare();
    let begun = Instant::now();
    copied(&all.made, &server);
    let size = server.rows("SELECT pg_size_pretty(pg_database_size('plant'))");
    println!(
        "{} runs, {} in PostgreSQL, copied in {:.0} s",
        all.runs,
        size[0][0],
        begun.elapsed().as_secs_f64()
    );
    let (_folder, serving) = pages(&server);
    let browser = serving.here();
    let get = |path: &str| browser.get(path).with("accept", "text/html").send();
    served(&get, all.runs, &mut Draw(2));
}
