//! What a kernel does to noise.

use halfrow_model::{Kernel, WEIGHT_ONE};

/// For each node the variance of an output, as a multiple of the variance of independent noise in the samples: the sum of the
/// squared weights of all seven taps.
#[must_use]
pub fn noise_gain(kernel: &Kernel) -> Vec<f64> {
    let node = |node: &[i16; 5]| -> f64 {
        let [g0, r1, g4, r5, g6] = node.map(|weight| f64::from(weight) / f64::from(WEIGHT_ONE));
        [g0, r1, 1.0 - g0 - g4 - g6, -r1 - r5, g4, r5, g6].iter().map(|weight| weight * weight).sum()
    };
    kernel.nodes().iter().map(node).collect()
}

#[cfg(test)]
mod tests {
    use halfrow_model::Interpolant;

    use super::noise_gain;

    /// By hand: linear between two samples has (1 − x/2)² + (x/2)²; Hermite at x = 1 weighs 1/2 and 1/2, −1/8, 1/4 and −1/8.
    #[test]
    fn noise_passes_as_the_squares_of_the_weights() {
        let linear = noise_gain(&Interpolant::Linear.into());
        assert_eq!((linear[0], linear[16], linear[32]), (1.0, 0.625, 0.5));
        let hermite = noise_gain(&Interpolant::Hermite.into());
        assert_eq!((hermite[0], hermite[32], hermite[64]), (1.0, 0.5 + 2.0 / 64.0 + 1.0 / 16.0, 1.0));
    }
}
