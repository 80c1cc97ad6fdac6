//! The numbers that the paper prints, with which ours are compared.

use halfrow_model::Interpolant;

/// The photographs of Table 1.
pub(super) const PHOTOGRAPHS: usize = 24;

/// The methods of Table 1, in its order.
pub(super) const METHODS: [Interpolant; 3] = [Interpolant::Linear, Interpolant::Keys, Interpolant::Hermite];

/// Table 1: the PSNR of each photograph by each of [`METHODS`], in dB.
pub(super) const TABLE_1: [[f64; 3]; PHOTOGRAPHS] = [
    [28.3397, 28.6264, 31.1430],
    [34.6072, 34.7776, 36.8320],
    [37.2506, 37.9944, 40.4508],
    [34.8381, 35.3573, 37.6632],
    [27.7612, 28.2699, 30.9813],
    [32.0905, 32.4734, 34.8706],
    [35.2795, 36.0861, 38.6636],
    [24.4214, 24.6689, 27.0478],
    [33.9174, 34.3457, 36.7068],
    [33.5049, 34.1129, 36.6462],
    [32.3943, 32.8305, 35.2668],
    [35.3424, 35.8074, 38.1037],
    [26.4063, 26.6969, 29.1076],
    [31.8545, 32.3717, 34.8103],
    [31.5073, 31.8176, 33.9694],
    [37.8926, 38.5464, 41.0116],
    [32.9059, 33.3530, 35.8067],
    [29.5375, 29.8183, 32.2079],
    [29.9253, 30.2310, 32.3098],
    [33.0676, 33.5107, 35.7215],
    [31.6363, 32.0334, 34.5214],
    [31.9587, 32.3180, 34.6598],
    [36.8203, 37.7203, 40.1037],
    [27.9189, 28.2316, 30.5792],
];

/// The last row of Table 1: the averages, in dB.
pub(super) const TABLE_1_AVERAGES: [f64; 3] = [32.1324, 32.5833, 34.9660];

/// How far a photograph's PSNR may be from Table 1, in dB. The paper leaves rounding and edges open.
pub(super) const PSNR_TOLERANCE: f64 = 0.2;

/// How far an average may be from Table 1, in dB.
pub(super) const AVERAGE_TOLERANCE: f64 = 0.05;

/// How far an average in integers may be from the one in double precision, in dB.
pub(super) const INTEGER_TOLERANCE: f64 = 0.01;

/// Sect. 3.2: the mean error of the simplified projection at R = 100, in pixels, of the whole image and of its middle 16 : 9
/// part.
pub(super) const MEAN_ERRORS: [f64; 2] = [2.38, 0.80];

/// How far a mean error may be from the paper's, in pixels. The paper prints two decimals.
pub(super) const MEAN_ERROR_TOLERANCE: f64 = 0.01;

/// Sect. 4.2: the longest delay of half a row of 1080p30, in milliseconds.
pub(super) const DELAY_MS: f64 = 0.02;

/// Sect. 4.2: the mean share of the LX25's resources stays below this, in percent.
pub(super) const RESOURCES_PERCENT: f64 = 10.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// The table's own averages show whether it was copied correctly.
    #[test]
    fn the_columns_of_table_1_have_its_averages() {
        for (method, average) in TABLE_1_AVERAGES.into_iter().enumerate() {
            let sum: f64 = TABLE_1.iter().map(|row| row[method]).sum();
            let found = sum / PHOTOGRAPHS as f64;
            assert!((found - average).abs() < 6e-5, "method {method}: {found} for {average}");
        }
    }
}
