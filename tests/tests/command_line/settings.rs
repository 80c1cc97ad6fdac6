//! Settings: the flag, else the environment, else the settings file, else the default.

use halfrow_tests::program::{Ended, Folder, finish};

use crate::{refused, small};

const FILE: &str = "settings.toml";

/// Runs `verify` on a small frame with a settings file, a variable and arguments.
fn run(folder: &Folder, settings: &str, variable: Option<(&str, &str)>, arguments: &[&str]) -> Ended {
    folder.write(FILE, settings);
    let mut command = folder.command(small("verify", &["--json", "--settings", FILE]));
    command.args(arguments).envs(variable);
    finish(&mut command)
}

/// The seed of a run.
fn seed(ended: &Ended) -> u64 {
    ended.json()["run"]["seed"].as_u64().unwrap()
}

#[test]
fn the_flag_beats_the_variable_beats_the_file_beats_the_default() {
    let folder = Folder::new();
    let (file, variable) = ("seed = 5\n", Some(("HALFROW_SEED", "6")));
    assert_eq!(seed(&run(&folder, "", None, &[])), 1);
    assert_eq!(seed(&run(&folder, file, None, &[])), 5);
    assert_eq!(seed(&run(&folder, file, variable, &[])), 6);
    assert_eq!(seed(&run(&folder, file, variable, &["--seed", "7"])), 7);
}

#[test]
fn the_board_is_chosen_in_the_same_order() {
    let folder = Folder::new();
    let target = |ended: &Ended| ended.json()["board"]["target"].as_str().unwrap().to_owned();
    let (file, variable) = ("board = 'mock,latency=5'\n", Some(("HALFROW_BOARD", "mock,latency=6")));
    assert_eq!(target(&run(&folder, "", None, &[])), "mock");
    assert_eq!(target(&run(&folder, file, None, &[])), "mock,latency=5");
    assert_eq!(target(&run(&folder, file, variable, &[])), "mock,latency=6");
    assert_eq!(target(&run(&folder, file, variable, &["--board", "mock,latency=7"])), "mock,latency=7");
}

#[test]
fn the_kernel_is_chosen_in_the_same_order() {
    let folder = Folder::new();
    // CRC-32 of each kernel's nodes, the first by a program that is not part of this project.
    let crc = |ended: &Ended| ended.json()["tables"]["kernel_crc32"].as_str().unwrap().to_owned();
    let named = |kernel| crc(&run(&folder, "", None, &["--kernel", kernel]));
    assert_eq!(named("keys"), "54f5e990");
    let (file, variable) = ("kernel = 'keys'\n", Some(("HALFROW_KERNEL", "linear")));
    assert_eq!(crc(&run(&folder, "", None, &[])), "16e29b0f");
    assert_eq!(crc(&run(&folder, file, None, &[])), "54f5e990");
    assert_eq!(crc(&run(&folder, file, variable, &[])), named("linear"));
    assert_eq!(crc(&run(&folder, file, variable, &["--kernel", "nearest"])), named("nearest"));
}

/// `verify` judges by the same kernel with these settings.
#[test]
fn tables_are_made_with_the_kernel_of_the_settings() {
    let folder = Folder::new();
    let made = |settings: &str, variable: Option<(&str, &str)>, more: &[&str]| {
        folder.write(FILE, settings);
        let call = small("tables", &["--settings", FILE, "-o", "made.json", "--overwrite"]);
        let mut command = folder.command(call);
        let ended = finish(command.args(more).envs(variable)).succeeded();
        ended.stdout.rsplit_once(", ").unwrap().1.to_owned()
    };
    let (file, variable) = ("kernel = 'keys'\n", Some(("HALFROW_KERNEL", "linear")));
    assert_eq!(made("", None, &[]), "hermite kernel\n");
    assert_eq!(made(file, None, &[]), "keys kernel\n");
    assert_eq!(made(file, variable, &[]), "linear kernel\n");
    assert_eq!(made(file, variable, &["--kernel", "nearest"]), "nearest kernel\n");
}

