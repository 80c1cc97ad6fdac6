//! Spoilt recordings, and clocks that go back as theirs do.

use std::cell::Cell;
use std::time::Duration;

use halfrow::link::{Candidate, Link, LinkError, RecordingFile};
use halfrow::progress::Silent;
use halfrow::run::{RecordedRun, RunOptions, verify};
use halfrow::target::Target;
use halfrow::verdict::Verdict;
use halfrow_protocol::message::{Commit, Refusal, RefusalCode};
use halfrow_protocol::{Encoder, Header, Kind, Reply, Request};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::dice::Dice;
use halfrow_tests::program::Folder;
use halfrow_tests::system::{System, open};

/// Where the exchanges of a recording begin: after the magic and one line.
fn first_exchange(recording: &[u8]) -> usize {
    let mut lines =
        recording.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(place, _)| place + 1);
    lines.nth(1).unwrap()
}

/// Replaces the time of every exchange of a recording.
fn retimed(recording: &[u8], mut time: impl FnMut(u64) -> u64) -> Vec<u8> {
    let (mut spoilt, mut at) = (recording.to_vec(), first_exchange(recording));
    while let Some(head) = recording.get(at..at + 16) {
        let then = u64::from_le_bytes(head[..8].try_into().unwrap());
        let length = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap()) as usize;
        spoilt[at..at + 8].copy_from_slice(&time(then).to_le_bytes());
        at += 16 + length(&head[8..12]) + length(&head[12..16]);
    }
    spoilt
}

#[test]
fn a_recording_whose_times_go_back_is_judged_or_refused() {
    let folder = Folder::new();
    let small = ["--width", "64", "--height", "8", "--frame", "builtin:noise", "--record", "sound.rec"];
    let call = ["verify", "--json", "--board", "mock,speed=100000,delay=0.01"];
    folder.halfrow(call.into_iter().chain(small)).succeeded();
    let sound = folder.read("sound.rec");
    let mut dice = Dice::new(11);
    let last = 1_000_000_000_000;
    let mut wild = |_| dice.below(5_000_000_000) as u64;
    let mut back = 0;
    for (name, spoilt) in [
        (
            "back and forth",
            retimed(&sound, |then| {
                back = 20_000_000 - back;
                then.saturating_sub(back)
            }),
        ),
        ("backwards", retimed(&sound, |then| last - then)),
        ("never", retimed(&sound, |_| 0)),
        ("the end of time", retimed(&sound, |then| u64::MAX - then)),
        ("wild", retimed(&sound, &mut wild)),
        ("wilder", retimed(&sound, &mut wild)),
    ] {
        folder.write("spoilt.rec", &spoilt);
        let ended = folder.halfrow(["verify", "--json", "--board", "replay:spoilt.rec"]);
        assert!(matches!(ended.code, Some(0 | 3)), "{name}: {:?} {}", ended.code, ended.stderr);
    }
}

/// Earlier programs did not ask a board for its counts, and their recordings do not say so.
#[test]
fn a_recording_of_a_run_that_asked_for_no_counts_is_judged_as_it_was() {
    let folder = Folder::new();
    let (plan, options) = (System::TINY.plan(), RunOptions { counts: false, ..RunOptions::default() });
    for board in ["mock", "mock,fault=stuck-data", "mock,fault=drop,rate=3e-5,seed=3"] {
        let (candidate, path) = (open(board), folder.path().join("run.rec"));
        let file = RecordingFile::prepare(&path, true).unwrap();
        let (candidate, _) = RecordedRun::begin(&plan, &options, candidate, Some(file)).unwrap();
        let report = verify(&plan, candidate, &options, &Silent).unwrap().report;
        let recording = folder.read("run.rec");
        let (head, exchanges) = recording.split_at(first_exchange(&recording));
        let earlier = std::str::from_utf8(head).unwrap().replace("\"counts\":false,", "");
        assert!(earlier.len() < head.len());
        folder.write("earlier.rec", [earlier.as_bytes(), exchanges].concat());
        let again = folder.halfrow(["verify", "--json", "--board", "replay:earlier.rec"]).json();
        assert_eq!(again["verdict"], report.verdict().to_string(), "{board}: {}", again["headline"]);
        assert_eq!(again["link"]["packets_out"], report.link.packets_out, "{board}");
    }
}

