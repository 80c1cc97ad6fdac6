//! What the role of a station may do at the plant, and what it may not.

use std::path::PathBuf;
use std::process::Command;

use halfrow_station::store::PlantAddress;
use postgres::{Client, NoTls};
use tempfile::TempDir;

use super::sent::send;
use super::server::Server;
use crate::common::{Did, folder, program};
use crate::history::made::{End, Made, Run};
use crate::history::released::history;
use crate::jobs::settings_of;
use crate::metrics::of_plant::block;

/// The address of the plant for stations, with a role that is made as docs/plant.md says.
pub(super) fn as_station(server: &Server) -> String {
    let grants = block("sql", "CREATE ROLE station").replace("\\password station\n", "");
    server.change(&grants);
    server.url().replace("postgres@", "station@")
}

/// Its password is at every line's computer.
#[test]
fn no_station_changes_or_removes_what_was_said_and_done() {
    let server = Server::prepared();
    let url = as_station(&server);
    let (_made, all) = send(history(), PlantAddress::new(&url, None, None).unwrap());
    assert!(all.sent > 0 && all.failed == 0, "{all:?}");
    let mut station = Client::connect(&url, NoTls).unwrap();
    for table in
        ["audit", "waiver", "record", "attachment", "failure", "suspect", "publication", "schema_version"]
    {
        station.batch_execute(&format!("SELECT * FROM {table}")).unwrap();
        let column = &server.rows(&format!(
            "SELECT column_name FROM information_schema.columns WHERE table_name = '{table}' AND table_schema = 'public'"
        ))[0][0];
        let change = format!("UPDATE {table} SET {column} = {column}");
        for text in [change, format!("DELETE FROM {table}"), format!("TRUNCATE {table}")] {
            // The control: its owner may.
            if !text.starts_with("TRUNCATE") {
                server.change(&format!("BEGIN; {text}; ROLLBACK"));
            }
            let refused = station.batch_execute(&text).unwrap_err();
            let code = refused.code().map(|code| code.code().to_owned());
            assert_eq!(code.as_deref(), Some("42501"), "{text}: {refused}");
        }
    }
}

/// Settings in a folder, with the role of stations.
struct Office {
    server: Server,
    folder: TempDir,
    settings: PathBuf,
}

impl Office {
    fn new() -> Self {
        let (server, folder) = (Server::prepared(), folder());
        let url = as_station(&server);
        let mut made = Made::new();
        // In 2001, so that it can be pruned.
        made.run(&Run { started_ms: 1_000_000_000_000, ..Run::of("S1", End::Pass) });
        let _made = send(made, PlantAddress::new(&url, None, None).unwrap());
        let settings = settings_of(&url, folder.path(), "12");
        Self { server, folder, settings }
    }

    /// What this command says, which must succeed.
    fn did(&self, line: &str) -> String {
        let mut command = Command::new(program());
        command.args(line.split(' ')).env("HALFROW_STATION_SETTINGS", &self.settings);
        let did = Did::from(command.current_dir(self.folder.path()).output().unwrap());
        assert_eq!(did.code, Some(0), "{line}: {did:?}");
        did.said
    }

    /// Like [`Self::did`], of a command that needs a reason.
    fn did_because(&self, line: &str) {
        self.did(&format!("{line} --reason moved --operator engel"));
    }
}

/// docs/plant.md: offices have a station's rights, too.
#[test]
fn stations_and_offices_may_share_boards_and_have_jobs_done() {
    let office = Office::new();
    for number in 1..=3 {
        let unit = format!("--product CAM-T --serial CAT0000{number}");
        office.did(&format!("board share shelf-{number} --operator engel --kind mock --board mock {unit}"));
    }
    ["out", "in", "unshare"].iter().for_each(|act| office.did_because(&format!("board {act} shelf-3")));
    let ids = office.did("job add --operator engel --plan plan.toml --kind mock --count 3");
    let cancelled = ids.lines().next().unwrap();
    ["cancel", "retry"].iter().for_each(|act| office.did_because(&format!("job {act} {cancelled}")));
    let judged = office.did("work --once --json");
    assert_eq!(judged.matches("\"verdict\":\"PASS\"").count(), 3, "{judged}");
    assert_eq!(office.server.rows("SELECT count(*) FROM job WHERE state = 'done'"), [["3"]]);
    assert!(office.did("board hold mock").contains("\"held\""));
    office.did("outbox send");
    office.did("plant check");
}

#[test]
fn offices_may_prune_a_plant_forget_stations_and_publish_plans() {
    let office = Office::new();
    let old = |table: &str| office.server.rows(&format!("SELECT 1 FROM {table}")).len();
    assert!(old("step") > 0 && old("measurement") > 0);
    office.did_because("plant prune --older-than 1");
    assert_eq!((old("step"), old("measurement")), (0, 0));
    office.did("plan key engel.key");
    office.did_because("plan publish plan.toml --key engel.key");
    // As if it had been damaged, it is published again.
    office.did_because("plan publish plan.toml --key engel.key");
    assert!(office.did("plan published").contains("CAM-T/quick"));
    assert_eq!(office.server.rows("SELECT name FROM station"), [["station 7"]]);
    let mut forget = Command::new(program());
    forget.args(["plant", "forget", "station 7", "--reason", "moved", "--operator", "engel", "--settings"]);
    assert!(forget.arg(&office.settings).output().unwrap().status.success());
    assert!(office.server.rows("SELECT name FROM station").is_empty());
    office.did("plant check");
}
