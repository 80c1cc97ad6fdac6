//! Boards that still exist but are kept from a run that lost them: by another host that took them over, or by the system.

use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

use halfrow::link::{Candidate, Link, LinkError, OpenError, SerialError, UsbError};
use halfrow::progress::Silent;
use halfrow::result::{Finding, Report};
use halfrow::run::{RunOptions, verify};
use halfrow::verdict::Cause;
use halfrow_mock::Options;
use halfrow_protocol::message::{Hello, Request, RowOut};
use halfrow_protocol::{Encoder, Header, Kind, Reply, VERSION};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::patience::come_to_an_end;
use halfrow_tests::system::{System, open};

/// How long the run waits for a board that does not come back.
const PATIENCE: Duration = Duration::from_millis(300);
/// What the boards are behind that are kept from a run.
const PORT: &str = "/dev/ttyUSB1";
const CHIP: &str = "FT2232H";

/// A line to a board that two hosts reach.
struct Line {
    link: Box<dyn Link>,
    /// Bytes that the first host sends until the other one takes the board over.
    left: usize,
    /// Whether the first host's end is of the kind that only one program can open.
    is_exclusive: bool,
}

impl Line {
    /// Sends the other host's greeting, and reads until the board is silent.
    fn take_over(&mut self) -> Result<(), LinkError> {
        let hello =
            Hello { nonce: 77, host: 77, version_min: VERSION, version_max: VERSION, take_over: true };
        let header = Header { kind: Kind::Hello.code(), sequence: 1, reply: false, session: 0, window: 0 };
        let mut said = vec![0; 2];
        Encoder::new().encode(&header, |payload| Request::Hello(hello).write(payload), &mut said).unwrap();
        let mut heard = Vec::new();
        while !said.is_empty() {
            let taken = self.link.exchange(&said, &mut heard, Duration::from_millis(1))?;
            said.drain(..taken);
        }
        heard.push(0);
        while !heard.is_empty() {
            heard.clear();
            self.link.exchange(&[], &mut heard, Duration::from_millis(10))?;
        }
        Ok(())
    }
}

/// The first host's end of the line.
#[derive(Clone)]
struct End(Arc<Mutex<Line>>);

impl End {
    fn line(&self) -> MutexGuard<'_, Line> {
        self.0.lock().unwrap()
    }
}

impl Link for End {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        let mut line = self.line();
        let taken = line.link.exchange(out, back, wait)?;
        if line.left > 0 {
            line.left = line.left.saturating_sub(taken);
            if line.left == 0 {
                line.take_over()?;
            }
        }
        Ok(taken)
    }

    fn now(&self) -> Duration {
        self.line().link.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn is_exclusive(&self) -> bool {
        self.line().is_exclusive
    }

    fn name(&self) -> String {
        "a line that two hosts reach".to_owned()
    }
}

fn judged(candidate: Candidate, take_over: bool) -> Report {
    let options = RunOptions { reconnect: Some(PATIENCE), take_over, ..RunOptions::default() };
    come_to_an_end(move || verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report)
}

#[test]
fn a_board_that_was_taken_over_is_left_to_who_took_it() {
    for (take_over, is_exclusive) in [(false, false), (true, false), (false, true)] {
        for after in [300, 3_000, 9_000] {
            let candidate = open("mock");
            let end = End(Arc::new(Mutex::new(Line { link: candidate.link, left: after, is_exclusive })));
            let link = Box::new(end.clone());
            let shared = Candidate { link, ..candidate };
            let report = judged(shared.reopened_by(move || Ok::<_, OpenError>(end.clone())), take_over);
            let what = format!(
                "take over: {take_over}, exclusive: {is_exclusive}, after {after}: {}",
                report.headline()
            );
            assert_eq!(report.cause, Cause::Busy, "{what}");
            assert!(report.headline().contains("another host holds the board"), "{what}");
            assert!(report.link.reconnections.is_empty(), "{what}");
        }
    }
}

