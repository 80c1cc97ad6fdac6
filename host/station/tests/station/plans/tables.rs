//! Tables and frames in a plan, and the files that they are made from.

use std::fs;
use std::process::Command;

use halfrow_station::plan::{Plan, StepKind};

use super::{WHOLE, load};
use crate::common::program;

/// A plan with these tables and two steps, of which the second has tables of its own.
fn of_tables(tables: &str, own: &str) -> String {
    let [head, rest] = [&WHOLE[..WHOLE.find("[tables]").unwrap()], "frames = [\"builtin:noise\"]\n"];
    let own = format!("[[step]]\nkind = \"verify\"\nname = \"own\"\n{rest}[step.tables]\n{own}\n");
    format!("{head}[tables]\n{tables}\n[[step]]\nkind = \"verify\"\n{rest}{own}")
}

/// A key in the tables of a step has the same effect as in those of the plan.
#[test]
fn tables_of_a_step_stand_in_the_place_of_the_plan_s_key_by_key() {
    let tables = "radius = 20.0\nwidth = 64\nheight = 16\nbits = 10\nphase = \"rggb\"\nrows = \"equation-9\"\nkernel = \"hermite\"";
    let chosen = |text: &str, step: usize| {
        let plan = load(text).unwrap();
        let StepKind::Verify(judging) = &plan.variant("").steps[step].kind else { panic!("{step}") };
        let chosen = &judging.chosen;
        (chosen.tables.clone(), chosen.kernel.clone(), judging.phase)
    };
    let of_plan = chosen(&of_tables(tables, ""), 1);
    assert_eq!(chosen(&of_tables(tables, ""), 2), of_plan);
    for (key, other) in [
        ("radius = 20.0", "radius = 30.0"),
        ("width = 64", "width = 128"),
        ("height = 16", "height = 32"),
        ("bits = 10", "bits = 12"),
        ("phase = \"rggb\"", "phase = \"bggr\""),
        ("rows = \"equation-9\"", "rows = \"fitted\""),
        ("kernel = \"hermite\"", "kernel = \"keys\""),
    ] {
        let own = chosen(&of_tables(tables, other), 2);
        assert_ne!(own, of_plan, "{other}");
        assert_eq!(own, chosen(&of_tables(&tables.replace(key, other), ""), 1), "{other}");
    }
    // A lens replaces a radius.
    let other = load(&of_tables(tables, "lens = \"other.yml\"")).map(drop).unwrap_err();
    assert!(other.contains("the file other.yml cannot be read"), "{other}");
}

/// The plan's own tables are in another line, and right.
#[test]
fn tables_that_are_wrong_for_a_step_or_a_variant_are_told_at_their_own_line() {
    let of_plan = "radius = 20.0\nwidth = 64\nheight = 16";
    for own in ["width = 63", "height = 4000", "radius = -1.0", "kernel = \"keys\"\nwidth = 63"] {
        let text = of_tables(of_plan, own);
        let key = own.lines().last().unwrap();
        let line = text.lines().position(|line| line == key).unwrap() + 1;
        let said = load(&text).map(drop).unwrap_err();
        assert!(
            said.starts_with(&format!("plan.toml:{line}: what the plan says of tables")),
            "{own}: {said}"
        );
    }
    let of_variant = WHOLE.replace("{ radius = 30.0 }", "{ height = 4000 }");
    let said = load(&of_variant).map(drop).unwrap_err();
    assert!(said.starts_with("plan.toml:43: what the plan says of tables"), "{said}");
}

