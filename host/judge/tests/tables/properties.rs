//! Properties of table files over random tables and random damage.

use halfrow::tables::mem::{kernel_text, parse_kernel, parse_tables, tables_text};
use halfrow::tables::{KernelFile, TableFile};
use halfrow_model::{BitDepth, Geometry, GridShape, Kernel, TableSet};
use proptest::array::uniform5;
use proptest::collection::{btree_map, vec};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use serde_json::{Map, Value};

fn table_sets() -> impl Strategy<Value = TableSet> {
    prop_oneof![row_factors(), grids()]
}

/// Grids of any shape, whose offsets and entries are drawn: legal or not, as files hold both.
fn grids() -> impl Strategy<Value = TableSet> {
    let sizes = (32_usize..=300, 1_usize..40, select(BitDepth::ALL.to_vec()));
    let shapes = (select(GridShape::V.collect::<Vec<_>>()), select(GridShape::K.collect::<Vec<_>>()));
    (sizes, shapes).prop_flat_map(|((pairs, height, depth), (v, k))| {
        let (width, shape) = (2 * pairs, GridShape::new(v, k).unwrap());
        let entries = shape.entries(&Geometry::centred(width, height, depth).unwrap());
        (0..=2 * width as u32 - 2, vec(0_u32..1 << 25, entries)).prop_map(move |(centre2, entries)| {
            let geometry = Geometry::new(width, height, depth, centre2).unwrap();
            TableSet::from_grid(geometry, shape, &entries).unwrap()
        })
    })
}

fn row_factors() -> impl Strategy<Value = TableSet> {
    let sizes = (32_usize..=1296, 1_usize..40, select(BitDepth::ALL.to_vec()));
    sizes.prop_flat_map(|(pairs, height, depth)| {
        let width = 2 * pairs;
        let units = vec(1_u32..=1 << 24, height);
        (0..=2 * width as u32 - 2, units).prop_map(move |(centre2, units)| {
            TableSet::from_units(Geometry::new(width, height, depth, centre2).unwrap(), &units).unwrap()
        })
    })
}

fn kernels() -> impl Strategy<Value = Kernel> {
    vec(uniform5(any::<i16>()), 65).prop_map(|nodes| Kernel::from_nodes(nodes).unwrap())
}

fn values() -> impl Strategy<Value = Value> {
    let number = any::<f64>().prop_filter("JSON has no such number", |number| number.is_finite());
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        number.prop_map(Value::from),
        ".{0,8}".prop_map(Value::from),
    ];
    leaf.prop_recursive(3, 16, 4, |inner| {
        prop_oneof![
            vec(inner.clone(), 0..4).prop_map(Value::from),
            btree_map(".{0,6}", inner, 0..4).prop_map(|members| Value::Object(members.into_iter().collect())),
        ]
    })
}

fn notes() -> impl Strategy<Value = Option<Map<String, Value>>> {
    proptest::option::of(btree_map(".{0,6}", values(), 0..4).prop_map(|notes| notes.into_iter().collect()))
}

fn table_files() -> impl Strategy<Value = TableFile> {
    (table_sets(), kernels(), notes()).prop_map(|(tables, kernel, about)| TableFile { tables, kernel, about })
}

/// JSON objects with the keys of a table file and values of any kind.
fn near_misses() -> impl Strategy<Value = String> {
    let keys = ["width", "height", "bits", "centre2", "v", "k", "step", "grid", "kernel", "about", "other"];
    let value = prop_oneof![values(), (0..70_i64).prop_map(Value::from), (0..3000_i64).prop_map(Value::from)];
    (btree_map(select(keys.to_vec()), value, 0..9), 1..=2).prop_map(|(members, datapath)| {
        let mut members: Map<_, _> =
            members.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        members.insert("datapath".to_owned(), Value::from(datapath));
        Value::Object(members).to_string()
    })
}

/// Calls every reader with `text`. They must return.
fn read_every_way(text: &str) {
    let _ = TableFile::parse(text);
    let _ = KernelFile::parse(text);
    let _ = parse_tables(text);
    let _ = parse_kernel(text);
}

proptest! {
    #[test]
    fn every_table_file_is_read_back_as_it_was(file in table_files()) {
        prop_assert_eq!(TableFile::parse(&file.to_json()).unwrap(), file);
    }

    #[test]
    fn every_kernel_file_is_read_back_as_it_was(kernel in kernels(), about in notes()) {
        let file = KernelFile { kernel, about };
        prop_assert_eq!(KernelFile::parse(&file.to_json()).unwrap(), file);
    }

    #[test]
    fn every_memory_image_is_read_back_as_it_was(tables in table_sets(), kernel in kernels()) {
        prop_assert_eq!(parse_tables(&tables_text(&tables)), Ok(tables));
        prop_assert_eq!(parse_kernel(&kernel_text(&kernel)), Ok(kernel));
    }

    #[test]
    fn no_text_makes_a_reader_panic(text in any::<String>()) {
        read_every_way(&text);
    }

    #[test]
    fn no_json_with_the_right_keys_makes_a_reader_panic(text in near_misses()) {
        read_every_way(&text);
    }

    #[test]
    fn no_damage_to_a_file_makes_a_reader_panic(
        file in table_files(),
        damage in vec((any::<Index>(), any::<u8>()), 1..4),
        end in any::<Index>(),
    ) {
        for text in [file.to_json(), tables_text(&file.tables), kernel_text(&file.kernel)] {
            let mut bytes = text.into_bytes();
            for (place, byte) in &damage {
                let place = place.index(bytes.len());
                bytes[place] = *byte;
            }
            read_every_way(&String::from_utf8_lossy(&bytes));
            bytes.truncate(end.index(bytes.len()));
            read_every_way(&String::from_utf8_lossy(&bytes));
        }
    }

    #[test]
    fn a_table_file_that_breaks_off_is_never_taken_for_whole(file in table_files(), end in any::<Index>()) {
        let text = file.to_json();
        let whole = text.trim_end();
        let cut = String::from_utf8_lossy(&whole.as_bytes()[..end.index(whole.len())]).into_owned();
        prop_assert!(TableFile::parse(&cut).is_err());
    }
}
