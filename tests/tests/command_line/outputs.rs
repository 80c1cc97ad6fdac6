//! What is in an output's way is found before a board is opened or anything is computed, and is left as it was.

use std::fs;
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown, symlink};
use std::os::unix::net::UnixListener;
use std::path::Path;

use halfrow_tests::not_tested::not_tested;
use halfrow_tests::program::another_user::{NOBODY, is_root};
use halfrow_tests::program::{Folder, finish};

use crate::{refused, small};

/// A board on which a run would end with another code than that of a refusal.
const DEAD: &str = "mock,fault=disconnect,byte=0";

/// A call of every command that writes, and a file that it would write.
fn calls() -> Vec<(Vec<&'static str>, &'static str)> {
    vec![
        (small("verify", &["--board", DEAD, "--record", "run.rec"]), "run.rec"),
        (small("tables", &["-o", "t.json"]), "t.json"),
        (small("tables", &["-o", "t.mem"]), "t.kernel.mem"),
        (small("lens", &["--map", "map.png"]), "map.png"),
        (small("frames", &["--only", "black", "-o", "."]), "black.pgm"),
        (small("frames", &["-o", "frames"]), "frames/bars.pgm"),
        (small("correct", &["builtin:black", "--board", DEAD, "-o", "out.png"]), "out.png"),
        (small("correct", &["builtin:black", "--model", "-o", "out"]), "out/black.pgm"),
        (small("correct", &["builtin:black", "--model", "-o", "a.raw", "--preview", "b.png"]), "b.png"),
        (vec!["kernel", "train", "--images", ".", "-o", "kernel.json"], "kernel.json"),
        (vec!["paper", "fig8", "delay", "--board", DEAD, "-o", "paper"], "paper/paper.html"),
        (vec!["paper", "fig8", "delay", "--board", DEAD, "-o", "paper"], "paper/fig-8c.svg"),
        (vec!["manual", "man"], "man/halfrow-lens.1"),
    ]
}

/// Puts something in the place of an output.
type Make = fn(&Path);

/// A folder in which `make` has put something at `place`, and with a picture that `kernel train` could begin with.
fn folder_with(place: &str, make: impl Fn(&Path)) -> Folder {
    let folder = Folder::new();
    folder.write("a.png", "no picture");
    let path = folder.path().join(place);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    make(&path);
    folder
}

#[test]
fn a_file_that_is_there_is_replaced_by_request_alone() {
    for (call, place) in calls() {
        let folder = folder_with(place, |path| fs::write(path, "precious").unwrap());
        refused(&folder, &call, &format!("{place} exists; allow it to be overwritten (--overwrite)"));
        assert_eq!(folder.text(place), "precious", "{call:?}");
        // Where the call named a folder, the message speaks of a folder.
        let named = if place.contains('/') || call.contains(&"frames") { "folder" } else { "file" };
        refused(&folder, &call, &format!("or name another {named}"));
    }
}

#[test]
fn a_hyphen_is_no_folder() {
    let folder = Folder::new();
    let hyphen = |call: &[&str], option: &str| {
        refused(&folder, call, &format!("`{option} -` names no place"));
    };
    let correct = small("correct", &["builtin:black", "--model"]);
    hyphen(&[&correct[..], &["-o", "-"]].concat(), "--output");
    hyphen(&[&correct[..], &["-o", "x.pgm", "--preview", "-"]].concat(), "--preview");
    hyphen(&small("frames", &["-o", "-"]), "--output");
    hyphen(&small("verify", &["--report", "-"]), "--report");
    hyphen(&small("verify", &["--record", "-"]), "--record");
    hyphen(&["paper", "fig8", "-o", "-"], "--output");
    hyphen(&small("tables", &["-o", "-"]), "--output");
    hyphen(&small("lens", &["--map", "-"]), "--map");
    hyphen(&["manual", "-"], "FOLDER");
}

