//! What a user may choose.

use opendr_engine::params::Params;

opendr_engine::choices! {
    /// In what weights are stored and arithmetic is done.
    pub enum Precision {
        /// Weights and values between layers in 8 bits: a quarter of the size.
        Int8 = "int8",
        /// Weights in 16 bits, arithmetic as before: half the size.
        Fp16 = "fp16",
    }
}

opendr_engine::choices! {
    /// How the range of a tensor follows from the values seen.
    pub enum Calibration {
        /// The range whose rounding and clipping lose the least, by the mean of the squares.
        LeastSquares = "least_squares",
        /// From the smallest to the largest value.
        MinMax = "min_max",
        /// Without the smallest and the largest values, one in ten thousand each.
        Percentile = "percentile",
        /// The range whose distribution differs least from the original (Kullback-Leibler; Migacz, 8-bit inference with
        /// TensorRT, 2017).
        Entropy = "entropy",
    }
}

/// How a model is made smaller.
#[derive(Debug, Clone, Params)]
pub struct OptimizeOptions {
    /// In what weights are stored and arithmetic is done.
    pub precision: Precision,
    /// How the range of a tensor follows from the values seen; of `int8` only.
    pub calibration: Calibration,
    /// At most so many samples of the data set are seen; of `int8` only.
    #[param(default = 64, range = 1..=100_000)]
    pub samples: usize,
    /// Bits of a weight, of `int8` only: with 8, processors without VNNI instructions (before 2019) may overflow.
    #[param(default = 7, range = 2..=8)]
    pub weight_bits: u32,
    /// Layers that stay in floats, by the names that the report has; of `int8` only.
    #[param(default = Vec::new())]
    pub keep_float: Vec<String>,
    /// The number of the task's metric that counts, e.g. `map50`; its main one where none is named.
    pub measured_by: Option<String>,
    /// Layers go back to floats, those that lose most first, until the number that counts is worse by at most this; needs data
    /// with annotations.
    #[param(range = 0.0..=1e9)]
    pub max_drop: Option<f64>,
}