#[test]
fn a_station_that_requires_hardware_judges_nothing_else() {
    let folder = Folder::new();
    assert_eq!(run(&folder, "require_hardware = true\n", None, &[]).code, Some(5));
    run(&folder, "require_hardware = false\n", None, &[]).succeeded();
    assert_eq!(run(&folder, "", Some(("HALFROW_REQUIRE_HARDWARE", "true")), &[]).code, Some(5));
    run(&folder, "", Some(("HALFROW_REQUIRE_HARDWARE", "0")), &[]).succeeded();
    let (required, no) = ("require_hardware = true\n", Some(("HALFROW_REQUIRE_HARDWARE", "no")));
    run(&folder, required, no, &[]).succeeded();
    assert_eq!(run(&folder, required, no, &["--require-hardware"]).code, Some(5));
    run(&folder, required, None, &["--require-hardware=no"]).succeeded();
    let unclear = run(&folder, "", Some(("HALFROW_REQUIRE_HARDWARE", "maybe")), &[]);
    assert_eq!(unclear.code, Some(2));
    assert!(unclear.stderr.contains("say yes or no"), "{}", unclear.stderr);
}

#[test]
fn frames_tables_and_report_come_from_the_file_too() {
    let folder = Folder::new();
    folder.halfrow(small("tables", &["--radius", "500", "-o", "lens.json"])).succeeded();
    let settings = "frame = ['builtin:bars']\ntables = 'lens.json'\nreport = 'out'\n";
    let ended = run(&folder, settings, None, &[]).succeeded();
    let names: Vec<_> =
        ended.json()["frames"].as_array().unwrap().iter().map(|it| it["name"].clone()).collect();
    assert_eq!(names.iter().filter(|name| *name == "builtin:bars").count(), 1);
    assert_eq!(names.len(), 5);
    assert_eq!(ended.json()["tables"]["source"], "lens.json");
    assert_eq!(folder.names("out").len(), 3);
    assert_eq!(run(&folder, settings, None, &[]).code, Some(2));
    run(&folder, &format!("{settings}overwrite = true\n"), None, &[]).succeeded();
}

/// Options that make tables are flags, so they take precedence over a table file that the station always uses.
#[test]
fn a_lens_on_the_command_line_beats_tables_from_elsewhere() {
    let folder = Folder::new();
    folder.halfrow(small("tables", &["-o", "lens.json"])).succeeded();
    let (file, variable) = ("tables = 'lens.json'\n", Some(("HALFROW_TABLES", "lens.json")));
    for (settings, variable) in [(file, None), ("", variable)] {
        let source = |more: &[&str]| {
            let said = run(&folder, settings, variable, more).json();
            assert_eq!(said["run"]["files"].as_array().map(Vec::is_empty), Some(!more.is_empty()));
            said["tables"]["source"].clone()
        };
        assert_eq!(source(&[]), "lens.json");
        for more in [["--rows", "fitted"], ["--rows", "equation-9"]] {
            assert!(source(&more).as_str().unwrap().starts_with("equidistant lens, R = "), "{more:?}");
        }
    }
    let sizes = ["--width", "64", "--height", "9", "--lens", "equidistant:40"];
    let call = ["verify", "--json"].into_iter().chain(sizes);
    let ended = finish(folder.command(call).env("HALFROW_TABLES", "lens.json"));
    assert!(ended.stdout.contains("equidistant lens, R = 40.000 pixels"), "{}{}", ended.stdout, ended.stderr);
    let call = ["correct", "builtin:noise", "--model", "-o", "40.pgm"].into_iter().chain(sizes);
    finish(folder.command(call).env("HALFROW_TABLES", "nowhere.json")).succeeded();
}

#[test]
fn limits_come_from_the_file_too() {
    let folder = Folder::new();
    let slow = ["--board", "mock,speed=1000"];
    assert_eq!(run(&folder, "timeout = 20\n", None, &slow).code, Some(3));
    run(&folder, "timeout = 20\n", Some(("HALFROW_TIMEOUT", "100000")), &slow).succeeded();
    let poor = ["--board", "mock,fault=truncate,rate=0.05,seed=1"];
    run(&folder, "retry_limit = 100\n", None, &poor).succeeded();
    assert_eq!(run(&folder, "retry_limit = 0\n", None, &poor).code, Some(3));
}

#[test]
fn what_corrects_takes_tables_and_kernel_from_the_file_too() {
    let folder = Folder::new();
    let made =
        folder.halfrow(["tables", "--width", "64", "--height", "9", "--radius", "9", "-o", "lens.json"]);
    assert_eq!(made.code, Some(0));
    let correct = ["correct", "builtin:noise", "--model", "--overwrite", "-o"];
    let corrected = |output, more: &[&'static str]| {
        folder.halfrow(correct.into_iter().chain([output]).chain(more.iter().copied())).succeeded();
        folder.read(output)
    };
    folder.write(FILE, "tables = 'lens.json'\nkernel = 'keys'\n");
    let named = corrected("named.pgm", &["--tables", "lens.json", "--kernel", "keys"]);
    assert!(corrected("set.pgm", &["--settings", FILE]) == named);
    let linear = corrected("other.pgm", &["--settings", FILE, "--kernel", "linear"]);
    assert!(linear != named);
    let call = correct.into_iter().chain(["variable.pgm", "--settings", FILE]);
    assert_eq!(finish(folder.command(call).env("HALFROW_KERNEL", "linear")).code, Some(0));
    assert!(folder.read("variable.pgm") == linear);
}

