//! `tables` and `frames`: what they write, and that `verify` accepts it.

use halfrow_tests::program::{Folder, finish, halfrow};

use crate::{refused, small};

/// Row factors of the paper's system, computed by a program that is not part of this project.
const FIRST_FACTOR: u32 = 14_648_698;
const MIDDLE_FACTOR: u32 = 16_777_214;

#[test]
fn the_paper_s_table_file_holds_the_golden_factors() {
    let folder = Folder::new();
    let ended = folder.halfrow(["tables", "--radius", "1106.697", "-o", "lens.json"]).succeeded();
    assert!(
        ended.stdout.starts_with("wrote lens.json: equidistant lens, R = 1106.697 pixels"),
        "{}",
        ended.stdout
    );
    let file = folder.json("lens.json");
    assert_eq!((&file["step"][0], &file["step"][539]), (&FIRST_FACTOR.into(), &MIDDLE_FACTOR.into()));
    assert_eq!(file["step"].as_array().unwrap().len(), 1080);
    assert_eq!((&file["datapath"], &file["centre2"]), (&1.into(), &1919.into()));
}

/// CRC-32 of the factors and of each kernel, also by that program.
#[test]
fn what_is_uploaded_has_the_golden_checksums() {
    for (kernel, crc) in [("hermite", "16e29b0f"), ("keys", "54f5e990")] {
        let frame = ["--frame", "builtin:black", "--radius", "1106.697", "--kernel", kernel];
        let tables = halfrow(["verify", "--json"].into_iter().chain(frame)).json()["tables"].clone();
        assert_eq!((&tables["tables_crc32"], &tables["kernel_crc32"]), (&"5f5a7553".into(), &crc.into()));
    }
}

#[test]
fn memory_images_hold_the_same_words() {
    let folder = Folder::new();
    folder.halfrow(["tables", "--radius", "1106.697", "-o", "lens.mem"]).succeeded();
    assert_eq!(folder.names("."), ["lens.kernel.mem", "lens.steps.mem"]);
    let rows = folder.text("lens.steps.mem");
    let words: Vec<_> = rows.lines().filter(|line| !line.starts_with("//")).collect();
    assert_eq!(
        (words[0], words[539]),
        (format!("{FIRST_FACTOR:07x}").as_str(), format!("{MIDDLE_FACTOR:07x}").as_str())
    );
    assert_eq!(words.len(), 1080);
    assert_eq!(folder.text("lens.kernel.mem").lines().filter(|line| line.len() == 20).count(), 65);
}

/// `$readmemh` takes both, and nothing says that they are of two lenses.
#[test]
fn of_two_memory_images_that_belong_together_none_is_replaced_when_one_cannot_be() {
    let folder = Folder::new();
    let images = || ["l.steps.mem", "l.kernel.mem"].map(|name| folder.text(name));
    let line = "exec strace -f -qq -o /dev/null -e inject=rename,renameat2:error=EIO:when=2 \"$@\"";
    let refused = |more: &[&str]| {
        let call = small("tables", &["-o", "l.mem"]);
        let ended = finish(&mut folder.by_shell(line, call.into_iter().chain(more.iter().copied())));
        assert_eq!(ended.code, Some(3), "{ended:?}");
        assert!(ended.stderr.contains("cannot write l.kernel.mem"), "{ended:?}");
    };
    refused(&[]);
    assert_eq!(folder.names("."), [""; 0]);
    assert_eq!(folder.halfrow(small("tables", &["-o", "l.mem"])).code, Some(0));
    let earlier = images();
    refused(&["--overwrite", "--kernel", "keys", "--centre-y", "3"]);
    assert!(images() == earlier);
    assert_eq!(folder.names("."), ["l.kernel.mem", "l.steps.mem"]);
    let again = ["-o", "l.mem", "--overwrite", "--kernel", "keys", "--centre-y", "3"];
    assert_eq!(folder.halfrow(small("tables", &again)).code, Some(0));
    let new = images();
    assert!(new[0] != earlier[0] && new[1] != earlier[1], "the control");
    assert_eq!(folder.names("."), ["l.kernel.mem", "l.steps.mem"]);
}

/// Neither exFAT can swap names, nor some network file systems.
#[test]
fn a_memory_image_that_does_not_belong_to_the_other_is_named_where_names_cannot_be_swapped() {
    let folder = Folder::new();
    assert_eq!(folder.halfrow(small("tables", &["-o", "l.mem"])).code, Some(0));
    let line = "exec strace -f -qq -o /dev/null -e inject=renameat2:error=EINVAL \
                -e inject=rename:error=EIO:when=2 \"$@\"";
    let ended = finish(&mut folder.by_shell(line, small("tables", &["-o", "l.mem", "--overwrite"])));
    assert_eq!(ended.code, Some(3), "{ended:?}");
    let warned: Vec<_> = ended.stderr.lines().filter(|line| line.contains("WARN")).collect();
    assert!(matches!(warned[..], [line] if line.contains("l.steps.mem")), "{ended:?}");
    assert_eq!(folder.names("."), ["l.kernel.mem", "l.steps.mem"]);
}

