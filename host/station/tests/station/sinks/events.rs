//! Events for dashboards, through Debian's broker.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;

use serde_json::Value;
use tempfile::TempDir;

use super::send;
use crate::common::{Killed, change, listening, now_ms, query, reason};
use crate::history::made::{End, Made, Run};
use crate::plant::link::certificates;

/// A broker that accepts one user, and a subscriber to everything that it gets.
struct Broker {
    listener: Killed,
    broker: Killed,
    port: u16,
    _folder: TempDir,
}

const PASSWORD: &str = "rosebud-5e1f";
/// Debian puts it into a folder that is not on a user's path.
const MOSQUITTO: &str = "PATH=\"$PATH:/usr/sbin:/usr/local/sbin\" exec mosquitto -c \"$0\"";
/// For how many seconds the subscriber listens.
const LONGEST: &str = "120";

impl Broker {
    /// A running broker, with the certificate in `certified` if there is one.
    fn start(certified: Option<&Path>) -> Self {
        Self::with(certified, "")
    }

    /// The same with more settings.
    fn with(certified: Option<&Path>, more: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let made =
            Command::new("mosquitto_passwd").args(["-b", "-c", &path("users"), "station", PASSWORD]).output();
        assert!(made.unwrap().status.success());
        let mut text = format!("allow_anonymous false\npassword_file {}\nuser root\n{more}", path("users"));
        let mut trusted = Vec::new();
        if let Some(place) = certified {
            let at = |name: &str| place.join(name).display().to_string();
            text += &format!("certfile {}\nkeyfile {}\n", at("server.crt"), at("server.key"));
            trusted = vec!["--cafile".to_owned(), at("ca.pem")];
        }
        let (broker, port) = listening("mosquitto", |port| {
            fs::write(path("broker.conf"), format!("listener {port} 127.0.0.1\n{text}")).unwrap();
            let mut broker = Command::new("sh");
            broker.args(["-c", MOSQUITTO, &path("broker.conf")]).stderr(Stdio::null()).spawn().unwrap()
        });
        let mut listener = Command::new("stdbuf");
        listener.args(["-oL", "mosquitto_sub", "-W", LONGEST]);
        listener.args([
            "-h",
            "localhost",
            "-p",
            &port.to_string(),
            "-u",
            "station",
            "-P",
            PASSWORD,
            "-q",
            "1",
        ]);
        let listener = listener.args(["-t", "#", "-F", "%t %p", "-d"]).args(trusted).stdout(Stdio::piped());
        Self { listener: Killed(listener.spawn().unwrap()), broker, port, _folder: folder }
    }

    /// The next events, each with topic and document.
    fn heard(&mut self, count: usize, begin: impl FnOnce()) -> Vec<(String, Value)> {
        let mut lines = BufReader::new(self.listener.stdout.take().unwrap()).lines().map(Result::unwrap);
        // Events before the subscription would be lost.
        assert!(lines.any(|line| line.contains("received SUBACK")), "the listener is refused");
        begin();
        let events = lines.filter_map(|line| {
            let (topic, text) = line.split_once(" {")?;
            Some((topic.to_owned(), serde_json::from_str(&format!("{{{text}")).ok()?))
        });
        events.take(count).collect()
    }

