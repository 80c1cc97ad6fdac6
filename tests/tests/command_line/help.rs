//! Help, version, completions and manual pages.

use std::process::{Command, Stdio};

use halfrow_tests::program::{Folder, halfrow};

/// All commands, and how the help of each begins.
const COMMANDS: [(&str, &str); 21] = [
    ("verify", "Judge a board"),
    ("soak", "Judge a board for hours"),
    ("correct", "Correct frames"),
    ("tables", "Make a table file"),
    ("lens", "Show a lens's figures"),
    ("kernel", "Fit a kernel to photographs"),
    ("paper", "Reproduce the paper's figures"),
    ("frames", "Write the built-in frames"),
    ("boards", "List the boards"),
    ("info", "Say what a board is"),
    ("link", "Test the link"),
    ("load", "Load a bitstream"),
    ("serve", "Serve a mock or simulated board"),
    ("station", "Start the production station"),
    ("faults", "List the faults"),
    ("codes", "List the codes"),
    ("commands", "Print the page of all commands"),
    ("explain", "Say what a code means"),
    ("schema", "Print the JSON Schema"),
    ("completions", "Print a completion script"),
    ("manual", "Write the manual pages"),
];

#[test]
fn every_command_is_listed_and_explains_itself() {
    let overview = halfrow(["help"]).stdout;
    let commands = overview.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
    let listed: Vec<_> = commands.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let expected: Vec<_> = COMMANDS.iter().map(|(name, _)| *name).chain(["help"]).collect();
    assert_eq!(listed, expected);
    for (name, beginning) in COMMANDS {
        let help = halfrow(["help", name]).succeeded();
        assert!(help.stdout.starts_with(beginning), "{name}: {}", help.stdout);
        assert!(help.stdout.contains(&format!("Usage: halfrow {name}")), "{name}: {}", help.stdout);
        assert_eq!(halfrow([name, "--help"]).stdout, help.stdout);
    }
}

#[test]
fn the_help_of_verify_says_what_the_exit_codes_mean() {
    let help = halfrow(["help", "verify"]).stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    let codes = "0 PASS, 1 FAIL, 2 usage, 3 ERROR, 4 busy, 5 nothing judged, 6 identity or version refused, 129, 130 or 143 interrupted";
    assert!(help.contains(codes), "{help}");
}

/// A value that needs its equals sign is shown with it, and what only the long help says begins a sentence.
#[test]
fn the_page_of_commands_shows_what_the_command_line_takes() {
    let page = halfrow(["commands"]).stdout;
    for shown in ["`--overwrite[=YES\\|NO]`", "`--reconnect[=SECONDS]`", "`--board TARGET`", "`--fail-fast`"]
    {
        assert!(page.contains(shown), "{shown}");
    }
    assert!(page.contains("the lens options make the tables. With it, options that make tables are refused"));
}

/// `frames` refuses each of them.
#[test]
fn the_help_of_frames_names_no_option_of_tables() {
    let help = halfrow(["frames", "--help"]).stdout;
    for option in ["--rows", "--projection", "--entries", "--nodes-every"] {
        assert!(!help.contains(option), "{help}");
        assert!(halfrow(["tables", "--help"]).stdout.contains(option));
    }
    assert!(help.contains("--radius"), "{help}");
}

/// Whether the help of each command names the mock as its default board.
#[test]
fn the_board_s_default_is_that_of_the_command() {
    for (command, default) in [("verify", true), ("soak", true), ("info", true), ("correct", false)] {
        let help = halfrow([command, "--help"]).stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(help.contains("`halfrow boards` [default: mock]"), default, "{command}: {help}");
    }
}

#[test]
fn the_version_names_the_commit() {
    let version = halfrow(["--version"]).stdout;
    let (number, commit) = version.trim_end().strip_prefix("halfrow ").unwrap().split_once(' ').unwrap();
    assert_eq!(number, env!("CARGO_PKG_VERSION"));
    assert!(commit.starts_with('(') && commit.ends_with(')') && commit.len() > 2, "{version}");
}

