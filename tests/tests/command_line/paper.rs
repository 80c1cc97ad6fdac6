//! `paper`: what it writes, what it finds, and what it refuses.

use std::path::PathBuf;

use halfrow_lab::paper::Item;
use halfrow_tests::program::Folder;
use serde_json::{Value, json};

use crate::{refused, refused_with};

/// The report and output of a run with these arguments, which must end with `code`.
#[track_caller]
fn made(folder: &Folder, code: i32, arguments: &[&str]) -> (Value, String) {
    let call = ["paper", "--quiet", "-o", "out"].iter().chain(arguments).copied();
    let ended = folder.halfrow(call);
    assert_eq!(ended.code, Some(code), "{arguments:?}: {}{}", ended.stdout, ended.stderr);
    let report = folder.json("out/paper.json");
    // Only files that are checked for in advance are written.
    if !arguments.contains(&"--overwrite") {
        let items = report["items"].as_array().unwrap().iter();
        let items = items.map(|item| Item::named(item["item"].as_str().unwrap()).unwrap());
        let listed: Vec<_> = items.flat_map(Item::files).chain(&["paper.html", "paper.json"]).collect();
        assert!(
            folder.names("out").iter().all(|name| listed.contains(&&name.as_str())),
            "{:?}",
            folder.names("out")
        );
    }
    (report, ended.stdout)
}

#[test]
fn without_photographs_the_remedy_is_named() {
    let folder = Folder::new();
    let remedy = "fig12 and table1 need the 24 photographs; give --images FOLDER";
    refused(&folder, &["paper", "-o", "out"], remedy);
    refused(&folder, &["paper", "table1", "-o", "out"], remedy);
    refused(&folder, &["paper", "-o", "out"], "fig3 fig4 fig5 fig6 fig8 verticals residuals delay resources");
    folder.write("kodim01.png", "no picture");
    refused(&folder, &["paper", "table1", "--images", ".", "-o", "out"], "photograph 1 of 24 cannot be used");
    refused(&folder, &["paper", "fig7", "-o", "out"], "[possible values: fig3, fig4,");
}

/// Sect. 3.2 prints 2.38 and 0.80 pixels.
#[test]
fn figure_5_has_the_paper_s_means() {
    let folder = Folder::new();
    let (report, said) = made(&folder, 0, &["fig5"]);
    let claims = &report["items"][0]["claims"];
    for (claim, paper) in [(&claims[0], 2.38), (&claims[1], 0.80)] {
        assert_eq!((&claim["paper"], &claim["holds"]), (&paper.into(), &true.into()));
        assert!(claim["deviation"].as_f64().unwrap().abs() < 0.01);
    }
    assert!(
        said.contains("mean error of the middle 16 : 9: 0.8021 px (paper 0.8, +0.0021, ± 0.01 px)"),
        "{said}"
    );
    let map = folder.text("out/fig-5.csv");
    assert_eq!((map.lines().count(), map.lines().nth(9).unwrap().split(',').count()), (202, 202));
    assert_eq!(folder.names("out"), ["fig-5.csv", "fig-5b.png", "paper.html", "paper.json"]);
}

#[test]
fn pictures_and_numbers_are_files_and_the_page_stands_alone() {
    let folder = Folder::new();
    made(&folder, 0, &["fig3", "fig4", "fig6", "fig8"]);
    let expected = [
        "fig-3.csv",
        "fig-3a.svg",
        "fig-3b.svg",
        "fig-4-lines.csv",
        "fig-4.csv",
        "fig-4a.png",
        "fig-4b.png",
        "fig-4c.png",
        "fig-4d.png",
        "fig-4e.png",
        "fig-6a.csv",
        "fig-6a.svg",
        "fig-6b.csv",
        "fig-6b.png",
        "fig-8.csv",
        "fig-8a.svg",
        "fig-8b.svg",
        "fig-8c.svg",
        "paper.html",
        "paper.json",
    ];
    assert_eq!(folder.names("out"), expected);
    let page = folder.text("out/paper.html");
    assert!(page.contains("Fig. 4(d): the projection of Carroll et al."));
    assert!(!page.contains("src=\"http") && !page.contains("<script"), "the page loads something");
    assert_eq!(page.matches("src=\"data:image/").count(), 12);
    // Exact columns stay straight; the columns of the table are longitude, fisheye, perspective, Mercator, exact.
    let straight = folder.text("out/fig-4.csv");
    assert!(straight.lines().skip(1).all(|line| line.ends_with(",0.000,0.000,0.000")), "{straight}");
}

