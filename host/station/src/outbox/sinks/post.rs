//! A web server as a sink: each run and each waiver is posted, with an idempotency key.

use std::collections::HashMap;
use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use ureq::http::{StatusCode, header};
use ureq::tls::{Certificate, RootCerts, TlsConfig};
use ureq::{Agent, Body, Proxy};

use super::letter::{Letter, letter};
use super::{SinkError, SinkSettingsError};
use crate::export::Format;
use crate::outbox::{Sink, Undelivered};
use crate::secret;
use crate::settings::SinkAddress;
use crate::store::Parcel;
use crate::trust;

/// How long a request may take, its answer included.
const DEADLINE: Duration = Duration::from_secs(30);
/// How often in a row a try may be said to be in progress: for about an hour, as retries follow each other.
const MOST_IN_PROGRESS: u32 = 20;
/// How many characters of an answer are reported.
const TOLD: usize = 500;
/// The header by which a server knows what it has been given before (draft-ietf-httpapi-idempotency-key-header).
const IDEMPOTENCY_KEY: &str = "Idempotency-Key";

/// A web server.
#[derive(Debug)]
pub(super) struct PostSink {
    name: String,
    url: String,
    host: String,
    format: Format,
    /// What lets the station in.
    token: Option<String>,
    agent: Agent,
    /// How often in a row it said of a document, by its id, that an earlier try is in progress.
    in_progress: HashMap<String, u32>,
}

impl PostSink {
    /// The server at `address`, behind `proxy` if there is one, which is given the token in the file `token`.
    pub(super) fn new(
        name: String,
        address: &SinkAddress,
        format: Format,
        token: Option<&Path>,
        proxy: Option<&Proxy>,
    ) -> Result<Self, SinkSettingsError> {
        let token = token.map(read).transpose()?;
        let mut config = Agent::config_builder()
            .timeout_global(Some(DEADLINE))
            .http_status_as_error(false)
            .max_redirects(0)
            .max_redirects_will_error(false)
            // A proxy that the environment names for all programs is not one of this station's settings.
            .proxy(proxy.cloned())
            .user_agent(format!("halfrow-station/{}", halfrow::VERSION));
        if address.is_protected {
            let trusted = trust::certificates(address.ca.as_deref())?;
            let roots: Vec<_> = trusted.iter().map(|one| Certificate::from_der(one).to_owned()).collect();
            let tls = TlsConfig::builder()
                .unversioned_rustls_crypto_provider(trust::provider())
                .root_certs(RootCerts::Specific(Arc::new(roots)));
            config = config.tls_config(tls.build());
        }
        let (url, host) = (address.url.clone(), address.host.clone());
        Ok(Self {
            name,
            url,
            host,
            format,
            token,
            agent: config.build().new_agent(),
            in_progress: HashMap::new(),
        })
    }

    fn post(&mut self, Letter { id, media, bytes, .. }: &Letter) -> Result<(), SinkError> {
        let mut request = self
            .agent
            .post(&self.url)
            .header(header::CONTENT_TYPE, *media)
            .header(IDEMPOTENCY_KEY, format!("\"{id}\""));
        if let Some(token) = &self.token {
            request = request.header(header::AUTHORIZATION, format!("Bearer {token}"));
        }
        let answer = request.send(bytes.as_slice());
        let unconnected = |error: ureq::Error| SinkError::unconnected(&self.host, error.into());
        let (parts, body) = answer.map_err(unconnected)?.into_parts();
        // It is counted anew when the document was refused and a person has released it.
        let in_progress = self.in_progress.remove(id).unwrap_or(0);
        if parts.status == StatusCode::CONFLICT && in_progress < MOST_IN_PROGRESS {
            self.in_progress.insert(id.clone(), in_progress + 1);
        }
        self.judged(parts.status, body, in_progress)
    }

    /// What an answer means: the server has this, takes nothing for now, takes nothing at all, or does not take this.
    /// `in_progress` counts the answers before it that said only that an earlier try is in progress.
    fn judged(&self, answered: StatusCode, body: Body, in_progress: u32) -> Result<(), SinkError> {
        let (host, status) = (self.host.clone(), answered.as_u16());
        match status {
            200..=299 => Ok(()),
            // It is still working on the same key (draft-ietf-httpapi-idempotency-key-header-07, section 2.7), as after
            // DEADLINE.
            409 if in_progress < MOST_IN_PROGRESS => Err(SinkError::Busy { host, status }),
            // What comes before an answer (RFC 9110, section 15.2) says nothing yet.
            100..=199 | 408 | 425 | 429 | 500..=599 => Err(SinkError::Busy { host, status }),
            300..=399 | 401 | 403 | 407 => Err(SinkError::Closed { host, status }),
            _ => Err(SinkError::Rejected { host, status, answer: beginning(body, self.token.as_deref()) }),
        }
    }
}

