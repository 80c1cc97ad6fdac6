//! The program is killed at every call by which something gets to the disk or to the screen.

use crate::bench::{PLAN, Station};
use crate::unsaved::{calls, injected};

/// Whatever changes the disk, and what says something.
const CALLS: &str =
    "write,pwrite64,fdatasync,fsync,rename,renameat,renameat2,link,linkat,unlink,unlinkat,ftruncate,mkdir";

/// Kills a run at each of these points, and looks each time at what the next start finds. Returns how often the lane had
/// judged the board good and the store has no PASS.
fn sweep(points: impl Iterator<Item = usize>) -> usize {
    let station = Station::with(PLAN);
    station.run("CAT00000", "mock");
    let (mut judged_only, mut greens, mut serials) = (0, 0, 0);
    for point in points {
        serials += 1;
        let serial = format!("CAT{serials:05}");
        let did = injected(&station, &serial, &format!("{CALLS}:signal=KILL:when={point}"));
        let is_green = did.said.contains("PASS");
        let of_unit = |what: &str| {
            station.query(&format!(
                "SELECT {what} FROM run JOIN unit ON unit.id = unit_id WHERE serial = '{serial}'"
            ))
        };
        let judged = spooled(&station)
            .contains("\"evidence\":{\"schema\":1,\"command\":\"verify\",\"verdict\":\"PASS\"");
        // The next start, which is a start after a crash.
        let next = station.run("CAT00000", "mock");
        assert_eq!(next.code, Some(0), "after point {point}: {next:?}");
        let verdicts = of_unit("verdict");
        assert!(verdicts.len() <= 1, "point {point}: {verdicts:?}");
        assert_eq!(of_unit("state").iter().filter(|state| *state == "open").count(), 0, "point {point}");
        if is_green {
            assert_eq!(verdicts, ["PASS"], "point {point}: green without a row");
            greens += 1;
        }
        judged_only += usize::from(judged && verdicts != ["PASS"]);
    }
    let checked = station.check();
    assert_eq!(checked.code, Some(0), "{checked:?}");
    assert!(greens < serials, "nothing was killed");
    judged_only
}

/// What the lane of the run that is open has told.
fn spooled(station: &Station) -> String {
    let runs = std::fs::read_dir(station.data().join("spool")).unwrap();
    let events =
        runs.map(|run| std::fs::read_to_string(run.unwrap().path().join("events.jsonl")).unwrap_or_default());
    events.collect()
}

fn all_points() -> usize {
    let station = Station::with(PLAN);
    station.run("CAT00000", "mock");
    calls(&station, "CAT00001", CALLS)
}

/// The control is in it: had the verdict been shown when the lane told it, and not when it was saved, some of these runs would
/// have been green without a row.
#[test]
fn no_green_is_lost_wherever_the_program_is_killed() {
    let all = all_points();
    assert!(all >= 40, "{all} points");
    // The last third is where results are saved.
    let few = (1..=all).filter(|point| if *point > 2 * all / 3 { point % 3 == 0 } else { point % 9 == 0 });
    let judged_only = sweep(few);
    assert!(judged_only > 0, "the control");
}

/// At every point; takes some minutes.
#[test]
#[ignore = "for scripts/soak"]
fn no_green_is_lost_at_any_point() {
    let all = all_points();
    let judged_only = sweep(1..=all + 1);
    assert!(judged_only > 5, "the control, of {all} points: {judged_only}");
}
