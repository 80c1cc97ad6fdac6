//! `--projection exact`: tables that are a grid of factors, and boards that do or do not take them.

use std::path::PathBuf;

use halfrow_tests::program::{Folder, halfrow};
use serde_json::Value;

use crate::refused;

/// Small frames, and a lens with a larger image circle.
const SMALL: [&str; 6] = ["--width", "192", "--height", "48", "--radius", "130"];

fn exact<'a>(command: &[&'a str]) -> Vec<&'a str> {
    [command, &SMALL, &["--projection", "exact"]].concat()
}

/// The report of `verify` on this board.
#[track_caller]
fn judged(folder: &Folder, board: &str, tables: &[&str], code: i32) -> Value {
    let call = [&["verify", "--json", "--quiet", "--board", board], tables].concat();
    let ended = folder.halfrow(call.iter().copied());
    assert_eq!(ended.code, Some(code), "{board}: {}{}", ended.stdout, ended.stderr);
    ended.json()
}

#[test]
fn a_board_is_judged_behind_a_grid() {
    let folder = Folder::new();
    let tables = exact(&[]);
    let said = judged(&folder, "mock", &tables, 0);
    assert!(said["tables"]["source"].as_str().unwrap().contains("(exact projection, v = "), "{said}");
    // Streamed frames, and frames at the full pixel clock.
    let passed = |check: &str| {
        said["checks"]
            .as_array()
            .unwrap()
            .iter()
            .any(|one| one["name"] == check && one["outcome"] == "passed")
    };
    assert!(passed("frames") && passed("at-speed"), "{}", said["checks"]);
    let said = judged(&folder, "mock,fault=stuck-data", &tables, 1);
    assert_eq!(
        said["suspects"][0]["code"],
        judged(&folder, "mock,fault=stuck-data", &SMALL, 1)["suspects"][0]["code"]
    );
}

/// An entry that leads out of the row foretells only part of it, and lines that change many entries foretell less.
#[test]
fn what_explains_fewer_samples_is_not_said_to_explain_as_much() {
    let small = ["--width", "64", "--height", "16", "--projection", "exact"];
    let said = judged(&Folder::new(), "mock,fault=row-factor,row=1,bit=20,hidden=true", &small, 1);
    let suspects = said["suspects"].as_array().unwrap();
    assert!(
        suspects[0]["place"].as_str().unwrap().starts_with("grid row 1, offset, one of bits 20"),
        "{suspects:?}"
    );
    let explained: Vec<_> = suspects.iter().map(|it| &it["account"]["explained"]).collect();
    assert!(explained.iter().all(|it| *it == explained[0]), "{suspects:?}");
}

/// In a frame of fewer rows a grid's entries have other places, so parts of frames would be refused.
#[test]
fn frames_behind_a_grid_are_whole_within_a_time() {
    let folder = Folder::new();
    let said = judged(&folder, "mock,speed=20000", &exact(&["--within", "8"]), 0);
    let parts = said["within"]["parts"].as_array().unwrap();
    let taken = |taken: &str| parts.iter().filter(|part| part["taken"] == part[taken]).count();
    let left_out = parts.iter().filter(|part| part["taken"] == 0).count();
    assert!(taken("of") > 1 && left_out > 0 && taken("of") + left_out == parts.len(), "{}", said["within"]);
    refused(&folder, &exact(&["verify", "--board", "mock,speed=20000", "--within", "1"]), "give at least");
}

/// Two tables take turns, each with its shape from a commit.
#[test]
fn a_board_is_soaked_behind_a_grid() {
    let folder = Folder::new();
    let soaked = |board, code: i32| {
        let call = exact(&["soak", "--frames", "9", "--json", "--quiet", "--board", board]);
        let ended = folder.halfrow(call);
        assert_eq!(ended.code, Some(code), "{board}: {}{}", ended.stdout, ended.stderr);
        ended.json()
    };
    let said = soaked("mock", 0);
    assert_eq!(said["soak"]["frames"], 9, "{said}");
    assert!(!said["not_exercised"].to_string().contains("table-change-at-speed"), "{said}");
    soaked("mock,fault=stuck-data", 1);
}

