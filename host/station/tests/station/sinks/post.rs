//! A web server to which results are posted, which is Python's own.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::net::{TcpListener, TcpStream};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;

use base64::Engine as _;
use serde_json::Value;
use tempfile::TempDir;

use super::{SEND, command, did, send};
use crate::common::{Did, Killed, logged, query, until};
use crate::history::released::history;
use crate::lanes::floor::{SERIALS, Station};
use crate::plant::link::certificates;

pub(super) struct Server {
    _process: Killed,
    folder: TempDir,
    pub(super) port: u16,
}

impl Server {
    /// A running server, with the certificate in `certified` if there is one.
    pub(super) fn start(certified: Option<&Path>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/station/sinks/server.py");
        let mut command = Command::new("python3");
        command.arg(script).arg(folder.path()).stdout(Stdio::piped());
        if let Some(place) = certified {
            command.arg(place.join("server.crt")).arg(place.join("server.key"));
        }
        let mut process = Killed(command.spawn().unwrap());
        let mut port = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut port).unwrap();
        let server = Self { _process: process, folder, port: port.trim().parse().unwrap() };
        server.answers("200 taken");
        server
    }

    /// Makes it answer this from now on.
    pub(super) fn answers(&self, answer: &str) {
        let aside = self.folder.path().join("answer.aside");
        fs::write(&aside, answer).unwrap();
        fs::rename(aside, self.folder.path().join("answer")).unwrap();
    }

    /// What was posted since the last call.
    pub(super) fn requests(&self) -> Vec<Value> {
        let path = self.folder.path().join("requests.jsonl");
        let text = fs::read_to_string(&path).unwrap_or_default();
        let _ = fs::remove_file(path);
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

/// The file of a token in this folder, which nobody else may read.
fn token(folder: &Path) -> PathBuf {
    let path = folder.join("mes.token");
    fs::write(&path, "rosebud-5e1f\n").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
    path
}

pub(super) fn sink(url: &str, more: &str) -> String {
    format!("[[sink]]\nname = \"mes\"\npost = \"{url}\"\n{more}\n")
}

#[test]
fn each_run_is_posted_once_with_its_key_and_again_only_when_nobody_knows() {
    let server = Server::start(None);
    let folder = history().closed();
    token(folder.path());
    let url = format!("http://127.0.0.1:{}/api/runs?line=3", server.port);
    let sink = sink(&url, "token_file = \"mes.token\"");
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("10 sent, 0 not"), "{sent:?}");
    let posted: BTreeMap<_, _> = server
        .requests()
        .into_iter()
        .map(|request| {
            let headers = &request["headers"];
            assert_eq!(request["path"], "/api/runs?line=3");
            assert_eq!(headers["authorization"], "Bearer rosebud-5e1f");
            assert_eq!(headers["content-type"], "application/json");
            // A string of structured fields is in quotes (draft-ietf-httpapi-idempotency-key-header-07, section 2.1).
            let key = headers["idempotency-key"].as_str().unwrap();
            let key = key.strip_prefix('"').unwrap().strip_suffix('"').unwrap().to_owned();
            let body = base64::prelude::BASE64_STANDARD.decode(request["body"].as_str().unwrap()).unwrap();
            (key, body)
        })
        .collect();
    let runs = query(folder.path(), "SELECT id || ' ' || record_sha256 FROM run WHERE state = 'final'");
    assert_eq!(posted.len(), runs.len() + 1, "and a waiver");
    for run in &runs {
        let (id, hash) = run.split_once(' ').unwrap();
        assert_eq!(halfrow::result::sha256([posted[id].as_slice()]), hash);
    }
    assert_eq!(send(folder.path(), &sink).said, "nothing is left to be sent\n");
    assert!(server.requests().is_empty());
}

/// The media types are those of RFC 7303, RFC 4180 and RFC 8259.
#[test]
fn each_document_says_what_it_is_whatever_runs_are_written_as() {
    for (format, of_runs) in [
        ("record", "application/json"),
        ("junit", "application/xml"),
        ("csv", "text/csv; charset=utf-8"),
        ("openhtf", "application/json"),
    ] {
        let server = Server::start(None);
        let folder = history().closed();
        let sink = sink(&format!("http://127.0.0.1:{}/", server.port), &format!("format = \"{format}\""));
        assert!(send(folder.path(), &sink).said.starts_with("10 sent, 0 not"));
        let waiver = query(folder.path(), "SELECT id FROM waiver").remove(0);
        let requests = server.requests();
        assert_eq!(requests.len(), 8);
        for request in requests {
            let is_waiver = request["headers"]["idempotency-key"] == format!("\"{waiver}\"");
            let expected = if is_waiver { "application/json" } else { of_runs };
            assert_eq!(request["headers"]["content-type"], expected, "{format}, {request}");
        }
    }
}

