//! Stations that take jobs while a file of a plan becomes another one.

use std::fs::{self, File};
use std::path::Path;
use std::process::Stdio;

use halfrow_station::settings::Settings;
use halfrow_station::store::Plant;

use super::{any, job, settings, shared};
use crate::common::{Killed, PLAN, command, folder, instead, until};
use crate::plant::server::Server;

/// Settings of a worker with a plan that names a picture, and one that names none.
fn with_two_plans(server: &Server, folder: &Path) -> Settings {
    let path = settings(server, folder, "12");
    picture(folder, 7);
    fs::write(folder.join("plan.toml"), PLAN.replace("builtin:noise", "a.pgm")).unwrap();
    fs::write(folder.join("other.toml"), PLAN.replace("name = \"quick\"", "name = \"other\"")).unwrap();
    instead(&path, "\"plan.toml\"", "\"plan.toml\", \"other.toml\"");
    Settings::load_without_lanes(&path).unwrap()
}

fn picture(folder: &Path, level: u8) {
    fs::write(folder.join("a.pgm"), [b"P5\n64 8\n255\n".as_slice(), &[level; 512]].concat()).unwrap();
}

/// A worker in `folder`, whose complaints are in its file `said`.
fn work(folder: &Path) -> Killed {
    let said = File::create(folder.join("said")).unwrap();
    Killed(command(folder, &["work"]).stdout(Stdio::null()).stderr(said).spawn().unwrap())
}

/// Waits until the job with this id is like this.
fn until_job(server: &Server, id: &str, is_so: &str) {
    let text = format!("SELECT 1 FROM job WHERE id = '{id}' AND {is_so}");
    until(is_so, || !server.rows(&text).is_empty());
}

/// Adds a job by the first or second plan, and returns its id.
fn add(plant: &mut Plant, settings: &Settings, plan: usize) -> String {
    plant.add_jobs(&job(&settings.plans[plan].plan, &any()), 1).unwrap().remove(0)
}

#[test]
fn a_job_whose_plan_s_file_was_changed_costs_no_attempt_and_holds_up_no_other_plan() {
    let (server, mut plant) = shared(1);
    let folder = folder();
    let settings = with_two_plans(&server, folder.path());
    let worker = work(folder.path());
    // A worker that judged by the plan has read it.
    until_job(&server, &add(&mut plant, &settings, 0), "state = 'done'");
    picture(folder.path(), 9);
    let first = add(&mut plant, &settings, 0);
    until_job(&server, &first, "fence >= 1");
    until_job(&server, &add(&mut plant, &settings, 1), "state = 'done' AND attempts = 1");
    until_job(&server, &first, "fence >= 3 AND state = 'waiting' AND attempts = 0");
    picture(folder.path(), 7);
    until_job(&server, &first, "state = 'done' AND attempts = 1");
    worker.end();
    let said = fs::read_to_string(folder.path().join("said")).unwrap();
    let times = |what: &str| said.matches(what).count();
    let changed = "no job of the plan CAM-T/quick 1 is taken for now: the file a.pgm, which the plan names, has changed";
    assert_eq!((times("file a.pgm"), times(changed)), (1, 1), "{said}");
    assert_eq!(times("jobs of the plan CAM-T/quick 1 are taken again"), 1, "{said}");
    assert_eq!(server.rows("SELECT DISTINCT verdict FROM run"), [["PASS"]]);
}
