//! Settings: what is accepted, and what is refused with its line and a remedy.

mod plans;

use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;
use std::time::Duration;

use halfrow::Verdict;
use halfrow_station::floor::Starts;
use halfrow_station::settings::{Destination, Settings, SinkSettings};

use crate::common::{Did, PLAN, program};

/// Settings that use every key.
const WHOLE: &str = r#"schema = 1
[station]
name = "12"
data = "data"
order = "scan-then-plug"
silence = 30.0
memory = 512
[scanner]
prefix = "]C1"
suffix = "!"
[plant]
url = "postgres://halfrow@localhost/plant"
password_file = "plant.password"
green = "plant"
most_unsent = 500
most_filled = 90
[[lane]]
name = "1"
board = "usb:1-2.3"
plans = ["a.toml", "b.toml"]
start = ["scan", "button"]
[[lane]]
name = "left"
board = "mock,serial=1"
plans = ["b.toml"]
[[on-pass]]
program = "lamp"
arguments = ["{lane}", "green"]
[[on-error]]
program = "./print"
deadline = 2.5
[[on-clear]]
program = "lamp"
arguments = ["{lane}", "off"]
"#;

fn load(text: &str) -> Result<Settings, String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), PLAN).unwrap();
    fs::write(folder.path().join("b.toml"), PLAN.replace("CAT", "CBT").replace("CAM-T", "CAM-B")).unwrap();
    fs::write(folder.path().join("print"), "").unwrap();
    let path = folder.path().join("station.toml");
    fs::write(&path, text).unwrap();
    let place = format!("{}/", folder.path().display());
    let told = |error: &dyn std::error::Error| {
        let chain = std::iter::successors(Some(error), |error| error.source());
        chain.map(ToString::to_string).collect::<Vec<_>>().join(": ").replace(&place, "")
    };
    Settings::load(&path).map_err(|error| told(&error))
}

#[test]
fn every_key_means_what_it_says() {
    let settings = load(WHOLE).unwrap();
    assert_eq!(
        (settings.name.as_str(), settings.silence, settings.memory_mib),
        ("12", Duration::from_secs(30), 512)
    );
    assert!(settings.data.ends_with("data") && settings.data.is_absolute() && settings.scan_then_plug);
    assert_eq!(settings.scanner.label("]C1CAT1!"), Some("CAT1"));
    assert_eq!(settings.scanner.label("]C1CAT1"), None);
    let plant = settings.plant.as_ref().unwrap();
    assert_eq!((plant.is_green_at_plant, plant.most_unsent, plant.most_filled), (true, 500, 90));
    let names: Vec<_> = settings.plans.iter().map(|file| file.plan.product.as_str()).collect();
    assert_eq!(names, ["CAM-T", "CAM-B"]);
    let [first, second] = settings.lanes.as_slice() else { panic!("{settings:?}") };
    assert_eq!((first.name.as_str(), first.board.to_string()), ("1", "usb:1-2.3".to_owned()));
    assert_eq!((first.plans.as_slice(), second.plans.as_slice()), ([0, 1].as_slice(), [1].as_slice()));
    assert_eq!(first.starts, Starts { scan: true, button: true, presence: false });
    assert_eq!(second.starts, Starts { scan: true, button: false, presence: false });
    let hooks: Vec<_> = settings.hooks.iter().map(|hook| (hook.on, hook.deadline.as_secs_f64())).collect();
    assert_eq!(hooks, [(Some(Verdict::Pass), 10.0), (Some(Verdict::Error), 2.5), (None, 10.0)]);
    assert_eq!(settings.hooks[0].program.to_string_lossy(), "lamp", "looked for where the shell looks");
    assert!(settings.hooks[1].program.is_absolute());
}

/// The keys that [`WHOLE`] lacks, and little else.
const REST: &str = r#"schema = 1
[station]
name = "12"
data = "data"
[access]
users = "users"
hours = 0.5
[plant]
url = "postgres://halfrow@localhost/plant"
[work]
plans = ["a.toml"]
has = ["fixture-3"]
at_once = 4
[[sink]]
name = "wall"
mqtt = "mqtts://broker.example/hall"
[[sink]]
name = "near"
mqtt = "mqtt://localhost"
[[lane]]
name = "1"
board = "usb:1-2.3"
plans = ["b.toml"]
start = ["presence"]
[[on-fail]]
program = "lamp"
"#;