#[test]
fn a_grid_is_a_file_of_its_own_kind() {
    let folder = Folder::new();
    for file in ["exact.json", "exact.mem"] {
        folder.halfrow(exact(&["tables", "-o", file])).succeeded();
    }
    let json = folder.json("exact.json");
    let [v, k] = ["v", "k"].map(|key| json[key].as_u64().unwrap());
    // DATAPATH.md: (N + 2) columns of floor((H - 1) / 2^v) + 3 grid rows.
    let (segments, rows) = (192_u64.div_ceil(1 << k), (47 >> v) + 3);
    let entries = json["grid"].as_array().unwrap();
    assert_eq!((&json["datapath"], entries.len() as u64), (&2.into(), (segments + 2) * rows));
    let image = folder.text("exact.steps.mem");
    assert!(
        image.contains(&format!("datapath=2 width=192 height=48 bits=12 centre2=191 v={v} k={k}")),
        "{image}"
    );
    let words = image
        .lines()
        .filter(|line| !line.starts_with("//"))
        .map(|word| u64::from_str_radix(word, 16).unwrap());
    assert!(words.eq(entries.iter().map(|entry| entry.as_u64().unwrap())), "both files have the same grid");
    judged(&folder, "mock", &["--tables", "exact.json"], 0);
    let mut broken = json;
    broken["grid"][3] = (1_u64 << 25).into();
    folder.write("broken.json", broken.to_string());
    refused(
        &folder,
        &["verify", "--board", "mock", "--tables", "broken.json"],
        "entry 3 of `grid` is 33554432",
    );
    broken["k"] = 4.into();
    folder.write("broken.json", broken.to_string());
    refused(&folder, &["verify", "--board", "mock", "--tables", "broken.json"], "give 5 or 6");
}

#[test]
fn boards_and_calls_that_do_not_go_with_a_grid_are_named_with_the_remedy() {
    let folder = Folder::new();
    let verify = |board: &'static str| exact(&["verify", "--board", board]);
    refused(&folder, &verify("mock,datapath2=no"), "leave out the exact projection (--projection)");
    let cases: [(&[&str], &str); 5] = [
        (&["--projection", "exact", "--rows", "fitted"], "leave out one of the two"),
        (&["--projection", "rows", "--entries", "4096"], "--entries and --nodes-every are for the grid"),
        (&["--projection", "rows", "--nodes-every", "32"], "--entries and --nodes-every are for the grid"),
        (&["--projection", "exact", "--nodes-every", "5"], "every 32 or every 64 columns"),
        (
            &["--projection", "exact", "--entries", "10"],
            "no grid for frames of 192 x 48 has 10 entries or fewer",
        ),
    ];
    for (more, said) in cases {
        refused(&folder, &[&["tables", "-o", "x.json"], &SMALL[..], more].concat(), said);
    }
}

#[test]
fn what_each_projection_leaves_is_told() {
    let folder = Folder::new();
    let told = folder.halfrow(exact(&["lens", "--json", "--map", "error.png"])).succeeded();
    let told = told.json();
    let inner = |by: &str| told["residual_px"]["parts"][by]["inner"]["max"].as_f64().unwrap();
    assert!(
        inner("exact") < 0.01 && inner("fitted") > 0.1 && inner("equation-9") > inner("fitted"),
        "{told}"
    );
    assert!(told["map"]["brightest_px"].as_f64().unwrap() < 0.1, "the map is of what was asked for: {told}");
    assert_eq!(told["rows"], "exact");
    // A frame of 192 x 48 whose circle has a radius of 130 ends within 85 degrees.
    let left = &told["residual_px"];
    assert_eq!(
        (&left["share_beyond_90_degrees"], &left["parts"]["exact"]["rim"]["max"]),
        (&0.0.into(), &0.0.into())
    );
    // One as wide and as high as the circle has the rim in it.
    let whole = ["--width", "260", "--height", "260", "--radius", "130"];
    let told = folder.halfrow([&["lens", "--json"], &whole[..]].concat()).json();
    let left = &told["residual_px"];
    let rim = |by: &str| left["parts"][by]["rim"]["max"].as_f64().unwrap();
    assert!(rim("equation-9") > 10.0 && rim("exact") > 0.05, "{told}");
    let text = folder.halfrow([&["lens"], &whole[..]].concat()).stdout;
    assert!(text.contains("rim max") && text.contains("level lines bend as before"), "{text}");
}