/// Where a lens whose image circle has the radius 320 around (319.5, 319.5) images a point of the world: r = R · θ / 90°.
fn imaged([u, v, w]: [f64; 3]) -> [f64; 2] {
    let (aside, angle) = (u.hypot(v), u.hypot(v).atan2(w));
    let r = 320.0 * angle / std::f64::consts::FRAC_PI_2;
    [319.5 + r * u / aside, 319.5 + r * v / aside]
}

/// A file of lines in a photograph whose image circle is said to have this radius.
fn file(radius: u32, lines: &[Value]) -> String {
    json!({ "circle": { "centre": [319.5, 319.5], "radius": radius }, "lines": lines }).to_string()
}

/// Two upright edges and a wall's long foot in a photograph of the user's own, which here is the street as written before.
#[test]
fn a_photograph_is_shown_by_lines_that_are_marked_in_it() {
    let folder = Folder::new();
    made(&folder, 0, &["fig4"]);
    folder.write("photograph.png", folder.read("out/fig-4a.png"));
    let line = |from, to, is: &str| json!({ "from": imaged(from), "to": imaged(to), "is": is });
    let lines = [
        line([-4.0, -3.0, 4.0], [-4.0, 3.0, 4.0], "upright"),
        line([3.0, -3.0, 4.0], [3.0, 3.0, 4.0], "upright"),
        line([-6.0, 3.0, 4.0], [6.0, 3.0, 4.0], "level"),
        line([-5.0, -4.0, 2.0], [-5.0, -4.0, 30.0], "straight"),
    ];
    // Windows editors put a mark before it.
    folder.write("lines.json", format!("\u{feff}{}", file(320, &lines)));
    let call = ["fig4", "--photograph", "photograph.png", "--lines", "lines.json", "--overwrite"];
    let (report, _) = made(&folder, 0, &call);
    assert_eq!(report["items"][0]["claims"], json!([]), "what the street must fulfil is not asked of it");
    let table = folder.text("out/fig-4-lines.csv");
    let straight = |name: &str| -> f64 {
        let line = table.lines().find(|line| line.starts_with(name)).unwrap();
        line.split(',').nth(1).unwrap().parse().unwrap()
    };
    let (own, mercator, plane) = (straight("Carroll"), straight("Mercator"), straight("perspective"));
    assert!(own < 1.0 && mercator > 10.0 && plane < 0.01, "{table}");
    // It is the same picture, through the same lens.
    assert_eq!(folder.read("out/fig-4a.png"), folder.read("photograph.png"));
    for (content, said) in [
        ("{}".to_owned(), "is no file of lines"),
        (file(0, &[]), "has the radius 0"),
        (
            file(320, &[lines[0].clone(), json!({ "from": [9, 9], "to": [9, 9], "is": "level" })]),
            "entry 2 of `lines` in lines.json",
        ),
        // Both its ends lie four such radii from the middle, or one and a half.
        (file(45, &lines[..1]), "entry 1 of `lines` in lines.json"),
        (file(120, &lines[..1]), "entry 1 of `lines` in lines.json"),
    ] {
        folder.write("lines.json", content);
        refused(&folder, &[&["paper", "-o", "out"], &call[..]].concat(), said);
    }
    folder.write("lines.json", format!("{{\n\"{}\": 1}}", "9".repeat(70_000)));
    let ended =
        refused_with(2, &folder, &[&["paper", "-o", "out"], &call[..]].concat(), " at line 2 column ");
    assert!(ended.stderr.len() < 1000, "{}", ended.stderr);
    refused(&folder, &["paper", "-o", "out", "fig4", "--lines", "lines.json"], "--photograph");
}