/// A link that this program has for itself.
struct Exclusive(Box<dyn Link>);

impl Link for Exclusive {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        self.0.exchange(out, back, wait)
    }

    fn now(&self) -> Duration {
        self.0.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.0.bytes_per_second()
    }

    fn is_exclusive(&self) -> bool {
        true
    }

    fn name(&self) -> String {
        self.0.name()
    }
}

/// Over such a link a board is taken from a run that was killed.
#[test]
fn a_recording_of_a_board_that_was_taken_over_is_judged_as_it_was() {
    let folder = Folder::new();
    let mut greetings = 0;
    let alter = move |toward, packet: Passing| {
        let is_greeted = toward == Toward::Host && packet.is(Kind::Hello);
        greetings += usize::from(is_greeted);
        if !is_greeted || greetings > 1 {
            return vec![packet];
        }
        let held = Refusal { code: RefusalCode::Held, kind: Kind::Hello.code(), detail: 5 };
        vec![packet.saying(&Reply::Refusal(held))]
    };
    let (plan, options) = (System::TINY.plan(), RunOptions::default());
    let candidate = Altered::new(&halfrow_mock::Options::default(), alter).candidate();
    let file = RecordingFile::prepare(&folder.path().join("run.rec"), false).unwrap();
    let candidate = Candidate { link: Box::new(Exclusive(candidate.link)), ..candidate };
    let (candidate, _) = RecordedRun::begin(&plan, &options, candidate, Some(file)).unwrap();
    let report = verify(&plan, candidate, &options, &Silent).unwrap().report;
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let again = folder.halfrow(["verify", "--json", "--board", "replay:run.rec"]).json();
    assert_eq!(again["verdict"], "PASS", "{}", again["headline"]);
}

/// An exchange in which a host commits generation 2, by which frames are judged, for the frame of the last number.
fn last_frame_committed() -> Vec<u8> {
    let commit = Commit { steps_crc: 0, kernel_crc: 0, first_frame: u16::MAX, generation: 2, shape: None };
    let (request, mut sent) = (Request::Commit(commit), Vec::new());
    let header = Header { kind: request.kind().code(), ..Header::default() };
    Encoder::new().encode(&header, |payload| request.write(payload), &mut sent).unwrap();
    let lengths = [sent.len() as u32, 0].map(u32::to_le_bytes).concat();
    [[0; 8].as_slice(), &lengths, &sent].concat()
}

#[test]
fn a_recording_of_numbers_that_no_run_has_is_no_recording_of_this_run() {
    let folder = Folder::new();
    let call = ["verify", "--json", "--width", "64", "--height", "8", "--frame", "builtin:noise"];
    folder.halfrow(call.into_iter().chain(["--record", "sound.rec"])).succeeded();
    let sound = folder.read("sound.rec");
    let (head, exchanges) = sound.split_at(first_exchange(&sound));
    let head = std::str::from_utf8(head).unwrap();
    let patient = head.replace("\"retries\":16", &format!("\"retries\":{}", u64::MAX));
    assert_ne!(patient, head);
    folder.write("patient.rec", [patient.as_bytes(), exchanges].concat());
    folder.write("last.rec", [head.as_bytes(), &last_frame_committed(), exchanges].concat());
    for (target, code) in [("replay:patient.rec", 0), ("replay:last.rec", 3)] {
        let ended = folder.halfrow(["verify", "--json", "--board", target]);
        assert_eq!(ended.code, Some(code), "{target}: {}{}", ended.stdout, ended.stderr);
        assert!(!ended.stdout.contains("program-failed"), "{}", ended.stdout);
    }
}

