//! A board that is unplugged at any moment: an error, no hang, no verdict, and a station that can go on.

use halfrow_tests::dice::Dice;
use halfrow_tests::patience::come_to_an_end;
use halfrow_tests::usb::{plug, verify};

/// Pulls the plug at byte `byte` on the way `toward` the board or the host.
fn pull(byte: usize, toward: &str) {
    let board = plug(&format!(",fault=disconnect,byte={byte},toward={toward}"));
    let ended = come_to_an_end(|| verify("usb"));
    let said = ended.json();
    assert_eq!(
        (ended.code, said["verdict"].as_str()),
        (Some(3), Some("ERROR")),
        "byte {byte} {toward}: {ended:?}"
    );
    assert!(ended.headline().contains("went away at"), "byte {byte} {toward}: {ended:?}");
    drop(board);
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn in_the_handshake_in_the_tables_and_in_a_row() {
    for (byte, toward) in [(0, "board"), (10, "host"), (3000, "board"), (60_000, "board"), (60_000, "host")] {
        pull(byte, toward);
    }
    let _board = plug("");
    verify("usb").succeeded();
}

/// Pulls the plug at `count` random places by `seed`; then a sound board must pass.
pub(crate) fn anywhere(seed: usize, count: usize) {
    let mut dice = Dice::new(20_261_121 + seed as u64);
    for _ in 0..count {
        pull(dice.below(60_000), dice.one_of(&["board", "host"]));
    }
    let _board = plug("");
    verify("usb").succeeded();
}
