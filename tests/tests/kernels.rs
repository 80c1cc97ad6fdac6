//! What the fitted kernels gain over Hermite on the photographs of Table 1, and fitting one from the command line.
//!
//! The photographs are taken from the folder `HALFROW_IMAGES`, or from `../shared/kodak` beside the project.

use halfrow_tests::photographs;
use halfrow_tests::program::Folder;
use serde_json::Value;

/// Gains in dB under Table 1's warp and under a band-limited one, each mean, least and most, found with NumPy 2.
const GAINS: [(&str, [[f64; 3]; 2]); 2] = [
    ("sharp5", [[1.6487, 1.0920, 2.1215], [1.1789, 0.3687, 1.6116]]),
    ("sharp7", [[2.6114, 1.2598, 3.4496], [2.5751, 0.9472, 3.3969]]),
];

#[test]
fn fitted_kernels_gain_on_the_photographs_of_table_1() {
    let Some(first) = photographs::paths().into_iter().next() else {
        println!("no photographs: set HALFROW_IMAGES to the folder of kodim01.png to kodim24.png");
        return;
    };
    let images = first.parent().unwrap().to_str().unwrap();
    for (name, expected) in GAINS {
        let call = ["kernel", "measure", "--json", "-q", "--kernel", name, "--images", images];
        let ended = Folder::new().halfrow(call);
        assert_eq!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
        let report: Value = serde_json::from_str(&ended.stdout).unwrap();
        for (gains, expected) in report["gains_db"].as_array().unwrap().iter().zip(expected) {
            for (key, expected) in ["mean", "least", "most"].into_iter().zip(expected) {
                let found = gains["gain"][key].as_f64().unwrap();
                assert!((found - expected).abs() < 1e-3, "{name}: {gains}");
            }
        }
    }
}

#[test]
fn a_folder_without_photographs_is_refused() {
    let folder = Folder::new();
    let call = ["kernel", "train", "--images", ".", "-o", "mine.json"];
    let ended = folder.halfrow(call);
    assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
    assert!(ended.stderr.contains("no .png file"), "{}", ended.stderr);
}