#[test]
fn what_is_no_regular_file_is_never_replaced() {
    // A socket and a FIFO stand for devices: run as root, a broken check would replace a real one.
    let makers: [(&str, Make); 5] = [
        ("no regular file", |path| drop(UnixListener::bind(path).unwrap())),
        ("no regular file", |path| {
            nix::unistd::mkfifo(path, nix::sys::stat::Mode::from_bits_truncate(0o600)).unwrap();
        }),
        ("no regular file", |path| fs::create_dir(path).unwrap()),
        ("a link to victim", |path| symlink("victim", path).unwrap()),
        ("a link to nowhere", |path| symlink("nowhere", path).unwrap()),
    ];
    for (sentence, make) in makers {
        for (call, place) in calls() {
            let folder = folder_with(place, make);
            // For these commands a folder is a valid output.
            if call[0] == "correct" && folder.path().join(place).is_dir() && !place.contains('/') {
                continue;
            }
            let kind = |folder: &Folder| fs::symlink_metadata(folder.path().join(place)).unwrap().file_type();
            let before = kind(&folder);
            let call: Vec<_> = call.iter().copied().chain(["--overwrite"]).collect();
            refused(&folder, &call, sentence);
            assert_eq!(kind(&folder), before, "{call:?}");
        }
    }
}

#[test]
fn a_folder_that_takes_no_files_is_found_at_once() {
    let folder = Folder::new();
    folder.write("file", "");
    folder.write("a.png", "no picture");
    let calls: [(&[&str], &str); 6] = [
        (&["verify", "--board", DEAD, "--record"], "run.rec"),
        (&["verify", "--board", DEAD, "--report"], "out"),
        (&["tables", "-o"], "t.json"),
        (&["lens", "--map"], "map.png"),
        (&["correct", "builtin:black", "--board", DEAD, "-o"], "out.pgm"),
        (&["kernel", "train", "--images", ".", "-o"], "kernel.json"),
    ];
    for (call, name) in calls {
        for place in ["missing", "file", "/proc"] {
            let place = format!("{place}/{name}");
            let call: Vec<_> = call.iter().copied().chain([place.as_str()]).collect();
            refused(&folder, &call, "folder");
        }
    }
    // A folder that can still be made is no error.
    let calls: [&[&str]; 4] = [
        &["frames", "-o"],
        &["correct", "builtin:black", "--model", "-o"],
        &["paper", "fig8", "-o"],
        &["manual"],
    ];
    for call in calls {
        for place in ["file/out", "/proc/out"] {
            refused(&folder, &call.iter().copied().chain([place]).collect::<Vec<_>>(), "out");
        }
    }
}

#[test]
fn a_report_s_place_is_no_link_and_no_file() {
    let folder = Folder::new();
    let call = small("verify", &["--report", "out", "--overwrite", "--board", DEAD]);
    symlink("elsewhere", folder.path().join("out")).unwrap();
    refused(&folder, &call, "out is a link to elsewhere");
    fs::remove_file(folder.path().join("out")).unwrap();
    let _socket = UnixListener::bind(folder.path().join("out")).unwrap();
    refused(&folder, &call, "it is not a folder");
}

/// A folder with readable files: frames, tables, a kernel, a lens, settings, and a recording.
fn inputs() -> Folder {
    let folder = Folder::new();
    let made = |call: Vec<&str>| assert_eq!(folder.halfrow(call.iter().copied()).code, Some(0), "{call:?}");
    made(small("frames", &["--only", "noise", "-o", "."]));
    made(small("correct", &["builtin:noise", "--model", "-o", "noise.png"]));
    made(small("tables", &["-o", "t.json"]));
    made(small("verify", &["--record", "run.rec"]));
    made(vec!["frames", "--width", "64", "--height", "2", "--only", "noise", "-o", "tiny"]);
    folder.write("s.toml", "seed = 3\n");
    folder.write(
        "lens.json",
        r#"{"K":[[90,0,64],[0,90,8],[0,0,1]],"D":[0,0,0,0],"image_width":128,"image_height":16}"#,
    );
    folder.write("lens.png", folder.read("lens.json"));
    let table = folder.json("t.json");
    folder.write("kernel.json", serde_json::json!({ "kernel": table["kernel"] }).to_string());
    folder.write("kernel.pgm", folder.read("kernel.json"));
    folder.write("t.pgm", folder.read("t.json"));
    fs::hard_link(folder.path().join("noise.pgm"), folder.path().join("again.rec")).unwrap();
    folder
}

