//! An MQTT 3.1.1 broker as a sink: each run and each waiver is an event, for dashboards. An event is not a result, so
//! what is older than an hour is not sent any more.

use std::time::{Duration, Instant};

use rumqttc::{
    Client, ClientError, ConnectReturnCode, Connection, ConnectionError, Event, MqttOptions, Packet,
    PublishOptions, QoS, TlsConfiguration, Transport,
};
use serde::Serialize;

use super::{SinkError, SinkSettingsError};
use crate::clock;
use crate::outbox::{Sink, Undelivered};
use crate::record::Record;
use crate::said::Said;
use crate::secret;
use crate::settings::{Login, SinkAddress};
use crate::store::{Parcel, Waiver};
use crate::trust;

/// The version of an event's own document.
const SCHEMA: u32 = 1;
/// What is older is not sent, in milliseconds.
const OLDEST_MS: i64 = 3_600_000;
/// How long the broker may take to confirm an event.
const CONFIRMED: Duration = Duration::from_secs(10);
/// The most bytes of an event: the longest that MQTT 3.1.1 has lengths for (section 2.2.3); a broker may take less.
const MOST: usize = 268_435_455;
/// How often a broker hears that the station is there, in seconds.
const ALIVE: u16 = 60;

/// A broker, which is connected to when there is something to send.
pub(super) struct EventSink {
    name: String,
    station: String,
    host: String,
    /// What every topic begins with.
    prefix: String,
    options: MqttOptions,
    connected: Option<(Client, Connection)>,
}

/// A run that is over.
#[derive(Serialize)]
struct RunEvent<'a> {
    schema: u32,
    run: &'a str,
    station: &'a str,
    lane: &'a str,
    product: &'a str,
    serial: &'a str,
    plan: &'a str,
    version: &'a str,
    verdict: String,
    cause: &'a str,
    headline: &'a str,
    /// The headline with its code.
    finding: Option<&'a Said>,
    started_ms: i64,
    ended_ms: i64,
    /// Whether it counts as production.
    production: bool,
    /// What kind of board was judged, if it said so.
    board_kind: Option<&'a str>,
}

impl<'a> RunEvent<'a> {
    fn of(Record { run, plan, conclusion, ended_ms, production, board, .. }: &'a Record) -> Self {
        Self {
            schema: SCHEMA,
            run: &run.id,
            station: &run.station,
            lane: &run.lane,
            product: &run.product,
            serial: &run.serial,
            plan: &plan.name,
            version: &plan.version,
            verdict: conclusion.verdict.to_string(),
            cause: conclusion.cause.as_ref(),
            headline: &conclusion.headline,
            finding: conclusion.finding.as_ref(),
            started_ms: run.started_ms,
            ended_ms: *ended_ms,
            production: *production,
            board_kind: board.as_ref().map(|board| board.kind.as_str()),
        }
    }
}

/// A waiver.
#[derive(Serialize)]
struct WaiverEvent<'a> {
    schema: u32,
    station: &'a str,
    #[serde(flatten)]
    waiver: &'a Waiver,
}

impl EventSink {
    /// A client of the broker at `address` for the station `station`, which logs in by `login` if there is one.
    pub(super) fn new(
        name: String,
        station: &str,
        address: &SinkAddress,
        login: Option<&Login>,
    ) -> Result<Self, SinkSettingsError> {
        // No sink's name has a dot, so the station's is all that is before the last one.
        let client = format!("halfrow-{station}.{name}");
        let mut options = MqttOptions::new(client, (address.host.clone(), address.port));
        options.set_keep_alive(ALIVE).set_clean_session(true);
        options.set_max_packet_size(options.max_packet_size(), MOST);
        if let Some(Login { user, password }) = login {
            let password = secret::text(password)?.trim_end_matches(['\r', '\n']).to_owned();
            options.set_credentials(user, password);
        }
        if address.is_protected {
            let trusted = trust::client(address.ca.as_deref())?;
            options.set_transport(Transport::tls_with_config(TlsConfiguration::Rustls(trusted.into())));
        }
        let (host, prefix) = (address.host.clone(), address.path.trim_matches('/').to_owned());
        Ok(Self { name, station: station.to_owned(), host, prefix, options, connected: None })
    }

    /// The event of a parcel and its topic; `None` for what is old or is no event.
    fn event(&self, parcel: &Parcel) -> Result<Option<(String, Vec<u8>)>, serde_json::Error> {
        let oldest_ms = clock::now_ms().saturating_sub(OLDEST_MS);
        Ok(match parcel {
            Parcel::Run { record, .. } if record.ended_ms >= oldest_ms => {
                let topic = self.topic(&[&record.run.lane, "run"]);
                Some((topic, serde_json::to_vec(&RunEvent::of(record))?))
            }
            Parcel::Waiver { waiver, .. } if waiver.at_ms >= oldest_ms => {
                let event = WaiverEvent { schema: SCHEMA, station: &self.station, waiver };
                Some((self.topic(&["waiver"]), serde_json::to_vec(&event)?))
            }
            Parcel::Run { .. } | Parcel::Waiver { .. } | Parcel::Audit(_) => None,
        })
    }

    /// The prefix, the station and these words. In names, separators of topics and wildcards become hyphens.
    fn topic(&self, words: &[&str]) -> String {
        let prefix = (!self.prefix.is_empty()).then(|| self.prefix.clone());
        let names = [self.station.as_str()].into_iter().chain(words.iter().copied());
        let names = names.map(|name| name.replace(['/', '+', '#', '\0'], "-"));
        prefix.into_iter().chain(names).collect::<Vec<_>>().join("/")
    }

