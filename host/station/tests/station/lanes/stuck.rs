//! A lane whose process cannot be killed.

use std::fs;
use std::path::{Path, PathBuf};

use halfrow_station::engine::{Engine, LaneState, News};
use halfrow_station::floor::Word;
use halfrow_station::settings::Settings;
use halfrow_station::store::{Folder, Store};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use super::floor::{HANG, SERIALS, Station};
use crate::common::program_of;

/// A program whose lanes stay silent, and leave the process group that is killed then.
pub(crate) struct Stuck {
    pub(crate) program: PathBuf,
    ids: PathBuf,
}

impl Stuck {
    pub(crate) fn in_folder(folder: &Path) -> Self {
        let ids = folder.join("stuck.ids");
        let noted = format!("open(my $ids, '>>', '{}'); print $ids \"$$\\n\"; close($ids);", ids.display());
        let script = format!("#!/usr/bin/perl\n{noted}\nsetpgrp(0, getpgrp(getppid()));\nsleep(600);\n");
        Self { program: program_of(folder, "stuck", &script), ids }
    }
}

impl Drop for Stuck {
    fn drop(&mut self) {
        for id in fs::read_to_string(&self.ids).unwrap_or_default().lines() {
            let _ = kill(Pid::from_raw(id.parse().unwrap()), Signal::SIGKILL);
        }
    }
}

/// Its result cannot be saved, either; after that is put right, the lane is still out of service.
#[test]
fn a_lane_whose_process_cannot_be_killed_is_out_though_its_result_was_not_saved() {
    let station = Station::with(&["mock"], "").with_silence(15);
    let path = station.path("station.toml");
    let stuck = Stuck::in_folder(&station.path(""));
    let settings = Settings::load(&path).unwrap();
    let store = Store::open(&Folder::new(&settings.data)).unwrap();
    let full = "CREATE TRIGGER full BEFORE UPDATE ON run BEGIN SELECT RAISE(ABORT, 'full'); END";
    station.change(full);
    let engine = Engine::start(settings, store, stuck.program.clone()).unwrap();
    let news = engine.listen();
    let state = |word| {
        let is = |news: &News| matches!(news, News::Lane(LaneState { state, .. }) if *state == word);
        loop {
            let news = news.recv_timeout(HANG).unwrap();
            if is(&news) {
                break news;
            }
        }
    };
    state(Word::Ready);
    engine.label(1, Some(0), SERIALS[0], "weber", None);
    state(Word::Unsaved);
    station.change("DROP TRIGGER full");
    let settled = news.iter().find_map(|news| match news {
        News::Lane(lane) if lane.state != Word::Unsaved => Some(lane),
        _ => None,
    });
    let settled = settled.unwrap();
    assert_eq!(settled.state, Word::Out, "{settled:?}");
    assert!(settled.note.unwrap().to_string().contains("cannot be killed"));
    assert_eq!(settled.shown.unwrap().verdict, halfrow::Verdict::Error);
    engine.close(None);
    drop(engine);
    station.assert_well();
}
