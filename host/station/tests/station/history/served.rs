//! The station's own program, with its pages for whoever looks.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

use super::made::Made;
use crate::common::{PLAN, program};

/// A plan of what was made.
pub(crate) fn plan() -> String {
    PLAN.replace("quick", "final")
}

/// A station that is served until this goes.
pub(crate) struct Served {
    station: Child,
    address: SocketAddr,
    data: TempDir,
    _settings: TempDir,
}

/// An answer.
pub(crate) struct Answer {
    pub(crate) status: u16,
    head: String,
    pub(crate) body: Vec<u8>,
    /// Whether it came to its end.
    pub(crate) is_whole: bool,
}

impl Answer {
    pub(crate) fn text(&self) -> String {
        String::from_utf8(self.body.clone()).unwrap()
    }

    /// The value of a header.
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        let lines = self.head.lines().filter_map(|line| line.split_once(": "));
        lines.into_iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, value)| value)
    }
}

impl Served {
    /// Serves what was made.
    pub(crate) fn of(made: Made) -> Self {
        let (data, settings) = (made.closed(), tempfile::tempdir().unwrap());
        fs::write(settings.path().join("plan.toml"), plan()).unwrap();
        let text = format!(
            "schema = 1\n[station]\nname = \"station 7\"\ndata = {:?}\n[web]\nlisten = \"127.0.0.1:0\"\n\
             [[lane]]\nname = \"1\"\nboard = \"mock\"\nplans = [\"plan.toml\"]\n",
            data.path()
        );
        let file = settings.path().join("station.toml");
        fs::write(&file, text).unwrap();
        let mut station = Command::new(program())
            .args(["serve", "--settings"])
            .arg(&file)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(station.stdout.take().unwrap()).lines();
        let address = lines.by_ref().map(Result::unwrap).find_map(|line| {
            let (_, rest) = line.split_once("http://")?;
            rest.split('/').next()?.parse().ok()
        });
        // What else it says must not fill the pipe.
        std::thread::spawn(move || lines.for_each(drop));
        Self { station, address: address.unwrap(), data, _settings: settings }
    }

    pub(crate) fn folder(&self) -> halfrow_station::store::Folder {
        halfrow_station::store::Folder::new(self.data.path())
    }

    /// What is at `path`.
    pub(crate) fn get(&self, path: &str) -> Answer {
        self.get_in(path, "en")
    }

    /// What is at `path` for a browser that prefers `language`.
    pub(crate) fn get_in(&self, path: &str, language: &str) -> Answer {
        let address = self.address;
        let mut stream = TcpStream::connect(address).unwrap();
        let head = format!(
            "GET {path} HTTP/1.1\r\nHost: {address}\r\nAccept-Language: {language}\r\nConnection: close\r\n\r\n"
        );
        stream.write_all(head.as_bytes()).unwrap();
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        let end = bytes.windows(4).position(|window| window == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        let body = &bytes[end + 4..];
        if head.to_lowercase().contains("transfer-encoding: chunked") {
            let (body, is_whole) = unchunked(body);
            return Answer { status, head, body, is_whole };
        }
        assert_ne!(head.to_lowercase().find("content-length"), None, "{head}");
        Answer { status, head, body: body.to_vec(), is_whole: true }
    }

    /// The page at `path`, which is there.
    pub(crate) fn page(&self, path: &str) -> String {
        let answer = self.get(path);
        assert_eq!(answer.status, 200, "{path}\n{}", answer.text());
        assert_eq!(answer.header("content-type"), Some("text/html; charset=utf-8"));
        answer.text()
    }
}

/// The bytes of chunks (RFC 9112, section 7.1), and whether the last one came.
fn unchunked(mut rest: &[u8]) -> (Vec<u8>, bool) {
    let mut bytes = Vec::new();
    while let Some(end) = rest.windows(2).position(|window| window == b"\r\n") {
        let length = usize::from_str_radix(std::str::from_utf8(&rest[..end]).unwrap(), 16).unwrap();
        if length == 0 {
            return (bytes, true);
        }
        let Some(chunk) = rest.get(end + 2..end + 2 + length) else { break };
        bytes.extend_from_slice(chunk);
        rest = rest.get(end + 4 + length..).unwrap_or_default();
    }
    (bytes, false)
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.station.kill();
        let _ = self.station.wait();
    }
}
