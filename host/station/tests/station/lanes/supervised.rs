//! A lane, as its supervisor hears it.

use std::thread;
use std::time::Duration;

use halfrow::verdict::StoppedBy;
use halfrow_station::lane::supervisor::{Attendant, End, Patience, supervise};
use halfrow_station::lane::{Job, Message, Ruling};
use halfrow_station::record::BoardSeen;

use super::floor::HANG;
use crate::common::{folder, script};

/// A station that takes so long over every message.
struct Slow(Duration);

impl Attendant for Slow {
    fn stop(&self) -> Option<StoppedBy> {
        None
    }

    fn hear(&mut self, _: &Message) {
        thread::sleep(self.0);
    }

    fn rule(&mut self, _: &BoardSeen) -> Ruling {
        Ruling::New
    }
}

/// Both messages are there before the first one is taken.
const TWO: &str = r#"read -r job
printf '{"told":"doing","what":"frames"}\n{"told":"done"}\n'
"#;

#[test]
fn a_lane_is_not_silent_while_the_station_takes_what_it_told() {
    let folder = folder();
    let lane = script(folder.path(), "lane", TWO);
    let [text, sha256, variant] = [""; 3].map(str::to_owned);
    let job = Job {
        run: "run".to_owned(),
        target: "mock".to_owned(),
        plan: folder.path().join("plan.toml"),
        text,
        sha256,
        variant,
        seed: 0,
        is_mock: false,
        spool: folder.path().to_owned(),
        memory_mib: 64,
    };
    let silence = Duration::from_secs(2);
    let heard = supervise(
        &lane,
        &job,
        folder.path(),
        Patience { silence, whole: HANG },
        &mut Slow(silence + Duration::from_millis(100)),
    );
    assert_eq!(heard.end, End::Done);
}
