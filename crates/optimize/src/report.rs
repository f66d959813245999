//! Report of an optimisation.

use std::fmt;

use opendr_engine::JsonFormat;
use serde::Serialize;

/// Report of an optimisation. `Display` writes a table.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Report {
    /// `int8` or `fp16`.
    pub precision: String,
    /// Size of the network files before and after, in bytes.
    pub bytes: [u64; 2],
    /// Main value of the metric before and after, where there was validation data.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Number of calibration samples.
    pub samples: usize,
    /// Layers with weights, in the order of the network; `int8` only.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<LayerReport>,
}

/// Main value of a metric before and after.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Accuracy {
    /// Key of the value, e.g. `"map50"`.
    pub metric: String,
    /// Value of the original model.
    pub before: f64,
    /// Value of the written model.
    pub after: f64,
}

/// Quantisation loss of a layer. Ratios are signal-to-noise ratios in decibels; 6 dB correspond to one bit.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct LayerReport {
    /// Name of its output, for use in `keep_float`.
    pub name: String,
    /// The operator.
    pub op: String,
    /// Number of weights.
    pub weights: usize,
    /// Ratio of its quantised weights.
    pub weight_snr_db: f64,
    /// Ratio of its quantised input.
    pub input_snr_db: f64,
    /// Ratio of its output, after all preceding quantisation.
    pub output_snr_db: f64,
    /// Whether it stays in floats.
    pub is_float: bool,
}

impl LayerReport {
    /// Returns the ratio for the quantisation of this layer alone, from both its losses.
    pub fn layer_snr_db(&self) -> f64 {
        let loss = |ratio: f64| 10f64.powf(-ratio / 10.0);
        -10.0 * (loss(self.weight_snr_db) + loss(self.input_snr_db)).log10()
    }
}

impl Report {
    /// Format of the report as JSON. Version 2 renamed the ratios of a layer to `..._snr_db`.
    pub const FORMAT: JsonFormat = JsonFormat::new("report of an optimisation", 2);
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [before, after] = self.bytes;
        let share = after as f64 / before.max(1) as f64;
        writeln!(f, "{}: {before} -> {after} bytes ({share:.3})", self.precision)?;
        if let Some(Accuracy { metric, before, after }) = &self.accuracy {
            writeln!(f, "{metric}: {before:.4} -> {after:.4} ({:+.4})", after - before)?;
        }
        if self.layers.is_empty() {
            return Ok(());
        }
        let width = self.layers.iter().map(|layer| layer.name.chars().count()).max().unwrap_or(0);
        writeln!(
            f,
            "\n  {:width$}  {:8}  {:>9}  signal to noise, dB: {:>7} {:>6} {:>6}",
            "layer", "operator", "weights", "weights", "input", "output"
        )?;
        for layer in &self.layers {
            write!(f, "  {:width$}  {:8}  {:>9}", layer.name, layer.op, layer.weights)?;
            if layer.is_float {
                writeln!(f, "{:>46.1}  float", layer.output_snr_db)?;
            } else {
                let LayerReport {
                    weight_snr_db: weight_ratio,
                    input_snr_db: input_ratio,
                    output_snr_db: output_ratio,
                    ..
                } = layer;
                writeln!(f, "{:22} {weight_ratio:>7.1} {input_ratio:>6.1} {output_ratio:>6.1}", "")?;
            }
        }
        Ok(())
    }
}
