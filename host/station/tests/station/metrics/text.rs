//! Figures as they are served, parsed.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::Did;
use crate::pages::station::Serving;

/// A metric's kind, and its labels except that of a histogram's bound.
type Shape = (String, BTreeSet<String>);

/// The figures of one answer.
#[derive(Debug)]
pub(crate) struct Figures {
    pub(crate) text: String,
    /// Every sample, by its name with its labels.
    pub(crate) samples: BTreeMap<String, f64>,
    kinds: BTreeMap<String, String>,
}

impl Figures {
    /// The figures that are served now, in Prometheus' own format.
    pub(crate) fn of(serving: &Serving) -> Self {
        let answer = serving.here().get("/metrics").send();
        assert_eq!(answer.status, 200, "{}", answer.text());
        assert_eq!(answer.header("content-type"), Some("text/plain; version=0.0.4; charset=utf-8"));
        Self::read(answer.text())
    }

    fn read(text: String) -> Self {
        let (mut samples, mut kinds) = (BTreeMap::new(), BTreeMap::new());
        for line in text.lines() {
            if let Some(of) = line.strip_prefix("# TYPE ") {
                let (name, kind) = of.split_once(' ').unwrap();
                kinds.insert(name.to_owned(), kind.to_owned());
            } else if !line.starts_with('#') {
                let (name, value) = line.rsplit_once(' ').unwrap();
                let before = samples.insert(name.to_owned(), value.parse().unwrap());
                assert_eq!(before, None, "{name} stands twice");
            }
        }
        Self { text, samples, kinds }
    }

    /// The value of the sample with this name and labels.
    pub(crate) fn at(&self, name: &str) -> f64 {
        *self.samples.get(name).unwrap_or_else(|| panic!("there is no {name} in\n{}", self.text))
    }

    /// Every metric with its shape. A metric without samples has no labels here.
    pub(crate) fn shapes(&self) -> BTreeMap<String, Shape> {
        let mut shapes: BTreeMap<_, _> =
            self.kinds.iter().map(|(name, kind)| (name.clone(), (kind.clone(), BTreeSet::new()))).collect();
        for sample in self.samples.keys() {
            let (name, labels) = sample.split_once('{').unwrap_or((sample, ""));
            let of = ["_bucket", "_sum", "_count"].iter().find_map(|end| name.strip_suffix(end));
            let name = of.filter(|name| shapes.contains_key(*name)).unwrap_or(name);
            let labels =
                labels.split("\",").filter_map(|label| label.split_once("=\"")).map(|(name, _)| name);
            shapes.get_mut(name).unwrap().1.extend(labels.filter(|name| *name != "le").map(str::to_owned));
        }
        shapes
    }
}

/// The metrics that the page lists below this headline.
pub(crate) fn told(headline: &str) -> BTreeMap<String, Shape> {
    let page = include_str!("../../../../../docs/metrics.md");
    let section = page.split("\n## ").find(|section| section.starts_with(headline)).unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    let shape = |row: &str| {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        // Prometheus' own format has no kind for metrics that only have labels.
        let kind = if cells[2] == "info" { "gauge" } else { cells[2] };
        let labels = cells[3].split(", ").filter(|label| !label.is_empty()).map(str::to_owned);
        (cells[1].trim_matches('`').to_owned(), (kind.to_owned(), labels.collect()))
    };
    rows.map(shape).collect()
}

/// Runs `promtool` with this text on stdin.
pub(crate) fn promtool(arguments: &[&str], folder: &Path, said: &str) -> Did {
    let mut child = Command::new("promtool")
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("promtool: {error}; apt-get install prometheus"));
    child.stdin.take().unwrap().write_all(said.as_bytes()).unwrap();
    child.wait_with_output().unwrap().into()
}

/// Asserts that `promtool` accepts the figures.
pub(crate) fn assert_sound(figures: &Figures) {
    let did = promtool(&["check", "metrics"], Path::new("/"), &figures.text);
    assert_eq!((did.code, did.complained.as_str()), (Some(0), ""), "{}", figures.text);
}
