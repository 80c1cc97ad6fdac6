//! Memory images for `$readmemh`.

use std::fs;
use std::path::{Path, PathBuf};

use halfrow::tables::mem::{self, kernel_text, parse_kernel, parse_tables, tables_text};
use halfrow::tables::{MemError, Place, TableFileError};
use halfrow_files::written_aside::WriteAsideError;
use halfrow_model::{
    BitDepth, Geometry, Interpolant, Kernel, KernelError, RowFactorError, TableError, TableSet,
};

fn tables() -> TableSet {
    let geometry = Geometry::new(64, 3, BitDepth::Twelve, 63).unwrap();
    TableSet::from_units(geometry, &[1, 14_648_488, 16_777_216]).unwrap()
}

#[test]
fn row_factors_are_seven_digits_under_a_comment_with_the_geometry() {
    let expected = "// halfrow row factors Q = 2^24 / k for $readmemh: 25 bits a word, row 0 first\n\
                    // datapath=1 width=64 height=3 bits=12 centre2=63\n\
                    0000001\n\
                    0df84a8\n\
                    1000000\n";
    assert_eq!(tables_text(&tables()), expected);
}

#[test]
fn a_node_is_twenty_digits_with_g6_first() {
    let kernel = Kernel::from_nodes(vec![[1, -1, 16384, -32768, 32767]; 65]).unwrap();
    let text = kernel_text(&kernel);
    let words: Vec<_> = text.lines().filter(|line| !line.starts_with("//")).collect();
    assert_eq!(words, ["7fff80004000ffff0001"; 65]);
    assert!(text.contains("g6 most significant"), "{text}");
}

/// At x = 1/2, Eq. 18 gives f_R1 = -9/64, f_G4 = 5/32, f_R5 = -3/64: -2304, 2560 and -768 in 2^-14.
#[test]
fn node_16_of_the_hermite_kernel_is_that_of_eq_18() {
    let text = kernel_text(&Interpolant::Hermite.into());
    let words: Vec<_> = text.lines().filter(|line| !line.starts_with("//")).collect();
    assert_eq!(words[16], "0000fd000a00f7000000");
}

#[test]
fn nothing_but_ascii_goes_to_verilog() {
    assert!(tables_text(&tables()).is_ascii());
    assert!(kernel_text(&Interpolant::Keys.into()).is_ascii());
}

#[test]
fn every_built_in_kernel_is_read_back_as_it_was() {
    for interpolant in Interpolant::ALL {
        let kernel = Kernel::from(interpolant);
        assert_eq!(parse_kernel(&kernel_text(&kernel)), Ok(kernel));
    }
}

#[test]
fn row_factors_are_read_back_with_their_geometry() {
    assert_eq!(parse_tables(&tables_text(&tables())), Ok(tables()));
}

#[test]
fn upper_case_blank_lines_and_other_comments_are_read_over() {
    let text = tables_text(&tables()).replace("0df84a8", "\r\n  // by hand\n\n  0DF84A8  ");
    assert_eq!(parse_tables(&text), Ok(tables()));
}

#[test]
fn the_files_are_named_after_the_one_that_was_given() {
    let named = ["a/line.steps.mem", "a/line.kernel.mem"].map(PathBuf::from);
    assert_eq!(mem::paths(Path::new("a/line.mem")), named);
    assert_eq!(mem::paths(Path::new("a/line")), named);
    assert_eq!(mem::paths(Path::new("v1.2")), ["v1.2.steps.mem", "v1.2.kernel.mem"].map(PathBuf::from));
}

#[test]
fn both_files_are_written_and_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("line.mem");
    let kernel = Kernel::from(Interpolant::Keys);
    assert_eq!(mem::write(&path, &tables(), &kernel, false).unwrap(), mem::paths(&path));
    let (read, of_kernel, inputs) = mem::read(&path).unwrap();
    assert_eq!((read, of_kernel), (tables(), kernel));
    assert_eq!(inputs.map(|input| input.path), mem::paths(&path));
    // Also by the name of either file, as `write` returns them.
    for named in mem::paths(&path) {
        assert_eq!(mem::read(&named).unwrap().2.map(|input| input.path), mem::paths(&path));
    }
}

#[test]
fn when_one_file_may_not_be_replaced_neither_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let both = mem::paths(&folder.path().join("line"));
    let write = |overwrite| {
        mem::write(&folder.path().join("line"), &tables(), &Interpolant::Linear.into(), overwrite)
    };
    for (mine, other) in [(&both[0], &both[1]), (&both[1], &both[0])] {
        fs::write(mine, "mine").unwrap();
        assert!(matches!(write(false), Err(WriteAsideError::Exists { path }) if path == *mine));
        assert_eq!(fs::read_to_string(mine).unwrap(), "mine");
        assert!(!other.exists());
        fs::remove_file(mine).unwrap();
    }
    for path in &both {
        fs::write(path, "mine").unwrap();
    }
    assert_eq!(write(true).unwrap(), both);
}

