//! The mathematics of the paper's figures, compared with values from other programs.

use halfrow::frames::preview::RgbImage;
use halfrow_lab::paper::{View, distorted, ray};
use halfrow_model::Equidistant;

/// The picture whose bytes are (37 · index) mod 251, distorted with R = 4 by NumPy 2.4: `floor(interp(k·x_d + 3.5, arange(8),
/// row))` for each row and colour.
const DISTORTED: [[u8; 24]; 4] = [
    [
        0, 37, 74, 89, 126, 163, 208, 24, 61, 87, 114, 151, 187, 224, 20, 66, 103, 140, 136, 173, 210, 24,
        61, 98,
    ],
    [
        135, 172, 209, 243, 34, 71, 107, 141, 178, 216, 3, 40, 77, 114, 150, 186, 223, 12, 50, 87, 124, 159,
        196, 233,
    ],
    [
        19, 56, 93, 127, 164, 201, 239, 28, 65, 101, 137, 174, 211, 248, 35, 73, 110, 144, 180, 217, 8, 43,
        80, 117,
    ],
    [
        154, 191, 228, 41, 78, 115, 111, 148, 185, 231, 27, 64, 100, 137, 164, 190, 227, 43, 88, 125, 113,
        178, 215, 1,
    ],
];

#[test]
fn distortion_is_added_as_numpy_adds_it() {
    let data = (0..96_u32).map(|place| (37 * place % 251) as u8).collect();
    let image = RgbImage { width: 8, height: 4, data };
    let lens = Equidistant::from_radius(4.0).unwrap();
    assert_eq!(distorted(&image, &lens).data, DISTORTED.as_flattened());
}

/// The sources of three points of each view, R = 320. Perspective and Mercator: `cv2.fisheye.distortPoints` of OpenCV 5.0 with no
/// coefficients and f = 2R/π. Exact: Eq. 6 as printed, over two million x_d, interpolated with NumPy. Simplified: Eqs. 8 and 9 in
/// NumPy.
#[test]
fn views_come_from_where_other_programs_find_them() {
    let lens = Equidistant::from_radius(320.0).unwrap();
    let points = [(100.0, 50.0), (-300.0, 200.0), (10.0, -310.0)];
    let frozen = [
        (View::Perspective, [(99.159402, 49.579701), (-185.991539, 123.994359), (6.788640, -210.447827)]),
        (View::Mercator, [(97.959062, 51.516873), (-201.084740, 231.806786), (5.230391, -232.469092)]),
        (View::Exact, [(98.078013, 50.0), (-230.117501, 200.0), (0.748103, -310.0)]),
        (View::Simplified, [(98.771754, 50.0), (-234.187425, 200.0), (2.480392, -310.0)]),
    ];
    for (view, sources) in frozen {
        for ((x, y), expected) in points.into_iter().zip(sources) {
            let found = view.source(&lens, x, y).unwrap();
            let apart = (found.0 - expected.0).hypot(found.1 - expected.1);
            assert!(apart < 1e-5, "{view:?} at ({x}, {y}): {found:?}, {apart:e} apart");
        }
    }
}

#[test]
fn a_view_shows_every_direction_where_it_takes_it_from() {
    let lens = Equidistant::from_radius(320.0).unwrap();
    for view in View::ALL {
        for (longitude, latitude) in [(0.0, 0.0), (40.0, 25.0), (-55.0, 10.0), (20.0, -60.0_f64)] {
            let direction = ray(f64::to_radians(longitude), latitude.to_radians());
            let (x, y) = view.place(&lens, direction);
            let source = view.source(&lens, x, y).unwrap();
            let imaged = lens.image_point(direction);
            assert!(
                (source.0 - imaged.0).hypot(source.1 - imaged.1) < 1e-6,
                "{view:?} {longitude} {latitude}"
            );
        }
    }
}

#[test]
fn outside_the_image_circle_there_is_nothing_to_show() {
    let lens = Equidistant::from_radius(320.0).unwrap();
    assert_eq!(View::Fisheye.source(&lens, 230.0, 230.0), None);
    assert_eq!(View::Exact.source(&lens, 0.0, 321.0), None);
    // The paper's projections fill their square to the edge.
    for view in [View::Exact, View::Simplified] {
        assert!(view.source(&lens, 319.5, 319.5).is_some(), "{view:?}");
    }
}
