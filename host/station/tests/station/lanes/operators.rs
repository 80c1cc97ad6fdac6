//! Several people at the pages of one station, and what the engine tells everybody.

use std::fs;

use halfrow_station::engine::{Engine, LaneDoing, LaneState, News};
use halfrow_station::floor::Word;
use halfrow_station::lane::Doing;
use halfrow_station::record::StepOutcome;
use halfrow_station::settings::Settings;
use halfrow_station::store::{Folder, Store};

use super::floor::{HANG, SERIALS, Station};
use crate::common::program;

/// Weber's board is plugged in after Braun has scanned another one.
#[test]
fn the_record_names_whoever_scanned_the_board_and_not_whoever_scanned_last() {
    let station = Station::with(&["mock"], "");
    let port = station.path("port");
    let plugged = format!(
        "[[lane]]\nname = \"2\"\nboard = \"serial:{}\"\nplans = [\"plan.toml\"]\nstart = [\"presence\"]\n",
        port.display()
    );
    let path = station.path("station.toml");
    let settings = fs::read_to_string(&path).unwrap();
    fs::write(&path, settings + &plugged).unwrap();
    let settings = Settings::load(&path).unwrap();
    let store = Store::open(&Folder::new(&settings.data)).unwrap();
    let engine = Engine::start(settings, store, program().to_owned()).unwrap();
    let news = engine.listen();
    let state = |of: &str, word| {
        let is = |news: &News| matches!(news, News::Lane(LaneState { lane, state, .. }) if lane == of && *state == word);
        while !is(&news.recv_timeout(HANG).unwrap()) {}
    };
    state("1", Word::Ready);
    engine.label(1, Some(1), SERIALS[0], "weber", None);
    engine.label(2, Some(0), SERIALS[1], "braun", None);
    state("1", Word::Pass);
    fs::write(&port, "").unwrap();
    // The file is not a serial port.
    state("2", Word::Error);
    engine.close(None);
    assert_eq!(station.query("SELECT operator_id FROM run ORDER BY lane"), ["braun", "weber"]);
}

/// Scripts read what `lanes` prints.
#[test]
fn what_a_run_does_is_printed_with_its_lane_its_run_and_its_rows() {
    let ended = Doing::Ended { step: "verify".to_owned(), outcome: StepOutcome::Failed };
    for (what, printed) in [
        (Doing::Rows(3, 9), r#""what":"rows","rows":[3,9]"#),
        (ended, r#""what":"verify failed","rows":null"#),
        (Doing::Board("HR1".to_owned()), r#""what":"the board is HR1","rows":null"#),
    ] {
        let news = News::Doing(LaneDoing { lane: "1".to_owned(), run: "a".to_owned(), what });
        let printed = format!(r#"{{"news":"doing","lane":"1","run":"a",{printed}}}"#);
        assert_eq!(serde_json::to_string(&news).unwrap(), printed);
    }
}
