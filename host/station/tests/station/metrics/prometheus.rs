//! The examples in `monitoring`, on a real Prometheus server that scrapes a station and its plant.

use std::collections::BTreeSet;
use std::fs;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use super::figures::{in_state, once, scan};
use super::rules::example;
use crate::common::{HANG, Killed, listening, plant_settings, until};
use crate::pages::http::{Request, escaped};
use crate::pages::station::{SERIALS, Serving, Station};
use crate::plant::pages::served;
use crate::plant::server::Server;

/// Prometheus with the example's configuration. It ends with its test.
struct Prometheus {
    _process: Killed,
    port: u16,
    _folder: TempDir,
}

impl Prometheus {
    /// A server that scrapes these ports twice a second.
    fn of(station: u16, plant: u16) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut text = fs::read_to_string(example("prometheus.yml")).unwrap();
        for (was, is) in [
            ("scrape_interval: 15s", "scrape_interval: 500ms"),
            ("station12.example:8612", &format!("127.0.0.1:{station}")),
            ("plant.example:8613", &format!("127.0.0.1:{plant}")),
            // Both need no token on their own computer.
            ("    authorization: {credentials_file: station.token}\n", ""),
            ("    authorization: {credentials_file: plant.token}\n", ""),
        ] {
            assert!(text.contains(was), "{was} of\n{text}");
            text = text.replace(was, is);
        }
        fs::write(folder.path().join("prometheus.yml"), text).unwrap();
        fs::copy(example("alerts.yml"), folder.path().join("alerts.yml")).unwrap();
        let begin = |port| {
            Command::new("setpriv")
                .args(["--pdeathsig", "KILL", "prometheus"])
                .args(["--config.file=prometheus.yml", "--storage.tsdb.path=data"])
                .args([format!("--web.listen-address=127.0.0.1:{port}"), "--log.level=error".to_owned()])
                .current_dir(folder.path())
                .stdout(Stdio::null())
                .spawn()
                .unwrap_or_else(|error| panic!("prometheus: {error}; apt-get install prometheus"))
        };
        let (process, port) = listening("prometheus", begin);
        let prometheus = Self { _process: process, port, _folder: folder };
        until("Prometheus to be ready", || prometheus.get("/-/ready").0 == 200);
        prometheus
    }

    fn get(&self, path: &str) -> (u16, String) {
        let answer = Request::bare(self.port, "GET", path).with("host", "127.0.0.1").send();
        (answer.status, answer.text())
    }

    /// How many series a query returns.
    fn series(&self, query: &str) -> usize {
        let (status, text) = self.get(&format!("/api/v1/query?query={}", escaped(query)));
        let answer: Value = serde_json::from_str(&text).unwrap();
        assert_eq!((status, &answer["status"]), (200, &"success".into()), "{query}: {text}");
        answer["data"]["result"].as_array().unwrap().len()
    }

    /// The queries that still return nothing after a long wait: a change over time needs two samples.
    fn unanswered_in_the_end<'a>(&self, queries: &'a BTreeSet<String>) -> Vec<&'a str> {
        let begun = Instant::now();
        loop {
            let unanswered = self.unanswered(queries);
            if unanswered.is_empty() || begun.elapsed() > HANG {
                return unanswered;
            }
            thread::sleep(Duration::from_millis(100));
        }
    }

    /// The queries that return nothing.
    fn unanswered<'a>(&self, queries: &'a BTreeSet<String>) -> Vec<&'a str> {
        queries.iter().filter(|query| self.series(query) == 0).map(String::as_str).collect()
    }
}

