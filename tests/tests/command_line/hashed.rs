//! The hashes of the files that a run has read.

use std::process::Command;

use halfrow_tests::program::{Folder, finish};

use crate::small;

/// Asserts that `call` opens `file` only once: if the file were replaced between two times, the hash would not be that of what
/// was judged.
#[track_caller]
fn opens_once(folder: &Folder, call: &[&str], file: &str) {
    let line = "exec strace -f -qq -e trace=open,openat -o opened \"$@\"";
    let ended = finish(&mut folder.by_shell(line, call.iter().copied()));
    assert_eq!(ended.code, Some(0), "{call:?}: {}{}", ended.stdout, ended.stderr);
    let opened = folder.text("opened");
    let opened: Vec<_> = opened.lines().filter(|line| line.contains(&format!("{file}\""))).collect();
    assert_eq!(opened.len(), 1, "{call:?} {file}: {opened:#?}");
}

#[test]
fn what_is_hashed_is_what_was_judged() {
    let folder = Folder::new();
    folder.write("lens.yml", include_bytes!("../../../host/judge/tests/lenses/files/opencv-4.10.yml"));
    folder.halfrow(small("tables", &["-o", "t.json"])).succeeded();
    folder.halfrow(small("frames", &["--only", "noise", "-o", "."])).succeeded();
    let tables = ["verify", "--json", "--tables", "t.json", "--frame", "noise.pgm", "--at-speed", "0"];
    opens_once(&folder, &tables, "t.json");
    opens_once(&folder, &tables, "noise.pgm");
    opens_once(&folder, &["soak", "--json", "--tables", "t.json", "--frames", "1"], "t.json");
    let lens = ["--lens", "lens.yml", "--width", "128", "--height", "72", "--frame", "builtin:black"];
    opens_once(&folder, &[&["verify", "--json", "--at-speed", "0"], &lens[..]].concat(), "lens.yml");
}

#[test]
fn a_kernel_file_is_among_the_files_of_a_run() {
    let folder = Folder::new();
    folder.write("own.json", include_bytes!("../../../host/judge/src/kernels/sharp7.json"));
    let call =
        small("verify", &["--json", "--kernel", "own.json", "--frame", "builtin:black", "--at-speed", "0"]);
    let files = &folder.halfrow(call.iter().copied()).json()["run"]["files"];
    let hashed = Command::new("sha256sum").arg(folder.path().join("own.json")).output().unwrap();
    let hashed = String::from_utf8(hashed.stdout).unwrap();
    assert_eq!(*files, serde_json::json!([{ "path": "own.json", "sha256": hashed[..64] }]));
    opens_once(&folder, &call, "own.json");
}

#[test]
fn what_names_a_photograph_of_a_kernel_is_what_it_was_fitted_to() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("photos")).unwrap();
    let data = (0..3 * 96 * 64_u32).map(|place| (place * place / 7 % 251) as u8).collect();
    let image = halfrow::frames::preview::RgbImage { width: 96, height: 64, data };
    halfrow::frames::write_rgb(&folder.path().join("photos/a.png"), &image, false).unwrap();
    let call = ["kernel", "measure", "--json", "--quiet", "--kernel", "sharp5", "--images", "photos"];
    opens_once(&folder, &call, "photos/a.png");
}
