//! All factors, which random cases would hardly reach. Ignored by default; scripts/soak runs them.

use std::iter::{StepBy, Take};
use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Instant;

use halfrow_model::{
    BitDepth, Corrector, Geometry, Interpolant, Kernel, MAX_WIDTH, ModelPath, NODES, correct_row,
};

use crate::fast::{paths, sources};
use crate::{ONE, row_factor};

/// Coprime to 2^24, so that every low part of a factor occurs.
const STRIDE: usize = 101;

/// Factors a stride apart, one thread's share at a time.
type Share = Take<StepBy<RangeInclusive<u32>>>;

/// Widths that are whole blocks and widths that are not.
const WIDTHS: [usize; 4] = [MAX_WIDTH, 1920, 1086, 64];

/// Runs `check` for all factors from 1 on, `stride` apart, share by share on all processors, and prints how long it took.
#[allow(clippy::print_stdout)]
fn over_factors(what: &str, stride: usize, check: impl Fn(Share) + Sync) {
    const SHARE: usize = 1 << 10;
    let (started, next) = (Instant::now(), AtomicU32::new(1));
    let threads = std::thread::available_parallelism().unwrap().get();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let first = next.fetch_add((SHARE * stride) as u32, Ordering::Relaxed);
                    if first > ONE {
                        break;
                    }
                    check((first..=ONE).step_by(stride).take(SHARE));
                }
            });
        }
    });
    println!("{what}: equal to the oracle by {}, {} s", named(), started.elapsed().as_secs());
}

fn named() -> String {
    paths().map(ModelPath::name).collect::<Vec<_>>().join(", ")
}

/// Checks that all paths find the oracle's source of every column.
fn check_sources(correctors: &[Corrector], geometry: &Geometry, factor: u32) {
    let expected = sources(geometry, factor);
    let mut found = (vec![0; geometry.width()], vec![0; geometry.width()]);
    for corrector in correctors {
        corrector.locate(geometry, row_factor(factor), &mut found.0, &mut found.1);
        let centre2 = geometry.centre2();
        assert!(found == expected, "{}, Q = {factor}, C = {centre2}", corrector.path());
        found.0.fill(-2);
    }
}

/// S of every column of the widest row, with the centre in the middle, for each of the 2^24 factors.
#[test]
#[ignore = "minutes; scripts/soak factors"]
fn every_path_finds_the_sources_of_all_factors_at_all_columns() {
    let geometry = Geometry::centred(MAX_WIDTH, 1, BitDepth::Twelve).unwrap();
    let kernel = Interpolant::Linear.into();
    let correctors: Vec<_> = paths().map(|path| Corrector::new(path, &kernel).unwrap()).collect();
    over_factors("sources of 2^24 factors at 2592 columns", 1, |factors| {
        factors.for_each(|factor| check_sources(&correctors, &geometry, factor));
    });
}

/// Centres at and off the edges, and widths that are whole blocks or not, for factors a stride apart.
#[test]
#[ignore = "minutes; scripts/soak factors"]
fn every_path_finds_the_sources_about_any_centre() {
    let kernel = Interpolant::Linear.into();
    let correctors: Vec<_> = paths().map(|path| Corrector::new(path, &kernel).unwrap()).collect();
    over_factors("sources about six centres on a stride of the factors", STRIDE, |factors| {
        for factor in factors {
            for width in WIDTHS {
                let last = 2 * width as u32 - 2;
                for centre2 in [0, 1, last / 3, last - 1, last, factor % (last + 1)] {
                    let geometry = Geometry::new(width, 1, BitDepth::Twelve, centre2).unwrap();
                    check_sources(&correctors, &geometry, factor);
                }
            }
        }
    });
}

/// Kernels of five and of seven taps: the usual ones, and ones with weights of every size and sign.
fn kernels() -> [Kernel; 4] {
    let wild = |place: usize| ((place as u32).wrapping_mul(2_654_435_761) >> 16) as i16;
    let seven = (0..NODES).map(|node| [0, 1, 2, 3, 4].map(|tap| wild(5 * node + tap)));
    let five = seven.clone().map(|[_, r1, g4, r5, _]| [0, r1, g4, r5, 0]);
    let [seven, five] = [seven.collect(), five.collect()].map(|nodes| Kernel::from_nodes(nodes).unwrap());
    [Interpolant::Hermite.into(), Interpolant::Keys.into(), five, seven]
}

#[test]
#[ignore = "minutes; scripts/soak factors"]
fn every_path_corrects_whole_rows_on_a_stride_of_the_factors() {
    let kernels = kernels();
    over_factors("whole rows on a stride of the factors, four kernels", STRIDE, |factors| {
        let mut correctors: Vec<Vec<_>> = kernels
            .iter()
            .map(|kernel| paths().map(|path| Corrector::new(path, kernel).unwrap()).collect())
            .collect();
        for (index, factor) in factors.enumerate() {
            let width = WIDTHS[(factor as usize + index) % WIDTHS.len()];
            let depth = BitDepth::ALL[factor as usize % 3];
            let geometry = Geometry::new(width, 1, depth, factor % (2 * width as u32 - 1)).unwrap();
            let sample = |column: u32| (column ^ factor).wrapping_mul(2_654_435_761) >> (32 - depth.bits());
            let row: Vec<u16> = (0..width as u32).map(|column| sample(column) as u16).collect();
            let (mut expected, mut found) = (vec![0; width], vec![0; width]);
            for (kernel, correctors) in kernels.iter().zip(&mut correctors) {
                correct_row(&geometry, row_factor(factor), kernel, &row, &mut expected);
                for corrector in correctors {
                    corrector.correct_row(&geometry, row_factor(factor), &row, &mut found);
                    assert!(found == expected, "{}: Q = {factor}, {geometry:?}", corrector.path());
                }
            }
        }
    });
}
