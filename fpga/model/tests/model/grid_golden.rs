//! Golden values of datapath 2 from programs outside the project (DATAPATH.md, "Golden values of datapath 2"). When one of
//! these fails, do not change the test: the arithmetic has changed, and every board in the field would disagree.

use halfrow_model::{
    BitDepth, Camera, Corrector, Equidistant, Frame, Geometry, GridShape, Interpolant, Kernel, ModelPath,
    TableSet, correct,
};

use crate::scenes::{frame, golden_samples};

/// The paper's lens on its frame.
fn paper() -> Camera {
    let lens = Equidistant::from_radius(1106.697).unwrap();
    Camera::new(Geometry::default(), lens.into(), (959.5, 539.5), 180.0).unwrap()
}

/// The table of DATAPATH.md.
pub(crate) fn golden_table() -> TableSet {
    paper().grid_by_formula(GridShape::new(5, 6).unwrap())
}

/// Which entries a drawn grid of DATAPATH.md has.
#[derive(Clone, Copy)]
pub(crate) enum Drawn {
    Narrow,
    Wide,
    Legal,
}

/// A drawn grid of DATAPATH.md: entry e is x >> 7 if wide, and otherwise 14680064 + (x >> 12), with x = (e + seed) · 2654435761 mod
/// 2^32. The offsets of a legal one are 2^24.
pub(crate) fn drawn(geometry: Geometry, shape: GridShape, seed: u32, drawn: Drawn) -> TableSet {
    let offsets = ((geometry.height() as u32 - 1) >> shape.v()) + 3;
    let entry = |place: u32| {
        let x = (place + seed).wrapping_mul(2_654_435_761);
        match drawn {
            Drawn::Wide => x >> 7,
            Drawn::Legal if place < offsets => 1 << 24,
            Drawn::Narrow | Drawn::Legal => 14_680_064 + (x >> 12),
        }
    };
    let entries: Vec<_> = (0..shape.entries(&geometry) as u32).map(entry).collect();
    TableSet::from_grid(geometry, shape, &entries).unwrap()
}

/// S modulo 2^40 of every output, row after row.
fn coordinates(tables: &TableSet) -> Vec<u64> {
    let geometry = tables.geometry();
    let row = |row| {
        let values = tables.values(row).unwrap();
        (0..geometry.width()).map(move |column| values.coordinate(column) as u64 & ((1 << 40) - 1))
    };
    (0..geometry.height()).flat_map(row).collect()
}

fn crc_of_q(tables: &TableSet) -> u32 {
    let geometry = tables.geometry();
    let row = |row| {
        let values = tables.values(row).unwrap();
        (0..geometry.width()).map(move |column| {
            let source = values.source(column);
            (source.base * 8192 + 256 * source.node as i64) as u32 + source.fraction as u32
        })
    };
    crc32((0..geometry.height()).flat_map(row).map(u32::to_le_bytes))
}

fn crc_of_frame(frame: &Frame) -> u32 {
    crc32(frame.samples().iter().map(|sample| sample.to_le_bytes()))
}

fn crc32<const N: usize>(words: impl Iterator<Item = [u8; N]>) -> u32 {
    crc32fast::hash(&words.flatten().collect::<Vec<_>>())
}

#[test]
fn the_table_of_the_paper_s_lens_is_the_golden_one() {
    let tables = golden_table();
    let entries: Vec<_> = tables.entries().collect();
    assert_eq!(entries.len(), 1152);
    // The offsets (0, 0) and (0, 18), then the nodes (0, 0), (15, 0) and (0, 18).
    assert_eq!(
        [0, 18, 36, 36 + 15 * 36, 36 + 18].map(|place| entries[place]),
        [17_658_292, 16_777_664, 16_098_102, 13_148_591, 16_776_904]
    );
    assert_eq!(crc32fast::hash(&tables.to_bytes()), 0xc3d3_6492);
}

#[test]
fn the_values_of_rows_are_the_golden_ones() {
    let tables = golden_table();
    let rows = [
        (0, 829_652, [16_141_200, 15_853_920, 13_359_768]),
        (31, 733_352, [16_221_016, 15_969_128, 13_755_368]),
        (32, 730_357, [16_223_472, 15_972_664, 13_767_680]),
        (539, 0, [16_777_216; 3]),
        (1079, 829_653, [16_141_192, 15_853_912, 13_359_768]),
    ];
    for (row, offset, factors) in rows {
        let values = tables.values(row).unwrap();
        assert_eq!(values.offset(), offset, "row {row}");
        assert_eq!([0, 1, 15].map(|node| values.factors()[node]), factors, "row {row}");
        assert_eq!(values.factors().len(), 31);
    }
}