/// The defaults are those of docs/station-lanes.md and docs/plant.md; the ports are IANA's for MQTT.
#[test]
fn what_is_left_out_is_as_the_pages_say() {
    let settings = load(REST).unwrap();
    assert_eq!((settings.silence, settings.memory_mib), (Duration::from_secs(60), 4096));
    assert!(!settings.scan_then_plug);
    assert_eq!(settings.access.as_ref().unwrap().idle, Duration::from_secs(1800));
    let shift = load(&REST.replace("hours = 0.5\n", "")).unwrap();
    assert_eq!(shift.access.unwrap().idle, Duration::from_secs(8 * 3600));
    let plant = settings.plant.as_ref().unwrap();
    assert_eq!((plant.is_green_at_plant, plant.most_unsent, plant.most_filled), (false, 10_000, 95));
    let [lane] = settings.lanes.as_slice() else { panic!("{settings:?}") };
    assert_eq!(lane.starts, Starts { scan: false, button: false, presence: true });
    let work = settings.work.as_ref().unwrap();
    assert_eq!((&settings.plans[work.plans[0]].plan.product[..], work.plans.len()), ("CAM-T", 1));
    assert_eq!((work.has.as_slice(), work.at_once), (["fixture-3".to_owned()].as_slice(), 4));
    assert_eq!(load(&REST.replace("at_once = 4\n", "")).unwrap().work.unwrap().at_once, 1);
    assert_eq!(settings.hooks.iter().map(|hook| hook.on).collect::<Vec<_>>(), [Some(Verdict::Fail)]);
    let port = |sink: &SinkSettings| match &sink.to {
        Destination::Events { address, .. } => address.port,
        to => panic!("{to:?}"),
    };
    assert_eq!(settings.sinks.iter().map(port).collect::<Vec<_>>(), [8883, 1883]);
}

/// A change of [`WHOLE`], the line that is then wrong, and how that is told.
const WRONG: &[(&str, &str, u32, &str)] = &[
    ("schema = 1", "schema = 9", 1, "this program reads settings of schema 1, not 9; take the"),
    ("name = \"12\"", "name = \" \"", 3, "there is nothing here; write a name"),
    ("order = \"scan", "order = \"plug", 5, "unknown variant `plug-then-plug`"),
    ("silence = 30.0", "silence = 0.0", 6, "0 s is no such time; give 0.1 to 86400 seconds"),
    ("silence = 30.0", "silense = 30.0", 6, "unknown field `silense`"),
    ("memory = 512", "memory = 1", 7, "1 MiB are no memory for a lane; give 64 to 1048576 MiB"),
    ("name = \"1\"", "name = \"1 2\"", 18, "`1 2` is no name for a lane; write 1 to 16 letters"),
    ("name = \"1\"", "name = \"left\"", 23, "two lanes are called left; give each"),
    ("localhost/plant", "localhost", 12, "the plant cannot be used: the plant's address says no database"),
    ("halfrow@", "halfrow:secret@", 12, "the plant cannot be used: the plant's address has a password"),
    ("postgres://", "mysql://", 12, "the plant cannot be used: this is no address of a plant; write it as"),
    (
        "localhost/plant\"",
        "db.example/plant\"\nca = \"none.pem\"",
        13,
        "the file of the plant's certificates cannot be used: ",
    ),
    ("\"plant.password\"", "\"\"", 13, "there is nothing here; write a name"),
    ("green = \"plant\"", "green = \"blue\"", 14, "unknown variant `blue`"),
    ("most_unsent = 500", "most_unsent = 0", 15, "with none unsent no lane could judge; give 1 or more"),
    ("most_filled = 90", "most_filled = 101", 16, "a disk cannot be full to 101 %; give 1 to 100"),
    ("usb:1-2.3", "labgrid", 19, "`labgrid` names no place of labgrid's; write labgrid:PLACE"),
    ("usb:1-2.3", "labgrid:a,baud=9600", 19, "`labgrid:a,baud=9600` names no place of labgrid's"),
    ("usb:1-2.3", "usb", 19, "`usb` is whichever board is plugged in; write usb:"),
    ("usb:1-2.3", "serial:/dev/ttyUSB0", 19, "`serial:/dev/ttyUSB0` is another board when"),
    ("usb:1-2.3", "usv:1-2.3", 19, "`usv` is not a kind of board; write one as `halfrow boards`"),
    ("usb:1-2.3", "", 19, "the board cannot be used: an empty target names no board"),
    (
        "mock,serial=1",
        "mock,fault=zz",
        24,
        "the board cannot be used: the target `mock,fault=zz` does not suit",
    ),
    ("\"mock,serial=1\"", "\"usb:1-2.3,channel=a\"", 24, "lane 1 has the board"),
    ("[\"b.toml\"]", "[]", 25, "lane left has no plan; name the file of one"),
    ("[\"b.toml\"]", "[\"c.toml\"]", 25, "the plan c.toml cannot be used: c.toml cannot be read"),
    ("[\"scan\", \"button\"]", "[]", 21, "nothing starts this lane; name scan, button or presence"),
    (
        "\"mock,serial=1\"\n",
        "\"mock,serial=1\"\nstart = [\"presence\"]\n",
        25,
        "nobody sees the board `mock,serial=1` being plugged in, so nothing starts this lane; name scan or button",
    ),
    (
        "\"mock,serial=1\"\n",
        "\"tcp:bench:3001\"\nstart = [\"presence\"]\n",
        25,
        "nobody sees the board `tcp:bench:3001` being plugged in",
    ),
    (
        "\"mock,serial=1\"\n",
        "\"labgrid:rack-3\"\nstart = [\"presence\"]\n",
        25,
        "nobody sees the board `labgrid:rack-3` being plugged in",
    ),
    ("{lane}", "{line}", 28, "nothing is known that is called {line}; write one of {lane}"),
    ("[\"b.toml\"]", "[\" \"]", 25, "there is nothing here; write a name"),
    ("deadline = 2.5", "deadline = -1.0", 31, "-1 s is no such time"),
    (
        "\"a.toml\", \"b.toml\"",
        "\"a.toml\", \"b.toml\", \"./a.toml\"",
        20,
        "lane 1 has the plan ./a.toml twice, first as a.toml; leave one of them out",
    ),
    ("usb:1-2.3", "tcp:127.0.0.1:99999", 19, "the board cannot be used: "),
    ("mock,serial=1", "mock,serial=1,fault=nope", 24, "the board cannot be used: "),
];

