//! Table files that no board may be given: each is refused with its own message, before a board is opened.

use halfrow_tests::program::Folder;
use serde_json::{Value, json};

use crate::{refused, refused_with};

/// A folder with a legal table file of 64 x 4.
fn legal() -> (Folder, Value) {
    let folder = Folder::new();
    folder.halfrow(["tables", "--width", "64", "--height", "4", "-o", "legal.json"]).succeeded();
    let file = folder.json("legal.json");
    (folder, file)
}

/// `verify` and `correct` must refuse the legal file after `change`.
#[track_caller]
fn bad_tables(change: impl FnOnce(&mut Value), sentence: &str) {
    changed(2, change, sentence);
}

#[track_caller]
fn changed(code: i32, change: impl FnOnce(&mut Value), sentence: &str) {
    let (folder, mut file) = legal();
    change(&mut file);
    folder.write("changed.json", file.to_string());
    refused_with(code, &folder, &["verify", "--tables", "changed.json", "--report", "out"], sentence);
    let correct = ["correct", "builtin:black", "--model", "--tables", "changed.json", "-o", "out.pgm"];
    refused_with(code, &folder, &correct, sentence);
}

#[test]
fn the_legal_file_itself_is_taken() {
    let (folder, file) = legal();
    folder.write("again.json", file.to_string());
    folder.halfrow(["verify", "--tables", "again.json"]).succeeded();
}

/// The two names that `tables` takes and prints when it writes images.
#[test]
fn memory_images_are_told_to_be_for_verilog() {
    let folder = Folder::new();
    folder.halfrow(["tables", "--width", "64", "--height", "4", "-o", "line.mem"]).succeeded();
    for name in ["line.mem", "line.steps.mem"] {
        let sentence = format!(
            "{name} is a name of memory images, which are for Verilog; for tables give the table file (.json)"
        );
        refused(&folder, &["verify", "--tables", name], &sentence);
    }
    let sentence = "line.kernel.mem is a name of memory images, which are for Verilog; for tables give the table file (.json), for a kernel its file";
    refused(&folder, &["verify", "--kernel", "line.kernel.mem"], sentence);
}

#[test]
fn entries_that_are_missing_or_too_many_are_refused() {
    bad_tables(|file| _ = file["step"].as_array_mut().unwrap().pop(), "has 3 entries instead of 4");
    bad_tables(|file| file["step"].as_array_mut().unwrap().push(1.into()), "has 5 entries instead of 4");
    bad_tables(|file| _ = file["kernel"].as_array_mut().unwrap().pop(), "has 64 entries instead of 65");
    bad_tables(|file| _ = file["kernel"][7].as_array_mut().unwrap().pop(), "has 4 entries instead of 5");
    bad_tables(|file| _ = file.as_object_mut().unwrap().remove("step"), "it lacks");
}

#[test]
fn factors_out_of_range_are_refused_with_their_row() {
    bad_tables(|file| file["step"][2] = 0.into(), "is 0, outside 1 to 16777216");
    bad_tables(|file| file["step"][2] = 16_777_217.into(), "is 16777217, outside 1 to 16777216");
    bad_tables(|file| file["step"][2] = (-1).into(), "row 2");
    bad_tables(|file| file["step"][2] = 1e30.into(), "row 2");
    bad_tables(|file| file["step"][2] = "many".into(), "row 2");
}

#[test]
fn a_weight_of_two_is_refused_with_its_node() {
    bad_tables(|file| file["kernel"][9][2] = 32768.into(), "is 32768, outside -32768 to 32767");
    bad_tables(|file| file["kernel"][9][2] = 32768.into(), "node 9");
    bad_tables(|file| file["kernel"][64][0] = (-32769).into(), "node 64");
    bad_tables(|file| file["kernel"][0][1] = 0.5.into(), "node 0");
}

/// With a small factor a row's source lies far ahead of its left edge when the centre is at the right, and far back from its
/// right edge when the centre is at the left.
#[test]
fn rows_that_reach_beyond_the_ring_are_refused() {
    let (folder, mut file) = legal();
    let call = ["verify", "--tables", "far.json", "--report", "out"];
    file["step"][1] = 1.into();
    file["centre2"] = 126.into();
    folder.write("far.json", file.to_string());
    // Column 0 comes from column 63, whose window reaches to 67: 32 beyond W/2 + 3.
    refused(&folder, &call, "row 1 needs samples 32 columns later than half a row of delay brings them");
    let correct = ["correct", "builtin:black", "--model", "--tables", "far.json", "-o", "out.pgm"];
    refused(&folder, &correct, "row 1 needs samples 32 columns later");
    file["centre2"] = 0.into();
    folder.write("far.json", file.to_string());
    // Column 63 comes from column 0, 63 + W/2 - 1 columns back, and the ring holds 63 before the newest.
    let short = [&call[..], &["--board", "mock,max-width=64,ring=64"]].concat();
    refused(&folder, &short, "row 1 needs samples 31 columns older than a ring of 64 still holds");
    // The ring of 2048 of any other mock holds them, and a table is legal by the ring alone (DATAPATH.md, "Ring").
    for tables in ["far.json", "legal.json"] {
        let judged = folder.halfrow(["verify", "--tables", tables]);
        assert_eq!(judged.code, Some(0), "{tables}: {}", judged.stderr);
    }
}