/// Every query of a dashboard, for all values of its variables.
fn queries(name: &str) -> BTreeSet<String> {
    let text = fs::read_to_string(example(name)).unwrap();
    let board: Value = serde_json::from_str(&text).unwrap();
    let panels = board["panels"].as_array().unwrap();
    let places: BTreeSet<_> = panels.iter().map(|panel| panel["id"].as_u64().unwrap()).collect();
    assert_eq!(places.len(), panels.len(), "two panels have one id");
    let targets = panels.iter().flat_map(|panel| panel["targets"].as_array().unwrap());
    let exprs: Vec<_> = targets.map(|target| target["expr"].as_str().unwrap().to_owned()).collect();
    assert!(exprs.len() > panels.len(), "{exprs:?}");
    let variables = board["templating"]["list"].as_array().unwrap();
    let queried: Vec<_> = variables.iter().filter(|variable| variable["type"] == "query").collect();
    let values = queried.iter().map(|variable| {
        let of = variable["query"].as_str().unwrap().strip_prefix("label_values(").unwrap();
        let (metric, label) = of.trim_end_matches(')').split_once(", ").unwrap();
        format!("{metric}{{{label}!=\"\"}}")
    });
    let filled = exprs.into_iter().map(|expr| {
        queried.iter().fold(expr, |expr, variable| {
            expr.replace(&format!("${}", variable["name"].as_str().unwrap()), ".*")
        })
    });
    let all: BTreeSet<_> = filled.chain(values).collect();
    assert!(all.iter().all(|query| !query.contains('$')), "{all:?}");
    all
}

/// Every metric in the alert rules.
fn named_by_alerts() -> BTreeSet<String> {
    let text = fs::read_to_string(example("alerts.yml")).unwrap();
    let words = text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    words.filter(|word| word.starts_with("halfrow_")).map(str::to_owned).collect()
}

/// Whoever is alerted looks at a dashboard.
#[test]
fn what_an_alert_watches_is_on_a_dashboard() {
    let shown: String =
        ["grafana-station.json", "grafana-plant.json"].into_iter().flat_map(queries).collect();
    let named = named_by_alerts();
    let unseen: Vec<_> = named.iter().filter(|name| !shown.contains(*name)).collect();
    assert!(named.len() >= 8 && unseen.is_empty(), "{unseen:?}");
}

/// Judges boards, and waits until the plant has all runs.
fn judged(serving: &Serving) {
    for ((lane, state), serial) in [("1", "pass"), ("2", "fail")].into_iter().zip(SERIALS) {
        scan(serving, lane, serial);
        in_state(serving, lane, state);
    }
    once(serving, "halfrow_outbox_entries{sink=\"plant\"}", 0.0);
}

#[test]
fn every_query_of_the_dashboards_and_of_the_alerts_is_answered() {
    let server = Server::prepared();
    let (_folder, plant) = served(&server);
    let web = format!("[web]\nlisten = \"127.0.0.1:0\"\n{}", plant_settings(&server.url()));
    let station = Station::with(2, &web).where_instead(
        "station.toml",
        "mock,serial=2",
        "mock,serial=2,fault=stuck-data",
    );
    let station_pages = station.serve();
    // It looks for its targets five seconds after its start.
    let prometheus = Prometheus::of(station_pages.port, plant.port);
    judged(&station_pages);
    for name in ["grafana-station.json", "grafana-plant.json"] {
        assert_eq!(prometheus.unanswered_in_the_end(&queries(name)), Vec::<&str>::new(), "{name}");
    }
    let named = named_by_alerts();
    assert!(named.len() >= 8, "{named:?}");
    assert_eq!(prometheus.unanswered_in_the_end(&named), Vec::<&str>::new());
    // The control: a name that no metric has.
    let wrong: BTreeSet<_> = queries("grafana-station.json")
        .iter()
        .map(|query| query.replace("commit_seconds", "comit_seconds"))
        .collect();
    until("only the wrong names to be unanswered", || {
        let unanswered = prometheus.unanswered(&wrong);
        !unanswered.is_empty() && unanswered.iter().all(|query| query.contains("comit"))
    });
    let (_, rules) = prometheus.get("/api/v1/rules");
    let rules: Value = serde_json::from_str(&rules).unwrap();
    let groups = rules["data"]["groups"].as_array().unwrap();
    assert_eq!(groups.iter().flat_map(|group| group["rules"].as_array().unwrap()).count(), 19);
}
