//! What `verify` prints, and where.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use halfrow_tests::program::{Folder, command, finish, halfrow};

use nix::fcntl::OFlag;
use nix::pty::{grantpt, posix_openpt, ptsname_r, unlockpt};

use crate::{refused, small};

const ESCAPE: char = '\u{1b}';

#[test]
fn json_begins_with_schema_command_verdict_exit_code_and_kind_of_board() {
    let ended = halfrow(small("verify", &["--json", "--operator", "Ada Weber"]));
    let beginning = "{\n  \"schema\": 1,\n  \"command\": \"verify\",\n  \"verdict\": \"PASS\",\n  \"exit_code\": 0,\n  \"board\": {\n    \"kind\": \"mock\",";
    assert!(ended.stdout.starts_with(beginning), "{}", ended.stdout);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert_eq!(ended.json()["run"]["operator"], "Ada Weber");
}

#[test]
fn json_of_a_refused_call_has_no_verdict() {
    let ended = halfrow(["verify", "--json", "--width", "63"]);
    assert_eq!(ended.code, Some(2));
    let said = ended.json();
    assert!(said["verdict"].is_null() && said["board"].is_null());
    assert_eq!(said["exit_code"], 2);
    assert!(ended.stderr.contains(said["error"]["message"].as_str().unwrap()));
}

#[test]
fn the_text_ends_with_the_verdict_and_says_that_no_hardware_was_tested() {
    let ended = halfrow(small("verify", &[]));
    let last = ended.stdout.trim_end().lines().last().unwrap();
    assert!(
        last.starts_with("PASS (mock board: no hardware was tested)  19 frames, 38,912 samples equal"),
        "{last}"
    );
}

#[test]
fn the_text_of_a_failure_names_the_suspect_and_what_to_do() {
    let ended = halfrow(small("verify", &["--board", "mock,fault=stuck-data"]));
    assert_eq!(ended.code, Some(1));
    assert!(ended.stdout.contains("line memory, data bit 5 stuck at 1"), "{}", ended.stdout);
    assert!(ended.stdout.contains("Next: Check data line 5"), "{}", ended.stdout);
    let last = ended.stdout.lines().last().unwrap();
    assert!(last.starts_with("FAIL: "), "{last}");
    let error = halfrow(small("verify", &["--board", "mock,fault=truncate,rate=0.2"]));
    let last = error.stdout.lines().last().unwrap();
    assert!(error.code == Some(3) && last.starts_with("ERROR: "), "{last}");
}

#[test]
fn colours_are_for_terminals_and_for_those_who_ask() {
    let arguments = small("verify", &["--frame", "builtin:black"]);
    let plain = finish(&mut command(arguments.clone()));
    let forced = finish(command(arguments.clone()).env("CLICOLOR_FORCE", "1"));
    let refused = finish(command(arguments).env("CLICOLOR_FORCE", "1").env("NO_COLOR", "1"));
    assert!(!plain.stdout.contains(ESCAPE) && !plain.stderr.contains(ESCAPE));
    assert!(forced.stdout.contains(ESCAPE));
    assert!(!refused.stdout.contains(ESCAPE) && !refused.stderr.contains(ESCAPE));
}

/// What `command` sends to a terminal of `columns` columns.
fn on_terminal(columns: &str, command: &mut Command) -> String {
    let mut master = posix_openpt(OFlag::O_RDWR | OFlag::O_NOCTTY | OFlag::O_CLOEXEC).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let path = ptsname_r(&master).unwrap();
    assert!(Command::new("stty").args(["-F", &path, "cols", columns]).status().unwrap().success());
    let terminal = File::options().write(true).open(&path).unwrap();
    let mut child = command.stdout(terminal).stderr(Stdio::null()).spawn().unwrap();
    command.stdout(Stdio::null());
    let mut sent = Vec::new();
    // Reading fails once nobody has the terminal open.
    let _ = master.read_to_end(&mut sent);
    assert!(child.wait().unwrap().success());
    String::from_utf8(sent).unwrap().replace("\r\n", "\n")
}

