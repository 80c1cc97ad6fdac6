//! Names of boards that stay the same when another board is plugged in first.

use std::path::Path;

use halfrow::link::discovery::{Found, find};
use halfrow::target::Target;

use crate::presence::{USB, chips};

/// What is wrong with a name that may lead to another board tomorrow, and what to write instead.
pub(crate) fn moving(board: &Target) -> Option<(String, String)> {
    let written = board.to_string();
    match (board.kind.as_str(), board.address.as_deref()) {
        ("usb", None) => {
            let what = format!("`{written}` is whichever board is plugged in");
            let stable = chips(Path::new(USB)).into_iter().map(|chip| format!("usb:{}", chip.place));
            Some((what, instead(&stable.collect::<Vec<_>>(), "usb:PLACE, as in usb:1-2.3")))
        }
        ("serial", Some(path)) if may_move(path) => {
            let what = format!("`{written}` is another board when they are plugged in in another order");
            // The board is spoken to as before, whatever its port is called.
            let called = |name: &str| Target { address: Some(name.to_owned()), ..board.clone() }.to_string();
            let stable = Found::named(board).names;
            let stable: Vec<_> = stable.iter().map(|name| called(&name.to_string_lossy())).collect();
            Some((what, instead(&stable, &called("/dev/serial/by-path/…"))))
        }
        ("serial", None) => {
            let stable =
                find().into_iter().map(|found| found.target).filter(|name| name.starts_with("serial:"));
            Some((
                "`serial` names no port".to_owned(),
                instead(&stable.collect::<Vec<_>>(), "serial:/dev/serial/by-path/…"),
            ))
        }
        _ => None,
    }
}

/// Whether the kernel numbers such ports in the order in which they appear.
fn may_move(path: &str) -> bool {
    ["/dev/ttyUSB", "/dev/ttyACM"].iter().any(|counted| path.starts_with(counted))
}

fn instead(stable: &[String], form: &str) -> String {
    if stable.is_empty() {
        format!("write {form}; `halfrow boards` lists them when they are plugged in")
    } else {
        format!("write {}", stable.join(" or "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_may_move_is_refused_with_one_that_stays() {
        for name in
            ["usb", "usb,speed=high", "serial:/dev/ttyUSB0", "serial:/dev/ttyACM1,baud=9600", "serial"]
        {
            let (what, remedy) = moving(&name.parse().unwrap()).unwrap();
            assert!(what.starts_with('`') && remedy.starts_with("write "), "{what}; {remedy}");
        }
        let (_, remedy) = moving(&"serial:/dev/ttyUSB99,board=ulx3s".parse().unwrap()).unwrap();
        let kept = "write serial:/dev/serial/by-path/…,board=ulx3s; `halfrow boards` lists";
        assert!(remedy.starts_with(kept), "{remedy}");
        for stays in [
            "usb:1-2.3",
            "usb:FT3XYZ",
            "serial:/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0",
            "serial:/dev/ttyS0",
            "tcp:bench:3001",
            "mock",
        ] {
            assert_eq!(moving(&stays.parse().unwrap()), None, "{stays}");
        }
    }
}
