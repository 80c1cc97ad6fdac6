//! Lamps, printers and relays.

use std::process::Command;

use super::floor::{SERIALS, Station};
use super::stuck::Stuck;
use crate::common::{logged, program, script, until};

/// The hook records its arguments, and fails if the record is not stored by then, or if it is given the plant's password.
#[test]
fn hooks_are_told_after_the_commit() {
    let settings = r#"
[[on-pass]]
program = "./lamp"
arguments = ["{lane}", "{serial}", "{verdict}", "{record}"]
[[on-fail]]
program = "./lamp"
arguments = ["{lane}", "{serial}", "{verdict}", "{record}"]
"#;
    let station = Station::with(&["mock", "mock,fault=stuck-data"], settings);
    let lines = "echo \"$1 $2 $3\" > \"$(dirname \"$0\")/lamp-$1\"\n\
                  find \"$(dirname \"$0\")/data/blobs\" -name \"$4\" | grep -q . || exit 1\n\
                  [ -z \"$HALFROW_PLANT_PASSWORD\" ] || exit 1\n";
    script(&station.path(""), "lamp", lines);
    let mut program = Command::new(program());
    program.env("HALFROW_PLANT_PASSWORD", "rosebud-5e1f");
    let mut running = station.started(program);
    running.test("1", SERIALS[0]);
    running.test("2", SERIALS[1]);
    let (code, heard) = running.end();
    assert_eq!(code, Some(0));
    assert_eq!(heard.iter().filter(|news| news["news"] == "hook").count(), 0, "{heard:#?}");
    let lamp = |lane: &str| std::fs::read_to_string(station.path(&format!("lamp-{lane}"))).unwrap();
    assert_eq!(lamp("1").trim(), format!("1 {} PASS", SERIALS[0]));
    assert_eq!(lamp("2").trim(), format!("2 {} FAIL", SERIALS[1]));
}

/// The hook of an earlier PASS must not light its lamp over a later FAIL. The first hook waits for a file that is written after
/// two more verdicts.
#[test]
fn the_hooks_of_a_lane_run_in_the_order_of_its_verdicts_and_keep_it_from_no_test() {
    let settings = r#"
[[on-pass]]
program = "./lamp"
arguments = ["{serial}"]
deadline = 600
"#;
    let station = Station::with(&["mock"], settings);
    let lines = format!(
        "cd \"$(dirname \"$0\")\"\necho \"begins $1\" >> lit\n\
         [ $1 != {} ] || while [ ! -e go ]; do sleep 0.1; done\necho \"ends $1\" >> lit\n",
        SERIALS[0]
    );
    script(&station.path(""), "lamp", &lines);
    let mut running = station.start();
    for serial in &SERIALS[..3] {
        running.scan(serial);
        running.state("1", "PASS");
    }
    std::fs::write(station.path("go"), "").unwrap();
    let (code, heard) = running.end();
    assert_eq!(code, Some(0));
    assert_eq!(heard.iter().filter(|news| news["news"] == "hook").count(), 0, "{heard:#?}");
    let in_order: String =
        SERIALS[..3].iter().map(|serial| format!("begins {serial}\nends {serial}\n")).collect();
    assert_eq!(std::fs::read_to_string(station.path("lit")).unwrap(), in_order);
}

#[test]
fn a_hook_that_fails_or_hangs_is_shown_and_changes_no_verdict() {
    let settings = r#"
[[on-pass]]
program = "sh"
arguments = ["-c", "echo no paper >&2; exit 3"]
[[on-pass]]
program = "sleep"
arguments = ["1000"]
deadline = 0.5
[[on-pass]]
program = "no-such-program"
"#;
    let station = Station::with(&["mock"], settings);
    let (mut running, log) = station.start_logging();
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    for said in ["no paper", "was killed after 0.5 s", "cannot be started"] {
        let news = running.wait(said, |news| news["news"] == "hook");
        assert!(news["said"].as_str().unwrap().contains(said), "{news}");
        // By then the next board may be in the lane.
        assert_eq!(news["serial"], SERIALS[0], "{news}");
    }
    logged(&log, 3, &format!("WARN lane 1, {}: the hook ", SERIALS[0]));
    let (code, heard) = running.end();
    assert_eq!(code, Some(0));
    let last = heard.iter().rfind(|news| news["news"] == "lane").unwrap();
    assert_eq!(last["state"], "PASS");
    assert_eq!(station.query("SELECT verdict FROM run"), ["PASS"]);
}