#[test]
fn an_input_is_never_overwritten() {
    let folder = inputs();
    let calls = [
        (small("verify", &["--tables", "t.json", "--record", "t.json"]), "t.json"),
        (small("verify", &["--frame", "noise.pgm", "--record", "noise.pgm"]), "noise.pgm"),
        (small("verify", &["--frame", "noise.pgm", "--record", "tiny/../noise.pgm"]), "noise.pgm"),
        (small("verify", &["--frame", "noise.pgm", "--record", "again.rec"]), "noise.pgm"),
        (small("verify", &["--lens", "lens.json", "--record", "lens.json"]), "lens.json"),
        (small("verify", &["--kernel", "kernel.json", "--record", "kernel.json"]), "kernel.json"),
        (small("verify", &["--settings", "s.toml", "--record", "s.toml"]), "s.toml"),
        (vec!["verify", "--board", "replay:run.rec", "--record", "run.rec"], "run.rec"),
        (small("correct", &["noise.pgm", "--model", "-o", "noise.pgm"]), "noise.pgm"),
        (small("correct", &["noise.pgm", "--model", "-o", "."]), "noise.pgm"),
        (small("correct", &["noise.pgm", "--model", "--tables", "t.pgm", "-o", "t.pgm"]), "t.pgm"),
        (
            small("correct", &["noise.pgm", "--model", "--kernel", "./kernel.pgm", "-o", "kernel.pgm"]),
            "kernel.pgm",
        ),
        (small("correct", &["noise.png", "--model", "-o", "x.pgm", "--preview", "noise.png"]), "noise.png"),
        (small("tables", &["--lens", "lens.json", "-o", "lens.json"]), "lens.json"),
        (small("tables", &["--kernel", "kernel.json", "-o", "kernel.json"]), "kernel.json"),
        (small("lens", &["--lens", "lens.png", "--map", "lens.png"]), "lens.png"),
        (vec!["kernel", "train", "--images", ".", "-o", "noise.png"], "noise.png"),
        (vec!["paper", "resources", "--synthesis", "tiny/paper.json", "-o", "tiny"], "tiny/paper.json"),
        (
            vec!["paper", "fig4", "--photograph", "tiny/fig-4a.png", "--lines", "s.toml", "-o", "tiny"],
            "tiny/fig-4a.png",
        ),
    ];
    folder.write("tiny/paper.json", "{}");
    folder.write("tiny/fig-4a.png", "a photograph");
    for (call, input) in calls {
        let before = folder.read(input);
        let call: Vec<_> = call.iter().copied().chain(["--overwrite"]).collect();
        refused(&folder, &call, "is read by this call");
        assert!(folder.read(input) == before, "{call:?}");
    }
}

/// Neither exFAT has them, nor some network file systems.
#[test]
fn a_file_system_without_renames_to_new_names_and_without_links_takes_files() {
    let folder = Folder::new();
    let line = "exec strace -f -qq -o /dev/null -e inject=renameat2:error=EINVAL -e inject=link,linkat:error=EPERM \"$@\"";
    let write =
        || finish(&mut folder.by_shell(line, small("correct", &["builtin:black", "--model", "-o", "a.pgm"])));
    let (written, refused) = (write(), write());
    assert_eq!((written.code, refused.code), (Some(0), Some(2)), "{}{}", written.stderr, refused.stderr);
    assert_eq!(folder.names("."), ["a.pgm"]);
}

