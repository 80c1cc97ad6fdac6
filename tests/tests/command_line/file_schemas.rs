//! The schemas of table and kernel files: they take what the program writes, and refuse what it refuses.

use halfrow::tables::{ContentError, KernelFile, TableFile};
use halfrow_tests::program::Folder;
use jsonschema::Validator;
use serde_json::{Value, json};

const TABLES: &str = include_str!("../../../host/schema/table-file-1.json");
const KERNELS: &str = include_str!("../../../host/schema/kernel-file-1.json");

fn schema(text: &str) -> Validator {
    jsonschema::validator_for(&serde_json::from_str(text).unwrap()).unwrap()
}

/// A file that the program makes for a small frame.
fn made(more: &[&str]) -> Value {
    let folder = Folder::new();
    let call = ["tables", "--width", "64", "--height", "16", "--radius", "40", "-o", "made.json"];
    folder.halfrow(call.iter().chain(more).copied()).succeeded();
    folder.json("made.json")
}

/// Sets the value at `pointer`, or removes it for `null`; then both schema and program must refuse the file.
#[track_caller]
fn both_refuse<T>(
    schema: &Validator,
    parse: fn(&str) -> Result<T, ContentError>,
    legal: &Value,
    pointer: &str,
    value: Value,
) {
    assert!(schema.is_valid(legal) && parse(&legal.to_string()).is_ok());
    let mut changed = legal.clone();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    let parent = if parent.is_empty() { &mut changed } else { changed.pointer_mut(parent).unwrap() };
    match (parent, value) {
        (Value::Object(members), Value::Null) => drop(members.remove(key)),
        (Value::Object(members), value) => drop(members.insert(key.to_owned(), value)),
        (Value::Array(values), Value::Null) => drop(values.remove(key.parse().unwrap())),
        (Value::Array(values), value) => values[key.parse::<usize>().unwrap()] = value,
        (other, _) => panic!("{other} has no members"),
    }
    assert_ne!(&changed, legal, "{pointer}");
    assert!(parse(&changed.to_string()).is_err(), "the program takes another {pointer}");
    assert!(!schema.is_valid(&changed), "the schema takes another {pointer}");
}

#[test]
fn what_is_wrong_in_a_table_file_is_wrong_by_its_schema_too() {
    let schema = schema(TABLES);
    let (rows, grid) = (made(&[]), made(&["--projection", "exact"]));
    assert_eq!((&rows["datapath"], &grid["datapath"]), (&1.into(), &2.into()));
    let of_both =
        ["/datapath", "/width", "/height", "/bits", "/centre2", "/kernel", "/kernel/64", "/kernel/64/4"];
    for file in [&rows, &grid] {
        for pointer in of_both {
            both_refuse(&schema, TableFile::parse, file, pointer, Value::Null);
        }
        for (pointer, value) in [
            ("/moon", json!(1)),
            ("/about", json!("text")),
            ("/datapath", json!(3)),
            ("/width", json!(65)),
            ("/width", json!(2594)),
            ("/height", json!(0)),
            ("/bits", json!(11)),
            ("/centre2", json!(-1)),
            ("/kernel/64/4", json!(32_768)),
            ("/kernel/64/4", json!(0.5)),
        ] {
            both_refuse(&schema, TableFile::parse, file, pointer, value);
        }
    }
    for (file, pointer, value) in [
        (&rows, "/step", json!(null)),
        (&rows, "/step/3", json!(0)),
        (&rows, "/step/3", json!(16_777_217)),
        (&rows, "/v", json!(1)),
        (&grid, "/grid", json!(null)),
        (&grid, "/grid/3", json!(33_554_432)),
        (&grid, "/v", json!(0)),
        (&grid, "/v", json!(7)),
        (&grid, "/k", json!(4)),
        (&grid, "/step", json!([16_777_216])),
    ] {
        both_refuse(&schema, TableFile::parse, file, pointer, value);
    }
}

#[test]
fn what_is_wrong_in_a_kernel_file_is_wrong_by_its_schema_too() {
    let schema = schema(KERNELS);
    let sharp: Value =
        serde_json::from_str(include_str!("../../../host/judge/src/kernels/sharp5.json")).unwrap();
    for (pointer, value) in [
        ("/kernel", json!(null)),
        ("/kernel/0", json!(null)),
        ("/kernel/0/0", json!(-32_769)),
        ("/datapath", json!(3)),
        ("/about", json!([])),
        ("/step", json!([1])),
    ] {
        both_refuse(&schema, KernelFile::parse, &sharp, pointer, value);
    }
    let mut without = sharp;
    without.as_object_mut().unwrap().remove("datapath");
    assert!(schema.is_valid(&without) && KernelFile::parse(&without.to_string()).is_ok());
}
