//! A sink that has refused very many entries.

use halfrow_station::said::{Said, Saying};
use halfrow_station::store::{Deed, Tried};

use super::did;
use crate::common::now_ms;
use crate::history::made::Made;
use crate::history::served::Served;

/// A history with a sink that has refused this many lines of the audit.
fn refused(many: usize) -> Made {
    let mut made = Made::new();
    made.store.sends_to(vec!["mes".to_owned()]).unwrap();
    for number in 0..many {
        let number = number.to_string();
        made.store.note(Deed { operator: "weber", act: "scan", subject: "1", detail: &number }).unwrap();
    }
    loop {
        let due = made.store.folder().due("mes", now_ms(), i64::MAX).unwrap();
        if due.is_empty() {
            return made;
        }
        let message = "it takes none of these".to_owned();
        let said = Said { message, ..Saying::NotAtPlant.into() };
        let dead = Tried::Dead { said };
        let tried: Vec<_> = due.into_iter().map(|entry| (entry, dead.clone())).collect();
        made.store.tried("mes", &tried, now_ms()).unwrap();
    }
}

#[test]
fn of_many_that_wait_for_a_person_the_first_hundred_are_shown_with_their_number() {
    for (many, shown) in [(100, 100), (101, 100)] {
        let served = Served::of(refused(many));
        let page = served.page("/outbox");
        assert_eq!(page.matches("action=\"/outbox/").count(), shown, "{many}");
        assert_eq!(page.contains("The first 100 of 101"), many > shown, "{many}");
        let sink = "[[sink]]\nname = \"mes\"\nfolder = \"mes\"";
        let listed = did(served.folder().path(), sink, &["outbox", "list"]).said;
        assert_eq!(listed.matches("it takes none of these").count(), shown, "{many}");
        assert_eq!(listed.contains("the first 100 of 101"), many > shown, "{listed}");
        assert_eq!(listed.contains("outbox release --sink mes"), many > shown, "{listed}");
        let json = did(served.folder().path(), sink, &["outbox", "list", "--json"]).said;
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(json["dead"].as_array().unwrap().len(), shown);
        assert_eq!(json["unsent"][0]["dead"], many);
    }
}

#[test]
fn whoever_has_all_sent_again_is_told_of_what_waits_for_a_person() {
    let folder = refused(2).closed();
    let sink = "[[sink]]\nname = \"mes\"\nfolder = \"mes\"";
    let again = ["outbox", "again", "mes", "--reason", "lost", "--operator", "engel"];
    let rest = "`halfrow-station outbox release --sink mes` has 2 more tried, which wait for a person";
    assert_eq!(did(folder.path(), sink, &again).said, format!("0 of mes are sent again; {rest}\n"));
}
