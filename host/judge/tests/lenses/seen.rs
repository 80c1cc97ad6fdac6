//! The lens through which built-in frames are seen in place of the one in a file.

use std::path::Path;

use halfrow::call::Input;
use halfrow::lenses::LensFile;
use halfrow::optics::{Optics, TablesBy, View};

/// Where the lens of `text` and the one of its built-in frames image rays `degrees` off the axis, for this angle across the
/// circle.
fn both(text: &str, field_of_view: f64, degrees: f64) -> (f64, f64) {
    let input = Input::of_bytes(Path::new("lens.json"), text.as_bytes());
    let view = View { field_of_view, ..View::default() };
    let file = LensFile::parse(text).unwrap();
    let optics = Optics::of_lens_file(input, &file, None, &view, TablesBy::Fitting).unwrap();
    let angle: f64 = degrees.to_radians();
    (optics.camera.lens().column(angle).unwrap(), optics.lens.focal_length() * angle)
}

fn lens(coefficient: f64) -> String {
    format!(
        r#"{{"K": [[50, 0, 95.5], [0, 50, 31.5], [0, 0, 1]], "D": [{coefficient}, 0, 0, 0], "width": 192, "height": 64}}"#
    )
}

/// By hand: 50 · (π/2 + 0.01 · (π/2)³).
#[test]
fn it_images_90_degrees_where_the_file_s_does_for_every_circle() {
    for field in [100.0, 180.0, 220.0] {
        let (own, seen) = both(&lens(0.01), field, 90.0);
        assert!((own - 80.477_71).abs() < 1e-4 && (own - seen).abs() < 1e-9, "{field}: {own} {seen}");
    }
}

/// r = θ − 0.25 · θ³ turns back at 66.2 degrees. By hand: 50 · (π/3 − 0.25 · (π/3)³).
#[test]
fn for_a_lens_that_does_not_reach_90_degrees_it_has_the_same_circle() {
    let (own, seen) = both(&lens(-0.25), 120.0, 60.0);
    assert!((own - 38.005_12).abs() < 1e-4 && (own - seen).abs() < 1e-9, "{own} {seen}");
}
