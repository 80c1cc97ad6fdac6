//! What integer arithmetic costs on photographs: the integer datapath compared with double precision, at 1920 x 1080 and 12 bits.
//!
//! The photographs are those in the folder `HALFROW_IMAGES`, or in `../shared/kodak` next to the project.

use halfrow_model::{
    Equidistant, Geometry, Interpolant, Kernel, TableSet, correct, correct_real, round_to_frame,
};
use halfrow_tests::photographs::{self, filled};

#[test]
fn on_photographs_the_integers_are_within_one_of_double_precision() {
    let paths = photographs::paths();
    if paths.is_empty() {
        return;
    }
    let (geometry, lens) = (Geometry::default(), Equidistant::default());
    let tables = TableSet::from_lens(geometry, &lens, None).unwrap();
    let kernel = Kernel::from(Interpolant::Hermite);
    let (mut equal, mut total) = (0, 0);
    for path in &paths {
        let frame = filled(path, &geometry);
        let integer = correct(&tables, &kernel, &frame).unwrap();
        let real = correct_real(&geometry, &lens, None, Interpolant::Hermite, &frame).unwrap();
        let real = round_to_frame(&real, &frame).unwrap();
        let pairs = integer.samples().iter().zip(real.samples());
        let largest = pairs.clone().map(|(integer, real)| integer.abs_diff(*real)).max();
        assert!(largest <= Some(1), "{} differs by {largest:?}", path.display());
        equal += pairs.filter(|(integer, real)| integer == real).count();
        total += frame.samples().len();
    }
    let share = 100.0 * equal as f64 / total as f64;
    println!(
        "{} photographs: {share:.2} % of {total} samples equal double precision, the rest within 1",
        paths.len()
    );
    assert!(share > 97.0, "{share:.2} %");
}