/// What [`WHOLE`] gets in front of `[[on-error]]`, the line that is then wrong, and how that is told.
const ADDED: &[(&str, u32, &str)] = &[
    ("[labgrid]\ndeadline = 0.0", 30, "0 s is no such time"),
    ("[labgrid]\nprogram = \"\"", 30, "there is nothing here"),
    ("[labgrid]\nplace = \"a\"", 30, "unknown field `place`"),
    (
        "[web]\nlisten = \"127.0.0.1:1\"\npublic = \"station12\"",
        31,
        "the address cannot be used: `station12` is not where browsers find a station",
    ),
    (
        "[web]\nlisten = \"127.0.0.1\"\npublic = \"https://a.example\"",
        30,
        "the address cannot be used: `127.0.0.1` is no address to listen on",
    ),
    (
        "[web]\nlisten = \"127.0.0.1:1\"\npublic = \"https://a.example\"",
        31,
        "others can reach these pages, and nobody logs in",
    ),
    ("[web]\nhosts = [\"localhost\", \"a.example\"]", 30, "others can reach these pages, and nobody logs in"),
    (
        "[web]\nlisten = \"0.0.0.0:1\"\nhosts = [\"a.example\"]",
        30,
        "others can reach these pages, and nobody logs in",
    ),
    (
        "[web]\nhosts = [\"http://localhost:8612\"]",
        30,
        "the address cannot be used: `http://localhost:8612` is no name by which browsers ask",
    ),
    (
        "[web]\nlisten = \"0.0.0.0:1\"\nhosts = [\"\"]\n[access]\nusers = \"u\"",
        31,
        "the address cannot be used: `` is no name by which browsers ask",
    ),
];