#[test]
fn asked_verbosely_the_version_tells_what_the_program_was_built_from() {
    let compiler = Command::new("rustc").arg("--version").output().unwrap().stdout;
    let compiler = format!("compiler: {}", String::from_utf8(compiler).unwrap().trim());
    for call in [&["--version", "--verbose"][..], &["-Vv"], &["-v", "verify", "--version"]] {
        let told = halfrow(call.iter().copied()).stdout;
        for line in [compiler.as_str(), "licence: MIT OR Apache-2.0", "  LGPL-2.1-or-later: libusb (C)"] {
            assert!(told.lines().any(|told| told == line), "{call:?}: no {line} in {told}");
        }
        assert!(told.contains("\ncommit: ") && told.contains("\nfeatures: "), "{call:?}: {told}");
    }
    assert_eq!(halfrow(["--version"]).stdout.lines().count(), 1);
    assert_eq!(halfrow(["--version", "--", "--verbose"]).stdout.lines().count(), 1);
}

#[test]
fn a_call_without_a_command_shows_help_and_is_a_usage_error() {
    let ended = halfrow([]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("Usage: halfrow"), "{}", ended.stderr);
    assert!(ended.stderr.contains("To begin:\n  halfrow verify "), "{}", ended.stderr);
}

#[test]
fn every_completion_script_knows_every_command() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = halfrow(["completions", shell]).succeeded();
        let unknown: Vec<_> = COMMANDS.iter().filter(|(name, _)| !script.stdout.contains(name)).collect();
        assert!(unknown.is_empty(), "{shell}: {unknown:?}");
        assert!(script.stdout.contains("retry-limit"), "{shell}");
    }
}

/// The options whose value is written as words with `|` between them, and the words.
fn options_of_words() -> Vec<(String, String)> {
    let option = |line: &str| {
        let written = line.strip_prefix("| `")?.split("` |").next()?;
        let (option, value) = written.rsplit_once("--")?.1.split_once(['=', ' '])?;
        let words = value.trim_end_matches(']').replace("\\|", " ").to_lowercase();
        let is_of_words = words.contains(' ') && !words.contains("file");
        is_of_words.then(|| (option.trim_end_matches('[').to_owned(), words))
    };
    halfrow(["commands"]).stdout.lines().filter_map(option).collect()
}

/// Beside those whose words the help lists by itself.
#[test]
fn a_shell_completes_the_words_that_an_option_takes() {
    let bash = halfrow(["completions", "bash"]).stdout;
    let written = options_of_words();
    for known in ["fit", "nodes-every", "overwrite", "require-hardware"] {
        assert!(written.iter().any(|(option, _)| option == known), "{known}: {written:?}");
    }
    let written = written.iter().map(|(option, words)| (option.as_str(), words.as_str()));
    let listed = [
        ("phase", "grbg rggb bggr gbrg"),
        ("bits", "8 10 12"),
        ("raw", "u8 u16le mipi10 mipi12"),
        ("format", "pgm png tif dng raw"),
        ("only", "black white grey"),
        ("model-path", "reference scalar avx2 avx512"),
    ];
    for (option, words) in listed.into_iter().chain(written) {
        let case = format!("--{option})\n");
        let mut offered = bash.split(&case).skip(1);
        let is_offered =
            |after: &str| after.trim_start().starts_with(&format!("COMPREPLY=($(compgen -W \"{words}"));
        assert!(bash.contains(&case), "{option}");
        assert!(offered.all(is_offered), "{option}");
    }
    let help = halfrow(["verify", "--help"]).stdout;
    assert!(!help.contains("[possible values: grbg"), "the sentence has them: {help}");
}