/// A network file system may tell of a full disk only when a file is brought to it.
#[test]
fn of_two_memory_images_none_is_replaced_where_names_cannot_be_swapped_and_one_finds_no_space() {
    let folder = Folder::new();
    let images = || ["l.steps.mem", "l.kernel.mem"].map(|name| folder.text(name));
    assert_eq!(folder.halfrow(small("tables", &["-o", "l.mem"])).code, Some(0));
    let earlier = images();
    let line = "exec strace -f -qq -o /dev/null -e inject=renameat2:error=EINVAL \
                -e inject=fsync:error=ENOSPC:when=2 \"$@\"";
    let again = ["-o", "l.mem", "--overwrite", "--kernel", "keys", "--centre-y", "3"];
    let ended = finish(&mut folder.by_shell(line, small("tables", &again)));
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(images() == earlier, "{ended:?}");
    assert!(!ended.stderr.contains("WARN"), "{ended:?}");
    assert_eq!(folder.names("."), ["l.kernel.mem", "l.steps.mem"]);
}

#[test]
fn a_table_file_and_written_frames_can_be_judged_with() {
    let folder = Folder::new();
    let lens = ["--width", "128", "--height", "72", "--radius", "73.78", "--bits", "10", "--centre-x", "60"];
    folder.halfrow(["tables", "--kernel", "keys", "-o", "lens.json"].into_iter().chain(lens)).succeeded();
    folder.halfrow(["frames", "-o", "frames"].into_iter().chain(lens)).succeeded();
    assert_eq!(folder.names("frames").len(), 12);
    let frames: Vec<_> = folder.names("frames").iter().map(|name| format!("--frame=frames/{name}")).collect();
    let call =
        ["verify", "--json", "--tables", "lens.json"].into_iter().chain(frames.iter().map(String::as_str));
    let said = folder.halfrow(call).json();
    assert_eq!(said["verdict"], "PASS", "{}", said["headline"]);
    assert_eq!(said["tables"]["source"], "lens.json");
    assert_eq!(said["run"]["files"].as_array().unwrap().len(), 13);
}

#[test]
fn written_frames_are_what_they_are_called() {
    let folder = Folder::new();
    let only = ["--only", "black", "--only", "white", "--only", "grey"];
    let call = small("frames", &["-o", "."]).into_iter().chain(only);
    folder.halfrow(call).succeeded();
    assert_eq!(folder.names("."), ["black.pgm", "grey.pgm", "white.pgm"]);
    for (name, sample) in [("black.pgm", 0_u16), ("grey.pgm", 2048), ("white.pgm", 4095)] {
        let samples = sample.to_be_bytes().repeat(128 * 16);
        assert!(folder.read(name) == [b"P5\n128 16\n4095\n".as_slice(), &samples].concat(), "{name}");
    }
}

/// The samples of a PGM of 128 columns with 16 bits each, from `row` on.
fn samples_from(folder: &Folder, name: &str, row: usize) -> Vec<i32> {
    let bytes = folder.read(name);
    let head = bytes.split(|&byte| byte == b'\n').take(3).map(|line| line.len() + 1).sum::<usize>();
    let samples = bytes[head + 2 * 128 * row..].as_chunks().0.iter();
    samples.map(|&sample| u16::from_be_bytes(sample).into()).collect()
}

/// In a frame of 32 rows with the axis in row 15.5, the rows from 12 on equal a frame with the axis in row 3.5, except for the
/// noise.
#[test]
fn the_street_is_seen_about_the_axis_wherever_that_is() {
    let lens = |centre: f64, rows: u32| {
        format!(
            r#"{{"K":[[90,0,63.5],[0,90,{centre}],[0,0,1]],"D":[0,0,0,0],"image_width":128,"image_height":{rows}}}"#
        )
    };
    for [high, low] in [
        [&["--radius", "80"][..], &["--radius", "80", "--centre-y", "3.5"]],
        [&["--lens", "high.json"], &["--lens", "low.json"]],
    ] {
        let folder = Folder::new();
        folder.write("high.json", lens(15.5, 32));
        folder.write("low.json", lens(3.5, 16));
        for (rows, more) in [("32", high), ("16", low)] {
            let call = ["frames", "--width", "128", "--only", "street", "--height", rows, "-o", rows];
            folder.halfrow(call.iter().chain(more).copied()).succeeded();
        }
        let (high, low) =
            (samples_from(&folder, "32/street.pgm", 12), samples_from(&folder, "16/street.pgm", 0));
        assert_eq!(low.len(), 16 * 128);
        let apart: i32 = low.iter().zip(&high).map(|(low, high)| (low - high).abs()).sum();
        assert!(apart < 60 * 16 * 128, "{apart}");
    }
}