/// Longer lines are harder to read: a wide terminal shows what a narrow one does, and no line is broken twice.
#[test]
fn a_terminal_shows_the_text_in_colours_and_within_80_columns_however_wide_it_is() {
    let arguments = small("verify", &["--operator", "Ada Weber"]);
    let narrow = on_terminal("80", &mut command(arguments.clone()));
    let wide = on_terminal("200", &mut command(arguments.clone()));
    let plain = on_terminal("200", command(arguments).env("NO_COLOR", "1"));
    let seen = anstream::adapter::strip_str(&narrow).to_string();
    // The verdict is one line, so that it can be searched for.
    let (text, verdict) = seen.trim_end().rsplit_once('\n').unwrap();
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{seen}");
    assert!(verdict.starts_with("PASS (mock board") && seen.contains("\noperator Ada Weber\n"), "{seen}");
    // Times may differ, but the layout does not.
    let shape = |text: &str| -> Vec<_> {
        text.lines().map(|line| line.split(' ').next().map(str::to_owned)).collect()
    };
    assert!(narrow.contains(ESCAPE) && shape(&narrow) == shape(&wide), "{narrow}\n{wide}");
    assert!(!plain.contains(ESCAPE), "{plain}");
}

#[test]
fn the_list_names_every_frame_and_opens_no_board() {
    let ended = halfrow(small("verify", &["--list", "--board", "mock,fault=disconnect,byte=0"])).succeeded();
    let listed = ended.stdout.lines().take_while(|line| !line.is_empty());
    assert_eq!(listed.count(), 19);
    assert!(ended.stdout.contains("builtin:zone-plate"), "{}", ended.stdout);
}

/// For each link that the list covers, its rate and the prices of the parts.
fn listed_prices(board: &str) -> Vec<(f64, Vec<(String, f64)>)> {
    let listed = halfrow(["verify", "--list", "--json", "--board", board]).json();
    let links = listed["prices"].as_array().cloned().unwrap_or_default();
    let part = |it: &serde_json::Value| {
        (it["part"].as_str().unwrap_or_default().to_owned(), it["seconds"].as_f64().unwrap_or_default())
    };
    let parts = |link: &serde_json::Value| link["parts"].as_array().unwrap().iter().map(part).collect();
    links.iter().map(|link| (link["bytes_per_second"].as_f64().unwrap(), parts(link))).collect()
}

#[test]
fn the_list_prices_each_part_at_the_link_that_the_target_names_or_at_usual_ones() {
    let usual = listed_prices("mock");
    assert_eq!(usual.iter().map(|(rate, _)| *rate).collect::<Vec<_>>(), [300e3, 1200e3, 5000e3]);
    let price = |parts: &[(String, f64)], name: &str| parts.iter().find(|part| part.0 == name).unwrap().1;
    // 1080 rows, each with 2880 bytes of samples, 26 of place and figures, 18 of its packet and 11 of stuffing.
    let row = 2880 + 26 + 18 + 11;
    for (rate, parts) in &usual {
        let carried = f64::from(row * 1079) / rate;
        let street = price(parts, "builtin:street");
        // At 5 MB/s the board has too few banks to fill the round trip.
        let most = if *rate < 5e6 { 1.02 } else { 1.3 };
        assert!((carried..carried * most + 0.01).contains(&street), "{street} {carried}");
        // Three frames on the mock cost the link their tables, and take 65 ms.
        assert!(price(parts, "at speed") < 0.2 + 5000.0 / rate, "{rate}");
    }
    let [(rate, own)] = &listed_prices("mock,speed=1200000")[..] else { panic!() };
    assert_eq!((*rate, own), (1.2e6, &usual[1].1));
    // 3 Mbaud are 300,000 bytes a second; the port is not opened.
    for options in ["baud=3000000", "board=ulx3s"] {
        let prices = listed_prices(&format!("serial:/dev/no-such-port,{options}"));
        let [(rate, _)] = &prices[..] else { panic!("{options}") };
        assert_eq!(*rate, 3e5, "{options}");
    }
    let text = halfrow(["verify", "--list", "--board", "mock,speed=1200000"]).stdout;
    let last = text.lines().last().unwrap_or_default();
    assert!(last.starts_with("the whole run") && last.ends_with(" s"), "{text}");
}