/// What the help says is what the option takes: the ends themselves, and nothing beyond.
#[test]
fn the_range_of_a_number_is_in_the_help_and_is_the_one_that_holds() {
    for (call, option, range, beyond) in [
        (&["verify"][..], "repeat", "1 to 1000", ["0", "1001"]),
        (&["soak"], "hours", "0.0001 to 8760", ["0.00009", "8761"]),
        (&["link"], "seconds", "0.001 to 86400", ["0.0009", "86401"]),
        (&["load", "a.bit"], "deadline", "0.1 to 86400", ["0.09", "86401"]),
        (&["verify"], "retry-limit", "0 to 100", ["-1", "101"]),
        (&["verify"], "within", "at most 1,000,000", ["0", "1000001"]),
        (&["verify"], "timeout", "at most 1e9", ["0", "1.1e9"]),
        (&["verify"], "at-speed", "at most 1e9", ["-1", "1.1e9"]),
    ] {
        let help = halfrow(call.iter().copied().chain(["--help"])).stdout;
        let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
        let told = help.split(&format!(" --{option} <")).nth(1).unwrap();
        let told = told.split(" --").next().unwrap();
        assert!(told.contains(range), "{option}: {told}");
        for value in beyond {
            let ended = halfrow(call.iter().copied().chain([format!("--{option}={value}").as_str()]));
            assert_eq!(ended.code, Some(2), "{option} {value}: {ended:?}");
            assert!(ended.stderr.contains("give "), "{option} {value}: {}", ended.stderr);
        }
    }
    for (option, default) in [("seed", "[default: 1]"), ("timeout", "[default: no limit]")] {
        let help = halfrow(["soak", "--help"]).stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        let told = help.split(&format!(" --{option} <")).nth(1).unwrap();
        assert!(told.split(" --").next().unwrap().contains(default), "{option}: {told}");
    }
}

#[test]
fn bash_reads_its_completion_script() {
    let script = halfrow(["completions", "bash"]).stdout;
    let folder = Folder::new();
    folder.write("halfrow", script);
    let read = Command::new("bash")
        .args(["-euc", "source ./halfrow; complete -p halfrow"])
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let said = String::from_utf8(read.stdout).unwrap();
    assert!(read.status.success() && said.contains("-F _halfrow"), "{said}{:?}", read.stderr);
}

#[test]
fn there_is_a_manual_page_for_the_program_and_for_every_command() {
    let folder = Folder::new();
    folder.halfrow(["manual", "."]).succeeded();
    let mut pages: Vec<_> = COMMANDS.iter().map(|(name, _)| format!("halfrow-{name}.1")).collect();
    pages.extend(["halfrow.1", "halfrow-kernel-measure.1", "halfrow-kernel-train.1"].map(str::to_owned));
    pages.sort();
    assert_eq!(folder.names("."), pages);
    for page in pages {
        let text = folder.text(&page);
        let title = format!(".TH {}", page.trim_end_matches(".1"));
        assert!(text.contains(&title) && text.contains(".SH SYNOPSIS"), "{page}: {text}");
    }
}

#[test]
fn the_synopsis_of_a_manual_page_names_the_values() {
    let folder = Folder::new();
    folder.halfrow(["manual", "."]).succeeded();
    assert!(folder.names(".").contains(&"halfrow-kernel-train.1".to_owned()));
    let page = folder.text("halfrow-verify.1");
    let synopsis = page.split(".SH SYNOPSIS\n").nth(1).unwrap().split("\n.SH").next().unwrap();
    for option in [
        "[\\fB\\-\\-board\\fR \\fITARGET\\fR]",
        "[\\fB\\-\\-lens\\-pitch\\fR \\fIUM\\fR]",
        "[\\fB\\-\\-lens\\fR \\fIFILE|equidistant:RADIUS\\fR]",
        "[\\fB\\-\\-json\\fR]",
    ] {
        assert!(synopsis.contains(option), "{option} in {synopsis}");
    }
    let page = folder.text("halfrow-tables.1");
    assert!(page.contains("\\fB\\-\\-output\\fR \\fIFILE\\fR"), "{page}");
}
