//! The station's own program, which serves pages.

use std::fs;
use std::process::Command;

use tempfile::TempDir;

use super::made::Made;
use crate::common::PLAN;
use crate::pages::http::{Request, Response};
use crate::pages::station::{Serving, command};

/// The plan of the runs that were made.
pub(crate) fn plan() -> String {
    PLAN.replace("quick", "final")
}

/// A station that serves until it is dropped.
pub(crate) struct Served {
    serving: Serving,
    data: TempDir,
    _settings: TempDir,
}

impl Served {
    /// Serves the runs that were made.
    pub(crate) fn of(made: Made) -> Self {
        Self::called(made, |_| ())
    }

    /// Serves the runs that were made, with a wall clock in this time zone.
    pub(crate) fn in_zone(made: Made, zone: &str) -> Self {
        Self::called(made, |call| {
            call.env("TZ", zone);
        })
    }

    fn called(made: Made, with: impl FnOnce(&mut Command)) -> Self {
        let (data, settings) = (made.closed(), tempfile::tempdir().unwrap());
        fs::write(settings.path().join("plan.toml"), plan()).unwrap();
        let text = format!(
            "schema = 1\n[station]\nname = \"station 7\"\ndata = {:?}\n[web]\nlisten = \"127.0.0.1:0\"\n\
             [[lane]]\nname = \"1\"\nboard = \"mock\"\nplans = [\"plan.toml\"]\n",
            data.path()
        );
        let file = settings.path().join("station.toml");
        fs::write(&file, text).unwrap();
        let mut call = command(&file);
        with(&mut call);
        Self { serving: Serving::of(&mut call), data, _settings: settings }
    }

    pub(crate) fn folder(&self) -> halfrow_station::store::Folder {
        halfrow_station::store::Folder::new(self.data.path())
    }

    /// The answer to a request for `path`.
    pub(crate) fn get(&self, path: &str) -> Response {
        self.get_in(path, "en")
    }

    /// The answer to a request for `path` by a browser that prefers `language`.
    pub(crate) fn get_in(&self, path: &str, language: &str) -> Response {
        let port = self.serving.port;
        let request = Request::bare(port, "GET", path).with("host", &format!("127.0.0.1:{port}"));
        let answer = request.with("accept-language", language).send();
        let is_framed =
            ["content-length", "transfer-encoding"].iter().any(|name| answer.header(name).is_some());
        assert!(is_framed, "{path}: {:?}", answer.headers);
        answer
    }

    /// The page at `path`, which must exist.
    pub(crate) fn page(&self, path: &str) -> String {
        let answer = self.get(path);
        assert_eq!(answer.status, 200, "{path}\n{}", answer.text());
        assert_eq!(answer.header("content-type"), Some("text/html; charset=utf-8"));
        answer.text()
    }
}
