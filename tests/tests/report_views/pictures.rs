//! The pictures of the page, extracted and decoded.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use halfrow::compare::Comparison;
use halfrow::report;
use halfrow::result::{Evidence, MissingRows, Report};
use halfrow_model::Frame;

use crate::made;

/// Colours of the scale.
const EQUAL: [u8; 3] = [0x17, 0x17, 0x20];
const FROM_8: [u8; 3] = [0xdc, 0x46, 0x6a];
/// Sky blue of M. Okabe and K. Ito, "Color Universal Design", 2002.
const MISSING: [u8; 3] = [86, 180, 233];

/// Width, height and pixels of the picture with the description `alt`.
fn picture(page: &str, alt: &str) -> (u32, u32, Vec<[u8; 3]>) {
    let (before, _) = page.split_once(&format!("alt=\"{alt}\"")).unwrap();
    let (_, data) = before.rsplit_once("base64,").unwrap();
    let (data, _) = data.split_once('"').unwrap();
    let bytes = STANDARD.decode(data).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, pixels.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect())
}

#[test]
fn each_pixel_of_the_map_of_a_large_frame_shows_the_largest_difference_of_its_eight_by_eight_samples() {
    let (mut report, mut evidence) = made::fail();
    let expected = made::sized_frame(256, 72, |_, _| 100);
    let found = made::sized_frame(256, 72, |row, column| if row == 3 && column < 5 { 116 } else { 100 });
    report.frames[1].comparison = Comparison::of_frames(&expected, &found);
    evidence[0] =
        Evidence { index: 1, input: expected.clone(), found, expected, missing: MissingRows::default() };
    let page = report::html(&report, &evidence).unwrap();
    let (width, height, pixels) = picture(&page, "Map of differences");
    assert_eq!((width, height), (32, 9));
    assert_eq!(pixels[0], FROM_8, "columns 0 to 4 of row 3 are 16 too large");
    assert!(pixels[1..].iter().all(|pixel| *pixel == EQUAL));
    assert!(page.contains("in each 8 × 8 samples:"));
}

#[test]
fn each_pixel_of_the_map_of_a_small_frame_shows_one_sample() {
    let (report, evidence) = made::fail();
    let page = report::html(&report, &evidence).unwrap();
    let (width, height, pixels) = picture(&page, "Map of differences");
    assert_eq!((width, height), (64, 40));
    let wrong: Vec<_> = (0..pixels.len()).filter(|&place| pixels[place] != EQUAL).collect();
    assert_eq!(wrong, (0..5).map(|column| 3 * 64 + column).collect::<Vec<_>>());
    assert_eq!(pixels[3 * 64], FROM_8);
    assert!(page.contains("of each sample:"));
}

#[test]
fn a_crop_shows_48_by_32_samples_around_the_first_difference() {
    let (report, evidence) = made::fail();
    let page = report::html(&report, &evidence).unwrap();
    let (width, height, pixels) = picture(&page, "Difference, colours as in the map");
    assert_eq!((width, height), (48, 32));
    let wrong: Vec<_> = (0..pixels.len()).filter(|&place| pixels[place] != EQUAL).collect();
    assert_eq!(wrong, (0..5).map(|column| 3 * 48 + column).collect::<Vec<_>>());
    assert!(page.contains("Rows 0 to 31, columns 0 to 47, raw samples; black is 0, white is 2032."));
}

#[test]
fn the_three_crops_share_one_contrast() {
    let (report, evidence) = made::fail();
    let page = report::html(&report, &evidence).unwrap();
    let grey = |alt| picture(&page, alt).2[31 * 48 + 47][0];
    // At row 31, column 47 the input is 31 · 64 + 47 = 2031 of at most 2032, and the other two are 2032 of 2032.
    assert_eq!((grey("Input"), grey("Expected"), grey("Found")), (254, 255, 255));
}

