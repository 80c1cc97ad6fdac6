//! Pictures that a decoder would take for others without a word.

use halfrow_frames::decode;
use halfrow_model::BitDepth;

use crate::pictures::{options, oriented};

/// In the place of the orientation, whose tag comes later.
#[test]
fn a_tiff_of_reversed_bits_is_refused() {
    let with_fill_order = |value: u16| {
        let mut file = oriented(1, 3, 8);
        let [places, orientation] = [5, 6].map(|entry| 8 + 2 + 12 * entry);
        let strip = file[places..orientation].to_vec();
        file[orientation..orientation + 12].copy_from_slice(&strip);
        let fill_order = [266, 3, 1, 0, value, 0].map(u16::to_le_bytes).concat();
        file[places..places + 12].copy_from_slice(&fill_order);
        decode(&file, &options(BitDepth::Eight))
    };
    assert_eq!(with_fill_order(1).unwrap().samples(), [1, 2, 3, 4, 5, 6, 7, 8]);
    let error = with_fill_order(2).unwrap_err().to_string();
    assert_eq!(
        error,
        "a TIFF whose bits are in another order (FillOrder 2) cannot be used; save it with FillOrder 1"
    );
}
