//! Servers whose certificates are not valid. Those of the tests are valid for two days.

use std::fs;
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

/// A station, a server to which it sends, and the certificates and clocks of both.
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

    /// The message when results are sent to `host` with the clock `ahead` seconds fast, and the authority in `trusted` is
    /// trusted.
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

    /// One of the two dates of the server's certificate.
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
    let until =
        format!("was valid until {} +00:00, and this computer's clock says 20", ends.date("-enddate"));
    assert!(late.contains("the certificate of localhost") && late.contains(&until), "{late}");
    let early = ends.told("localhost", ends.ours.path(), -5 * DAY);
    let from =
        format!("is valid from {} +00:00 on, and this computer's clock says 20", ends.date("-startdate"));
    assert!(early.contains("the certificate of localhost") && early.contains(&from), "{early}");
}

/// A file that can only be read in part is not used at all, and one without certificates trusts nobody.
#[test]
fn a_file_of_certificates_that_is_not_whole_is_told_before_anything_is_sent() {
    let ends = Ends::new();
    let path = ends.ours.path().join("half.pem");
    let whole = fs::read_to_string(ends.ours.path().join("ca.pem")).unwrap();
    let key = fs::read_to_string(ends.ours.path().join("ca.key")).unwrap();
    let broken = format!("{whole}-----BEGIN CERTIFICATE-----\n!!!!\n-----END CERTIFICATE-----\n");
    for (text, said) in [
        (broken.as_str(), "the certificates in "),
        (key.as_str(), "there is no certificate to know the other side by"),
    ] {
        fs::write(&path, text).unwrap();
        let ca = format!("ca = \"{}\"", path.display());
        let sink = sink(&format!("https://localhost:{}/", ends.server.port), &ca);
        let refused: Did = command(ends.folder.path(), &sink, &SEND).output().unwrap().into();
        assert!(refused.code == Some(2) && refused.complained.contains(said), "{refused:?}");
    }
    assert!(ends.server.requests().is_empty());
}

/// For example, the system may trust a company's proxy, which reads what passes through it.
#[test]
fn who_signs_is_of_the_file_of_the_settings_alone_and_not_of_the_system_s() {
    let ends = Ends::new();
    let theirs = certified();
    let ca = |place: &TempDir| place.path().join("ca.pem");
    let url = format!("https://localhost:{}/", ends.server.port);
    let sent = |of_system: &TempDir, of_settings: String| -> Did {
        let mut send = command(ends.folder.path(), &sink(&url, &of_settings), &SEND);
        send.env("SSL_CERT_FILE", ca(of_system)).env_remove("SSL_CERT_DIR").output().unwrap().into()
    };
    let refused = sent(&ends.ours, format!("ca = \"{}\"", ca(&theirs).display()));
    assert!(refused.said.contains("is signed by nobody who is trusted"), "{refused:?}");
    assert!(ends.server.requests().is_empty());
    // Without a file, the system's own certificates are used.
    assert!(sent(&ends.ours, String::new()).said.starts_with("10 sent, 0 not"));
}

#[test]
fn a_certificate_of_somebody_else_is_told_as_that() {
    let ends = Ends::new();
    let stranger = ends.told("localhost", certified().path(), 0);
    assert!(stranger.contains("of localhost is signed by nobody who is trusted"), "{stranger}");
    let named = ends.told("127.0.0.1", ends.ours.path(), 0);
    assert!(named.contains("of 127.0.0.1 is of another name (localhost, mes.example)"), "{named}");
}
