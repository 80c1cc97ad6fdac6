//! The plans that settings name.

use std::fs;

use halfrow_station::settings::Settings;

use super::REST;
use crate::common::PLAN;

/// `plan fetch` fetches the plans by which lanes and jobs are judged, each once.
#[test]
fn a_plan_of_the_plant_is_fetched_for_lanes_and_for_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let text = REST.replace("[\"b.toml\"]", "[\"plant:CAM-T/final\", \"b.toml\"]");
    let text = text.replace("[\"a.toml\"]", "[\"plant:CAM-T/jobs\", \"plant:CAM-T/final\"]");
    fs::write(&path, text).unwrap();
    let published = Settings::plans_of_plant(&path).unwrap();
    let names: Vec<_> = published.plans.iter().map(|plan| (&plan.product[..], &plan.plan[..])).collect();
    assert_eq!(names, [("CAM-T", "final"), ("CAM-T", "jobs")]);
    assert_eq!(published.data, folder.path().join("data"));
}

/// Every label would be one of two plans.
#[test]
fn a_plan_is_one_plan_whatever_its_file_is_called() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().file_name().unwrap().to_str().unwrap().to_owned();
    fs::write(folder.path().join("a.toml"), PLAN).unwrap();
    fs::write(folder.path().join("copy.toml"), PLAN).unwrap();
    for other in [&format!("../{own}/a.toml"), "copy.toml"] {
        let text = REST.replace("[\"b.toml\"]", &format!("[\"a.toml\", \"{other}\"]"));
        fs::write(folder.path().join("station.toml"), text).unwrap();
        let error = Settings::load(&folder.path().join("station.toml")).unwrap_err().to_string();
        let said = format!("station.toml:23: lane 1 has the plan {other} twice, first as a.toml; leave one");
        assert!(error.contains(&said), "{error}");
    }
}