#[test]
fn what_is_wrong_is_told_with_its_line_and_a_remedy() {
    let changed = |from: &str, to: &str| {
        assert!(WHOLE.contains(from), "{from}");
        load(&WHOLE.replacen(from, to, 1)).unwrap_err()
    };
    for (from, to, line, said) in WRONG {
        let error = changed(from, to);
        assert!(error.starts_with(&format!("station.toml:{line}: {said}")), "{from} -> {to}: {error}");
    }
    for (table, line, said) in ADDED {
        let error = changed("[[on-error]]", &format!("{table}\n[[on-error]]"));
        assert!(error.starts_with(&format!("station.toml:{line}: {said}")), "{table}: {error}");
    }
    let error = changed("./print", "./brint");
    assert!(error.contains("there is no program"), "{error}");
    let error = load("schema = 1\n[station]\nname = \"12\"\ndata = \"data\"\n").unwrap_err();
    assert_eq!(error, "station.toml:1: the station has no lane; write a [[lane]] with name, board and plans");
}

/// A board that is scanned into one lane would be judged under the number of the board in the other.
#[test]
fn two_lanes_have_no_port_in_common_whatever_it_is_called() {
    let folder = tempfile::tempdir().unwrap();
    let named = |port: &str| {
        ["by-path", "by-id"].map(|name| {
            let path = folder.path().join(format!("{name}{}", port.replace('/', "-")));
            symlink(port, &path).unwrap();
            format!("serial:{}", path.display())
        })
    };
    let with = |[one, other]: &[String; 2]| {
        load(&WHOLE.replace("usb:1-2.3", one).replace("mock,serial=1", other)).map(drop)
    };
    let both = named("/dev/tty");
    let [one, other] = &both;
    let said = format!("station.toml:24: lane 1 has the board `{other}` already, as `{one}`; give each lane");
    let error = with(&both).unwrap_err();
    assert!(error.starts_with(&said), "{error}");
    let spelt = [format!("{one},board=ulx3s"), format!("{one},baud=3000000,flow=none")];
    let error = with(&spelt).unwrap_err();
    let said = format!("station.toml:24: lane 1 has the board `{}` already, as `{}`", spelt[1], spelt[0]);
    assert!(error.starts_with(&said), "{error}");
    let error = load(&WHOLE.replace("usb:1-2.3", &format!("{},baud=9600", spelt[0]))).unwrap_err();
    let said = "station.toml:19: the board cannot be used: `baud=9600` contradicts `board=ulx3s`";
    assert!(error.starts_with(said), "{error}");
    with(&named("/dev/not-plugged-in")).unwrap();
}

#[test]
fn a_board_that_labgrid_lends_is_named_by_its_place() {
    let lent = WHOLE.replace("usb:1-2.3", "labgrid:cam-1");
    assert_eq!(load(&lent).unwrap().lanes[0].board.to_string(), "labgrid:cam-1");
    let error = load(&lent.replace("mock,serial=1", "labgrid:cam-1")).unwrap_err();
    assert_eq!(
        error,
        "station.toml:24: lane 1 has the board `labgrid:cam-1` already; give each lane a board of its own"
    );
}

/// The words of `text` between backticks.
fn ticked(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// All keys that are accepted where `text` has the key `nix`.
fn known(text: &str) -> Vec<String> {
    let said = load(text).map(drop).unwrap_err();
    assert!(said.contains("unknown field `nix`"), "{said}");
    let expected = said.split("expected").nth(1).unwrap().split(';').next().unwrap();
    ticked(expected).into_iter().map(str::to_owned).collect()
}

/// The error about an unknown key refers its reader to this page.
#[test]
fn the_page_names_every_key() {
    let page = include_str!("../../../../../docs/station-lanes.md");
    let table = page.split("\n### All settings\n").nth(1).unwrap().split("\n#").next().unwrap();
    let mut named = vec!["schema".to_owned()];
    for row in table.lines().filter(|line| line.starts_with("| `[")) {
        let cells: Vec<_> = row.split(" | ").collect();
        for head in ticked(cells[0]) {
            assert_eq!(known(&format!("schema = 1\n{head}\nnix = 1\n")), ticked(cells[1]), "{head}");
            named.push(head.trim_matches(['[', ']']).to_owned());
        }
    }
    let mut all = known("nix = 1\n");
    all.sort();
    named.sort();
    assert_eq!(named, all);
}

/// Whoever stands beside it need not name it for one command and not for the next.
#[test]
fn every_command_finds_the_settings_where_it_is_called() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("station.toml"), "schema = 9\n").unwrap();
    for command in ["lanes", "serve", "work"] {
        let mut call = Command::new(program());
        let did: Did = call.arg(command).current_dir(folder.path()).output().unwrap().into();
        assert!(did.code == Some(2) && did.complained.contains("station.toml:1: "), "{command}: {did:?}");
    }
}
