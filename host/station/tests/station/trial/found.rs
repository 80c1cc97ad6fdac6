//! The result of a trial, taken from the databases alone.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use tempfile::TempDir;

use super::{Trial, lock};

/// What was found; all of it should be zero.
#[derive(Debug)]
pub(super) struct Found {
    /// Jobs without a run that counts as a judgement.
    pub(super) undone: usize,
    /// Jobs with more than one such run.
    pub(super) doubles: usize,
    /// Runs that were judged on a board on which another one had begun meanwhile.
    pub(super) at_once: usize,
    /// Runs that a station and the plant do not both have with the same hash.
    pub(super) unlike: usize,
    /// By how many the judgements that the plant has counted exceed its runs that count.
    pub(super) miscounted: i64,
}

impl Found {
    /// What is found after a trial is over, with the folders of its stations.
    pub(super) fn of(trial: &Trial, folders: &[TempDir]) -> Self {
        let server = lock(&trial.server);
        let judged = judged(trial, &server.rows(JUDGED));
        let jobs = server.rows("SELECT id, run_id FROM job");
        let is_undone = |job: &&Vec<String>| judged.get(&job[0]).is_none_or(|runs| !runs.contains(&job[1]));
        let stations: BTreeSet<_> = folders.iter().flat_map(kept).collect();
        let plant: BTreeSet<_> =
            server.rows("SELECT id || ' ' || record_sha256 FROM run").concat().into_iter().collect();
        let miscounted = server.rows(MISCOUNTED)[0][0].parse().unwrap();
        Self {
            undone: jobs.iter().filter(is_undone).count(),
            doubles: judged.values().filter(|runs| runs.len() > 1).count(),
            at_once: trial.shelf.at_once(),
            unlike: stations.symmetric_difference(&plant).count(),
            miscounted,
        }
    }

    /// What is not zero, in words.
    pub(super) fn wrong(&self) -> Vec<String> {
        let Self { undone, doubles, at_once, unlike, miscounted } = self;
        let all = [
            (*undone, "jobs without a run that counts"),
            (*doubles, "jobs with two"),
            (*at_once, "runs on a board that another one had"),
            (*unlike, "runs that station and plant do not both have"),
            (usize::try_from(miscounted.unsigned_abs()).unwrap(), "runs that are counted wrongly"),
        ];
        all.into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, what)| format!("{count} {what}"))
            .collect()
    }
}

/// Runs that count and were judged, with their records.
const JUDGED: &str = "SELECT run.id, record.text FROM run JOIN record ON record.sha256 = run.record_sha256
    WHERE nth > 0 AND verdict IN ('PASS', 'FAIL')";

const MISCOUNTED: &str = "SELECT (SELECT coalesce(sum(runs - errors), 0) FROM day_count)
    - (SELECT count(*) FROM run WHERE nth > 0 AND verdict IN ('PASS', 'FAIL'))";

/// The runs of each job that count.
fn judged(trial: &Trial, rows: &[Vec<String>]) -> BTreeMap<String, Vec<String>> {
    let believed = lock(&trial.believed);
    let job_of = |run: &String, text: &String| {
        let record: Value = serde_json::from_str(text).unwrap();
        let claimed = record["run"]["job"]["id"].as_str().map(str::to_owned);
        claimed.or_else(|| believed.iter().find(|of| of[1] == *run).map(|of| of[0].clone())).unwrap()
    };
    let mut judged = BTreeMap::<String, Vec<String>>::new();
    for row in rows {
        judged.entry(job_of(&row[0], &row[1])).or_default().push(row[0].clone());
    }
    judged
}

/// The runs of a station that ended, each with its hash.
fn kept(folder: &TempDir) -> Vec<String> {
    let text = "SELECT id || ' ' || record_sha256 FROM run WHERE state = 'final'";
    crate::common::query(&super::process::data(folder), text)
}