/// The phase decides which samples of a colour picture's row are red.
#[test]
fn a_picture_in_colour_is_seen_through_the_phase_of_the_plan() {
    let folder = tempfile::tempdir().unwrap();
    let data = [200, 100, 50].repeat(64 * 16);
    let image = halfrow::frames::preview::RgbImage { width: 64, height: 16, data };
    halfrow::frames::write_rgb(&folder.path().join("colour.png"), &image, false).unwrap();
    let first = |phase: &str| {
        let text = WHOLE.replace("\"rggb\"", &format!("\"{phase}\"")).replace("chart.pgm", "colour.png");
        let plan = Plan::parse(&folder.path().join("plan.toml"), text).unwrap();
        let StepKind::Verify(judging) = &plan.variant("N").steps[2].kind else { panic!("{phase}") };
        let halfrow::FrameSource::File { frame, .. } = &judging.frames[1] else { panic!("{phase}") };
        frame.row(0)[..2].to_vec()
    };
    let [red, blue] = [first("rggb"), first("bggr")];
    assert!(red[0] > red[1] && red[1] == blue[1] && blue[1] > blue[0], "{red:?}, {blue:?}");
}

/// With other bytes in a lens, table file or kernel of the same name, the plan is another one.
#[test]
fn every_file_that_tables_are_made_of_is_in_the_hash() {
    let folder = tempfile::tempdir().unwrap();
    let lens = include_bytes!("../../../../judge/tests/lenses/files/opencv-4.10.yml");
    let kernel = include_bytes!("../../../../judge/src/kernels/sharp7.json");
    let of_all = halfrow::model::Geometry::new(64, 16, halfrow::model::BitDepth::Ten, 126).unwrap();
    let row = vec![16_777_216; 16];
    let tables = halfrow::model::TableSet::from_units(of_all, &row).unwrap();
    let kernel_of_file = halfrow::model::Interpolant::Hermite.into();
    let file = halfrow::tables::TableFile { tables, kernel: kernel_of_file, about: None }.to_json();
    for (name, bytes, key) in [
        ("lens.yml", lens.as_slice(), "lens = \"lens.yml\"\nwidth = 128\nheight = 72"),
        ("kernel.json", kernel, "radius = 20.0\nwidth = 64\nheight = 16\nkernel = \"kernel.json\""),
        ("tables.json", file.as_bytes(), "file = \"tables.json\""),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let text = of_tables(key, "");
        let plan = Plan::parse(&folder.path().join("plan.toml"), text.clone()).unwrap();
        let sum = halfrow::result::sha256([bytes]);
        assert_eq!(
            plan.files.iter().map(|file| (file.path.as_str(), &file.sha256)).collect::<Vec<_>>(),
            [(name, &sum)]
        );
        assert_eq!(plan.sha256, halfrow::result::sha256([format!("{text}\n{name}\0{sum}")]));
    }
}

/// Nobody writes to it, so opening it would wait for ever.
#[test]
fn a_pipe_that_a_plan_names_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let made = Command::new("mkfifo").arg(folder.path().join("chart.pgm")).status();
    assert!(made.unwrap().success());
    let file = folder.path().join("plan.toml");
    fs::write(&file, WHOLE).unwrap();
    let checked =
        Command::new("timeout").arg("60").arg(program()).args(["plan", "check"]).arg(&file).output().unwrap();
    let said = String::from_utf8(checked.stderr).unwrap();
    assert!(checked.status.code() == Some(2) && said.contains("plan.toml:27: the file "), "{said}");
}

/// Frame numbers have 16 bits on the wire, and a few of them are reserved (protocol/WIRE.md).
#[test]
fn more_frames_than_a_run_can_number_are_refused_when_the_plan_is_read() {
    let of_so_many = |count: usize| {
        let names = vec!["\"builtin:noise\""; count].join(", ");
        let text = WHOLE.replace("\"builtin:noise\", \"chart.pgm\"", &names);
        load(&text.replace("repeat = 2", "repeat = 1000")).map(drop)
    };
    assert_eq!(of_so_many(65), Ok(()));
    let said = of_so_many(66).unwrap_err();
    assert!(said.starts_with("plan.toml:27: so many frames cannot be used: 66000 frames"), "{said}");
}