#[test]
fn a_missing_or_foreign_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("line.mem");
    let [rows, _] = mem::paths(&path);
    assert!(matches!(mem::read(&path), Err(TableFileError::Io { path, .. }) if path == rows));
    fs::write(&rows, "// datapath=1\n").unwrap();
    assert!(matches!(mem::read(&path), Err(TableFileError::Mem { path, .. }) if path == rows));
    fs::write(&rows, "// datapath=3\n").unwrap();
    assert!(matches!(mem::read(&path), Err(TableFileError::Datapath { path, .. }) if path == rows));
}

#[test]
fn a_header_without_a_number_names_the_number() {
    let places = [Place::Datapath, Place::Bits, Place::Width, Place::Height, Place::Centre2];
    for place in places {
        let text = tables_text(&tables()).replace(&format!("{}=", place.key()), "x=");
        assert_eq!(parse_tables(&text), Err(MemError::Header(place)));
    }
    // A second number says nothing if it is the same, and otherwise it is unclear which is meant.
    let with =
        |note: &str| parse_tables(&tables_text(&tables()).replace("height=3", &format!("height=3 {note}")));
    assert_eq!(with("height=3"), Ok(tables()));
    assert_eq!(with("centre2=64"), Err(MemError::Header(Place::Centre2)));
    let refused = parse_tables(&tables_text(&tables()).replace("width=64", "width=-64")).unwrap_err();
    let sentence =
        "its comments give no single whole number as `width=`; write the file again with `halfrow tables`";
    assert_eq!(refused.to_string(), sentence);
}

#[test]
fn a_geometry_that_the_datapath_does_not_have_is_refused() {
    let refuse = |old, new| parse_tables(&tables_text(&tables()).replace(old, new)).unwrap_err();
    assert_eq!(refuse("bits=12", "bits=9"), MemError::Bits { found: 9 });
    assert!(matches!(refuse("width=64", "width=65"), MemError::Geometry(_)));
    let count = TableError::Count { row_factors: 3, height: 4 };
    assert_eq!(refuse("height=3", "height=4"), MemError::Tables(count));
}

#[test]
fn a_line_that_is_no_word_is_named() {
    for word in ["0df84a", "0df84a88", "0df84ag", "+df84a8", "xxxxxxx", "@000001", "0df84a8 // Q"] {
        let refused = parse_tables(&tables_text(&tables()).replace("0df84a8", word)).unwrap_err();
        assert_eq!(refused, MemError::Word { line: 4, found: word.to_owned(), digits: 7 });
    }
    let refused = parse_kernel("// datapath=1 order=g6,r5,g4,r1,g0\n0001\n").unwrap_err();
    let sentence =
        "line 2 is \"0001\", not 20 hexadecimal digits; write the file again with `halfrow tables`";
    assert_eq!(refused.to_string(), sentence);
}

#[test]
fn a_row_factor_that_no_board_could_use_is_refused() {
    for (word, units) in [("0000000", 0), ("1000001", 0x100_0001), ("fffffff", 0xfff_ffff)] {
        let refused = parse_tables(&tables_text(&tables()).replace("0df84a8", word));
        assert_eq!(
            refused,
            Err(MemError::Tables(TableError::RowFactor { row: 1, source: RowFactorError { units } }))
        );
    }
}

#[test]
fn a_kernel_with_a_node_too_few_is_refused() {
    let text = kernel_text(&Interpolant::Linear.into());
    let shorter = text.trim_end().rsplit_once('\n').unwrap().0;
    assert_eq!(parse_kernel(shorter), Err(MemError::Kernel(KernelError::Count(64))));
}

#[test]
fn a_kernel_whose_weights_may_be_in_another_order_is_refused() {
    let refused = parse_kernel(&kernel_text(&Interpolant::Hermite.into()).replace("g6,", "g0,")).unwrap_err();
    let sentence =
        "its comments do not say `order=g6,r5,g4,r1,g0`; write the file again with `halfrow tables`";
    assert_eq!(refused.to_string(), sentence);
}

#[test]
fn an_image_that_is_missing_is_reported_under_the_name_that_was_given() {
    let folder = tempfile::tempdir().unwrap();
    let given = folder.path().join("line.steps.mem");
    let refused = mem::read(&given).unwrap_err();
    assert!(refused.to_string().contains("/line.steps.mem"), "{refused}");
    // Unless the name of both ends so.
    mem::write(&given, &tables(), &Interpolant::Hermite.into(), false).unwrap();
    assert_eq!(mem::read(&given).unwrap().0, tables());
}
