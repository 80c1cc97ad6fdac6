//! Pictures of frames that a run failed with.

use std::path::Path;
use std::process::Command;

use halfrow::frames::{ReadOptions, decode};
use halfrow_station::record::Record;

use super::looked_at::{all_between, listed};
use super::made::Made;
use super::served::{self, Served};
use crate::common::{self, program};

/// Judges a mock board by a plan that takes a moment, and returns the exit code.
fn judge(folder: &Path, board: &str, serial: &str) -> Option<i32> {
    let plan = folder.join("plan.toml");
    std::fs::write(&plan, served::plan()).unwrap();
    let arguments = ["run", "--serial", serial, "--board", board, "--operator", "weber"];
    let mut run = Command::new(program());
    run.args(arguments).arg("--data").arg(folder).arg("--any-disk").arg("--plan").arg(plan);
    run.output().unwrap().status.code()
}

/// The samples of a frame that was kept, and their hash.
fn samples(served: &Served, run: &str, name: &str, record: &Record) -> (Vec<u16>, String) {
    let attached = record.attachments.iter().find(|one| one.name.ends_with(name)).unwrap();
    let answer = served.get(&format!("/runs/{run}/evidence/{}", attached.sha256));
    assert_eq!(answer.header("content-type"), Some("image/png"));
    let samples = decode(&answer.body, &ReadOptions::default()).unwrap().samples().to_vec();
    let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
    (samples, halfrow::result::sha256([bytes]))
}

#[test]
fn a_fail_keeps_the_frames_that_are_wrong_and_shows_them() {
    let folder = common::folder();
    assert_eq!(judge(folder.path(), "mock,fault=stuck-data,bit=7", "CAT00001"), Some(1));
    assert_eq!(judge(folder.path(), "mock", "CAT00002"), Some(0));
    let served = Served::of(Made::at(folder));
    let runs = listed(&served.page("/history"));
    let [passed, failed] = &runs[..] else { panic!("{runs:?}") };
    let stored = served.folder().verdict_of(failed).unwrap().unwrap();
    let record = Record::parse(&served.folder().blobs().get(&stored.record_sha256).unwrap()).unwrap();
    let told = &record.steps.last().unwrap().evidence.as_ref().unwrap()["frames"][0];
    let [input, found, expected] =
        ["-in.png", "-out.png", "-should.png"].map(|name| samples(&served, failed, name, &record));
    // The judge counted and hashed these while it had the frame.
    let differing = found.0.iter().zip(&expected.0).filter(|(found, expected)| found != expected).count();
    assert_eq!(Some(differing as u64), told["comparison"]["differences"].as_u64());
    assert_eq!(Some(input.1.as_str()), told["sha256"].as_str());
    let page = served.page(&format!("/runs/{failed}"));
    let pictures = all_between(&page, "<img src=\"", '"');
    assert_eq!(pictures.len(), 4, "{page}");
    for picture in &pictures {
        let answer = served.get(picture);
        assert_eq!((answer.status, answer.header("content-type")), (200, Some("image/png")), "{picture}");
        assert!(answer.body.starts_with(b"\x89PNG"));
        // The map of so small a frame has a square for each sample.
        assert_eq!(answer.body[16..24], [0, 0, 0, 64, 0, 0, 0, 8], "{picture}");
        // It is evidence of that run only.
        assert_eq!(served.get(&picture.replace(failed, passed)).status, 404);
    }
    assert!(page.contains("A square stands for one sample. Colour of its difference:"), "{page}");
    assert!(page.contains("fill=\"rgb(131 38 129)\"></rect></svg> from 1<"), "{page}");
    assert!(!served.page(&format!("/runs/{passed}")).contains("<img"));
}

/// Rows that never came back are black in the frame that is kept, which says nothing of the board.
#[test]
fn rows_that_never_came_back_are_shown_as_missing() {
    let folder = common::folder();
    let board = "mock,fault=stuck-data,bit=7,fault=disconnect,byte=9000";
    assert_eq!(judge(folder.path(), board, "CAT00001"), Some(3));
    let served = Served::of(Made::at(folder));
    let run = &listed(&served.page("/history"))[0];
    let page = served.page(&format!("/runs/{run}"));
    let map = all_between(&page, "<img src=\"", '"').pop().unwrap();
    let pictures = common::folder();
    let file = pictures.path().join("map.png");
    std::fs::write(&file, served.get(&map).body).unwrap();
    let map = halfrow::frames::read_rgb(&file).unwrap();
    let shown = |row: &[u8]| row.chunks(3).all(|pixel| pixel == [0x56, 0xb4, 0xe9]);
    let rows: Vec<_> = map.data.chunks(3 * map.width).map(shown).collect();
    let came = rows.iter().filter(|is_missing| !**is_missing).count();
    assert!((1..8).contains(&came) && rows[came..].iter().all(|is_missing| *is_missing), "{rows:?}");
    assert!(page.contains("fill=\"rgb(86 180 233)\"></rect></svg> did not come back<"), "{page}");
}
