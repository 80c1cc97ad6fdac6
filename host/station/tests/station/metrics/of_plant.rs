//! A plant's figures, over all its stations.

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::Command;

use super::figures::once;
use super::text::{Figures, assert_sound, told};
use crate::common::{self, Did, HANG, engel, folder, program, reason};
use crate::history::released::history;
use crate::jobs::{add, run_out, shared, worker};
use crate::pages::http::Request;
use crate::pages::station::{PUBLIC, Serving};
use crate::plant::pages::{command, served, settings};
use crate::plant::sent::send;
use crate::plant::server::Server;

#[test]
fn a_plant_tells_of_all_stations_and_says_when_it_is_away() {
    let mut server = Server::prepared();
    let (_made, _) = send(history(), server.address());
    let (_folder, serving) = served(&server);
    let figures = Figures::of(&serving);
    assert_sound(&figures);
    assert_eq!(figures.shapes(), told("A plant"), "docs/metrics.md lists what is served");
    let labels =
        |row: &[String]| format!("station=\"{}\",product=\"{}\",plan=\"{}\"", row[0], row[1], row[2]);
    let runs =
        "SELECT station, product, name, verdict, count(*) FROM run JOIN plan ON plan.sha256 = plan_sha256
        GROUP BY station, product, name, verdict";
    let rows = server.rows(runs);
    assert_eq!(rows.len(), 3, "{rows:?}");
    for row in rows {
        let counted =
            figures.at(&format!("halfrow_plant_runs_total{{{},verdict=\"{}\"}}", labels(&row), row[3]));
        assert_eq!(counted.to_string(), row[4], "{row:?}");
    }
    let units = "SELECT station, product, name, count(*), sum(CASE WHEN verdict = 'PASS' THEN 1 ELSE 0 END) FROM run
        JOIN plan ON plan.sha256 = plan_sha256 WHERE nth = 1 AND verdict <> 'ERROR' GROUP BY station, product, name";
    for row in server.rows(units) {
        let counted = ["judged", "first_passed"]
            .map(|what| figures.at(&format!("halfrow_plant_units_{what}{{{}}}", labels(&row))).to_string());
        assert_eq!(counted, row[3..], "{row:?}");
    }
    let seen = server.rows("SELECT seen_ms FROM station").remove(0).remove(0);
    let told = figures.at("halfrow_plant_station_seen_timestamp_seconds{station=\"station 7\"}");
    assert_eq!(told * 1000.0, seen.parse::<f64>().unwrap());
    let version = server.rows("SELECT max(n) FROM schema_version").remove(0).remove(0);
    assert_eq!(figures.at("halfrow_plant_schema_version").to_string(), version);
    assert_eq!(figures.at("halfrow_plant_up"), 1.0);
    server.kill();
    let away = Figures::of(&serving);
    assert_eq!(away.at("halfrow_plant_up"), 0.0);
    assert!(!away.text.contains("halfrow_plant_runs_total{"), "{}", away.text);
    assert_sound(&away);
    server.again();
    assert_eq!(Figures::of(&serving).samples, figures.samples);
}

/// The value of every figure of jobs and boards, but the age: waiting, claimed, dead; free, held, out.
fn of_jobs(figures: &Figures) -> [f64; 6] {
    let jobs = ["waiting", "claimed", "dead"].map(|state| format!("halfrow_plant_jobs{{state=\"{state}\"}}"));
    let boards = ["free", "held", "out"].map(|state| format!("halfrow_plant_boards{{state=\"{state}\"}}"));
    [&jobs[0], &jobs[1], &jobs[2], &boards[0], &boards[1], &boards[2]].map(|name| figures.at(name))
}

const DEAD_JOBS: &str = "halfrow_plant_jobs{state=\"dead\"}";

