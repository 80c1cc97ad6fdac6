//! A web server as a sink: each run and each waiver is posted, with an idempotency key.

use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use ureq::http::{StatusCode, header};
use ureq::tls::{Certificate, RootCerts, TlsConfig};
use ureq::{Agent, Body};

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
/// How much of an answer is told.
const TOLD: u64 = 500;
/// By which a server knows what it has been given before (draft-ietf-httpapi-idempotency-key-header).
const IDEMPOTENCY_KEY: &str = "Idempotency-Key";

/// A web server.
#[derive(Debug)]
pub(super) struct PostSink {
    name: String,
    url: String,
    host: String,
    format: Format,
    /// What lets the station in.
    authorization: Option<String>,
    agent: Agent,
}

impl PostSink {
    /// The server at `address`, which is told the token in the file `token`.
    pub(super) fn new(
        name: String,
        address: &SinkAddress,
        format: Format,
        token: Option<&Path>,
    ) -> Result<Self, SinkSettingsError> {
        let authorization = match token {
            Some(path) => Some(format!("Bearer {}", secret::text(path)?.trim())),
            None => None,
        };
        let mut config = Agent::config_builder()
            .timeout_global(Some(DEADLINE))
            .http_status_as_error(false)
            .max_redirects(0)
            .max_redirects_will_error(false)
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
        Ok(Self { name, url, host, format, authorization, agent: config.build().new_agent() })
    }

    fn post(&self, Letter { id, media, bytes, .. }: &Letter) -> Result<(), SinkError> {
        let mut request = self
            .agent
            .post(&self.url)
            .header(header::CONTENT_TYPE, *media)
            .header(IDEMPOTENCY_KEY, format!("\"{id}\""));
        if let Some(authorization) = &self.authorization {
            request = request.header(header::AUTHORIZATION, authorization);
        }
        let answer = request.send(bytes.as_slice());
        let unreached = |source| SinkError::Unreached { host: self.host.clone(), source: Box::new(source) };
        let (parts, body) = answer.map_err(unreached)?.into_parts();
        self.judged(parts.status, body)
    }

    /// What an answer means: whether it has this, takes nothing for now, takes nothing at all, or does not take this.
    fn judged(&self, answered: StatusCode, body: Body) -> Result<(), SinkError> {
        let (host, status) = (self.host.clone(), answered.as_u16());
        match status {
            200..=299 => Ok(()),
            // It is still at work with the same key (draft-ietf-httpapi-idempotency-key-header-07, section 2.7), as after DEADLINE.
            408 | 409 | 425 | 429 | 500..=599 => Err(SinkError::Busy { host, status }),
            300..=399 | 401 | 403 | 407 => Err(SinkError::Closed { host, status }),
            _ => Err(SinkError::Rejected { host, status, answer: beginning(body) }),
        }
    }
}

/// The first words of an answer, in one line.
fn beginning(body: Body) -> String {
    let mut bytes = Vec::new();
    // What there is of it tells something.
    let _ = body.into_reader().take(TOLD).read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes);
    text.split(|letter: char| letter.is_whitespace() || letter.is_control())
        .filter(|word| !word.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
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