#[test]
fn the_coordinates_of_rows_are_the_golden_ones() {
    let tables = golden_table();
    let rows = [
        (0, [36_950_154_368, 37_208_377_658, 53_331_655_808, 257_457_003_471, 478_177_577_026]),
        (31, [32_569_260_736, 32_828_765_506, 49_050_614_464, 257_453_815_241, 482_558_421_819]),
        (32, [32_433_416_064, 32_692_960_265, 48_917_837_696, 257_453_662_479, 482_694_156_146]),
        (539, [0, 268_435_456, 17_179_869_184, 257_429_602_304, 515_127_640_064]),
        (1079, [36_950_309_952, 37_208_533_114, 53_331_803_200, 257_456_999_312, 478_177_388_674]),
    ];
    for (row, coordinates) in rows {
        let values = tables.values(row).unwrap();
        assert_eq!([0, 1, 64, 959, 1919].map(|column| values.coordinate(column)), coordinates, "row {row}");
    }
}

#[test]
fn all_coordinates_of_the_frame_are_the_golden_ones() {
    let tables = golden_table();
    assert_eq!(crc32(coordinates(&tables).into_iter().map(u64::to_le_bytes)), 0xd524_3365);
    assert_eq!(crc_of_q(&tables), 0x8843_444e);
}

#[test]
fn the_frame_is_corrected_to_the_golden_one_by_every_path() {
    let tables = golden_table();
    let input = frame(tables.geometry(), golden_samples(tables.geometry()));
    for (interpolant, expected) in [(Interpolant::Hermite, 0x45ce_11e7), (Interpolant::Keys, 0xc3d6_56e3)] {
        assert_corrected(&tables, interpolant, &input, expected);
    }
}

fn assert_corrected(tables: &TableSet, interpolant: Interpolant, input: &Frame, expected: u32) {
    let kernel = Kernel::from(interpolant);
    assert_eq!(crc_of_frame(&correct(tables, &kernel, input).unwrap()), expected, "{interpolant}");
    for path in ModelPath::available() {
        let corrected = Corrector::new(path, &kernel).unwrap().correct(tables, input).unwrap();
        assert_eq!(crc_of_frame(&corrected), expected, "{interpolant}, {path}");
    }
}

#[test]
fn one_factor_a_row_has_the_golden_coordinates_in_finer_units() {
    let lens = Equidistant::from_radius(1106.697).unwrap();
    let tables = TableSet::from_lens(Geometry::default(), &lens, None).unwrap();
    assert_eq!(crc32(coordinates(&tables).into_iter().map(u64::to_le_bytes)), 0x2074_7eed);
}

#[test]
fn drawn_grids_have_the_golden_coordinates() {
    use Drawn::{Legal, Narrow, Wide};
    let grids = [
        ((128, 9, 127), (1, 5), (0, Narrow), [0xf3f8_7b0c, 0x45fa_e881, 0x01ec_a8fe]),
        ((128, 70, 100), (6, 6), (1, Narrow), [0xdb24_8d53, 0x2617_fe6d, 0x7aa7_0b1a]),
        ((130, 40, 31), (3, 5), (2, Wide), [0x27d8_4e57, 0x21b5_19cd, 0x57d2_02ca]),
        ((192, 5, 382), (2, 6), (3, Wide), [0x9f8f_1aa6, 0xc53e_6168, 0xd986_2215]),
        ((128, 9, 127), (1, 5), (4, Legal), [0xeb9a_29e3, 0x538a_7945, 0x4b36_8c58]),
        ((192, 70, 191), (6, 6), (5, Legal), [0x415e_6db8, 0x3743_6daa, 0x7ab6_d91a]),
        ((130, 40, 129), (3, 5), (6, Legal), [0x1cff_5b88, 0x3ec8_01f0, 0x2900_a4ec]),
    ];
    for ((width, height, centre2), (v, k), (seed, kind), expected) in grids {
        let geometry = Geometry::new(width, height, BitDepth::Twelve, centre2).unwrap();
        let tables = drawn(geometry, GridShape::new(v, k).unwrap(), seed, kind);
        let coordinates = crc32(coordinates(&tables).into_iter().map(u64::to_le_bytes));
        let found = [crc32fast::hash(&tables.to_bytes()), coordinates, crc_of_q(&tables)];
        assert_eq!(found, expected, "seed {seed}");
    }
}

#[test]
fn frames_are_corrected_by_drawn_grids_to_the_golden_ones() {
    for ((width, height, centre2), (v, k), seed, expected) in [
        ((128, 9, 127), (1, 5), 4, 0x825e_7ff5),
        ((192, 70, 191), (6, 6), 5, 0x6dd2_1ae8),
        ((130, 40, 129), (3, 5), 6, 0x44c8_4c7b),
    ] {
        let geometry = Geometry::new(width, height, BitDepth::Twelve, centre2).unwrap();
        let tables = drawn(geometry, GridShape::new(v, k).unwrap(), seed, Drawn::Legal);
        let input = frame(tables.geometry(), golden_samples(tables.geometry()));
        assert_corrected(&tables, Interpolant::Hermite, &input, expected);
    }
}