/// The model would still compute something, and each of its paths something else.
#[test]
fn nothing_is_corrected_by_tables_that_no_board_takes() {
    let folder = Folder::new();
    let aside = ["--width", "64", "--height", "49", "--radius", "25", "--centre-x=63"];
    let model = ["correct", "builtin:street", "--model", "-o", "out.pgm"];
    refused(&folder, &[&model[..], &aside].concat(), "row 0 needs samples 14 columns later");
    let size = ["--width", "64", "--height", "4", "--radius", "60", "--projection", "exact"];
    folder.halfrow([&["tables", "-o", "grid.json"], &size[..]].concat()).succeeded();
    let mut file = folder.json("grid.json");
    file["grid"][0] = (file["grid"][0].as_u64().unwrap() - 7_000_000).into();
    folder.write("grid.json", file.to_string());
    refused(
        &folder,
        &[&model[..], &["--tables", "grid.json"]].concat(),
        "grid.json cannot be used: row 0 begins left of the frame",
    );
}

/// Editors on Windows write one, and show it nowhere.
#[test]
fn a_byte_order_mark_changes_nothing() {
    let (folder, _) = legal();
    folder.write("marked.json", format!("\u{feff}{}", folder.text("legal.json")));
    let kernel = folder.json("legal.json");
    let kernel = json!({ "datapath": 1, "kernel": kernel["kernel"] });
    folder.write("kernel.json", format!("\u{feff}{kernel}"));
    let correct = |tables: &str, kernel: &[&str]| {
        let call =
            ["correct", "builtin:noise", "--model", "--tables", tables, "-o", "out.pgm", "--overwrite"];
        folder.halfrow([&call[..], kernel].concat()).succeeded();
        folder.read("out.pgm")
    };
    let plain = correct("legal.json", &[]);
    assert!(correct("marked.json", &[]) == plain);
    assert!(correct("legal.json", &["--kernel", "kernel.json"]) == plain);
}

#[test]
fn tables_of_another_datapath_are_refused_like_boards_of_another_datapath() {
    changed(
        6,
        |file| file["datapath"] = 3.into(),
        "the tables are for datapath 3, and this program knows 1 and 2 alone",
    );
}

#[test]
fn what_no_table_file_has_is_refused() {
    bad_tables(|file| file["steps"] = json!([]), "it has the key \"steps\"");
    bad_tables(|file| file["width"] = 65.into(), "65");
    bad_tables(|file| file["bits"] = 9.into(), "is 9; ");
    bad_tables(|file| file["centre2"] = 127.into(), "is 127, outside 0 to 126");
    bad_tables(|file| *file = json!([]), "it is not the JSON object it should be");
    let (folder, _) = legal();
    let text = folder.text("legal.json");
    folder.write("half.json", &text[..text.len() / 2]);
    refused(&folder, &["verify", "--tables", "half.json"], "it breaks off at line");
}

/// The largest possible table file has less than 64 KiB; one of 10 MB would take hundreds to parse.
#[test]
fn a_file_longer_than_any_tables_is_refused_before_it_is_parsed() {
    let (folder, _) = legal();
    folder.write("long.json", vec![b'['; (1 << 20) + 1]);
    refused(&folder, &["verify", "--tables", "long.json"], "it is longer than 1048576 bytes");
    refused(&folder, &["verify", "--kernel", "long.json"], "it is longer than 1048576 bytes");
    folder.write(
        "notes.json",
        folder.text("legal.json").replacen('{', &format!("{{{}", " ".repeat(500_000)), 1),
    );
    folder.halfrow(["verify", "--tables", "notes.json"]).succeeded();
}

#[test]
fn a_kernel_file_is_checked_as_a_table_file_is() {
    let folder = Folder::new();
    folder.write("kernel.json", json!({ "datapath": 3, "kernel": [] }).to_string());
    refused_with(6, &folder, &["verify", "--kernel", "kernel.json"], "datapath 3");
    folder.write("kernel.json", json!({ "kernel": [[0, 0, 0, 0, 0]] }).to_string());
    refused(&folder, &["verify", "--kernel", "kernel.json"], "has 1 entries instead of 65");
}
