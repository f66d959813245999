//! What became of a model.

use std::fmt;

use serde::Serialize;

/// What became of a model. Printed, it is a table.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Report {
    /// `int8` or `fp16`.
    pub precision: String,
    /// Bytes of the network's files before and after.
    pub bytes: [u64; 2],
    /// The metric's main number before and after, and its name, where there was data with annotations.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Samples that ranges were taken from.
    pub samples: usize,
    /// Layers with weights, in the order of the network; of `int8` only.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<LayerReport>,
}

/// A metric's main number.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Accuracy {
    /// Its key, e.g. `"map50"`.
    pub metric: String,
    /// Of the model as it was.
    pub before: f64,
    /// Of the model that was written.
    pub after: f64,
}

/// What became of a layer. Ratios are of the signal's power to that of what was lost, in decibels: 6 are a bit.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct LayerReport {
    /// The name of what it gives, to be used in `keep_float`.
    pub name: String,
    /// The operator.
    pub op: String,
    /// How many weights it has.
    pub weights: usize,
    /// Of its weights, rounded.
    pub weight_ratio: f64,
    /// Of what it is given, rounded.
    pub input_ratio: f64,
    /// Of what it gives, after all the roundings before.
    pub output_ratio: f64,
    /// Whether it stays in floats.
    pub is_float: bool,
}

impl LayerReport {
    /// What is lost by rounding this layer alone, as a ratio like the others: its two losses together.
    pub fn own_ratio(&self) -> f64 {
        let loss = |ratio: f64| 10f64.powf(-ratio / 10.0);
        -10.0 * (loss(self.weight_ratio) + loss(self.input_ratio)).log10()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [before, after] = self.bytes;
        let share = after as f64 / before.max(1) as f64;
        writeln!(f, "{}: {before} bytes became {after} ({share:.3})", self.precision)?;
        if let Some(Accuracy { metric, before, after }) = &self.accuracy {
            writeln!(f, "{metric}: {before:.4} became {after:.4} ({:+.4})", after - before)?;
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
                writeln!(f, "{:>46.1}  float", layer.output_ratio)?;
            } else {
                let LayerReport { weight_ratio, input_ratio, output_ratio, .. } = layer;
                writeln!(f, "{:22} {weight_ratio:>7.1} {input_ratio:>6.1} {output_ratio:>6.1}", "")?;
            }
        }
        Ok(())
    }
}