#[test]
fn where_hardware_is_required_the_mock_is_not_judged() {
    let flag = halfrow(small("verify", &["--json", "--require-hardware"]));
    let variable = finish(command(small("verify", &["--json"])).env("HALFROW_REQUIRE_HARDWARE", "1"));
    for ended in [flag, variable] {
        assert_eq!((ended.code, &ended.json()["verdict"]), (Some(5), &"ERROR".into()));
        assert_eq!(ended.json()["frames"], serde_json::json!([]));
    }
}

#[test]
fn the_log_goes_to_stderr_alone() {
    let poor = small("verify", &["--board", "mock,fault=drop,packet=60,toward=board"]);
    let quiet = halfrow(poor.clone());
    assert_eq!((quiet.code, quiet.stderr.as_str()), (Some(0), ""));
    let talkative = halfrow(poor.into_iter().chain(["-v"])).succeeded();
    assert!(talkative.stderr.contains("is missing; sending it again"), "{}", talkative.stderr);
    assert!(!talkative.stdout.contains("INFO"), "{}", talkative.stdout);
}

#[test]
fn more_of_the_log_tells_of_damaged_packets() {
    let arguments = small("verify", &["--board", "mock,fault=flip,packet=60,toward=host", "-vv"]);
    assert!(halfrow(arguments).stderr.contains("a damaged packet: "));
}

#[test]
fn a_reader_that_goes_away_changes_no_verdict() {
    let mut run = command(small("verify", &["--board", "mock,fault=late"]));
    let mut child = run.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(1));
}

#[test]
fn a_run_ends_at_its_time_limit() {
    let arguments = small("verify", &["--json", "--board", "mock,speed=1000", "--timeout", "20"]);
    let ended = halfrow(arguments);
    assert_eq!(ended.code, Some(3));
    let headline = ended.json()["headline"].as_str().unwrap().to_owned();
    assert!(headline.contains("the run did not end within its time limit of 20.0 s"), "{headline}");
}

/// No defect is reported, since the board's tables were not read back.
#[test]
fn what_differed_until_a_run_broke_off_is_told() {
    let board = "mock,fault=stuck-data,bit=7,speed=10000";
    let ended = halfrow(small("verify", &["--json", "--board", board, "--repeat", "40", "--timeout", "30"]));
    assert_eq!(ended.code, Some(3));
    let (said, headline) = (ended.json(), ended.json()["headline"].as_str().unwrap().to_owned());
    let frames = said["frames"].as_array().unwrap();
    let wrong = frames.iter().filter(|frame| frame["comparison"]["differences"].as_u64() > Some(0)).count();
    assert!(wrong > 10, "{wrong}");
    let told = format!(
        "in {wrong} of {} frames, and the run broke off before that was looked into: the run did not end",
        frames.len()
    );
    assert!(headline.contains(&told), "{headline}");
    assert_eq!(said["error"]["code"], "run-too-long");
}

/// The message does not ask for more time: the link's pace is not the reason.
#[test]
fn a_run_whose_board_is_silent_when_its_time_ends_says_so() {
    let board = "mock,fault=stall,packet=300,seconds=60";
    let ended = halfrow(small("verify", &["--json", "--board", board, "--timeout", "5"]));
    assert_eq!(ended.code, Some(3));
    let headline = ended.json()["headline"].as_str().unwrap().to_owned();
    assert!(
        headline.contains("within its time limit of 5.0 s, and no packet came in the last"),
        "{headline}"
    );
}