#[test]
fn what_a_server_answers_says_who_waits_for_whom() {
    let server = Server::start(None);
    let folder = history().closed();
    let sink = sink(&format!("http://127.0.0.1:{}/", server.port), "");
    // It accepts nothing at all: after the first refusal no more is sent.
    for (answer, said) in [
        ("503 later", "answers 503; it is asked again later"),
        ("429 slowly", "answers 429; it is asked again later"),
        ("408 slow", "answers 408; it is asked again later"),
        ("425 early", "answers 425; it is asked again later"),
        ("103 soon", "answers 103; it is asked again later"),
        ("401 who", "check the address and the token"),
        ("403 no", "check the address and the token"),
        ("407 by whom", "check the address and the token"),
        ("302 elsewhere", "answers 302 to everything"),
        ("308 elsewhere", "answers 308 to everything"),
    ] {
        server.answers(answer);
        let sent = send(folder.path(), &sink);
        assert!(sent.said.starts_with("0 sent, 10 not") && sent.said.contains(said), "{answer}: {sent:?}");
        assert_eq!(server.requests().len(), 1, "{answer}");
    }
    // It fails at each, or is still working on it, and may accept it later. Lines of the audit are not posted.
    for (answer, came) in [("500 oops", "2 sent, 8 not"), ("409 patience", "0 sent, 8 not")] {
        server.answers(answer);
        assert!(send(folder.path(), &sink).said.starts_with(came), "{answer}");
        assert_eq!(server.requests().len(), 8, "{answer}");
    }
    // It will never accept them as they are, so they wait for a person.
    server.answers("422 the serial number is\n unknown here");
    for posted in [8, 0] {
        let refused = send(folder.path(), &sink);
        assert!(refused.said.starts_with("0 sent, 8 not") && refused.code == Some(3), "{refused:?}");
        assert_eq!(server.requests().len(), posted);
    }
    let listed = did(folder.path(), &sink, &["outbox", "list"]);
    assert!(listed.said.contains("(the serial number is unknown here)"), "{listed:?}");
    server.answers("204 ");
    let release = ["outbox", "release", "--sink", "mes", "--reason", "known now", "--operator", "engel"];
    assert_eq!(did(folder.path(), &sink, &release).said, "8 of mes are tried again\n");
    // The release has its line in the audit, and so has the command.
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("10 sent, 0 not") && sent.code == Some(0), "{sent:?}");
}

#[test]
fn what_was_tried_a_moment_ago_is_sent_when_a_person_says_so() {
    let server = Server::start(None);
    let folder = history().closed();
    let sink = sink(&format!("http://127.0.0.1:{}/", server.port), "");
    server.answers("500 oops");
    for _ in 0..3 {
        assert_eq!(send(folder.path(), &sink).code, Some(3));
        assert_eq!(server.requests().len(), 8, "each once");
    }
    server.answers("200 taken");
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("8 sent, 0 not") && sent.code == Some(0), "{sent:?}");
}

/// Error pages of proxies and frameworks repeat the request for those who look for faults.
#[test]
fn a_server_that_tells_what_it_was_sent_has_the_token_kept_nowhere() {
    let server = Server::start(None);
    let folder = history().closed();
    token(folder.path());
    let sink = sink(&format!("http://127.0.0.1:{}/", server.port), "token_file = \"mes.token\"");
    // The second token is cut by the end of what is kept.
    let told = "authorization: Bearer rosebud-5e1f, ";
    let filled = "x".repeat(500 - told.len() - 4);
    server.answers(&format!("400 {told}{filled}rosebud-5e1f rosebud-5e1f"));
    assert_eq!(send(folder.path(), &sink).code, Some(3));
    let listed = did(folder.path(), &sink, &["outbox", "list"]).said;
    assert!(listed.contains("authorization: Bearer …, xxx"), "{listed}");
    for said in query(folder.path(), "SELECT said FROM outbox WHERE dead_ms IS NOT NULL") {
        assert!(!said.contains("rose"), "{said}");
    }
}

#[test]
fn a_token_that_no_request_can_have_is_told_before_anything_is_sent() {
    let server = Server::start(None);
    let folder = history().closed();
    let path = token(folder.path());
    let sink = sink(&format!("http://127.0.0.1:{}/", server.port), "token_file = \"mes.token\"");
    for wrong in ["one\ntwo\n", "one two\n", "schlüssel\n"] {
        fs::write(&path, wrong).unwrap();
        let refused = send(folder.path(), &sink);
        assert!(
            refused.code == Some(2) && refused.complained.contains("mes.token holds no token"),
            "{wrong}: {refused:?}"
        );
    }
    assert!(server.requests().is_empty());
}

#[test]
fn what_leaves_the_computer_goes_to_the_server_of_that_name_alone() {
    let (ours, theirs) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    for place in [&ours, &theirs] {
        certificates(place.path());
    }
    let server = Server::start(Some(ours.path()));
    let folder = history().closed();
    let url = format!("https://localhost:{}/", server.port);
    let trusting =
        |place: &TempDir| sink(&url, &format!("ca = \"{}\"", place.path().join("ca.pem").display()));
    let refused = send(folder.path(), &trusting(&theirs));
    assert!(
        refused.said.starts_with("0 sent, 10 not") && refused.said.contains("certificate"),
        "{refused:?}"
    );
    assert!(server.requests().is_empty());
    let sent = send(folder.path(), &trusting(&ours));
    assert!(sent.said.starts_with("10 sent, 0 not"), "{sent:?}");
    assert_eq!(server.requests().len(), 8);
}

