//! The files of who may act and of who may read.

use std::thread;

use super::station::Station;

/// Each keeps what the others have changed.
#[test]
fn tokens_that_are_added_and_removed_at_once_are_all_as_they_were_told_to_be() {
    let station = Station::public(1);
    let names: Vec<_> = (0..8).map(|number| format!("mes-{number}")).collect();
    let at_once = |act: &str| {
        thread::scope(|scope| {
            for name in &names {
                let station = &station;
                scope.spawn(move || {
                    let done = station.token(&[act, name]);
                    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
                });
            }
        });
        String::from_utf8(station.token(&["list"]).stdout).unwrap()
    };
    let added = at_once("add");
    assert_eq!(names.iter().filter(|name| added.contains(*name)).count(), 8, "{added}");
    assert_eq!(at_once("remove").trim(), "");
}

/// It is not as if there were no tokens, or nobody.
#[test]
fn a_file_of_tokens_that_cannot_be_reached_is_no_empty_one() {
    let station =
        Station::public(1).where_instead("station.toml", "\"tokens.toml\"", "\"users.toml/tokens.toml\"");
    let listed = station.token(&["list"]);
    let said = String::from_utf8_lossy(&listed.stderr);
    assert!(!listed.status.success() && said.contains("cannot be read or written"), "{listed:?}");
}

#[test]
fn a_station_without_access_says_by_a_code_that_it_has_no_users_and_no_tokens() {
    let station = Station::private(1);
    for (did, code) in [
        (station.user(&["list"], ""), "settings-without-users"),
        (station.token(&["list"]), "settings-without-tokens"),
    ] {
        let said = String::from_utf8(did.stderr).unwrap();
        assert_eq!(did.status.code(), Some(2), "{said}");
        assert!(said.contains(&format!("halfrow explain {code}")), "{said}");
    }
}