/// With the axis at 96, 127, row 0 of a near grid would begin farther right than a board can look ahead; mirrored, it need not.
#[test]
fn a_grid_that_is_worse_than_fitted_rows_is_warned_of() {
    for (column, is_worse) in [("96", true), ("31", false)] {
        let lens = ["--width", "128", "--height", "128", "--radius", "128", "--centre-y", "127"];
        let told = Folder::new()
            .halfrow([&["lens", "--projection", "exact", "--centre-x", column], &lens[..]].concat());
        let warned =
            told.stdout.contains("no better grid of 2048 entries or fewer that a board takes was found");
        assert_eq!((told.code, warned), (Some(0), is_worse), "{}", told.stdout);
    }
}

#[test]
fn a_grid_that_is_worse_for_its_few_entries_is_warned_of_with_their_number() {
    let exact = ["lens", "--projection", "exact", "--entries", "120", "--nodes-every", "64"];
    let size = ["--width", "640", "--height", "480", "--radius", "150"];
    let told = Folder::new().halfrow([&exact[..], &size].concat());
    let sentence = "no better grid of 120 entries or fewer, with a node every 64 columns, that a board takes was \
                    found, so use --rows fitted in place of --projection exact";
    assert!(told.stdout.contains(sentence), "{}{}", told.stdout, told.stderr);
}

/// By hand: r = θ − 0.2 · θ³ turns back at √(5/3), 73.97 degrees.
#[test]
fn the_angle_beyond_which_nothing_has_a_place_is_the_lens_s() {
    let folder = Folder::new();
    folder.write(
        "lens.json",
        r#"{"K": [[50, 0, 80], [0, 50, 60], [0, 0, 1]], "D": [-0.2, 0, 0, 0], "width": 160, "height": 120}"#,
    );
    let told = folder.halfrow(["lens", "--lens", "lens.json", "--field-of-view", "147.8"]);
    assert!(
        told.stdout.contains("show what lies beyond 74 degrees, which"),
        "{}{}",
        told.stdout,
        told.stderr
    );
}

/// The grid is extended beyond the end of the exact projection, so none of its rows is left as it was.
#[test]
fn a_lens_that_misses_the_frame_gives_no_grid_either() {
    let folder = Folder::new();
    let exact = ["--width", "192", "--height", "48", "--radius", "30", "--projection", "exact"];
    let far = [&exact[..], &["--centre-y", "150"]].concat();
    for call in [&["tables", "-o", "x.json"][..], &["lens"], &["verify", "-q"]] {
        refused(&folder, &[call, &far].concat(), "48 of 48 rows lie outside the image circle");
    }
    // Of the |y| from 0.5 to 23.5, six on either side are above 18.
    let high = ["--width", "192", "--height", "48", "--radius", "18"];
    let told = |more: &[&str]| {
        let call = [&["tables", "-o", "t.json", "--overwrite"], &high[..], more].concat();
        let ended = folder.halfrow(call).succeeded();
        ended.stdout
    };
    let rows = told(&[]);
    assert!(rows.contains("12 rows outside the image circle: not stretched"), "{rows}");
    let grid = told(&["--projection", "exact"]);
    assert!(
        grid.contains("12 rows outside the image circle: stretched by the grid, beyond 90 degrees"),
        "{grid}"
    );
}