/// The link that replays these exchanges, each of which says what was taken and what was received.
fn replayed(folder: &Folder, exchanges: &[(&[u8], &[u8])]) -> Box<dyn Link> {
    let mut recording =
        b"halfrow recording 1\n{\"link\":\"\",\"bytes_per_second\":null,\"run\":{}}\n".to_vec();
    for (taken, received) in exchanges {
        recording.extend(0_u64.to_le_bytes());
        recording.extend([taken, received].map(|bytes| (bytes.len() as u32).to_le_bytes()).concat());
        recording.extend([*taken, *received].concat());
    }
    folder.write("made.rec", &recording);
    halfrow::link::open(&format!("replay:{}", folder.path().join("made.rec").display()).parse().unwrap())
        .unwrap()
        .link
}

/// When a wait is over that the clock limits, a recording has no clock to say so. But who waits on without sending departs from
/// the recording.
#[test]
fn whoever_waits_once_where_the_recorded_host_sent_says_the_same_as_it() {
    let folder = Folder::new();
    let (mut came, wait) = (Vec::new(), Duration::from_millis(1));
    // More than a host sends to end its session.
    let more = [7; 200];
    let mut link = replayed(&folder, &[(&[], &[0]), (&[1, 2], &[3]), (&more, &[])]);
    assert_eq!(link.exchange(&[], &mut came, wait).unwrap(), 0);
    assert_eq!(link.exchange(&[], &mut came, wait).unwrap(), 0);
    assert_eq!(link.exchange(&[1, 2], &mut came, wait).unwrap(), 2);
    assert_eq!(came, [0, 3]);
    assert_eq!(link.exchange(&[], &mut came, wait).unwrap(), 0);
    let error = link.exchange(&[], &mut came, wait).unwrap_err();
    assert!(matches!(error, LinkError::OtherConversation { byte: 2 }), "{error}");
}

/// A link whose clock goes back at every other reading.
struct Backwards {
    link: Box<dyn Link>,
    looks: Cell<u64>,
}

impl Link for Backwards {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        self.link.exchange(out, back, wait)
    }

    fn now(&self) -> Duration {
        self.looks.set(self.looks.get() + 1);
        Duration::from_millis(1_000_000)
            .saturating_sub(Duration::from_micros(self.looks.get() % 2 + self.looks.get()))
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn name(&self) -> String {
        "a link whose clock goes back".to_owned()
    }
}

fn backwards() -> Candidate {
    let target: Target = "mock".parse().unwrap();
    let candidate = halfrow::link::open(&target).unwrap();
    let link = Box::new(Backwards { link: candidate.link, looks: Cell::new(0) });
    Candidate { link, ..candidate }
}

#[test]
fn a_clock_that_goes_back_costs_nothing_but_the_time() {
    let report = System::TINY.judge_candidate(backwards());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

#[test]
fn the_link_test_bears_such_a_clock() {
    let options = halfrow::board::OpenOptions::default();
    let mut board = halfrow::board::Board::open(backwards().link, &options).unwrap();
    let figures = halfrow::link_test::run(&mut board, Duration::from_millis(50), 1).unwrap();
    assert_eq!((figures.errors.wrong, figures.to_board.seconds), (0, 0.0));
}

/// The host that recorded it also computed between two exchanges, and this one exchanges nothing.
#[test]
fn a_replay_tells_no_round_trip() {
    let folder = Folder::new();
    let small = ["--width", "64", "--height", "8", "--frame", "builtin:noise", "--record", "sound.rec"];
    let call = ["verify", "--json", "--board", "mock,speed=100000,delay=0.01"];
    let recorded = folder.halfrow(call.into_iter().chain(small)).json();
    // A packet each way takes 10 ms and its bytes' time.
    assert!(recorded["link"]["round_trip_us"].as_u64().unwrap() > 20_000, "{}", recorded["link"]);
    let replay = ["verify", "--board", "replay:sound.rec"];
    let again = folder.halfrow(replay.into_iter().chain(["--json", "--report", "again"])).json();
    assert_eq!(
        (&again["verdict"], &again["link"]["round_trip_us"]),
        (&"PASS".into(), &serde_json::Value::Null)
    );
    let page = folder.text("again/report.html");
    for told in [page, folder.halfrow(replay).stdout] {
        assert!(!told.to_lowercase().contains("round trip"), "{told}");
    }
}
