//! Options of an optimisation.

use opendr_engine::params::Params;

opendr_engine::choices! {
    /// Precision of weights and arithmetic.
    pub enum Precision {
        /// Weights and activations in 8 bits: a quarter of the size.
        Int8 = "int8",
        /// Weights in 16 bits, arithmetic unchanged: half the size.
        Fp16 = "fp16",
    }
}

opendr_engine::choices! {
    /// Method that determines the range of a tensor from its observed values.
    pub enum Calibration {
        /// The range with the least mean squared error of rounding and clipping.
        LeastSquares = "least_squares",
        /// From the smallest to the largest value.
        MinMax = "min_max",
        /// Without the smallest and the largest values, one in ten thousand each.
        Percentile = "percentile",
        /// The range with the least Kullback-Leibler divergence from the original distribution (Migacz, 8-bit
        /// inference with TensorRT, 2017).
        Entropy = "entropy",
    }
}

/// Options of an optimisation.
#[derive(Debug, Clone, Params)]
pub struct OptimizeOptions {
    /// Precision of weights and arithmetic.
    pub precision: Precision,
    /// Method that determines the range of a tensor from its observed values; `int8` only.
    pub calibration: Calibration,
    /// Maximum number of calibration samples from the data set; `int8` only.
    #[param(default = 64, range = 1..=100_000)]
    pub samples: usize,
    /// Bits of a weight; `int8` only. With 8, sums may overflow on CPUs without VNNI instructions (before 2019).
    #[param(default = 7, range = 2..=8)]
    pub weight_bits: u32,
    /// Layers that stay in floats, by their names in the report; `int8` only.
    #[param(default = Vec::new())]
    pub keep_float: Vec<String>,
    /// Value of the task's metric that is compared, e.g. `map50`; the main one by default.
    pub measured_by: Option<String>,
    /// Maximum loss of the compared value: layers return to floats, those with the largest loss first, until it is
    /// reached; needs data with annotations.
    #[param(range = 0.0..=1e9)]
    pub max_drop: Option<f64>,
}