#[test]
fn a_plant_tells_which_jobs_wait_for_a_station_or_a_person_and_which_boards_are_there() {
    let (server, mut plant) = shared(3);
    let (_folder, serving) = served(&server);
    let oldest = "halfrow_plant_jobs_oldest_waiting_seconds";
    let none = Figures::of(&serving);
    assert_eq!((of_jobs(&none), none.at(oldest)), ([0.0, 0.0, 0.0, 3.0, 0.0, 0.0], 0.0));
    let jobs = add(&mut plant, 4);
    let claim = plant.claim(&worker("7")).unwrap().unwrap();
    assert_eq!(claim.job, jobs[0]);
    server.change(&format!(
        "UPDATE job SET state = 'dead', said = 'no', attempts = 5 WHERE id = '{}';
         UPDATE job SET state = 'done' WHERE id = '{}';
         UPDATE job SET created_ms = created_ms - 7200000 WHERE id <> '{}';
         UPDATE board SET out = 'burnt' WHERE name = (SELECT max(name) FROM board WHERE holder IS NULL)",
        jobs[1], jobs[2], jobs[0]
    ));
    let figures = once(&serving, DEAD_JOBS, 1.0);
    assert_sound(&figures);
    assert_eq!(of_jobs(&figures), [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
    assert!(
        figures.at(oldest) >= 7200.0 && figures.at(oldest) < 7200.0 + HANG.as_secs_f64(),
        "{}",
        figures.text
    );
    // Whoever had the job and the board is gone.
    run_out(&server);
    assert_eq!(of_jobs(&Figures::of(&serving)), [2.0, 0.0, 1.0, 2.0, 0.0, 1.0]);
}

/// Whoever cancels a job knows of it, and nobody else has to look at it; so a person can say of a dead job that it is settled.
#[test]
fn a_job_that_a_person_cancelled_waits_for_no_person() {
    let (server, mut plant) = shared(1);
    let (_folder, serving) = served(&server);
    let jobs = add(&mut plant, 4);
    let reason = reason("a mistake");
    for _ in 0..2 {
        let claim = plant.claim(&worker("7")).unwrap().unwrap();
        plant.refuse(&claim, "its unit passed").unwrap();
        plant.give_back(&claim.lease).unwrap();
    }
    let claim = plant.claim(&worker("7")).unwrap().unwrap();
    assert_eq!(claim.job, jobs[2]);
    assert_eq!(of_jobs(&once(&serving, DEAD_JOBS, 2.0))[..3], [1.0, 1.0, 2.0]);
    // One that is dead, one that is claimed, and one that waits.
    for (job, left) in [(&jobs[0], 1.0), (&jobs[2], 1.0), (&jobs[3], 1.0), (&jobs[1], 0.0)] {
        assert!(plant.cancel_job(job, engel(&reason)).unwrap(), "{job}");
        assert!(!plant.cancel_job(job, engel(&reason)).unwrap(), "{job} is cancelled already");
        once(&serving, DEAD_JOBS, left);
    }
    assert_eq!(of_jobs(&Figures::of(&serving))[..3], [0.0; 3]);
    assert!(plant.retry_job(&jobs[0], engel(&reason)).unwrap());
    assert_eq!(of_jobs(&Figures::of(&serving))[..3], [1.0, 0.0, 0.0]);
    plant.give_back(&claim.lease).unwrap();
    let claim = plant.claim(&worker("7")).unwrap().unwrap();
    plant.refuse(&claim, "its unit passed").unwrap();
    once(&serving, DEAD_JOBS, 1.0);
}

/// No job is ever removed. The statement's words stand here as what they begin with; the plan does not depend on the rest.
#[test]
fn jobs_that_are_done_are_not_read_for_those_that_wait() {
    let (server, mut plant) = shared(0);
    add(&mut plant, 1);
    server.change(
        "INSERT INTO job SELECT gen_random_uuid()::text, plan_sha256, product, serial, kind, needs, priority, 'done', NULL, 1, NULL,
           1, NULL, created_ms, operator_id, NULL FROM job, generate_series(1, 20000);
         ANALYZE job",
    );
    let text = include_str!("../../../sql/plant/open-jobs.sql")
        .replace("{job_state}", "job.state")
        .replace("{is_exhausted}", "(job.attempts >= 5)")
        .replace("{now_ms}", "0");
    let plan = server.rows(&format!("EXPLAIN {text}")).concat().join("\n");
    assert!(plan.contains("job_open") && !plan.contains("Seq Scan"), "{plan}");
}

/// The page's connection, which is kept, is older than the tables.
#[test]
fn a_plant_whose_tables_a_newer_program_has_changed_meanwhile_is_not_read() {
    let server = Server::prepared();
    let (_folder, serving) = served(&server);
    let is_up = || Figures::of(&serving).at("halfrow_plant_up");
    assert_eq!(is_up(), 1.0);
    server.change("INSERT INTO schema_version VALUES (99, 'x', 1)");
    assert_eq!(is_up(), 0.0);
    let page = serving.here().get("/").send();
    assert!(page.status == 503 && page.text().contains("has version 99"), "{}", page.text());
    server.change("DELETE FROM schema_version WHERE n = 99");
    assert_eq!(is_up(), 1.0);
}

/// What the program did with these settings and this on stdin.
fn did(arguments: &[&str], settings: &Path, said: &str) -> Did {
    common::told(Command::new(program()).args(arguments).arg("--settings").arg(settings), said).into()
}

/// A plant that others can reach has its own people and machines, and no lanes in its settings.
#[test]
fn people_and_machines_look_at_a_plant_that_others_can_reach() {
    let server = Server::prepared();
    let folder = folder();
    let public =
        "public = \"https://station12.example\"\n[access]\nusers = \"users.toml\"\ntokens = \"tokens.toml\"";
    let settings = settings(&server, folder.path(), public);
    let did = |arguments: &[&str], said: &str| {
        let did = did(arguments, &settings, said);
        assert_eq!(did.code, Some(0), "{did:?}");
        did.said
    };
    did(&["user", "add", "Braun", "--role", "engineer"], "B-0022\ncorrect horse\n");
    let token = did(&["token", "add", "prometheus", "--scope", "read"], "");
    let serving = Serving::of(&mut command(&settings));
    let stranger = Request::bare(serving.port, "GET", "/metrics").with("host", PUBLIC);
    assert_eq!(stranger.send().status, 401);
    let known = stranger.with("authorization", &format!("Bearer {}", token.trim())).send();
    assert_eq!(known.status, 200, "{}", known.text());
    assert!(known.text().contains("halfrow_plant_up 1\n"), "{}", known.text());
    assert_eq!(serving.engineer().get("/").send().status, 200);
    let noted = server.rows("SELECT operator_id, act FROM audit ORDER BY id");
    assert_eq!(noted, [["prometheus", "token"], ["Braun", "login"]]);
}

/// The block of docs/plant.md in this language that has `what` in it.
pub(crate) fn block(language: &str, what: &str) -> &'static str {
    let blocks = include_str!("../../../../../docs/plant.md").split("```");
    let mut of_language = blocks.filter_map(|block| block.strip_prefix(language));
    of_language.find(|block| block.contains(what)).unwrap()
}

/// Has `settings` name the plant as the page does, and its server ask the page's role for a password, which is in the file that the
/// page names.
fn as_on_the_page(settings: &Path, server: &Server) {
    let (_, plant) = block("toml", "postgres://reader@").split_once("[plant]\n").unwrap();
    let (plant, _) = plant.split_once("[web]").unwrap();
    let url = server.url().replace("postgres://postgres@", "postgres://reader@");
    let plant = plant.replace("postgres://reader@db.example/plant", &url);
    let text = fs::read_to_string(settings).unwrap();
    let (before, _) = text.split_once("[plant]\n").unwrap();
    fs::write(settings, format!("{before}[plant]\n{plant}")).unwrap();
    let file = settings.with_file_name("reader.password");
    fs::write(&file, "open sesame\n").unwrap();
    fs::set_permissions(&file, Permissions::from_mode(0o600)).unwrap();
    server.asks_for_a_password("reader");
}

/// The role and how the settings name it are those of the plant's page.
#[test]
fn the_pages_work_with_a_role_that_only_looks_and_no_machine_is_let_in_without_the_audit() {
    let server = Server::prepared();
    let (_made, _) = send(history(), server.address());
    // What psql sends for it.
    let grants = block("sql", "GRANT INSERT ON audit")
        .replace("\\password reader", "ALTER ROLE reader PASSWORD 'open sesame';");
    let of_audit = "GRANT INSERT ON audit TO reader;\n";
    assert!(grants.contains(of_audit), "{grants}");
    server.change(&grants.replace(of_audit, ""));
    let folder = folder();
    let public =
        "public = \"https://station12.example\"\n[access]\nusers = \"users.toml\"\ntokens = \"tokens.toml\"";
    let settings = settings(&server, folder.path(), public);
    as_on_the_page(&settings, &server);
    did(&["user", "add", "Braun", "--role", "engineer"], &settings, "B-0022\ncorrect horse\n");
    let token = did(&["token", "add", "mes", "--scope", "read"], &settings, "").said;
    let serving = Serving::of(&mut command(&settings));
    let ask = |path: &str| {
        let request = Request::bare(serving.port, "GET", path).with("host", PUBLIC);
        request.with("authorization", &format!("Bearer {}", token.trim())).send().status
    };
    assert_eq!([ask("/history"), ask("/history")], [503, 503]);
    server.change(of_audit);
    for path in ["/", "/history", "/unit?serial=S1", "/yield", "/pareto", "/jobs", "/metrics"] {
        assert_eq!(ask(path), 200, "{path}");
    }
    assert_eq!(serving.engineer().get("/").send().status, 200);
    let noted = "SELECT operator_id, act FROM audit WHERE operator_id IN ('mes', 'Braun') ORDER BY id";
    assert_eq!(server.rows(noted), [["mes", "token"], ["Braun", "login"]]);
}

/// A client locks a table of the plant: whoever asks for figures, however often, learns of it soon, and pages that do not need
/// the plant go on.
#[test]
fn a_plant_that_hangs_is_away_and_holds_up_nothing_else() {
    let server = Server::prepared();
    let (_made, _) = send(history(), server.address());
    let (_folder, serving) = served(&server);
    let mut holder = server.client("plant");
    holder.batch_execute("BEGIN; LOCK TABLE day_count IN ACCESS EXCLUSIVE MODE").unwrap();
    // More requests than the pages have threads for those that wait.
    std::thread::scope(|scope| {
        let asked: Vec<_> =
            (0..12).map(|_| scope.spawn(|| Figures::of(&serving).at("halfrow_plant_up"))).collect();
        assert!(asked.into_iter().all(|up| up.join().unwrap() == 0.0));
    });
    assert_eq!(serving.here().get("/").send().status, 200);
    holder.batch_execute("ROLLBACK").unwrap();
    once(&serving, "halfrow_plant_up", 1.0);
}
