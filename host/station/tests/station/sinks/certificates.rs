//! Servers whose certificates are not good. Those of the tests are good for two days.

use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

use super::post::{Server, sink};
use super::{SEND, command};
use crate::clocks::Clocks;
use crate::common::Did;
use crate::history::released::history;
use crate::plant::link::certificates_for;

const DAY: i64 = 86_400;

/// A station, a server that it sends to, and whom it trusts.
struct Ends {
    folder: TempDir,
    server: Server,
    ours: TempDir,
    clocks: Clocks,
}

impl Ends {
    fn new() -> Self {
        let ours = certified();
        let (server, clocks) = (Server::start(Some(ours.path())), Clocks::in_folder(ours.path()));
        Self { folder: history().closed(), server, ours, clocks }
    }

    /// What is told when results are sent to `host` with the clock so many seconds ahead, and whoever signs in `trusted` is trusted.
    fn told(&self, host: &str, trusted: &Path, ahead: i64) -> String {
        self.clocks.ahead(ahead, 0);
        let ca = format!("ca = \"{}\"", trusted.join("ca.pem").display());
        let sink = sink(&format!("https://{host}:{}/", self.server.port), &ca);
        let mut send = command(self.folder.path(), &sink, &SEND);
        let sent: Did = self.clocks.of(&mut send).env("TZ", "UTC").output().unwrap().into();
        assert!(sent.said.starts_with("0 sent, 10 not") && !sent.said.contains("not reached"), "{sent:?}");
        assert!(self.server.requests().is_empty());
        sent.said
    }

    /// The date of the server's certificate.
    fn date(&self, which: &str) -> String {
        let certificate = self.ours.path().join("server.crt");
        let mut openssl = Command::new("openssl");
        openssl.args(["x509", "-noout", "-dateopt", "iso_8601", which, "-in"]).arg(certificate);
        let said = String::from_utf8(openssl.output().unwrap().stdout).unwrap();
        said.split_once('=').unwrap().1[.."2026-11-27 10:00".len()].to_owned()
    }
}

fn certified() -> TempDir {
    let place = tempfile::tempdir().unwrap();
    certificates_for(place.path(), "DNS:mes.example");
    place
}

#[test]
fn a_certificate_out_of_its_time_is_told_with_its_date_and_the_clock_s() {
    let ends = Ends::new();
    let late = ends.told("localhost", ends.ours.path(), 46 * DAY);
    let until = format!("was valid until {}, and this computer's clock says 20", ends.date("-enddate"));
    assert!(late.contains("the certificate of localhost") && late.contains(&until), "{late}");
    let early = ends.told("localhost", ends.ours.path(), -5 * DAY);
    let from = format!("is valid from {} on, and this computer's clock says 20", ends.date("-startdate"));
    assert!(early.contains("the certificate of localhost") && early.contains(&from), "{early}");
}

#[test]
fn a_certificate_of_somebody_else_is_told_as_that() {
    let ends = Ends::new();
    let stranger = ends.told("localhost", certified().path(), 0);
    assert!(stranger.contains("of localhost is signed by nobody who is trusted"), "{stranger}");
    let named = ends.told("127.0.0.1", ends.ours.path(), 0);
    assert!(named.contains("of 127.0.0.1 is of another name (localhost, mes.example)"), "{named}");
}