/// A label printer that prints much on stderr is not interrupted.
#[test]
fn a_hook_that_complains_at_length_does_its_work_and_is_heard_from_its_beginning() {
    let settings = r#"
[[on-pass]]
program = "sh"
arguments = ["-c", "echo no paper >&2; yes | head -c 300000 >&2 || exit 4; echo printed > done; exit 3"]
"#;
    let station = Station::with(&["mock"], settings);
    let mut program = Command::new(program());
    program.current_dir(station.path(""));
    let mut running = station.started(program);
    running.scan(SERIALS[0]);
    let news = running.wait("what the hook says", |news| news["news"] == "hook");
    let said = news["said"].as_str().unwrap();
    assert!(said.contains("(exit status: 3): no paper y y") && said.len() < 2000, "{said}");
    assert_eq!(std::fs::read_to_string(station.path("done")).unwrap(), "printed\n");
    running.end();
}

#[test]
fn a_hook_that_cannot_be_killed_is_waited_for_no_longer() {
    let hook = "[[on-pass]]\nprogram = \"./stuck\"\ndeadline = 1\n";
    let station = Station::with(&["mock"], hook);
    let _stuck = Stuck::in_folder(&station.path(""));
    let mut running = station.start();
    running.scan(SERIALS[0]);
    let news = running.wait("a hook that failed", |news| news["news"] == "hook");
    assert!(news["said"].as_str().unwrap().contains("was killed after 1 s"), "{news}");
    assert_eq!(running.end().0, Some(0));
}

#[test]
fn a_hook_that_failed_is_told_though_what_it_has_started_may_say_more() {
    let hook = "[[on-pass]]\nprogram = \"./lamp\"\n";
    let station = Station::with(&["mock"], hook);
    script(&station.path(""), "lamp", "setsid sleep 150 &\nexit 3\n");
    let mut running = station.start();
    running.scan(SERIALS[0]);
    let news = running.wait("a hook that failed", |news| news["news"] == "hook");
    assert!(news["said"].as_str().unwrap().contains("failed (exit status: 3)"), "{news}");
    assert_eq!(running.end().0, Some(0));
}

/// What the hooks of this station wrote, a line for each.
fn lit(station: &Station) -> Vec<String> {
    let lit = std::fs::read_to_string(station.path("lit")).unwrap_or_default();
    lit.lines().map(str::to_owned).collect()
}

/// Hooks of every kind, which write what they show.
fn lamps(station: &Station) -> String {
    let script = script(&station.path(""), "lamp", "echo \"$1\" >> \"$(dirname \"$0\")/lit\"\n");
    let hook = |on: &str, shows: &str| {
        format!("[[on-{on}]]\nprogram = \"{}\"\narguments = [\"{shows}\"]\n", script.display())
    };
    let verdicts = ["pass", "fail", "error"].map(|on| hook(on, "{lane} {verdict}")).concat();
    verdicts + &hook("clear", "{lane} off")
}

/// A lamp that an earlier start, or the board before, has left green must not shine over a board that nobody judged.
#[test]
fn a_lamp_is_put_out_when_the_page_shows_no_verdict_any_more() {
    let station = Station::with(&["serial:port", "mock"], "");
    let port = station.path("port");
    let settings = std::fs::read_to_string(station.path("station.toml")).unwrap();
    let settings = settings.replace("serial:port", &format!("serial:{}", port.display()));
    std::fs::write(station.path("station.toml"), settings + &lamps(&station)).unwrap();
    let mut running = station.start();
    // The settings have been read: with such a file in the place of the port they would be refused.
    running.state("2", "READY");
    std::fs::write(&port, "").unwrap();
    running.state("1", "READY");
    running.test("1", SERIALS[0]);
    running.state("1", "ERROR");
    std::fs::remove_file(&port).unwrap();
    running.wait("an empty lane", |news| news["lane"] == "1" && news["is_present"] == false);
    until("the lamp of the verdict", || lit(&station).last().is_some_and(|last| last == "1 ERROR"));
    std::fs::write(&port, "").unwrap();
    assert_eq!(running.state("1", "READY")["last"]["verdict"], "ERROR");
    until("a lamp that is out", || lit(&station).last().is_some_and(|last| last == "1 off"));
    for serial in [SERIALS[1], SERIALS[2]] {
        running.test("2", serial);
        running.state("2", "PASS");
    }
    let (code, heard) = running.end();
    assert_eq!(code, Some(0));
    assert_eq!(heard.iter().filter(|news| news["news"] == "hook").count(), 0, "{heard:#?}");
    let of = |lane: &str| {
        let lit = lit(&station).into_iter().filter(|line| line.starts_with(lane));
        lit.map(|line| line[2..].to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(of("1"), ["off", "ERROR", "off", "off"]);
    assert_eq!(of("2"), ["off", "PASS", "off", "PASS", "off"], "by the next serial number, and at the end");
}
