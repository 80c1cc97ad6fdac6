//! Which steps are tried again without a person: none after which the board may be to blame.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::thread;

use halfrow::link;

use super::bench::{PLAN, Station};
use super::identity::{answers, device};

/// What happens to the first board once it has said enough.
#[derive(Clone, Copy, Debug)]
enum Then {
    /// Its session is lost: the second board answers over the same connection, and ever after.
    Reset,
    /// The connection ends, and the second board answers from the next one on.
    Cut,
}

/// When the first board has said enough.
#[derive(Clone, Copy, Debug)]
enum Enough {
    /// It has sent so many bytes.
    Bytes(usize),
    /// It has answered so many requests of this kind, whose packets are an empty byte, COBS's first code, the version and the kind.
    Requests(usize, u8),
}

impl Enough {
    /// Whether it is so after the board heard these bytes, and said that many.
    fn is_so(&mut self, heard: &mut Vec<u8>, said: usize) -> bool {
        let (left, so_many) = match self {
            Self::Bytes(bytes) => (bytes, said),
            Self::Requests(requests, kind) => {
                let begins = |four: &&[u8]| matches!(four, [0, code, 1, of] if *code > 0 && of == kind);
                let so_many = heard.windows(4).filter(begins).count();
                heard.drain(..heard.len().saturating_sub(3));
                (requests, so_many)
            }
        };
        *left = left.saturating_sub(so_many);
        *left == 0
    }
}

/// A port at which `first` answers until that is enough, and then `second`.
fn interrupted(first: String, second: String, mut enough: Enough, then: Then) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    let open = |board: &str| link::open(&board.parse().unwrap()).unwrap().link;
    thread::spawn(move || {
        let (mut board, mut heard, mut is_over) = (open(&first), Vec::new(), false);
        for host in listener.incoming() {
            let (mut host, mut received) = (host.unwrap(), [0; 4096]);
            while let Ok(read @ 1..) = host.read(&mut received) {
                let said = answers(&mut *board, &received[..read]);
                heard.extend_from_slice(&received[..read]);
                // The host may have ended the connection.
                drop(host.write_all(&said));
                if !is_over && enough.is_so(&mut heard, said.len()) {
                    (board, is_over) = (open(&second), true);
                    match then {
                        Then::Reset => {}
                        Then::Cut => break,
                    }
                }
            }
        }
    });
    target
}

/// The verdict of a run whose first board is interrupted in the step `kind`, that step's tries, and what the first one told. A
/// retry would meet a sound board.
fn came(kind: &str, boards: (String, String), then: Then) -> (String, String, String) {
    came_after(Enough::Bytes(20_000), kind, boards, then)
}

/// Like [`came`], with the first board interrupted when that is enough.
fn came_after(
    enough: Enough,
    kind: &str,
    (first, second): (String, String),
    then: Then,
) -> (String, String, String) {
    let plan = match kind {
        "link" => {
            PLAN.replace("[[step]]\n", "[[step]]\nkind = \"link\"\nretries = 1\nseconds = 0.2\n[[step]]\n")
        }
        _ => PLAN.replace("timeout = 60", "timeout = 60\nretries = 1\nrepeat = 20"),
    };
    let station = Station::with(&plan);
    station.run("CAT00001", &interrupted(first, second, enough, then));
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
    let tries = format!("SELECT attempt || ' ' || outcome FROM step WHERE name = '{kind}' ORDER BY attempt");
    let first = format!("SELECT detail FROM step WHERE name = '{kind}' AND attempt = 1");
    let [verdict, first] = ["SELECT verdict FROM run", &first].map(|query| station.query(query).remove(0));
    (verdict, station.query(&tries).join(", "), first)
}

const NUMBER: u64 = 0x11;

#[test]
fn a_try_in_which_samples_differed_is_not_repeated_whatever_broke_it_off() {
    for then in [Then::Cut, Then::Reset] {
        let wrong = format!("{},fault=stuck-data,bit=4", device(NUMBER));
        let (verdict, tries, told) = came("verify", (wrong, device(NUMBER)), then);
        assert_eq!((verdict.as_str(), tries.as_str()), ("ERROR", "1 error"), "{then:?}: {told}");
        // Otherwise nothing would have been held against the board yet.
        assert!(told.contains("samples differ") && told.contains("broke off"), "{then:?}: {told}");
        assert!(told.ends_with("not retried automatically: the board showed a fault"), "{told}");
    }
}

/// The link test reads back what it wrote: WIRE.md, section 3, has TABLE_READ as kind 11.
#[test]
fn a_link_test_that_broke_off_after_wrong_answers_is_not_repeated() {
    let reads = Enough::Requests(3, 0x11);
    let wrong = format!("{},fault=row-factor,row=100,bit=0", device(NUMBER));
    let (verdict, tries, told) = came_after(reads, "link", (wrong, device(NUMBER)), Then::Cut);
    assert_eq!((verdict.as_str(), tries.as_str()), ("ERROR", "1 error"), "{told}");
    assert!(
        told.contains("the link test broke off after ") && told.contains("other bytes than were sent"),
        "{told}"
    );
    assert!(told.ends_with("not retried automatically: the board showed a fault"), "{told}");
    let (verdict, tries, told) = came_after(reads, "link", (device(NUMBER), device(NUMBER)), Then::Cut);
    assert_eq!((verdict.as_str(), tries.as_str()), ("PASS", "1 error, 2 passed"), "the control: {told}");
}

#[test]
fn a_sound_board_whose_link_broke_is_judged_by_the_next_try() {
    let (verdict, tries, told) = came("verify", (device(NUMBER), device(NUMBER)), Then::Cut);
    assert_eq!((verdict.as_str(), tries.as_str()), ("PASS", "1 error, 2 passed"), "{told}");
}

#[test]
fn a_board_that_loses_its_session_while_it_is_judged_is_tested_again_by_a_person() {
    let (verdict, tries, told) = came("verify", (device(NUMBER), device(NUMBER)), Then::Reset);
    assert_eq!((verdict.as_str(), tries.as_str()), ("ERROR", "1 error"), "{told}");
}

/// The end of what is told of a step that is not repeated because another board may be there.
const MAY_BE_ANOTHER: &str =
    "the board or its connection was away, and the board may be at fault, or another one now";

fn unnumbered() -> String {
    "mock".to_owned()
}

/// Without a number it may be another board that answers from then on.
#[test]
fn a_step_during_which_the_session_was_lost_is_repeated_only_with_a_board_that_proves_who_it_is() {
    let (verdict, tries, told) = came("link", (device(NUMBER), device(NUMBER)), Then::Reset);
    assert_eq!((verdict.as_str(), tries.as_str()), ("PASS", "1 error, 2 passed"), "{told}");
    let (verdict, tries, told) = came("link", (unnumbered(), unnumbered()), Then::Reset);
    assert_eq!((verdict.as_str(), tries.as_str()), ("ERROR", "1 error"), "{told}");
    assert!(told.ends_with(MAY_BE_ANOTHER), "{told}");
}

/// A board is exchanged by being unplugged.
#[test]
fn a_step_whose_connection_ended_is_not_repeated_with_a_board_that_has_no_number() {
    let came = ["link", "verify"].map(|kind| came(kind, (unnumbered(), unnumbered()), Then::Cut));
    let told = came
        .each_ref()
        .map(|(verdict, tries, told)| (verdict.as_str(), tries.as_str(), told.ends_with(MAY_BE_ANOTHER)));
    assert_eq!(told, [("ERROR", "1 error", true); 2], "{came:?}");
}
