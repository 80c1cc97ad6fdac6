//! Why sinks do not accept results, on the station's page.

use super::post::Server;
use super::send;
use crate::history::made::{End, Made, Run};
use crate::history::served::Served;

/// The other system's answer is not translated.
#[test]
fn why_a_sink_takes_nothing_is_told_in_the_language_of_the_page_around_its_own_words() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    let (server, folder) = (Server::start(None), made.closed());
    server.answers("422 Part unknown to MES");
    let post = format!("[[sink]]\nname = \"mes\"\npost = \"http://127.0.0.1:{}/\"\n", server.port);
    let sinks = format!("{post}[[sink]]\nname = \"share\"\nfolder = \"nowhere\"");
    assert_eq!(send(folder.path(), &sinks).code, Some(3));
    let missing = folder.path().join("nowhere").display().to_string();
    let served = Served::of(Made::at(folder));
    for (language, refused, away) in [
        ("en", "answers 422 to this (Part unknown to MES)", format!("the folder {missing} is not there")),
        (
            "de",
            "antwortet hierauf mit 422 (Part unknown to MES)",
            format!("der Ordner {missing} ist nicht da"),
        ),
        ("zh", "对此返回 422（Part unknown to MES）", format!("文件夹 {missing} 不存在")),
    ] {
        let page = served.get_in("/outbox", language).text();
        let (_, page) = page.split_once("<main").unwrap();
        assert!(page.contains(refused) && page.contains(&away), "{page}");
        assert!(!page.contains("lang=\"en\""), "{page}");
    }
}
