//! The files of who may act and of who may read.

use std::os::unix::fs::PermissionsExt as _;
use std::process::Command;
use std::{fs, thread};

use super::station::{Serving, Station};
use crate::common::{Did, plant_settings, program, unmasked};
use crate::plant;

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

/// As when a script adds people and starts the pages of a new station.
#[test]
fn programs_that_are_the_first_in_a_folder_at_once_have_one_key() {
    let station = Station::public(1);
    let key = station.path("data").join("station.key");
    for round in 0..4 {
        fs::remove_file(&key).unwrap();
        let added = thread::scope(|scope| {
            let add = |number| {
                let name = format!("mes-{round}-{number}");
                scope.spawn(|| (station.token(&["add", &name]), name))
            };
            let adding: Vec<_> = (0..8).map(add).collect();
            adding.into_iter().map(|one| one.join().unwrap()).collect::<Vec<_>>()
        });
        for (did, name) in added {
            assert!(did.status.success(), "{name}: {}", String::from_utf8_lossy(&did.stderr));
        }
    }
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

/// It would not log anybody in on the page of lanes.
#[test]
fn a_barcode_of_the_station_is_nobodys_badge() {
    let station = Station::public(1);
    for barcode in ["HR:START", "HR:LANE:1", "HR:MOCK"] {
        let refused = station.user(&["add", "Vogel"], &format!("{barcode}\n"));
        let said = String::from_utf8_lossy(&refused.stderr);
        assert!(
            !refused.status.success() && said.contains("barcode of the station"),
            "{barcode}: {refused:?}"
        );
    }
    assert!(station.user(&["add", "Vogel"], "HR:0017\n").status.success(), "no barcode of the station");
}

/// A badge that is scanned meanwhile is refused, so none is asked for.
#[test]
fn while_people_cannot_be_read_the_lanes_say_so_instead_of_asking_for_a_badge() {
    let station = Station::with(1, "[web]\nlisten = \"127.0.0.1:0\"\n[access]\nusers = \"users.toml\"");
    assert!(station.user(&["add", "Weber"], "A-0017\n").status.success());
    let serving = station.serve();
    let mut weber = serving.here();
    weber.learn(&weber.post("/login", &[("badge", "A-0017")]).send());
    weber.get("/").until("lane ready");
    let (file, people) = (station.path("users.toml"), fs::read(station.path("users.toml")).unwrap());
    fs::write(&file, "no table").unwrap();
    for path in ["/", "/still"] {
        let page = weber.get(path).send().text();
        let told = page.split_once("<p class=\"badge\">").map(|(_, rest)| rest.split("</p>").next().unwrap());
        assert!(told.is_some_and(|told| told.contains("users.toml")), "{path}: {page}");
        let asked = page.contains("<p class=\"does\">") || page.contains("Scan your badge");
        assert!(page.contains("lane ready") && !asked, "{path}: {page}");
    }
    let mut follows = weber.get("/live").lines();
    assert!(follows.next().is_some_and(|status| status.contains("200")));
    fs::write(&file, people).unwrap();
    // Then the page is loaded anew.
    follows.for_each(drop);
    assert!(weber.get("/").send().text().contains("<p class=\"does\">scan its label</p>"));
}

/// By the umask everybody could read in it, or put another key or database there.
#[test]
fn the_folder_is_closed_to_others_whichever_command_makes_it() {
    let station = Station::public(1);
    let data = station.path("data");
    fs::remove_dir_all(&data).unwrap();
    let is_closed = |command: &str| {
        let mode = fs::metadata(&data).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode, 0o750, "{command}: {mode:o}");
        fs::remove_dir_all(&data).unwrap();
    };
    for command in ["user add Engel", "token add mes"] {
        let mut open = Command::new("sh");
        open.args(["-c", &format!("umask 0; echo C-0001 | \"$0\" {command} --settings \"$1\"")]);
        let added: Did = open.arg(program()).arg(station.path("station.toml")).output().unwrap().into();
        assert_eq!(added.code, Some(0), "{added:?}");
        is_closed(command);
    }
    // It need not reach the plant.
    let plant = "schema = 1\n[station]\nname = \"north\"\ndata = \"data\"\n[web]\nlisten = \"127.0.0.1:0\"\n";
    let settings = station.path("plant.toml");
    fs::write(&settings, plant.to_owned() + &plant_settings("postgres://reader@127.0.0.1:1/plant")).unwrap();
    drop(Serving::of(&mut unmasked(&plant::pages::command(&settings))));
    is_closed("plant serve");
}
