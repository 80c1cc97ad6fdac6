//! Which steps a station tries again by itself: none of which a PASS would hide what was seen before.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::thread;

use super::bench::{PLAN, Station};
use super::identity::{answers, device, one_after_the_other, opened};

/// [`PLAN`], whose only step besides the identity may be tried twice.
fn plan() -> String {
    PLAN.replace("timeout = 60", "timeout = 60\nretries = 1")
}

const TRIES: &str =
    "SELECT group_concat(outcome) FROM (SELECT outcome FROM step WHERE name = 'verify' ORDER BY attempt)";

/// The cable of the first try breaks. The control is a board with which nothing is wrong until then.
#[test]
fn a_board_whose_samples_differed_before_its_link_broke_is_not_tried_again() {
    for (fault, code, tries) in [("", 0, "error,passed"), (",fault=stuck-data", 3, "error")] {
        let station = Station::with(&plan());
        let breaks = format!("{}{fault},fault=disconnect,byte=9000,toward=host", device(0x11));
        let did =
            station.run("CAT00001", &one_after_the_other(vec![device(0x11), breaks, device(0x11)], || ()));
        assert_eq!((did.code, &*station.query(TRIES)), (Some(code), &[tries.to_owned()][..]), "{did:?}");
        assert_eq!(did.said.contains("samples differ"), code == 3, "{did:?}");
    }
}

/// Another board is put in its place while it is judged, without the connection breaking. The control has a number, by which
/// it is known to be the same one.
#[test]
fn a_board_that_was_reset_and_has_no_number_is_not_tried_again() {
    for (board, code, tries) in [("mock,serial=17", 0, "error,passed"), ("mock,serial=0", 3, "error")] {
        let station = Station::with(&plan());
        let did = station.run("CAT00001", &reset_after(board, 20_000));
        assert_eq!((did.code, &*station.query(TRIES)), (Some(code), &[tries.to_owned()][..]), "{did:?}");
        let lost =
            "SELECT count(*) FROM step WHERE attempt = 1 AND detail LIKE '%no longer knows this session%'";
        assert_eq!(station.query(lost), ["1"], "{did:?}");
    }
}

/// The target of `board`, which loses power for a moment when the host has sent this many bytes.
fn reset_after(board: &str, bytes: usize) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    let board = board.to_owned();
    thread::spawn(move || {
        let (mut powered, mut sent) = (opened(&board), 0);
        while let Ok((mut host, _)) = listener.accept() {
            let mut buffer = [0; 4096];
            while let Ok(read @ 1..) = host.read(&mut buffer) {
                if (sent..sent + read).contains(&bytes) {
                    powered = opened(&board);
                }
                sent += read;
                let said = answers(&mut *powered, &buffer[..read]).unwrap();
                host.write_all(&said).unwrap();
            }
        }
    });
    target
}