#[test]
fn a_stricter_limit_on_retries_makes_a_link_too_poor() {
    let board = "mock,fault=truncate,rate=0.05,seed=1";
    halfrow(small("verify", &["--board", board, "--retry-limit", "100"])).succeeded();
    let strict = halfrow(small("verify", &["--board", board, "--retry-limit", "0"]));
    assert_eq!(strict.code, Some(3), "{}", strict.stdout);
    assert!(strict.stdout.contains("the link is too poor to judge a board over"), "{}", strict.stdout);
}

#[test]
fn limits_that_make_no_sense_are_refused() {
    let folder = Folder::new();
    refused(&folder, &["verify", "--repeat", "0"], "give a whole number, 1 to 1000");
    for command in [&["verify"][..], &["soak", "--frames", "3"], &["link"]] {
        for time in ["-1", "0", "1e-12", "nan", "inf", "1e300"] {
            let timeout = format!("--timeout={time}");
            refused(
                &folder,
                &[command, &[&timeout]].concat(),
                "--timeout takes a number of seconds; give more than 0",
            );
        }
    }
    refused(&folder, &["verify", "--timeout=soon"], "invalid value 'soon'");
    refused(&folder, &["verify", "--retry-limit=-1"], "percent");
    refused(&folder, &["verify", "--retry-limit=nan"], "percent");
    refused(&folder, &["verify", "--seed=-1"], "give a whole number, 0 to 18446744073709551615");
}

/// A board in this program has a clock of its own, but --timeout also limits how long a user waits.
#[test]
fn the_time_limit_is_also_this_computer_s() {
    let folder = Folder::new();
    folder.halfrow(small("verify", &["--record", "run.rec"])).succeeded();
    let mock = folder.halfrow(small("verify", &["--timeout", "1e-5"]));
    let replay = folder.halfrow(["verify", "--board", "replay:run.rec", "--timeout", "1e-5"]);
    for ended in [mock, replay] {
        assert_eq!(ended.code, Some(3), "{}", ended.stdout);
        assert!(
            ended.stdout.contains("the run did not end within its time limit (--timeout) of 10.0 µs"),
            "{}",
            ended.stdout
        );
    }
}

/// A board that has answered exists, so what lies between is the suspect.
#[test]
fn a_board_that_falls_silent_behind_a_noisy_link_is_not_the_suspect() {
    let silent = halfrow(small("verify", &["--board", "mock,fault=stall,packet=0,seconds=1000"]));
    assert_eq!(silent.code, Some(3));
    let last = silent.stdout.lines().last().unwrap();
    assert!(last.contains("check that the board is powered and loaded"), "{last}");
    for (fault, sentence) in [
        ("stall,packet=60,seconds=1000", "though the board had answered before; check the cable"),
        ("flip,rate=1e-3,seed=1", "came damaged: the link loses what is sent over it; check the cable"),
    ] {
        let ended = halfrow(small("verify", &["--board", &format!("mock,fault={fault}")]));
        assert_eq!(ended.code, Some(3));
        let last = ended.stdout.lines().last().unwrap();
        assert!(last.contains(sentence) && !last.contains("powered and loaded"), "{last}");
    }
}

/// Another device at the port, or another rate: bytes come, but they are no packets.
#[test]
fn bytes_that_are_no_packets_are_told_from_silence() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    thread::spawn(move || {
        let (mut peer, _) = listener.accept().unwrap();
        while peer.write_all(b"login: ").is_ok() {
            thread::sleep(Duration::from_millis(50));
        }
    });
    let ended = halfrow(small("verify", &["--board", &target]));
    assert_eq!(ended.code, Some(3));
    let last = ended.stdout.lines().last().unwrap();
    assert!(last.contains(" bytes came, with no packet among them; check that the target's rate"), "{last}");
}