/// The largest error is the largest of the inner part or of the rest, wherever the image circle ends.
#[test]
fn the_parts_of_what_is_left_are_parts_of_it() {
    let lens =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../host/judge/tests/lenses/files/opencv-4.10.yml");
    let lens = lens.display().to_string();
    let small = ["--lens", &lens, "--width", "320", "--height", "180"];
    let field = [&small[..], &["--field-of-view", "120"]].concat();
    let whole = ["--width", "128", "--height", "100", "--radius", "60"].to_vec();
    for more in [small.to_vec(), field, whole] {
        let told = Folder::new().halfrow([&["lens", "--json"], &more[..]].concat()).json();
        let left = &told["residual_px"];
        for by in ["equation-9", "fitted", "exact"] {
            let max = |part: &str| left["parts"][by][part]["max"].as_f64().unwrap();
            let largest = left["horizontal"][by]["max"].as_f64().unwrap();
            assert!((max("inner").max(max("rim")) - largest).abs() < 1e-12, "{more:?}, {by}: {left}");
        }
    }
}

/// A board may have several datapaths, but a run judges by one.
#[test]
fn the_board_s_identity_names_the_datapath_that_it_is_judged_by() {
    for (call, datapath) in [(exact(&["verify", "-q"]), 2), ([&["verify", "-q"], &SMALL[..]].concat(), 1)] {
        let told = halfrow(call.iter().copied()).stdout;
        let identity = told.lines().find(|line| line.contains(" identity ")).unwrap_or_default();
        assert!(identity.ends_with(&format!(", wire 1, tables for datapath {datapath}")), "{told}");
        assert!(told.contains(", datapath 1 and 2, wire 1\n"), "{told}");
    }
}

/// Capability 12 lets a board take k = 5 alone, or 6.
#[test]
fn the_nodes_of_a_grid_are_as_far_apart_as_a_board_takes_them() {
    let folder = Folder::new();
    for (columns, k) in [("32", 5), ("64", 6)] {
        let made =
            folder.halfrow(exact(&["tables", "-o", "x.json", "--overwrite", "--nodes-every", columns]));
        assert_eq!(made.code, Some(0), "{}", made.stderr);
        let tables = folder.json("x.json");
        assert_eq!(tables["k"], k, "{}", tables["k"]);
    }
}

/// A grid ends where 90 degrees are, at |y| = π/2 · 68.181 = 107.1 rows from the middle of 320, so 106 rows are outside.
#[test]
fn a_grid_has_the_circle_of_180_degrees_whatever_the_field_of_view() {
    let folder = Folder::new();
    folder.write(
        "lens.json",
        r#"{"K": [[68.181, 0, 159.5], [0, 68.181, 159.5], [0, 0, 1]], "D": [0, 0, 0, 0], "width": 320, "height": 320}"#,
    );
    for field in ["60", "180", "220"] {
        let lens = ["--lens", "lens.json", "--field-of-view", field];
        let made = ["tables", "--json", "--projection", "exact", "--overwrite", "-o", "x.json"];
        let said = folder.halfrow(made.into_iter().chain(lens)).json();
        assert_eq!(said["rows_outside_circle"], 106, "{field}");
        let source = said["source"].as_str().unwrap();
        assert!(source.contains(" lens lens.json, R = 107.098 pixels (exact projection"), "{source}");
    }
}

/// Of a lens without a file it changes R of Eq. 9 alone, which neither a grid nor a frame has.
#[test]
fn a_field_of_view_is_refused_where_it_does_nothing() {
    let folder = Folder::new();
    let size = ["--width", "192", "--height", "48"];
    for lens in [["--focal-length", "0.15"], ["--pixel-pitch", "3"]] {
        let with = |call: &[&'static str]| [call, &size, &lens, &["--field-of-view", "120"]].concat();
        for call in [
            &["tables", "-o", "x.json"][..],
            &["verify", "-q"],
            &["correct", "builtin:street", "--model", "-o", "x.pgm"],
        ] {
            let call = with(&[call, &["--projection", "exact"]].concat());
            refused(&folder, &call, "--field-of-view does nothing");
        }
        refused(&folder, &with(&["frames", "-o", "frames"]), "--field-of-view does nothing");
        let told = folder.halfrow(with(&["lens", "--projection", "exact"]));
        assert_eq!(told.code, Some(0), "the circle of Eq. 9 and of fitted rows is shown: {}", told.stderr);
    }
}