/// The token in the file `path`.
fn read(path: &Path) -> Result<String, SinkSettingsError> {
    let text = secret::text(path)?;
    let token = text.trim();
    if !token.bytes().all(|byte| byte.is_ascii_graphic()) {
        return Err(SinkSettingsError::Token { path: path.to_owned() });
    }
    Ok(token.to_owned())
}

/// The beginning of an answer, in one line. It is without the token, because a server may repeat everything that it
/// was sent.
fn beginning(body: Body, token: Option<&str>) -> String {
    let (mut bytes, length) = (Vec::new(), token.map_or(0, str::len));
    // A token that begins in what is reported is read whole; a character has at most four bytes.
    let most = u64::try_from(4 * TOLD + length).unwrap_or(u64::MAX);
    // Even a part of it says something.
    let _ = body.into_reader().take(most).read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes);
    let text = match token {
        Some(token) => without(&text, token),
        None => text.chars().take(TOLD).collect(),
    };
    text.split(|letter: char| letter.is_whitespace() || letter.is_control())
        .filter(|word| !word.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
}

/// The first [`TOLD`] characters of `text`, with `…` for each `token` that begins in them.
fn without(text: &str, token: &str) -> String {
    let (mut told, mut left) = (String::new(), TOLD);
    for piece in text.split(token) {
        told.extend(piece.chars().take(left));
        left = left.saturating_sub(piece.chars().count());
        if left == 0 {
            return told;
        }
        told.push('…');
        left = left.saturating_sub(token.len());
    }
    // There is no token after the last piece.
    told.pop();
    told
}

impl Sink for PostSink {
    fn name(&self) -> &str {
        &self.name
    }

    fn take(&mut self, parcel: &Parcel) -> Result<(), Undelivered> {
        let Some(letter) = letter(parcel, self.format).map_err(Undelivered::from)? else { return Ok(()) };
        Ok(self.post(&letter)?)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead as _, BufReader, Write as _};
    use std::net::TcpListener;
    use std::thread;

    use super::*;
    use crate::record::tests::pass;

    /// No try is in progress for so long: the server means something else, and somebody has to look at it.
    #[test]
    fn what_is_said_to_be_in_progress_for_an_hour_waits_for_a_person() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        thread::spawn(move || {
            for mut client in listener.incoming().map(Result::unwrap) {
                let mut reader = BufReader::new(client.try_clone().unwrap());
                let head: Vec<_> =
                    reader.by_ref().lines().map(Result::unwrap).take_while(|line| !line.is_empty()).collect();
                let length = head
                    .iter()
                    .find_map(|line| line.to_lowercase().strip_prefix("content-length: ")?.parse().ok());
                reader.read_exact(&mut vec![0; length.unwrap()]).unwrap();
                let answer =
                    "HTTP/1.1 409 Conflict\r\ncontent-length: 10\r\nconnection: close\r\n\r\nlot closed";
                client.write_all(answer.as_bytes()).unwrap();
            }
        });
        let url = format!("http://127.0.0.1:{port}/");
        let (host, path) = ("127.0.0.1".to_owned(), "/".to_owned());
        let address = SinkAddress { url, host, port, path, is_protected: false, ca: None };
        let mut sink = PostSink::new("mes".to_owned(), &address, Format::Record, None, None).unwrap();
        let mut take = |id: &str| {
            let mut record = pass();
            record.run.id = id.to_owned();
            let (record, text, sha256) = (Box::new(record), "{}".to_owned(), String::new());
            sink.take(&Parcel::Run { record, text, sha256 }).unwrap_err()
        };
        for _ in 0..MOST_IN_PROGRESS {
            assert!(matches!(take("a"), Undelivered::NotNow(_)));
        }
        let refused = take("a");
        assert!(
            matches!(&refused, Undelivered::Refused(said) if said.message.contains("lot closed")),
            "{refused:?}"
        );
        assert!(matches!(take("b"), Undelivered::NotNow(_)), "another one");
        assert!(matches!(take("a"), Undelivered::NotNow(_)), "once a person has released it");
    }
}
