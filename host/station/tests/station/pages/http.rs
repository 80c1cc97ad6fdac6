//! An HTTP client that sends exactly what it is given.

use std::collections::BTreeMap;
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;

use crate::common::{HANG, until_found};

/// An answer.
#[derive(Clone, Debug)]
pub(crate) struct Response {
    pub(crate) status: u16,
    pub(crate) headers: BTreeMap<String, String>,
    pub(crate) body: Vec<u8>,
    /// Whether the body arrived completely.
    pub(crate) is_whole: bool,
}

impl Response {
    /// The body as text.
    pub(crate) fn text(&self) -> String {
        String::from_utf8(self.body.clone()).unwrap()
    }

    /// The value of the header `name`, given in lower case.
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.headers.get(name).map(String::as_str)
    }
}

/// A connection to this port.
pub(super) fn connected(port: u16) -> TcpStream {
    let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(HANG)).unwrap();
    stream
}

/// The answer to these bytes, on a new connection.
///
/// # Errors
/// Why the connection ended, if it ended without an answer.
pub(crate) fn exchange(port: u16, bytes: &[u8]) -> io::Result<Response> {
    let mut stream = connected(port);
    // A server that refuses a request may close the connection before it has read everything.
    let _ = stream.write_all(bytes);
    let mut head = Vec::new();
    let mut byte = [0];
    while !head.ends_with(b"\r\n\r\n") {
        stream.read_exact(&mut byte)?;
        head.extend(byte);
    }
    let head = String::from_utf8(head).unwrap();
    let mut lines = head.lines();
    let status = lines.next().unwrap().split(' ').nth(1).unwrap().parse().unwrap();
    let pairs = lines.filter_map(|line| line.split_once(": "));
    let headers: BTreeMap<String, String> =
        pairs.map(|(name, value)| (name.to_lowercase(), value.to_owned())).collect();
    let (body, is_whole) = body(&mut stream, &headers);
    Ok(Response { status, headers, body, is_whole })
}

/// The body after a head, and whether it is complete. The head of an answer to HEAD announces a body that does not come, and a
/// stream of news has no end.
fn body(stream: &mut TcpStream, headers: &BTreeMap<String, String>) -> (Vec<u8>, bool) {
    let mut bytes = Vec::new();
    if headers.get("content-type").is_some_and(|kind| kind == "text/event-stream") {
        return (bytes, false);
    }
    if headers.get("transfer-encoding").is_some_and(|kind| kind == "chunked") {
        let _ = stream.read_to_end(&mut bytes);
        return unchunked(&bytes);
    }
    let length = headers.get("content-length").map_or(0, |length| length.parse().unwrap());
    let _ = stream.take(length).read_to_end(&mut bytes);
    let is_whole = bytes.len() as u64 == length;
    (bytes, is_whole)
}

/// The content of chunks (RFC 9112, section 7.1), and whether the last one arrived.
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

/// A request.
#[derive(Clone, Debug)]
pub(crate) struct Request {
    pub(crate) port: u16,
    pub(crate) method: String,
    pub(crate) path: String,
    pub(crate) headers: Vec<(String, String)>,
    pub(crate) body: String,
}

impl Request {
    /// A request without any header.
    pub(crate) fn bare(port: u16, method: &str, path: &str) -> Self {
        Self {
            port,
            method: method.to_owned(),
            path: path.to_owned(),
            headers: Vec::new(),
            body: String::new(),
        }
    }

    pub(crate) fn with(mut self, name: &str, value: &str) -> Self {
        self.headers.retain(|(known, _)| known != name);
        self.headers.push((name.to_owned(), value.to_owned()));
        self
    }

    pub(crate) fn without(mut self, name: &str) -> Self {
        self.headers.retain(|(known, _)| known != name);
        self
    }

    pub(crate) fn send(&self) -> Response {
        let text = self.text();
        exchange(self.port, text.as_bytes()).unwrap_or_else(|error| panic!("no answer to {self:?}: {error}"))
    }

    /// Sends it until the answer contains `text`, and returns that answer's body.
    pub(crate) fn until(&self, text: &str) -> String {
        until_found(text, || {
            let answer = self.send().text();
            if answer.contains(text) { Ok(answer) } else { Err(answer) }
        })
    }

    /// Sends a scan until it is taken: a board is only seen once the station has looked for it.
    pub(crate) fn until_taken(self) {
        self.with("accept", "application/json").until("\"is_taken\":true");
    }

    /// The lines of an answer that does not end, including those of its head.
    pub(crate) fn lines(&self) -> impl Iterator<Item = String> + use<> {
        let mut stream = connected(self.port);
        stream.write_all(self.text().as_bytes()).unwrap();
        BufReader::new(stream).lines().map_while(Result::ok)
    }

    pub(super) fn text(&self) -> String {
        let mut text = format!("{} {} HTTP/1.1\r\n", self.method, self.path);
        for (name, value) in &self.headers {
            text += &format!("{name}: {value}\r\n");
        }
        if self.method == "POST" {
            text += &format!(
                "content-type: application/x-www-form-urlencoded\r\ncontent-length: {}\r\n",
                self.body.len()
            );
        }
        text + &format!("connection: close\r\n\r\n{}", self.body)
    }
}

/// A form value, percent-encoded.
pub(crate) fn escaped(text: &str) -> String {
    let escape = |byte: u8| {
        if byte.is_ascii_alphanumeric() { char::from(byte).to_string() } else { format!("%{byte:02X}") }
    };
    text.bytes().map(escape).collect()
}