/// What rename(2) and fsync(2) leave to the caller: a file that gets its name before its bytes are on the disk may be empty after
/// a power cut, and a name that is not on the disk may be gone.
#[test]
fn outputs_are_on_the_disk_before_their_names_are_and_their_names_at_the_end() {
    let folder = Folder::new();
    for (call, name) in [
        (small("tables", &["-o", "t.json"]), "t.json"),
        (small("verify", &["--report", "out"]), "out"),
        (small("verify", &["--report", "out", "--overwrite"]), "out"),
    ] {
        let line = "exec strace -f -qq -y -e trace=fsync,rename,renameat2 -o calls \"$@\"";
        let ended = finish(&mut folder.by_shell(line, call.iter().copied()));
        assert_eq!(ended.code, Some(0), "{call:?}: {}{}", ended.stdout, ended.stderr);
        let calls = folder.text("calls");
        let calls: Vec<_> = calls.lines().collect();
        // A rename that fails on purpose tries whether the folder can be replaced.
        let is_named = |line: &&str| {
            line.contains("rename") && line.contains(&format!("{name}\"")) && line.ends_with("= 0")
        };
        let named = calls.iter().position(is_named).unwrap();
        let aside = calls[named].split('"').nth(1).unwrap();
        let is_synced = |calls: &[&str], path: &str| {
            calls.iter().any(|line| line.contains("fsync(") && line.contains(&format!("{path}>)")))
        };
        let aside = Path::new(aside).file_name().unwrap().to_str().unwrap();
        let inside = if name == "out" { folder.names(name) } else { Vec::new() };
        for path in inside.iter().map(|file| format!("/{aside}/{file}")).chain([format!("/{aside}")]) {
            assert!(is_synced(&calls[..named], &path), "{call:?}, {path}: {calls:#?}");
        }
        let around = folder.path().file_name().unwrap().to_str().unwrap();
        assert!(is_synced(&calls[named..], &format!("/{around}")), "{call:?}: {calls:#?}");
    }
}

/// When the file cannot be given to the group that it had, the other group may read only what everybody may.
#[test]
fn a_file_that_comes_to_another_group_is_open_to_nobody_more() {
    if !is_root() {
        not_tested("files of another group", "only root may give a file to a group that it is not in");
        return;
    }
    for (mode, expected) in [(0o660, 0o600), (0o664, 0o644), (0o2664, 0o644)] {
        let folder = Folder::new();
        let (theirs, file) = (folder.path().join("theirs"), folder.path().join("theirs/t.json"));
        fs::create_dir(&theirs).unwrap();
        fs::write(&file, "somebody's").unwrap();
        chown(&theirs, Some(NOBODY), Some(NOBODY)).unwrap();
        chown(&file, None, Some(54_321)).unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
        let call = small("tables", &["-o", "theirs/t.json", "--overwrite"]);
        finish(&mut folder.as_nobody(&call)).succeeded();
        let there = fs::metadata(&file).unwrap();
        assert_eq!((there.mode() & 0o7777, there.uid(), there.gid()), (expected, NOBODY, NOBODY), "{mode:o}");
    }
}

#[test]
fn two_outputs_are_two() {
    let folder = Folder::new();
    let call = |more: &[&'static str]| small("verify", &[&["--board", DEAD, "--overwrite"], more].concat());
    refused(&folder, &call(&["--record", "rr", "--report", "rr"]), "would both be written to rr");
    folder.halfrow(small("verify", &["--report", "rep"])).succeeded();
    refused(&folder, &call(&["--record", "rep/run.rec", "--report", "rep"]), "would both be written to rep");
    refused(&folder, &call(&["--record", "rep/report.xml", "--report", "./rep"]), "would both be written to");
    assert_eq!(folder.names("rep"), ["report.html", "report.json", "report.xml"]);
}

#[test]
fn manual_pages_are_written_into_a_folder_as_other_files_are() {
    let folder = Folder::new();
    folder.halfrow(["manual", "a/man"]).succeeded();
    let pages = folder.names("a/man");
    folder.write("a/man/halfrow.1", "precious");
    refused(
        &folder,
        &["manual", "a/man"],
        ".1 exists; allow it to be overwritten (--overwrite), or name another folder",
    );
    assert_eq!(folder.text("a/man/halfrow.1"), "precious");
    folder.halfrow(["manual", "a/man", "--overwrite"]).succeeded();
    assert!(folder.text("a/man/halfrow.1").contains(".TH halfrow"));
    assert_eq!(folder.names("a/man"), pages);
}

#[test]
fn tables_have_two_formats() {
    for name in ["t.txt", "t"] {
        refused(&Folder::new(), &small("tables", &["-o", name]), "end it in .json, or in .mem");
    }
}

#[test]
fn a_port_that_there_is_not_is_refused() {
    for port in ["99999", "-1", "x", "localhost:", ":3000", "host:99999"] {
        refused(&Folder::new(), &["serve", &format!("--tcp={port}")], "0 to 65535");
    }
}
