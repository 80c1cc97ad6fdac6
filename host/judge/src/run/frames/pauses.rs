//! How long gaps keep the enable off, computed from the seed from which they are drawn (`protocol/WIRE.md`, section 5).

use halfrow_model::xorshift32;

/// For each row of a frame of `height` rows of `width` samples, the board clocks for which gaps keep the enable off.
pub(crate) fn pauses(gap_seed: u32, width: usize, height: usize) -> Vec<u16> {
    if gap_seed == 0 {
        return vec![0; height];
    }
    let mut x = gap_seed;
    let mut draw = || {
        x = xorshift32(x);
        x
    };
    let row = |row| {
        if row > 0 {
            // This draw adds blanking.
            draw();
        }
        let off = (0..width).filter(|_| draw() & 7 == 0).count();
        u16::try_from(off).unwrap_or(u16::MAX)
    };
    (0..height).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected values come from a program in Python.
    #[test]
    fn pauses_are_those_that_another_program_draws() {
        assert_eq!(pauses(1, 64, 4), PYTHON);
        assert_eq!(pauses(0, 64, 2), [0, 0]);
    }

    const PYTHON: [u16; 4] = [6, 15, 9, 10];
}
