//! How close two 8-bit pictures are.

/// PSNR = 10 log10(255² / MSE) in dB (Eq. 19), over all samples of two frames of the same size; infinite if they are equal.
#[must_use]
pub(crate) fn psnr(reference: &[u16], found: &[u16]) -> f64 {
    let squared = |(a, b): (&u16, &u16)| u64::from(a.abs_diff(*b)).pow(2);
    let sum: u64 = reference.iter().zip(found).map(squared).sum();
    let mean = sum as f64 / reference.len() as f64;
    10.0 * (255.0 * 255.0 / mean).log10()
}

#[cfg(test)]
mod tests {
    use super::psnr;

    /// By hand: errors of 0, 3, 4 and 0 have a mean square of 25/4, and 10 log10(65025 / 6.25) = 40.1720; an error of 255
    /// everywhere is 0 dB.
    #[test]
    fn the_ratio_is_that_of_eq_19() {
        assert!((psnr(&[10, 10, 10, 10], &[10, 13, 6, 10]) - 40.1720).abs() < 1e-4);
        assert!(psnr(&[0, 0], &[255, 255]).abs() < 1e-12);
        assert_eq!(psnr(&[7, 8], &[7, 8]), f64::INFINITY);
    }
}
