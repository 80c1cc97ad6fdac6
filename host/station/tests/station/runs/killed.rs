//! The program is killed at every call that brings something to the disk or to the screen.

use super::bench::{PLAN, Station};
use super::checked::evidence;
use super::unsaved::{Call, calls, injected};

/// System calls that change the disk or print something.
const CALLS: &str =
    "write,pwrite64,fdatasync,fsync,rename,renameat,renameat2,link,linkat,unlink,unlinkat,ftruncate,mkdir";

/// Kills a run at each of these calls, and checks what the next start finds. Returns how often the lane had judged the board good
/// although the store has no PASS.
fn sweep(points: &[Call]) -> usize {
    let station = Station::with(PLAN);
    station.run("CAT00000", "mock");
    let (mut judged_only, mut greens, mut serials) = (0, 0, 0);
    for point @ (name, number) in points {
        serials += 1;
        let serial = format!("CAT{serials:05}");
        let did = injected(&station, &serial, &format!("{name}:signal=KILL:when={number}"));
        let is_green = did.said.contains("PASS");
        let of_unit = |what: &str| {
            station.query(&format!(
                "SELECT {what} FROM run JOIN unit ON unit.id = unit_id WHERE serial = '{serial}'"
            ))
        };
        let judged = spooled(&station)
            .contains("\"evidence\":{\"schema\":1,\"command\":\"verify\",\"verdict\":\"PASS\"");
        // The next start, which follows a crash.
        let next = station.run("CAT00000", "mock");
        assert_eq!(next.code, Some(0), "after {point:?}: {next:?}");
        let verdicts = of_unit("verdict");
        assert!(verdicts.len() <= 1, "{point:?}: {verdicts:?}");
        assert_eq!(of_unit("state").iter().filter(|state| *state == "open").count(), 0, "{point:?}");
        if is_green {
            assert_eq!(verdicts, ["PASS"], "{point:?}: green without a row");
            greens += 1;
        }
        judged_only += usize::from(judged && verdicts != ["PASS"]);
    }
    let checked = station.check();
    assert_eq!(checked.code, Some(0), "{checked:?}");
    assert!(0 < greens && greens < serials, "{greens} of {serials} were green");
    assert_eq!(half_written(&station), Vec::<String>::new());
    judged_only
}

/// The messages of the open run's lane.
fn spooled(station: &Station) -> String {
    let runs = std::fs::read_dir(station.data().join("spool")).unwrap();
    let events =
        runs.map(|run| std::fs::read_to_string(run.unwrap().path().join("events.jsonl")).unwrap_or_default());
    events.collect()
}

/// Files among the evidence that are not evidence.
fn half_written(station: &Station) -> Vec<String> {
    let names =
        evidence(station).into_iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned());
    names.filter(|name| name.len() != 64).collect()
}

fn all_points() -> Vec<Call> {
    let station = Station::with(PLAN);
    station.run("CAT00000", "mock");
    let all = calls(&station, "CAT00001", CALLS);
    assert!(all.len() >= 40, "{all:?}");
    all
}

/// The test contains its control: if the verdict were shown when the lane sends it, and not when it is saved, some of these runs
/// would be green without a row.
#[test]
fn no_green_is_lost_wherever_the_program_is_killed() {
    let all = all_points();
    // Results are saved in the second half.
    let one_in = |number| if 2 * number > all.len() { 4 } else { 12 };
    let few = all.iter().enumerate().filter(|(number, _)| number % one_in(*number) == 0);
    let judged_only = sweep(&few.map(|(_, call)| call.clone()).collect::<Vec<_>>());
    assert!(judged_only > 0, "the control");
}

/// In a folder that has no earlier results.
#[test]
fn a_first_start_is_in_no_other_s_way_wherever_it_is_killed() {
    let all = calls(&Station::with(PLAN), "CAT00000", "fsync,fdatasync");
    assert!(all.len() >= 10, "{all:?}");
    for (name, number) in all {
        let station = Station::with(PLAN);
        injected(&station, "CAT00001", &format!("{name}:signal=KILL:when={number}"));
        let next = station.run("CAT00000", "mock");
        assert_eq!(next.code, Some(0), "{name} {number}: {next:?}");
    }
}

/// At every call.
#[test]
#[ignore = "for scripts/soak"]
fn no_green_is_lost_at_any_point() {
    let all = all_points();
    let judged_only = sweep(&all);
    assert!(judged_only > 5, "the control, of {} calls: {judged_only}", all.len());
}