#[test]
fn the_bars_count_the_differences_by_row_and_by_column() {
    let (report, evidence) = made::fail();
    let page = report::html(&report, &evidence).unwrap();
    assert!(page.contains("M0 3h100v1h-100z"), "row 3 has all five");
    let columns: String = (0..5).map(|column| format!("M{column} 0v100h1v-100z")).collect();
    assert!(page.contains(&columns), "columns 0 to 4 have one each");
}

/// Takes rows away from the only frame that was kept.
fn without_rows(report: &mut Report, kept: &mut Evidence, missing: &[usize]) {
    let Evidence { found, expected, .. } = &*kept;
    let mut samples = found.samples().to_vec();
    let mut comparison = Comparison::new(found.width(), found.height());
    for row in 0..found.height() {
        if missing.contains(&row) {
            samples[row * found.width()..][..found.width()].fill(0);
        } else {
            comparison.row(row, expected.row(row), found.row(row));
        }
    }
    report.frames[1].rows = found.height() - missing.len();
    report.frames[1].comparison = comparison;
    kept.found = Frame::new(found.width(), found.depth(), found.phase(), samples).unwrap();
    let returned: Vec<_> = (0..kept.found.height()).map(|row| !missing.contains(&row)).collect();
    kept.missing = MissingRows::of(&returned);
    report.frames[1].missing = kept.missing.clone();
}

/// Nothing is known about them, so they are not shown as black samples that differ.
#[test]
fn rows_that_did_not_come_back_have_a_colour_of_their_own() {
    let (mut report, mut evidence) = made::fail();
    assert!(!report::html(&report, &evidence).unwrap().contains("did not come back"));
    without_rows(&mut report, &mut evidence[0], &[2, 39]);
    let page = report::html(&report, &evidence).unwrap();
    let map = picture(&page, "Map of differences").2;
    let crop = picture(&page, "Difference, colours as in the map").2;
    let (_, _, found) = picture(&page, "Found");
    assert!(
        found.chunks(48).enumerate().all(|(row, pixels)| pixels.contains(&MISSING) == [2, 39].contains(&row))
    );
    for (pixels, width) in [(&map, 64), (&crop, 48)] {
        let colour = |row, column| match (row, column) {
            (2 | 39, _) => MISSING,
            (3, 0..5) => FROM_8,
            _ => EQUAL,
        };
        assert!((0..pixels.len()).all(|place| pixels[place] == colour(place / width, place % width)));
    }
    assert_eq!(page.matches("<h3>Around").count(), 1, "no crop of what did not come back");
    assert!(page.contains("<h3>Around row 3, column 0: expected 193, found 209</h3>"));
    assert!(page.contains(r#"background:rgb(86 180 233)"></span> did not come back"#), "{page}");
}

/// Of 256 x 72 samples, 4 x 256 came back.
#[test]
fn the_legend_of_a_large_frame_is_the_maps_however_few_rows_came_back() {
    let (mut report, mut evidence) = made::fail();
    let expected = made::sized_frame(256, 72, |_, _| 100);
    let found = made::sized_frame(256, 72, |row, column| if row == 3 && column < 5 { 116 } else { 100 });
    evidence[0] =
        Evidence { index: 1, input: expected.clone(), found, expected, missing: MissingRows::default() };
    without_rows(&mut report, &mut evidence[0], &(4..72).collect::<Vec<_>>());
    let page = report::html(&report, &evidence).unwrap();
    assert!(page.contains("in each 8 × 8 samples:"));
    assert!(page.contains("Differences in each 8 rows: at most 5"));
    let pixels = picture(&page, "Map of differences").2;
    assert_eq!((pixels[0], pixels[1], pixels[32]), (FROM_8, MISSING, MISSING));
}

/// Of later frames of a run they are not kept.
#[test]
fn the_bars_do_not_need_the_counts_of_the_report() {
    let (mut report, evidence) = made::fail();
    let page = report::html(&report, &evidence).unwrap();
    let counts = &mut report.frames[1].comparison;
    (counts.by_row, counts.by_column) = (Vec::new(), Vec::new());
    assert_eq!(report::html(&report, &evidence).unwrap(), page);
}