#[test]
fn a_seed_gives_the_same_noise_again_and_another_seed_other_noise() {
    let folder = Folder::new();
    for (seed, name) in [("7", "a"), ("7", "b"), ("8", "c")] {
        let call = small("frames", &["--only", "noise", "--seed", seed, "-o", name]);
        folder.halfrow(call).succeeded();
    }
    let noise = |name| folder.read(&format!("{name}/noise.pgm"));
    assert!(noise("a") == noise("b") && noise("a") != noise("c"));
}

#[test]
fn files_that_are_there_stay_as_they_are() {
    let folder = Folder::new();
    folder.write("lens.json", "precious");
    folder.write("black.pgm", "precious");
    folder.write("lens.kernel.mem", "precious");
    let exists = |arguments: &[&str]| {
        let ended = folder.halfrow(arguments.iter().copied());
        assert_ne!(ended.code, Some(0), "{arguments:?}");
        assert!(ended.stderr.contains("--overwrite"), "{}", ended.stderr);
    };
    exists(&small("tables", &["-o", "lens.json"]));
    exists(&small("tables", &["-o", "lens.mem"]));
    exists(&small("frames", &["--only", "black", "-o", "."]));
    assert_eq!(folder.names("."), ["black.pgm", "lens.json", "lens.kernel.mem"]);
    assert!(folder.names(".").iter().all(|name| folder.text(name) == "precious"));
    folder.halfrow(small("tables", &["-o", "lens.json", "--overwrite"])).succeeded();
    assert!(folder.text("lens.json").starts_with('{'));
}

#[test]
fn endings_are_taken_in_any_case() {
    let folder = Folder::new();
    for (name, made) in
        [("LENS.JSON", &["LENS.JSON"][..]), ("Lens.Mem", &["Lens.kernel.mem", "Lens.steps.mem"])]
    {
        folder.halfrow(small("tables", &["-o", name])).succeeded();
        assert!(
            made.iter().all(|file| folder.names(".").contains(&(*file).to_owned())),
            "{:?}",
            folder.names(".")
        );
    }
    assert_eq!(folder.names(".").len(), 3);
}

#[test]
fn rows_outside_the_image_circle_are_allowed_and_counted() {
    let folder = Folder::new();
    let size = ["--width", "64", "--height", "100", "--radius", "40"];
    let ended = folder.halfrow(["tables", "-o", "lens.json"].into_iter().chain(size)).succeeded();
    // |y| is 0.5, 1.5, … 49.5; ten of the 50 rows on either side have |y| of 40.5 or more.
    assert!(ended.stdout.contains("20 rows outside the image circle"), "{}", ended.stdout);
    let said = halfrow(["verify", "--json"].into_iter().chain(size)).json();
    assert_eq!((&said["verdict"], &said["tables"]["rows_outside_circle"]), (&"PASS".into(), &20.into()));
}

#[test]
fn a_lens_that_cannot_be_is_refused() {
    let folder = Folder::new();
    refused(&folder, &["tables", "--radius", "0", "-o", "x.json"], "radius");
    refused(&folder, &["tables", "--radius", "nan", "-o", "x.json"], "radius");
    refused(&folder, &["tables", "--focal-length=-1", "-o", "x.json"], "focal length");
    refused(&folder, &["tables", "--field-of-view", "0", "-o", "x.json"], "field of view");
    refused(
        &folder,
        &["tables", "--radius", "9", "--focal-length", "1", "-o", "x.json"],
        "cannot be used with",
    );
    refused(&folder, &["tables", "--centre-y", "nan", "-o", "x.json"], "optical centre");
    refused(&folder, &["tables", "--bits", "9", "-o", "x.json"], "8, 10 or 12");
    refused(&folder, &["tables", "--phase", "rgbg", "-o", "x.json"], "rgbg");
}

/// The angle across the circle is how far a table reaches, and no other lens. By hand: f = 200/π pixels, so 90 degrees are imaged
/// at 100 pixels.
#[test]
fn the_street_is_seen_through_the_lens_whatever_its_field_of_view() {
    let folder = Folder::new();
    let f = 200.0 / std::f64::consts::PI;
    folder.write("equidistant.json", format!(r#"{{"K": [[{f}, 0, 95.5], [0, {f}, 31.5], [0, 0, 1]], "D": [0, 0, 0, 0], "width": 192, "height": 64}}"#));
    let street = |lens: &[&str]| {
        let call = ["frames", "--only", "street", "--overwrite", "-o", "."];
        let ended = folder.halfrow(call.iter().chain(lens).copied());
        assert_eq!(ended.code, Some(0), "{lens:?}: {}", ended.stderr);
        folder.read("street.pgm")
    };
    let expected = street(&["--radius", "100", "--width", "192", "--height", "64"]);
    for field in ["120", "180", "220"] {
        let found = street(&["--lens", "equidistant.json", "--field-of-view", field]);
        assert!(found == expected, "{field} degrees");
    }
}