    /// Publishes an event, and waits until the broker has confirmed it.
    fn tell(&mut self, topic: &str, event: Vec<u8>) -> Result<(), SinkError> {
        if let Some(kept) = self.connected.take() {
            match self.publish(kept, topic, event.clone()) {
                // It may have ended long ago.
                Err(SinkError::Dropped { .. } | SinkError::Unreached { .. }) => {}
                told => return told,
            }
        }
        self.publish(Client::builder(self.options.clone()).capacity(4).build(), topic, event)
    }

    fn publish(
        &mut self,
        (client, mut connection): (Client, Connection),
        topic: &str,
        event: Vec<u8>,
    ) -> Result<(), SinkError> {
        let (bytes, mut is_in) = (event.len(), false);
        let how = PublishOptions::new(QoS::AtLeastOnce);
        let unreached =
            |error: ClientError| SinkError::Unreached { host: self.host.clone(), source: error.into() };
        client.try_publish(topic, event, how).map_err(unreached)?;
        let until = Instant::now() + CONFIRMED;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let Ok(happened) = connection.recv_timeout(left) else {
                return Err(SinkError::Unconfirmed { host: self.host.clone(), seconds: CONFIRMED.as_secs() });
            };
            match happened {
                Ok(Event::Incoming(Packet::ConnAck(_))) => is_in = true,
                // Only one is under way at a time.
                Ok(Event::Incoming(Packet::PubAck(_))) => {
                    self.connected = Some((client, connection));
                    return Ok(());
                }
                Ok(_) => {}
                Err(error) if is_in => {
                    let (host, source) = (self.host.clone(), error.into());
                    return Err(SinkError::Dropped { host, bytes, source });
                }
                Err(error) => return Err(refused(&self.host, error)),
            }
        }
    }
}

/// The error of a connection that was not established, or ended.
fn refused(host: &str, error: ConnectionError) -> SinkError {
    use ConnectReturnCode::{BadUserNamePassword, NotAuthorized};
    match error {
        ConnectionError::ConnectionRefused(code @ (BadUserNamePassword | NotAuthorized)) => {
            SinkError::Unknown { host: host.to_owned(), said: format!("{code:?}") }
        }
        error => SinkError::unconnected(host, error.into()),
    }
}

impl Sink for EventSink {
    fn name(&self) -> &str {
        &self.name
    }

    fn take(&mut self, parcel: &Parcel) -> Result<(), Undelivered> {
        let event = self.event(parcel).map_err(|error| SinkError::Export(error.into()));
        let Some((topic, event)) = event.map_err(Undelivered::from)? else { return Ok(()) };
        Ok(self.tell(&topic, event)?)
    }

    fn rest(&mut self) {
        if let Some((client, mut connection)) = self.connected.take()
            && client.try_disconnect_now().is_ok()
        {
            // If the broker is gone, nothing more need be said.
            let _ = connection.recv_timeout(Duration::from_millis(200));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::{Value, json};

    use super::*;
    use crate::record::RunHead;
    use crate::record::tests::pass;

    fn sink(name: &str, station: &str, path: &str) -> EventSink {
        let (url, host) = ("mqtt://broker/x".to_owned(), "broker".to_owned());
        let address =
            SinkAddress { url, host, port: 1883, path: path.to_owned(), is_protected: false, ca: None };
        EventSink::new(name.to_owned(), station, &address, None).unwrap()
    }

    /// What a dashboard shows of it must be of this board and this run.
    #[test]
    fn an_event_says_of_a_run_what_its_record_says() {
        let run = RunHead { started_ms: 1_000, lane: "left".to_owned(), ..pass().run };
        let event: Value =
            serde_json::to_value(RunEvent::of(&Record { run, ended_ms: 2_500, ..pass() })).unwrap();
        let told = json!({
            "schema": 1,
            "run": "017f22e2-79b0-7cc3-98c4-dc0c0c07398f",
            "station": "12",
            "lane": "left",
            "product": "CAM-A",
            "serial": "CA1",
            "plan": "n",
            "version": "1",
            "verdict": "PASS",
            "cause": "none",
            "headline": "all is right",
            "finding": null,
            "started_ms": 1_000,
            "ended_ms": 2_500,
            "production": true,
            "board_kind": null,
        });
        assert_eq!(event, told);
    }

    /// A topic to which something is published has no wildcard (MQTT 3.1.1, section 4.7.1), and another level makes it
    /// another topic.
    #[test]
    fn a_name_adds_no_level_and_no_wildcard_to_a_topic() {
        assert_eq!(sink("wall", "a/b+c#", "/hall/").topic(&["1\0", "run"]), "hall/a-b-c-/1-/run");
        assert_eq!(sink("wall", "12", "/").topic(&["waiver"]), "12/waiver");
    }

    /// A broker ends the earlier of two connections with the same client id (MQTT 3.1.1, section 3.1.4).
    #[test]
    fn two_sinks_are_two_clients_of_a_broker() {
        let clients = [("wall", "12"), ("office", "12"), ("c", "a-b"), ("b-c", "a"), ("c", "a.b")];
        let ids = clients.map(|(name, station)| sink(name, station, "/").options.client_id());
        assert_eq!(BTreeSet::from(ids.clone()).len(), clients.len(), "{ids:?}");
    }
}