    /// The settings of a sink with this password, which is put into a file in the station's folder.
    fn sink(&self, station: &Path, scheme: &str, password: &str, more: &str) -> String {
        let path = station.join("broker.password");
        fs::write(&path, format!("{password}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
        let url = format!("{scheme}://localhost:{}/factory/halfrow", self.port);
        let login = "user = \"station\"\npassword_file = \"broker.password\"";
        format!("[[sink]]\nname = \"wall\"\nmqtt = \"{url}\"\n{login}\n{more}\n")
    }
}

/// The folder of a station with a run and a waiver of now, and a run of two hours ago.
fn station() -> TempDir {
    let mut made = Made::new();
    let minute_ago = now_ms() - 60_000;
    made.run(&Run { started_ms: minute_ago - 7_200_000, ..Run::of("OLD", End::Pass) });
    let failed =
        made.run(&Run { started_ms: minute_ago, production: false, ..Run::of("NEW", End::Fail(&["clock"])) });
    made.store.waive(&failed, "engel", &reason("seen")).unwrap();
    let folder = made.closed();
    // Earlier programs accepted a reason of any length.
    let database = rusqlite::Connection::open(folder.path().join("station.db")).unwrap();
    database.execute("UPDATE waiver SET reason = ?1", [long_reason()]).unwrap();
    folder
}

/// A reason that is longer than an event usually is.
fn long_reason() -> String {
    "seen ".repeat(40_000)
}

#[test]
fn what_has_just_happened_is_told_and_what_is_old_is_not() {
    let certified = tempfile::tempdir().unwrap();
    certificates(certified.path());
    for is_protected in [false, true] {
        let place = is_protected.then(|| certified.path());
        let mut broker = Broker::start(place);
        let folder = station();
        let scheme = if is_protected { "mqtts" } else { "mqtt" };
        let ca =
            place.map(|place| format!("ca = \"{}\"", place.join("ca.pem").display())).unwrap_or_default();
        let sink = broker.sink(folder.path(), scheme, PASSWORD, &ca);
        let events = broker.heard(2, || {
            let sent = send(folder.path(), &sink);
            // The waiver's line in the audit makes no event, either.
            assert!(sent.said.starts_with("4 sent, 0 not"), "{sent:?}");
        });
        let [(run, told), (waiver, waived)] = &events[..] else { panic!("{events:?}") };
        assert_eq!(run, "factory/halfrow/12/1/run");
        let expected = [("serial", "NEW"), ("verdict", "FAIL"), ("station", "station 7"), ("plan", "final")];
        assert!(expected.iter().all(|(key, value)| told[key] == *value), "{told}");
        assert_eq!(told["production"], false, "as the record says: {told}");
        assert_eq!(waiver, "factory/halfrow/12/waiver");
        assert_eq!((&waived["run"], &waived["reason"]), (&told["run"], &long_reason().into()));
    }
}

#[test]
fn a_broker_that_is_away_or_does_not_let_in_is_tried_again() {
    let mut broker = Broker::start(None);
    let folder = station();
    let refused = send(folder.path(), &broker.sink(folder.path(), "mqtt", "wrong", ""));
    // An old run is not sent to the broker at all.
    assert!(
        refused.said.starts_with("1 sent, 3 not")
            && refused.said.contains("check user and password_file in the settings"),
        "{refused:?}"
    );
    broker.broker.kill().unwrap();
    broker.broker.wait().unwrap();
    let away = send(folder.path(), &broker.sink(folder.path(), "mqtt", PASSWORD, ""));
    assert!(away.said.starts_with("0 sent, 3 not") && away.said.contains("refused"), "{away:?}");
}

#[test]
fn a_broker_whose_certificate_nobody_signed_who_is_trusted_is_told_as_that() {
    let (ours, theirs) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    for place in [&ours, &theirs] {
        certificates(place.path());
    }
    let broker = Broker::start(Some(ours.path()));
    let folder = station();
    let ca = format!("ca = \"{}\"", theirs.path().join("ca.pem").display());
    let refused = send(folder.path(), &broker.sink(folder.path(), "mqtts", PASSWORD, &ca));
    let told = "the certificate of localhost is signed by nobody who is trusted";
    assert!(refused.said.starts_with("1 sent, 3 not") && refused.said.contains(told), "{refused:?}");
}

/// The broker is there, and takes what comes after.
#[test]
fn an_event_that_is_too_long_for_a_broker_keeps_no_other_one_waiting() {
    let broker = Broker::with(None, "max_packet_size 20000\n");
    let folder = station();
    // The waiver is the first that is sent.
    change(folder.path(), "UPDATE waiver SET id = '00' || substr(id, 3)");
    change(folder.path(), "UPDATE outbox SET subject = '00' || substr(subject, 3) WHERE kind = 'waiver'");
    assert!(query(folder.path(), "SELECT id FROM waiver")[0].starts_with("00"));
    let sent = send(folder.path(), &broker.sink(folder.path(), "mqtt", PASSWORD, ""));
    assert!(sent.said.starts_with("3 sent, 1 not"), "{sent:?}");
    assert!(sent.said.contains("ended the connection over an event of 200"), "{sent:?}");
    assert_eq!(query(folder.path(), "SELECT kind FROM outbox WHERE done_ms IS NULL"), ["waiver"]);
}

/// The broker accepts the station, and is gone before it confirms an event.
#[test]
fn an_event_that_no_broker_has_confirmed_is_tried_again() {
    let folder = station();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    thread::spawn(move || {
        for stream in listener.incoming() {
            let (mut stream, mut bytes) = (stream.unwrap(), [0; 4096]);
            let _ = stream.read(&mut bytes);
            // CONNACK (MQTT 3.1.1, section 3.2), but no PUBACK.
            let _ = stream.write_all(&[0x20, 2, 0, 0]);
            let _ = stream.read(&mut bytes);
        }
    });
    let sent =
        send(folder.path(), &format!("[[sink]]\nname = \"wall\"\nmqtt = \"mqtt://localhost:{port}/x\"\n"));
    // Neither event, while the old run and the line of the audit make none.
    assert!(sent.said.starts_with("2 sent, 2 not"), "{sent:?}");
}
