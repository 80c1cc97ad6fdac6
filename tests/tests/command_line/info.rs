//! What `info` prints about a board.

use halfrow_mock::Options;
use halfrow_pipe::BoardOptions as _;
use halfrow_tests::program::halfrow;
use serde_json::json;

/// Any of its replies may be lost, even the one to the closing RESET: a session that is unknown is closed.
#[test]
fn a_board_is_told_of_whatever_reply_is_lost() {
    for packet in 1..10 {
        let board = format!("mock,fault=drop,packet={packet},toward=host");
        let told = halfrow(["info", "--board", &board]);
        assert_eq!(told.code, Some(0), "packet {packet}: {told:?}");
        assert!(told.stdout.contains("pixel clock"), "packet {packet}: {told:?}");
    }
}

/// The page has a row for each line before the counters, in order.
#[test]
fn the_page_of_capabilities_has_every_line() {
    let page = include_str!("../../../docs/capabilities.md");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next());
    let said = halfrow(["info"]).stdout;
    let lines = said.lines().take_while(|line| !line.is_empty()).map(|line| line.split("  ").next().unwrap());
    assert_eq!(rows.collect::<Vec<_>>(), lines.collect::<Vec<_>>());
}

#[test]
fn the_page_of_boards_has_every_option_of_the_mock() {
    let page = include_str!("../../../docs/boards.md");
    let is_there = |key: &str| page.contains(&format!("`{key}`")) || page.contains(&format!("{key}="));
    let missing: Vec<_> = Options::KEYS.iter().filter(|key| !is_there(key)).collect();
    assert_eq!(missing, Vec::<&&str>::new());
}

#[test]
fn a_board_says_what_it_makes_at_full_speed() {
    let said = |board| halfrow(["info", "--board", board]).stdout;
    let whole = said("mock,records=8,least-frame-blanking=5");
    assert!(
        whole.contains("\nframes at speed     yes (content 1): 8 records, keeps the first wrong row\n"),
        "{whole}"
    );
    assert!(whole.contains("\ninput rows          CRC reported\n"), "{whole}");
    let old = said("mock,bursts=no,entered=no");
    assert!(old.contains("\nframes at speed     none\n"), "{old}");
    assert!(old.contains("\ninput rows          CRC not reported\n"), "{old}");
    let rows_alone = said("mock,datapath2=no");
    assert!(rows_alone.contains("\ndatapath            1\ngrids               none\n"), "{rows_alone}");
    let told = halfrow(["info", "--json", "--board", "mock,records=8,least-frame-blanking=5"]).json();
    let bursts = json!({ "content": 1, "records": 8, "least_frame_blanking": 5, "trap": true });
    assert_eq!(told["board"]["identity"]["bursts"], bursts);
    assert_eq!(told["board"]["identity"]["grids"]["entries"], 2048);
}
