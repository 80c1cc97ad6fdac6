//! The crate against the frozen vectors: every field of every packet, every damage, and the bytes that the crate sends.

// clippy.toml allows this in #[test] functions, but not in the functions that they call.
#![allow(clippy::expect_used)]

mod vector_file;

use std::collections::BTreeMap;

use halfrow_protocol::message::{
    Bursts, Capabilities, Entries, Expect, FrameRecord, MAGIC, NODE_WEIGHTS, Records, Refusal, RowIn, RowOut,
    RowPlace, Shape, Span, Table, TrappedRow,
};
use halfrow_protocol::{Damage, Decoder, Encoder, Header, Kind, Malformed, Packet, Reply, Request, samples};

/// The fields of a packet, or its damage, by the keys that they have in the head of a vector.
type Keys = BTreeMap<String, String>;

/// Payload fields by their names in WIRE.md.
type Fields = Vec<(&'static str, String)>;

struct Vector {
    name: String,
    from_host: bool,
    canonical: bool,
    expected: Vec<Keys>,
    bytes: Vec<u8>,
}

impl Vector {
    fn parse((name, text): (String, String)) -> Self {
        let bytes = vector_file::bytes(&text);
        let mut vector = Self { name, from_host: false, canonical: false, expected: Vec::new(), bytes };
        let head = text.lines().filter_map(|line| line.strip_prefix("// ")?.split_once(" ="));
        for (key, value) in head.filter(|(key, _)| !key.contains(' ')) {
            vector.take(key, value.trim());
        }
        vector
    }

    fn take(&mut self, key: &str, value: &str) {
        if key == "direction" {
            self.from_host = value == "host";
        } else if key == "canonical" {
            self.canonical = value == "yes";
        } else {
            if key == "kind" || key == "damage" {
                self.expected.push(Keys::new());
            }
            let event = self.expected.last_mut().expect("a kind or a damage first");
            let value = value.split(' ').map(decimal).collect::<Vec<_>>().join(" ");
            event.entry(key.into()).and_modify(|list| *list += &format!(" {value}")).or_insert(value);
        }
    }
}

fn decimal(word: &str) -> String {
    let number = word.strip_prefix("0x").and_then(|digits| u64::from_str_radix(digits, 16).ok());
    number.map_or(word.into(), |number| number.to_string())
}

fn all() -> Vec<Vector> {
    vector_file::read_all().into_iter().map(Vector::parse).collect()
}

macro_rules! fields {
    ($of:expr; $($name:ident)*) => { vec![$((stringify!($name), $of.$name.to_string())),*] };
}

fn list(items: impl IntoIterator<Item = impl ToString>) -> String {
    items.into_iter().map(|item| item.to_string()).collect::<Vec<_>>().join(" ")
}

fn hex(bytes: &[u8]) -> String {
    list(bytes.iter().map(|byte| format!("{byte:02x}")))
}

fn span_fields(span: Span) -> Fields {
    let mut fields = fields![span; port first count];
    fields.extend([("table", (span.table as u8).to_string()), ("bank", (span.bank as u8).to_string())]);
    fields
}

fn entries_fields(entries: Entries<'_>) -> Fields {
    let values = match entries.span.table {
        Table::RowFactors | Table::Grid => list(entries.row_factors()),
        Table::Kernel => list(entries.nodes().flat_map(<[i16; NODE_WEIGHTS]>::into_iter)),
    };
    [span_fields(entries.span), vec![("entries", values)]].concat()
}

fn unpacked(packed: &[u8], width: u16) -> String {
    let mut row = vec![0; usize::from(width)];
    samples::unpack(packed, &mut row);
    list(row)
}

fn row_fields(place: RowPlace, generation: u8, packed: &[u8]) -> Fields {
    let mut fields = fields![place; row_sequence frame row width];
    fields.push(("flags", u8::from(place.last).to_string()));
    fields.extend([("generation", generation.to_string()), ("samples", unpacked(packed, place.width))]);
    fields
}

/// The numbers of a record, in the order of its bytes.
fn record_numbers(record: FrameRecord) -> [u32; 8] {
    let FrameRecord { signature, samples, rows, least_latency, most_latency, pauses, generation, held_back } =
        record;
    let words = [rows, least_latency, most_latency, pauses].map(u32::from);
    let [rows, least_latency, most_latency, pauses] = words;
    [signature, samples, rows, least_latency, most_latency, pauses, generation.into(), held_back.into()]
}

fn records_fields(records: &Records<'_>) -> Fields {
    let fields = fields![records; burst from];
    let state = ("state", (records.state as u8).to_string());
    let count = ("count", records.bytes.len().to_string());
    [fields, vec![state, count, ("records", list(records.records().flat_map(record_numbers)))]].concat()
}

fn trap_fields(kept: Option<&TrappedRow<'_>>) -> Fields {
    let mut fields = vec![("kept", u8::from(kept.is_some()).to_string())];
    if let Some(row @ TrappedRow { width, packed, .. }) = kept {
        fields.extend(fields![row; frame row width signature]);
        fields.push(("samples", unpacked(packed, *width)));
    }
    fields
}

fn capability_fields(board: &Capabilities) -> Fields {
    let mut fields = fields![board; datapath max_width max_height depths taps latency ring least_blanking
        table_banks row_banks_in row_banks_out step_ports kernel_ports clock_source clock_hz];
    if let Some(bursts @ Bursts { trap, .. }) = &board.bursts {
        fields.extend(fields![bursts; content records least_frame_blanking]);
        fields.push(("trap", u8::from(*trap).to_string()));
    }
    fields.extend(board.entered.then(|| ("entered", "1".into())));
    if let Some(grids) = &board.grids {
        fields.extend(fields![grids; further_datapath entries ks grid_blanking grid_width]);
    }
    fields.push(("nature", (board.nature as u8).to_string()));
    // A board without a name sends none; the crate reads this as an empty name.
    fields.extend((!board.name.is_empty()).then(|| ("name", board.name.clone())));
    fields
}

fn request_fields(request: &Request<'_>) -> Fields {
    match *request {
        Request::Hello(hello) => {
            let take_over = ("take_over", u8::from(hello.take_over).to_string());
            [fields![hello; nonce host version_min version_max], vec![take_over]].concat()
        }
        Request::Capabilities | Request::RowAck | Request::Trap => vec![],
        Request::Status { clear } => vec![("clear", u8::from(clear).to_string())],
        Request::Reset(reset) => {
            [fields![reset; next_row], vec![("level", (reset.level as u8).to_string())]].concat()
        }
        Request::Echo(bytes) => vec![("bytes", hex(bytes))],
        Request::TableWrite(entries) => entries_fields(entries),
        Request::TableRead(span) | Request::TableCrc(span) => span_fields(span),
        Request::Commit(commit) => {
            let shape = commit.shape.iter().flat_map(|shape: &Shape| fields![shape; v k]);
            fields![commit; steps_crc kernel_crc first_frame generation].into_iter().chain(shape).collect()
        }
        Request::Configure(set) => fields![set; width height centre2 blanking gap_seed bits],
        // A host's rows have no generation; the crate sends 0 and ignores what it reads.
        Request::RowIn(RowIn { place, packed }) => row_fields(place, 0, packed),
        Request::Burst(burst) => {
            let mode = ("mode", (burst.mode as u8).to_string());
            [fields![burst; burst frames seed first_frame frame_blanking], vec![mode]].concat()
        }
        Request::Records { from } => vec![("from", from.to_string())],
        Request::Expect(expect @ Expect { first, bytes }) => vec![
            ("first", first.to_string()),
            ("count", bytes.len().to_string()),
            ("signatures", list(expect.signatures())),
        ],
    }
}

fn reply_fields(reply: &Reply<'_>) -> Fields {
    match reply {
        Reply::Hello(welcome) => {
            [fields![welcome; nonce version session build serial], vec![("magic", hex(&MAGIC))]].concat()
        }
        Reply::Capabilities(board) => capability_fields(board),
        Reply::Status(status) => {
            status.counters().into_iter().map(|(name, count)| (name, count.to_string())).collect()
        }
        Reply::Reset | Reply::TableWrite | Reply::Configure | Reply::Burst | Reply::Expect => vec![],
        Reply::Echo(bytes) => vec![("bytes", hex(bytes))],
        Reply::TableRead(entries) => entries_fields(*entries),
        Reply::TableCrc(crc) => vec![("crc", crc.to_string())],
        Reply::Commit { generation } => vec![("generation", generation.to_string())],
        Reply::RowOut(row @ RowOut { place, generation, packed, .. }) => {
            let latencies = fields![row; first_latency last_latency pauses repeats];
            let entered = row.entered.map(|crc| ("entered", crc.to_string()));
            [row_fields(*place, *generation, packed), latencies, Vec::from_iter(entered)].concat()
        }
        Reply::Records(records) => records_fields(records),
        Reply::Trap(kept) => trap_fields(kept.as_ref()),
        Reply::Refusal(refusal @ Refusal { code, .. }) => {
            [fields![refusal; kind detail], vec![("code", (*code as u8).to_string())]].concat()
        }
    }
}

fn payload_keys(message: Result<Fields, Malformed>) -> Keys {
    match message {
        Ok(fields) => fields.into_iter().map(|(name, value)| (format!("payload.{name}"), value)).collect(),
        Err(Malformed::Kind(_)) => Keys::from([("refused".into(), "kind".into())]),
        Err(_) => Keys::from([("refused".into(), "payload".into())]),
    }
}

fn packet_keys(packet: &Packet<'_>, from_host: bool) -> Keys {
    let mut keys = payload_keys(if from_host {
        Request::read(packet).as_ref().map(request_fields).map_err(|&error| error)
    } else {
        Reply::read(packet).as_ref().map(reply_fields).map_err(|&error| error)
    });
    let Header { reply, .. } = packet.header;
    let header = fields![packet.header; kind sequence session window];
    keys.extend(header.into_iter().map(|(name, value)| (name.into(), value)));
    keys.insert("reply".into(), u8::from(reply).to_string());
    keys.insert("length".into(), packet.payload.len().to_string());
    keys
}

/// A damage by its name in the vectors.
fn damage_keys(damage: Damage) -> Keys {
    let name = match damage {
        Damage::Stuffing => "stuffing",
        Damage::Size => "size",
        Damage::Crc => "crc",
        Damage::Version(_) => "version",
        Damage::Length => "length",
    };
    Keys::from([("damage".into(), name.into())])
}

fn decode(vector: &Vector) -> Vec<Keys> {
    let (mut decoder, mut input, mut found) = (Decoder::new(), vector.bytes.as_slice(), Vec::new());
    while let Some(event) = decoder.next(&mut input) {
        found.push(match event {
            Ok(packet) => packet_keys(&packet, vector.from_host),
            Err(damage) => damage_keys(damage),
        });
    }
    found
}

/// The bytes of a canonical vector's packet after it was read and written again.
fn resend(vector: &Vector) -> Vec<u8> {
    let (mut decoder, mut wire) = (Decoder::new(), Vec::new());
    let packet = decoder.next(&mut vector.bytes.as_slice()).expect("an event").expect("a packet");
    let write = |payload: &mut Vec<u8>| {
        if vector.from_host {
            Request::read(&packet).expect("a request").write(payload);
        } else {
            Reply::read(&packet).expect("a reply").write(payload);
        }
    };
    Encoder::new().encode(&packet.header, write, &mut wire).expect("a payload that fits");
    wire
}

#[test]
fn every_vector_decodes_to_the_fields_and_damages_of_its_head() {
    for vector in all() {
        assert_eq!(decode(&vector), vector.expected, "{}", vector.name);
    }
}

#[test]
fn a_canonical_packet_is_sent_with_the_bytes_of_its_vector() {
    for vector in all().into_iter().filter(|vector| vector.canonical) {
        assert_eq!(resend(&vector), vector.bytes, "{}", vector.name);
    }
}

#[test]
fn every_kind_has_a_vector_in_each_direction_that_it_goes() {
    let has = |kind: Kind, from_host: bool| {
        let code = kind.code().to_string();
        all().iter().any(|vector| {
            vector.canonical && vector.from_host == from_host && vector.expected[0]["kind"] == code
        })
    };
    for kind in Kind::ALL {
        let (host, board) = match kind {
            Kind::RowIn | Kind::RowAck => (true, false),
            Kind::RowOut | Kind::Refusal => (false, true),
            _ => (true, true),
        };
        assert_eq!((has(kind, true), has(kind, false)), (host, board), "{kind:?}");
    }
}

#[test]
fn every_refusal_code_has_a_vector() {
    let mut codes: Vec<u8> =
        all().iter().filter_map(|vector| vector.expected[0].get("payload.code")?.parse().ok()).collect();
    codes.sort_unstable();
    assert_eq!(codes, (1..=12).collect::<Vec<_>>());
}

#[test]
fn a_trap_either_has_a_row_or_none() {
    let vector = all().into_iter().find(|vector| vector.name == "trap-reply.hex").expect("its vector");
    let (mut decoder, mut input) = (Decoder::new(), vector.bytes.as_slice());
    let packet = decoder.next(&mut input).expect("an event").expect("a packet");
    let mut payload = packet.payload.to_vec();
    payload[0] = 2;
    let packet = Packet { header: packet.header, payload: &payload };
    assert_eq!(Reply::read(&packet), Err(Malformed::Value { field: "kept", value: 2 }));
}

#[test]
fn a_reply_to_hello_with_another_magic_is_no_halfrow_boards() {
    let vector = all().into_iter().find(|vector| vector.name == "hello-reply.hex").expect("its vector");
    let (mut decoder, mut input) = (Decoder::new(), vector.bytes.as_slice());
    let packet = decoder.next(&mut input).expect("an event").expect("a packet");
    for place in 4..8 {
        let mut payload = packet.payload.to_vec();
        payload[place] ^= 0x20;
        let packet = Packet { header: packet.header, payload: &payload };
        assert_eq!(Reply::read(&packet), Err(Malformed::Magic), "byte {place}");
    }
}