/// The lines may be of another photograph, or of this one before it was scaled or turned. Pixel 0 begins at -0.5.
#[test]
fn lines_that_are_not_in_the_photograph_are_refused() {
    let folder = Folder::new();
    let pixels =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../host/frames/tests/photographs/alpha.bmp.png");
    folder.write("photograph.png", std::fs::read(pixels).unwrap());
    let line = |[from, to]: [[f64; 2]; 2]| json!({ "from": from, "to": to, "is": "straight" });
    let call = |ends| {
        let (circle, first) =
            (json!({ "centre": [36, 24], "radius": 60 }), line([[20.0, 10.0], [20.0, 40.0]]));
        folder.write("lines.json", json!({ "circle": circle, "lines": [first, line(ends)] }).to_string());
        ["paper", "fig4", "--photograph", "photograph.png", "--lines", "lines.json", "-o", "out"]
    };
    let sentence =
        "entry 2 of `lines` in lines.json ends outside of the photograph, which has 72 x 48 pixels";
    for ends in [
        [[71.6, 8.0], [60.0, 40.0]],
        [[60.0, 40.0], [71.6, 8.0]],
        [[-0.6, 8.0], [10.0, 40.0]],
        [[40.0, -0.6], [44.0, 40.0]],
        [[40.0, 8.0], [44.0, 47.6]],
    ] {
        refused(&folder, &call(ends), sentence);
    }
    folder.halfrow(call([[-0.5, -0.5], [71.5, 47.5]])).succeeded();
}

#[test]
fn a_circle_that_is_too_small_is_told_the_least() {
    let folder = Folder::new();
    folder.write("photograph.png", "is read behind the lines");
    let call = ["paper", "fig4", "--photograph", "photograph.png", "--lines", "lines.json", "-o", "out"];
    for radius in [0.5, -1.0] {
        let circle = json!({ "centre": [319.5, 319.5], "radius": radius });
        folder.write("lines.json", json!({ "circle": circle, "lines": [] }).to_string());
        refused(
            &folder,
            &call,
            &format!("has the radius {radius}; give at least 1, the pixels from its middle"),
        );
    }
}

/// Nothing would be farthest from straight in any projection.
#[test]
fn a_photograph_without_a_line_is_shown_by_none() {
    let folder = Folder::new();
    folder.write("photograph.png", "is read behind the lines");
    folder.write("lines.json", file(320, &[]));
    let call = ["paper", "fig4", "--photograph", "photograph.png", "--lines", "lines.json", "-o", "out"];
    refused(&folder, &call, "lines.json marks no line; mark at least one");
}

#[test]
fn the_delay_is_measured_and_a_board_that_takes_longer_fails() {
    let folder = Folder::new();
    let (report, _) = made(&folder, 0, &["delay", "--board", "mock,latency=20"]);
    assert_eq!(report["items"][0]["claims"][0]["found"], 960.0 + 20.0);
    // 980 clocks at 1920 · 1080 · 30 Hz are 15.754 µs.
    let time = report["items"][0]["claims"][1]["found"].as_f64().unwrap();
    assert!((time - 0.015_754).abs() < 1e-6, "{time}");
    let (report, said) = made(&folder, 1, &["delay", "--overwrite", "--board", "mock,fault=late"]);
    assert_eq!(report["items"][0]["claims"][2]["holds"], false);
    assert!(said.contains("FAIL    pixel clocks between"), "{said}");
}