/// An earlier PASS must not remain where the report of this run belongs.
#[test]
fn a_board_that_cannot_be_opened_has_a_report_too() {
    let folder = Folder::new();
    let into = ["--report", "out", "--overwrite"];
    folder.halfrow(small("verify", &into)).succeeded();
    for command in ["verify", "soak"] {
        let absent = [&into[..], &["--board", "serial:/dev/no-such-port"]].concat();
        let absent = if command == "soak" { [&absent[..], &["--frames", "1"]].concat() } else { absent };
        let ended = folder.halfrow(small(command, &absent));
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(3), ""), "{}", ended.stderr);
        let report = folder.json("out/report.json");
        assert_eq!(report["verdict"], "ERROR");
        assert!(ended.stderr.contains(report["error"]["message"].as_str().unwrap()), "{report}");
        assert!(folder.text("out/report.xml").contains("errors=\"2\""));
    }
    // A wrong call is no run, and removes nothing.
    let wrong = folder.halfrow(small("verify", &[&into[..], &["--board", "serial"]].concat()));
    assert_eq!(wrong.code, Some(2));
    assert_eq!(folder.names("out"), ["report.html", "report.json", "report.xml"]);
    let wrong = folder.halfrow(small("verify", &["--report", "new", "--board", "serial"]));
    assert_eq!(wrong.code, Some(2));
    assert!(!folder.path().join("new").exists());
}

/// The message names a mock that is large enough, and that mock passes.
#[test]
fn a_mock_that_is_too_small_is_told_how_it_is_made_larger() {
    let wide = ["--width", "2592", "--height", "4", "--frame", "builtin:grey"];
    let call = |board| ["verify", "-q", "--board", board].into_iter().chain(wide);
    refused(
        &Folder::new(),
        &call("mock").collect::<Vec<_>>(),
        "or the built-in mock with room for these: mock,max-width=2592",
    );
    halfrow(call("mock,max-width=2592")).succeeded();
    let high = ["verify", "-q", "--board", "mock,max-height=8", "--width", "64", "--height", "9"];
    refused(&Folder::new(), &high, "room for these: mock,max-width=64,max-height=9");
}

/// By its own clock, a wire without a speed takes no time at all.
#[test]
fn a_virtual_clock_measures_nothing_of_a_link() {
    let link = |board| halfrow(["link", "--seconds", "0.01", "--board", board]);
    let still = link("mock").stdout;
    let lines: Vec<_> = still.lines().collect();
    let [.., damaged, times, judging] = &lines[..] else { panic!("{still}") };
    let words = times.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(words, "times not measured on a simulated link", "{still}");
    assert!(damaged.starts_with("damaged ") && judging.starts_with("judging "), "{still}");
    assert!(lines[2].contains("(0 out, 0 in): none, below"), "{still}");
    let moving = link("mock,speed=1000000").stdout;
    assert!(!moving.contains("not measured") && moving.contains("MB/s"), "{moving}");
}

/// A table file does not say which lens it is for, but the street's figures are those of a lens.
#[test]
fn the_street_behind_a_table_file_is_said_to_be_seen_through_a_lens_of_its_own() {
    let folder = Folder::new();
    let size = ["--width", "640", "--height", "480", "--radius", "400"];
    folder.halfrow(["tables", "-o", "my.json"].into_iter().chain(size)).succeeded();
    let street = ["verify", "-q", "--frame", "builtin:street"];
    let words = |told: &str| told.split_whitespace().collect::<Vec<_>>().join(" ");
    let said = "; it is seen through a lens that the tables may not be for link ";
    let by_lens = words(&folder.halfrow(street.into_iter().chain(size)).stdout);
    let by_file = words(&folder.halfrow(street.into_iter().chain(["--tables", "my.json"])).stdout);
    assert!(by_lens.contains(" street ") && !by_lens.contains(said), "{by_lens}");
    assert!(by_file.contains(said), "{by_file}");
}