/// The variables from which programs take the proxy for everything that they send, unless told otherwise.
const PROXIES: [&str; 6] =
    ["ALL_PROXY", "all_proxy", "HTTPS_PROXY", "https_proxy", "HTTP_PROXY", "http_proxy"];

#[test]
fn a_proxy_in_the_environment_gets_nothing() {
    let certified = tempfile::tempdir().unwrap();
    certificates(certified.path());
    let proxy = Server::start(None);
    let ca = format!("ca = \"{}\"", certified.path().join("ca.pem").display());
    for (scheme, certified, more) in [("http", None, ""), ("https", Some(certified.path()), ca.as_str())] {
        let server = Server::start(certified);
        let folder = history().closed();
        let sink = sink(&format!("{scheme}://localhost:{}/", server.port), more);
        let mut send = command(folder.path(), &sink, &SEND);
        send.envs(PROXIES.map(|name| (name, format!("http://127.0.0.1:{}", proxy.port))));
        let sent: Did = send.env_remove("NO_PROXY").env_remove("no_proxy").output().unwrap().into();
        assert!(sent.said.starts_with("10 sent, 0 not"), "{scheme}: {sent:?}");
        assert_eq!(server.requests().len(), 8, "{scheme}");
    }
    assert!(proxy.requests().is_empty());
}

/// A proxy that connects every client to the server that it names, and the heads of their requests.
fn connecting() -> (u16, Receiver<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let (sender, asked) = mpsc::channel();
    thread::spawn(move || {
        for client in listener.incoming().map(Result::unwrap) {
            let head =
                BufReader::new(&client).lines().map(Result::unwrap).take_while(|line| !line.is_empty());
            let head: Vec<_> = head.collect();
            let to = head[0].split(' ').nth(1).unwrap();
            let server = TcpStream::connect(to).unwrap();
            (&client).write_all(b"HTTP/1.1 200 OK\r\n\r\n").unwrap();
            for (from, to) in [(&client, &server), (&server, &client)] {
                let (mut from, mut to) = (from.try_clone().unwrap(), to.try_clone().unwrap());
                thread::spawn(move || io::copy(&mut from, &mut to));
            }
            sender.send(head.join("\n")).unwrap();
        }
    });
    (port, asked)
}

#[test]
fn a_proxy_of_the_settings_carries_what_it_cannot_read() {
    let certified = tempfile::tempdir().unwrap();
    certificates(certified.path());
    let server = Server::start(Some(certified.path()));
    let folder = history().closed();
    token(folder.path());
    let (port, asked) = connecting();
    let more = format!(
        "token_file = \"mes.token\"\nca = \"{}\"\nproxy = \"http://localhost:{port}\"",
        certified.path().join("ca.pem").display()
    );
    let sent = send(folder.path(), &sink(&format!("https://localhost:{}/", server.port), &more));
    assert!(sent.said.starts_with("10 sent, 0 not"), "{sent:?}");
    assert_eq!(server.requests().len(), 8);
    let asked: Vec<_> = asked.try_iter().collect();
    assert!(!asked.is_empty());
    for head in asked {
        let first = format!("CONNECT localhost:{} HTTP/1.1", server.port);
        assert!(head.starts_with(&first) && !head.contains("rosebud"), "{head}");
    }
}

#[test]
fn the_log_says_once_that_a_sink_takes_nothing_and_once_that_it_does_again() {
    let server = Server::start(None);
    server.answers("500 oops");
    let share = "[[sink]]\nname = \"share\"\nfolder = \"share\"\n";
    let mes = sink(&format!("http://127.0.0.1:{}/", server.port), "");
    let station = Station::with(&["mock"], &format!("{share}{mes}"));
    let (mut running, log) = station.start_logging();
    let told = |count: usize, of: &str| logged(&log, count, of);
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    let tried = "SELECT count(*) FROM outbox WHERE kind = 'run' AND attempts > 1";
    until("two entries that were tried again", || station.query(tried) == ["2"]);
    told(1, "WARN the sink share takes nothing, and all waits for it: the folder ");
    told(1, "WARN the sink mes does not take the run ");
    told(0, "is sent again");
    fs::create_dir(station.path("share")).unwrap();
    server.answers("200 taken");
    told(1, "WARN the sink share answers again: 1 waited");
    told(1, "WARN the sink mes has taken all that it did not take before");
    server.answers("500 oops");
    running.scan(SERIALS[1]);
    running.state("1", "PASS");
    told(2, "WARN the sink mes does not take the run ");
    server.answers("422 unknown");
    told(1, "WARN the sink mes refuses the run ");
    told(1, "which waits for a person: 127.0.0.1 answers 422 to this (unknown)");
    told(1, "WARN nothing waits for the sink mes any more, but 1 entry waits for a person");
    assert_eq!(running.end().0, Some(0));
    assert_eq!(fs::read_to_string(&log).unwrap().lines().count(), 7);
}