#[test]
fn resources_come_from_the_synthesis_report_or_say_how_to_make_one() {
    let folder = Folder::new();
    let (_, said) = made(&folder, 5, &["resources"]);
    assert!(said.contains("run `scripts/hardware resources`"), "{said}");
    let part = |used: f64, percent: f64| json!({ "used": used, "percent": percent });
    let report = |mean: f64| {
        let build = json!({
            "name": "core, 5 taps, 1 bank", "luts": part(478.0, 3.2), "registers": part(608.0, 2.0),
            "block_rams": part(7.5, 14.4), "dsps": part(5.0, 13.2), "mean": mean,
        });
        json!({ "tool": "Yosys", "device": "XC6SLX25", "builds": [build] }).to_string()
    };
    folder.write("good.json", report(8.2));
    folder.write("large.json", report(10.0));
    let (made_of, _) = made(&folder, 0, &["resources", "--overwrite", "--synthesis", "good.json"]);
    assert_eq!(made_of["items"][0]["claims"][0]["found"], 8.2);
    let (_, said) = made(&folder, 3, &["resources", "--overwrite", "--synthesis", "large.json"]);
    assert!(said.contains("MISSED"), "{said}");
    for bad in ["{}", "null"] {
        folder.write("bad.json", bad);
        let call = ["paper", "fig5", "resources", "-o", "new", "--synthesis", "bad.json"];
        refused(&folder, &call, "make it anew");
    }
    let named = ["paper", "fig5", "resources", "-o", "new", "--synthesis", "typo.json"];
    refused(&folder, &named, "typo.json is no synthesis report that can be used");
    assert!(!folder.path().join("new").exists(), "it was noticed once the folder was made");
}

#[test]
fn a_file_that_has_no_end_is_not_read_to_it() {
    let folder = Folder::new();
    folder.write("photograph.png", "is read behind the lines");
    folder.write("long.json", " ".repeat((1 << 20) + 1));
    std::fs::create_dir(folder.path().join("out")).unwrap();
    let lines = ["fig4", "--photograph", "photograph.png", "--lines"];
    for option in [lines.as_slice(), &["resources", "--synthesis"]] {
        for file in ["long.json", "/dev/zero"] {
            let call = [&["paper", "-o", "out"], option, &[file]].concat();
            refused(&folder, &call, "it is longer than 1048576 bytes");
        }
    }
}

/// What was not tried is reported next to the result, which is not green then.
#[test]
fn a_page_of_which_a_part_was_not_tried_says_so_at_its_head() {
    let folder = Folder::new();
    made(&folder, 0, &["delay", "resources"]);
    let page = folder.text("out/paper.html");
    let (head, _) = page.split_once("</header>").unwrap();
    assert!(head.contains("<header class=\"error\">") && head.contains("REPRODUCED IN PART"), "{head}");
    assert!(head.contains("3 of 3 numbers that were tried are accepted, 1 not tried"), "{head}");
    made(&folder, 0, &["delay", "--overwrite"]);
    let page = folder.text("out/paper.html");
    let (head, _) = page.split_once("</header>").unwrap();
    assert!(head.contains("<header class=\"pass\">") && !head.contains("not tried"), "{head}");
}

#[test]
fn an_earlier_page_stays_as_it_is() {
    let folder = Folder::new();
    made(&folder, 0, &["fig8"]);
    refused(&folder, &["paper", "fig8", "-o", "out"], "--overwrite");
}

#[test]
fn json_is_what_the_folder_holds_and_the_exit_code_stays() {
    let folder = Folder::new();
    for (code, item) in [(0, ["fig8", "fig5"]), (5, ["resources", "resources"])] {
        let (report, said) = made(&folder, code, &[item[0], item[1], "--json", "--overwrite"]);
        let said: Value = serde_json::from_str(&said).unwrap();
        for key in ["schema", "command", "halfrow", "items"] {
            assert_eq!(said[key], report[key], "{key}");
        }
    }
    let refused = folder.halfrow(["paper", "table1", "--json", "-o", "none"]);
    assert_eq!((refused.code, &refused.json()["exit_code"]), (Some(2), &2.into()));
    assert!(
        refused.json()["error"]["message"].as_str().unwrap().contains("give --images"),
        "{}",
        refused.stdout
    );
}