#[test]
fn the_user_s_own_settings_file_is_read() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("halfrow")).unwrap();
    folder.write("halfrow/settings.toml", "seed = 11\n");
    let mut command = folder.command(small("verify", &["--json"]));
    assert_eq!(seed(&finish(command.env("XDG_CONFIG_HOME", folder.path()))), 11);
    folder.write(FILE, "seed = 12\n");
    assert_eq!(seed(&finish(command.env("HALFROW_SETTINGS", FILE))), 12);
}

/// Another user's home, which is what a container image often leaves in `USER`.
#[test]
fn the_user_s_own_settings_file_is_passed_over_when_it_may_not_be_read_and_a_named_one_is_not() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new();
    let (home, file) = (folder.path().join("halfrow"), folder.path().join("halfrow/settings.toml"));
    std::fs::create_dir(&home).unwrap();
    folder.write("halfrow/settings.toml", "seed = 11\n");
    let mode = |mode| std::fs::set_permissions(&home, std::fs::Permissions::from_mode(mode)).unwrap();
    mode(0o000);
    let call = small("verify", &["--json", "--frame", "builtin:grey"]);
    let passed_over = finish(folder.as_nobody(&call).env("XDG_CONFIG_HOME", folder.path()));
    let silent = finish(folder.as_nobody(&call).env("HALFROW_SETTINGS", "/dev/null"));
    let named = finish(folder.as_nobody(&call).env("HALFROW_SETTINGS", &file));
    mode(0o755);
    assert_eq!(seed(&passed_over), 1, "{}", passed_over.stderr);
    let said = format!("the settings file {} may not be read, and is passed over", file.display());
    assert!(passed_over.stderr.contains(&said), "{}", passed_over.stderr);
    assert!(passed_over.stderr.contains("HALFROW_SETTINGS=/dev/null"), "{}", passed_over.stderr);
    assert_eq!((silent.code, silent.stderr.contains("settings")), (Some(0), false), "{}", silent.stderr);
    assert_eq!(named.code, Some(2), "{}", named.stderr);
    assert!(named.stderr.contains("HALFROW_SETTINGS=/dev/null"), "{}", named.stderr);
}

#[test]
fn a_settings_file_that_is_wrong_is_never_passed_over() {
    let folder = Folder::new();
    let call = small("verify", &["--settings", FILE]);
    refused(&folder, &call, "cannot read the settings file settings.toml");
    folder.write(FILE, "seed = 1\nbord = 'mock'\n");
    refused(&folder, &call, "settings.toml, line 2: there is no setting \"bord\"");
    folder.write(FILE, "\n\nseed = 'one'\n");
    refused(&folder, &call, "settings.toml, line 3: ");
    folder.write(FILE, "retry_limit = 101\n");
    refused(&folder, &call, "101 is no share in percent");
    folder.write(FILE, "timeout = -1\n");
    refused(&folder, &call, "-1 is no time in seconds");
    folder.write(FILE, "seed = \n");
    refused(&folder, &call, "settings.toml, line 1: ");
    folder.write(FILE, "board = 'moon'\n");
    refused(&folder, &call, "`moon` is not a known kind of board");
    folder.write(FILE, "frame = ['builtin:moon']\n");
    refused(&folder, &call, "`moon` is no built-in frame");
}

#[test]
fn an_error_quotes_no_more_of_a_value_than_can_be_read() {
    let folder = Folder::new();
    let said = |settings: &str| {
        let ended = run(&folder, settings, None, &[]);
        assert!(ended.code == Some(2) && ended.stderr.len() < 1000, "{}", ended.stderr);
        ended.stderr
    };
    assert!(said("retry_limit = 1e308").contains("line 1: 1e308 is no share in percent"));
    assert!(said("timeout = 1e308").contains("line 1: 1e308 is no time in seconds"));
    let long = said(&format!("seed = '{}'", "9".repeat(70_000)));
    assert!(long.contains("line 1: invalid type: string \"999") && long.contains("..."), "{long}");
}