/// A greeting like this one, of another host that takes the board over.
fn of_another_host(greeting: &Passing) -> Passing {
    let mut payload = greeting.payload.clone();
    // Nonce and host, and the byte that says whether the host takes the board over (WIRE.md, 00).
    payload[..8].iter_mut().for_each(|byte| *byte = !*byte);
    payload[10] = 1;
    Passing { payload, ..greeting.clone() }
}

/// All rows are wrong, and the first CONFIGURE comes twice, so that everything is looked at again.
#[test]
fn a_board_that_was_taken_over_before_a_second_look_is_left_to_who_took_it() {
    for (take_over, is_exclusive) in [(false, false), (true, false), (false, true)] {
        let (mut greetings, mut configured) = (0, false);
        let alter = move |toward, packet: Passing| {
            let is_sent = |kind| toward == Toward::Board && packet.is(kind);
            greetings += usize::from(is_sent(Kind::Hello));
            let is_doubled = is_sent(Kind::Configure) && !std::mem::replace(&mut configured, true);
            match packet.reply() {
                _ if is_sent(Kind::Hello) && greetings == 2 => vec![of_another_host(&packet), packet],
                _ if is_doubled => vec![packet.clone(), packet],
                Some(Reply::RowOut(row)) => {
                    let packed: Vec<_> = row.packed.iter().map(|byte| byte ^ 1).collect();
                    vec![packet.saying(&Reply::RowOut(RowOut { packed: &packed, ..row }))]
                }
                _ => vec![packet],
            }
        };
        let candidate = Altered::new(&Options::default(), alter).candidate();
        let end = End(Arc::new(Mutex::new(Line { link: candidate.link, left: 0, is_exclusive })));
        let report = judged(Candidate { link: Box::new(end), ..candidate }, take_over);
        let what = format!("take over: {take_over}, exclusive: {is_exclusive}: {}", report.headline());
        assert_eq!(report.cause, Cause::Busy, "{what}");
        let Finding::SecondLookBrokenOff(broken_off) = &report.finding else { panic!("{what}") };
        assert_eq!(broken_off.reason.code(), "board-held", "{what}");
    }
}

/// Why a board is not opened again, and what a run then ends with.
type Refused = (fn() -> OpenError, Cause, &'static str);

const REFUSED: [Refused; 7] = [
    (
        || SerialError::NotAllowed { path: PORT.into(), remedy: "join the group dialout".to_owned() }.into(),
        Cause::Station,
        "you may not open /dev/ttyUSB1; join the group dialout",
    ),
    (
        || SerialError::NotGiven(PORT.into()).into(),
        Cause::Station,
        "/dev/ttyUSB1 is on this computer, but this program is not given it",
    ),
    (
        || SerialError::InUse { path: PORT.into(), holders: Vec::new() }.into(),
        Cause::Busy,
        "/dev/ttyUSB1 is in use",
    ),
    (
        || UsbError::NotPermitted { name: CHIP.to_owned(), remedy: "run the line".to_owned() }.into(),
        Cause::Station,
        "this user may not open the USB device FT2232H; run the line",
    ),
    (
        || UsbError::NotGiven { name: CHIP.to_owned() }.into(),
        Cause::Station,
        "the USB device FT2232H is plugged in, but this program is not given it",
    ),
    (
        || UsbError::Busy { what: CHIP.to_owned(), holders: Vec::new() }.into(),
        Cause::Busy,
        "FT2232H is in use",
    ),
    (|| SerialError::Missing(PORT.into()).into(), Cause::Station, "the board did not come back in 0.3 s"),
];

#[test]
fn a_board_that_may_not_be_opened_again_is_not_said_to_be_away() {
    for (refused, cause, said) in REFUSED {
        let lost = open("mock,fault=disconnect,packet=60");
        let report = judged(lost.reopened_by(move || Err::<End, _>(refused())), false);
        assert_eq!(report.cause, cause, "{}", report.headline());
        assert!(report.headline().contains(said), "{}", report.headline());
    }
}