/// The cells of a page's table with this head, row by row.
fn rows_of_page(page: &str, head: &[&str]) -> Vec<Vec<String>> {
    let cells =
        |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let behind = page.lines().skip_while(|line| cells(line) != head).skip(2);
    behind.take_while(|line| line.starts_with('|')).map(cells).collect()
}

/// Asserts that docs/lenses.md has this table, its numbers within one unit of their last digit, since logarithms and sines differ
/// between machines.
#[track_caller]
fn assert_on_page(table: &Value) {
    let page = include_str!("../../../docs/lenses.md");
    let head: Vec<_> =
        table["columns"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    let (written, made) = (rows_of_page(page, &head), table["rows"].as_array().unwrap());
    assert_eq!(written.len(), made.len(), "the table {head:?}");
    let number = |text: &str| text.trim_end_matches(" %").parse::<f64>();
    for (written, made) in written.iter().zip(made) {
        for (written, made) in written.iter().zip(made.as_array().unwrap()) {
            let made = made.as_str().map_or_else(|| made.to_string(), str::to_owned);
            let agree = match (number(written), number(&made)) {
                (Ok(on_page), Ok(found)) => {
                    let decimals =
                        written.trim_end_matches(" %").split_once('.').map_or(0, |(_, rest)| rest.len());
                    (on_page - found).abs() < 1.01 * 0.1_f64.powi(decimals as i32)
                }
                _ => *written == made,
            };
            assert!(agree, "docs/lenses.md says {written} for {made}: {head:?}");
        }
    }
}

/// The bends of the fisheye picture and of Eq. 9 were computed in NumPy, by bisecting Eq. 4 and OCamCalib's polynomial over the
/// rows of each edge, with the same medians; so was Eq. 9's mean over the map.
#[test]
fn three_ways_stand_side_by_side_and_bends_are_those_of_the_projections() {
    let folder = Folder::new();
    let (report, _) = made(&folder, 0, &["verticals"]);
    let [map, bends, _] = &report["items"][0]["tables"].as_array().unwrap()[..] else { panic!("{report}") };
    let mean = |row: usize| map["rows"][row][1].as_f64().unwrap();
    assert!((mean(0) - 2.3853).abs() < 2e-4 && mean(1) < mean(0) && mean(2) < 0.1, "{map}");
    for (row, mean, largest) in
        [(0, 17.329, 98.436), (1, 4.615, 25.813), (4, 18.046, 103.782), (5, 4.314, 24.320)]
    {
        let found = |place: usize| bends["rows"][row][place].as_f64().unwrap();
        assert!((found(3) - mean).abs() < 0.05, "{bends}");
        assert!((found(4) - largest).abs() < 0.25, "{bends}");
    }
    assert_on_page(bends);
    let page = folder.text("out/paper.html");
    assert!(page.contains("<div class=\"previews threes\">"), "three columns");
    for name in ["map", "facades-paper", "facades-dsl215"] {
        let places =
            ["equation-9", "fitted", "exact"].map(|way| page.find(&format!("{name}-{way}.png")).unwrap());
        assert!(places.is_sorted(), "{name}");
        assert!(folder.names("out").contains(&format!("{name}-exact.png")), "{name}");
    }
    assert!(folder.text("out/verticals-edges.csv").lines().count() == 1 + 8 * 10);
}

/// The claims, which are the largest errors that a grid by formula leaves, were computed in Python, apart from this program.
#[test]
#[ignore = "a minute long; scripts/soak runs it"]
fn what_is_left_per_lens_frame_and_centre_is_what_the_page_of_lenses_says() {
    let folder = Folder::new();
    let (report, _) = made(&folder, 0, &["residuals"]);
    let item = &report["items"][0];
    assert_eq!(item["claims"].as_array().unwrap().len(), 11);
    for table in item["tables"].as_array().unwrap() {
        assert_on_page(table);
    }
}
