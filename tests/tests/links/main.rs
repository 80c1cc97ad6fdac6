//! Real links to mock boards: serial ports on pseudo-terminals that the tests make, TCP, and ser2net between the two.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod access;
mod discovered;
mod late_host;
mod measured;
mod reconnected;
mod scenarios;
mod ser2net;
mod serial;
mod served;
mod taken_over;
mod tcp;
mod unplugged;

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::{Ended, halfrow};
use halfrow_tests::served::Served;

/// The options of a frame so small that a whole run takes a moment.
const SMALL: [&str; 6] = ["--width", "64", "--height", "8", "--frame", "builtin:noise"];

/// Judges the board at `target`.
fn verify(target: &str, more: &[&str]) -> Ended {
    let call = ["verify", "--json", "--board", target].into_iter();
    halfrow(call.chain(SMALL).chain(more.iter().copied()))
}

/// Judges the served board, which must pass. Rows may be asked for again when the thread that serves it is late, but nothing may
/// be damaged.
#[track_caller]
fn passes(served: &Served) {
    let ended = verify(&served.target(), &[]).succeeded();
    let said = ended.json();
    assert_eq!(said["board"]["kind"], "mock");
    assert_eq!(said["link"]["damaged_in"], 0);
}

/// What comes of `try_it` once it does not find the port busy any more: a process that another test has just started has every open
/// port, too, until it runs its own program.
fn once_free<T>(mut try_it: impl FnMut() -> T, is_busy: impl Fn(&T) -> bool) -> T {
    let mut came = None;
    wait_until("the port to be free", || !is_busy(came.insert(try_it())));
    came.unwrap()
}

/// The run ends with `code` and says `sentence`.
#[track_caller]
fn ends(ended: &Ended, code: i32, sentence: &str) {
    assert_eq!(ended.code, Some(code), "{}{}", ended.stdout, ended.stderr);
    let headline = ended.headline();
    assert!(headline.contains(sentence), "{headline}");
    assert_eq!(ended.json()["exit_code"], code);
}
