//! Table and kernel files: what is written, what is read back, and what Verilog is given.

use std::fs;

use halfrow::tables::{ContentError, KernelFile, TableFile, TableFileError};
use halfrow_files::written_aside::WriteAsideError;
use halfrow_model::{BitDepth, Equidistant, Geometry, Interpolant, Kernel, TableSet};
use serde_json::{Value, json};

/// The paper's system, whose tables have known checksums.
fn paper_file() -> TableFile {
    let lens = Equidistant::from_radius(1106.697).unwrap();
    let tables = TableSet::from_lens(Geometry::default(), &lens, None).unwrap();
    TableFile { tables, kernel: Interpolant::Hermite.into(), about: None }
}

/// Three rows, and a kernel that repeats one node.
fn small_file() -> TableFile {
    let geometry = Geometry::new(64, 3, BitDepth::Ten, 126).unwrap();
    TableFile {
        tables: TableSet::from_units(geometry, &[1, 14_648_488, 16_777_216]).unwrap(),
        kernel: Kernel::from_nodes(vec![[1, -1, 16384, -32768, 32767]; 65]).unwrap(),
        about: None,
    }
}

#[test]
fn a_table_file_has_one_key_a_line_and_one_node_a_line() {
    let nodes = ["    [1, -1, 16384, -32768, 32767]"; 65].join(",\n");
    let expected = format!(
        "{{\n  \"datapath\": 1,\n  \"width\": 64,\n  \"height\": 3,\n  \"bits\": 10,\n  \"centre2\": 126,\n  \
         \"step\": [\n    1, 14648488, 16777216\n  ],\n  \"kernel\": [\n{nodes}\n  ]\n}}\n"
    );
    assert_eq!(small_file().to_json(), expected);
}

#[test]
fn another_json_reader_finds_the_papers_numbers() {
    let value: Value = serde_json::from_str(&paper_file().to_json()).unwrap();
    let integers = |list: &Value| -> Vec<i64> {
        list.as_array().unwrap().iter().map(|number| number.as_i64().unwrap()).collect()
    };
    let bytes: Vec<u8> =
        integers(&value["step"]).iter().flat_map(|&units| (units as u32).to_le_bytes()).collect();
    let nodes = value["kernel"].as_array().unwrap().iter().flat_map(integers);
    let weights: Vec<u8> = nodes.flat_map(|weight| (weight as i16).to_le_bytes()).collect();
    assert_eq!(value["step"][0], 14_648_698);
    assert_eq!(crc32fast::hash(&bytes), 0x5f5a_7553);
    assert_eq!(crc32fast::hash(&weights), 0x16e2_9b0f);
}

#[test]
fn no_line_is_longer_than_a_screen() {
    let longest = paper_file().to_json().lines().map(str::len).max();
    assert!(longest <= Some(110), "{longest:?}");
}

#[test]
fn a_table_file_is_read_back_as_it_was() {
    let text = r#"{"z": {"b": [1.10, 1106.697, 0.1, null]}, "a": "half a row, \u00e9"}"#;
    let about = Some(serde_json::from_str(text).unwrap());
    let file = TableFile { about, ..paper_file() };
    assert_eq!(TableFile::parse(&file.to_json()).unwrap(), file);
}

#[test]
fn notes_keep_their_order_and_their_digits() {
    let notes = r#"{"z":1,"m":{"y":1106.697,"x":[true]},"a":"R"}"#;
    let file = TableFile { about: Some(serde_json::from_str(notes).unwrap()), ..small_file() };
    let again = TableFile::parse(&file.to_json()).unwrap().to_json();
    assert!(again.contains(&format!("\n  \"about\": {notes},\n")), "{again}");
}

#[test]
fn the_order_of_the_keys_and_the_white_space_do_not_matter() {
    let mut value: Value = serde_json::from_str(&small_file().to_json()).unwrap();
    value.as_object_mut().unwrap().sort_keys();
    assert_eq!(TableFile::parse(&value.to_string()).unwrap(), small_file());
}

#[test]
fn a_kernel_file_is_read_back_as_it_was() {
    let about = json!({"from": "Keys"}).as_object().cloned();
    let file = KernelFile { kernel: Interpolant::Keys.into(), about };
    assert_eq!(KernelFile::parse(&file.to_json()).unwrap(), file);
}

#[test]
fn a_kernel_file_may_be_a_kernel_alone() {
    let nodes = vec![[0, -2304, 2560, -768, 0]; 65];
    let file = KernelFile::parse(&json!({ "kernel": nodes }).to_string()).unwrap();
    assert_eq!(file, KernelFile { kernel: Kernel::from_nodes(nodes).unwrap(), about: None });
}

#[test]
fn a_written_file_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let (tables, kernel) = (folder.path().join("t.json"), folder.path().join("k.json"));
    let kernel_file = KernelFile { kernel: Interpolant::Linear.into(), about: None };
    small_file().write(&tables, false).unwrap();
    kernel_file.write(&kernel, false).unwrap();
    assert_eq!(TableFile::read(&tables).unwrap().0, small_file());
    assert_eq!(KernelFile::read(&kernel).unwrap().0, kernel_file);
}

#[test]
fn a_written_file_is_replaced_only_when_it_may_be() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    small_file().write(&path, false).unwrap();
    assert!(matches!(paper_file().write(&path, false), Err(WriteAsideError::Exists { .. })));
    assert_eq!(TableFile::read(&path).unwrap().0, small_file());
    paper_file().write(&path, true).unwrap();
    assert_eq!(TableFile::read(&path).unwrap().0, paper_file());
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none.json");
    let refused = TableFile::read(&path).unwrap_err();
    assert!(matches!(&refused, TableFileError::Io { path: named, .. } if *named == path));
    assert!(refused.to_string().contains("none.json; check"), "{refused}");
}

#[test]
fn a_file_that_is_no_text_is_refused_with_the_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    fs::write(&path, b"{\"about\": \xff}").unwrap();
    let Err(TableFileError::Io { source, .. }) = TableFile::read(&path) else { panic!("it was read") };
    assert_eq!(source.to_string(), "it is not text from byte 10 on, in line 1");
}

#[test]
fn a_file_longer_than_any_table_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    fs::File::create(&path).unwrap().set_len((1 << 20) + 1).unwrap();
    let refused = TableFile::read(&path);
    let Err(TableFileError::Io { source, .. }) = refused else { panic!("{refused:?}") };
    assert!(source.to_string().contains("longer than 1048576 bytes"), "{source}");
}

#[test]
fn what_is_wrong_inside_a_file_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    fs::write(&path, small_file().to_json().replace("\"height\": 3", "\"height\": 4")).unwrap();
    let refused = TableFile::read(&path).unwrap_err();
    assert_eq!(refused.to_string(), format!("{} cannot be used", path.display()));
    let TableFileError::Content { source, .. } = refused else { panic!("{refused}") };
    assert!(matches!(source, ContentError::Length { found: 3, wanted: 4, .. }), "{source}");
}

#[test]
fn tables_for_another_datapath_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    fs::write(&path, r#"{"datapath": 3, "rows": "of some later kind"}"#).unwrap();
    for refused in [TableFile::read(&path).unwrap_err(), KernelFile::read(&path).unwrap_err()] {
        assert!(matches!(&refused, TableFileError::Datapath { source, .. } if source.found == 3));
        let chain = format!("{:#}", anyhow::Error::new(refused));
        assert!(chain.contains("t.json is refused: the tables are for datapath 3"), "{chain}");
        assert!(chain.contains("`halfrow tables`"), "{chain}");
    }
}
