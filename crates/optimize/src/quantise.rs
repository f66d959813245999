//! INT8 quantisation of a float network with recorded inputs.

use std::collections::{BTreeSet, HashMap};

use opendr_engine::{Device, Error, Progress, Result, Unit};
use opendr_inference::recording::Recording;
use opendr_onnx::passes::{constants_to_initializers, simplify};
use opendr_onnx::proto::{GraphProto, ModelProto};

use crate::histogram::Histogram;
use crate::integer_graph::integer_graph;
use crate::options::OptimizeOptions;
use crate::plan::{Layer, Plan, layers};
use crate::range::{Range, decibels};
use crate::report::LayerReport;
use crate::watched::Watched;
use crate::weights::ByteWeights;

/// First opset with per-channel scales of weights.
const LEAST_OPSET: i64 = 13;
/// Number of samples on which the report compares outputs.
const COMPARED: usize = 8;
/// Maximum number of tensors observed at once; all tensors of a large network do not fit into memory.
const WATCHED: usize = 64;

/// Checks that the opset of a network supports quantisation.
///
/// # Errors
/// `Unsupported` when it is too old.
pub fn check_version(model: &ModelProto) -> Result<()> {
    let opset =
        model.opset_import.iter().find(|opset| opset.domain.is_empty()).map_or(1, |opset| opset.version);
    if opset >= LEAST_OPSET {
        return Ok(());
    }
    Err(Error::unsupported(format!(
        "the network uses ONNX opset {opset}, but int8 needs {LEAST_OPSET} or later; export it again, or use fp16"
    )))
}

/// A network during quantisation.
pub struct Quantiser<'a> {
    model: ModelProto,
    graph: GraphProto,
    layers: Vec<Layer>,
    histograms: HashMap<String, Histogram>,
    recordings: Vec<&'a Recording>,
    options: &'a OptimizeOptions,
    device: Device,
}

impl<'a> Quantiser<'a> {
    /// Observes every tensor of `model` while it runs on `recordings`.
    ///
    /// # Errors
    /// `InvalidInput` without recordings, `InvalidParam` when `keep_float` names an unknown layer, `Unsupported` when
    /// the network has no layer to quantise.
    pub fn new(
        mut model: ModelProto,
        recordings: Vec<&'a Recording>,
        options: &'a OptimizeOptions,
        device: Device,
        progress: &dyn Progress,
    ) -> Result<Self> {
        if recordings.is_empty() {
            return Err(Error::invalid_input(
                "int8 needs calibration samples, and there are none; pass a data set",
            ));
        }
        let mut graph = model.graph.take().unwrap_or_default();
        constants_to_initializers(&mut graph);
        simplify(&mut graph);
        let mut layers = layers(&graph);
        if layers.is_empty() {
            return Err(Error::unsupported(
                "the network has no convolution or matrix product with constant weights; use fp16",
            ));
        }
        for name in &options.keep_float {
            let names = || layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>().join(", ");
            let unknown = Error::invalid_param(format!(
                "keep_float: there is no layer {name:?}; the layers are {}",
                names()
            ));
            layers.iter_mut().find(|layer| layer.name == *name).ok_or(unknown)?.is_float = true;
        }
        let mut quantiser =
            Self { model, graph, layers, histograms: HashMap::new(), recordings, options, device };
        quantiser.watch(progress)?;
        Ok(quantiser)
    }

    /// Counts the values of every tensor that may be quantised.
    fn watch(&mut self, progress: &dyn Progress) -> Result<()> {
        let mut all = self.layers.clone();
        all.iter_mut().for_each(|layer| layer.is_float = false);
        let layer_input = |layer: &Layer| self.graph.node.get(layer.node)?.input.first().cloned();
        // With some layers in floats, their inputs need a range of their own.
        let layer_inputs: Vec<String> = all.iter().filter_map(layer_input).collect();
        let seen: BTreeSet<String> =
            Plan::new(&self.graph, all).observed_tensors().into_iter().chain(layer_inputs).collect();
        let inputs: Vec<String> = self.graph.input.iter().map(|input| input.name.clone()).collect();
        let (given, made): (Vec<_>, Vec<_>) = seen.into_iter().partition(|name| inputs.contains(name));
        for name in given {
            let mut histogram = Histogram::default();
            for recording in &self.recordings {
                let tensors = recording.inputs.iter().zip(&recording.tensors);
                for (_, tensor) in tensors.filter(|(info, _)| info.name == name) {
                    histogram.add(tensor.view()?.values()?);
                }
            }
            self.histograms.insert(name, histogram);
        }
        let batches = made.len().div_ceil(WATCHED);
        progress.begin("calibrating", Some((self.recordings.len() * batches) as u64), Unit::Items);
        let watched = made.chunks(WATCHED).try_for_each(|names| {
            let network = Watched::open(&self.model, &self.graph, names, self.device)?;
            let mut histograms = vec![Histogram::default(); names.len()];
            for recording in &self.recordings {
                network.run(recording, |at, values| {
                    if let Some(histogram) = histograms.get_mut(at) {
                        histogram.add(values);
                    }
                })?;
                progress.advance(1);
                if progress.stopped() {
                    return Err(Error::invalid_input("stopped: nothing was written"));
                }
            }
            self.histograms.extend(names.iter().cloned().zip(histograms));
            Ok(())
        });
        progress.end();
        watched
    }

    fn ranges(&self) -> HashMap<String, Range> {
        let range = |(name, histogram): (&String, &Histogram)| {
            (name.clone(), Range::chosen(histogram, self.options.calibration))
        };
        self.histograms.iter().map(range).collect()
    }

    /// Returns the network in INT8, except for the layers that stay in floats.
    ///
    /// # Errors
    /// `Internal` when a range is missing, which does not occur after the observation.
    pub fn network(&self) -> Result<ModelProto> {
        let plan = Plan::new(&self.graph, self.layers.clone());
        let graph = integer_graph(&self.graph, &plan, &self.ranges(), self.options.weight_bits)?;
        Ok(ModelProto { graph: Some(graph), ..self.model.clone() })
    }

    /// Keeps the `count` quantised layers with the largest loss in floats; returns whether there was one.
    pub fn keep_worst(&mut self, count: usize) -> bool {
        let mut ratios: Vec<(usize, f64)> = (self.own_reports().iter().enumerate())
            .filter(|(_, layer)| !layer.is_float)
            .map(|(at, layer)| (at, layer.layer_snr_db()))
            .collect();
        ratios.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        for (at, _) in ratios.iter().take(count) {
            if let Some(layer) = self.layers.get_mut(*at) {
                layer.is_float = true;
            }
        }
        !ratios.is_empty()
    }

    /// Returns the number of layers.
    pub fn layer_count(&self) -> usize {
        self.layers.len()
    }

    /// Returns the loss of each layer on its own.
    fn own_reports(&self) -> Vec<LayerReport> {
        let ranges = self.ranges();
        let plan = Plan::new(&self.graph, self.layers.clone());
        let shared: HashMap<&String, &String> =
            plan.tensors.iter().map(|(tensor, range)| (tensor, range)).collect();
        let report = |layer: &Layer| {
            let input = self.graph.node.get(layer.node).and_then(|node| node.input.first());
            let range = |input| ranges.get(shared.get(input).copied().unwrap_or(input));
            let seen = input.and_then(|input| self.histograms.get(input).zip(range(input)));
            let weights = ByteWeights::new(&layer.weights, layer.axis, self.options.weight_bits, |_| 0.0);
            LayerReport {
                name: layer.name.clone(),
                op: layer.op.clone(),
                weights: layer.weights.data().len(),
                weight_snr_db: weights.map_or(0.0, |weights| weights.signal_to_noise),
                input_snr_db: seen.map_or(0.0, |(histogram, range)| range.signal_to_noise(histogram)),
                output_snr_db: 0.0,
                is_float: layer.is_float,
            }
        };
        self.layers.iter().map(report).collect()
    }

    /// Returns the loss of each layer on its own, and the loss accumulated up to it.
    ///
    /// # Errors
    /// Those of [`Watched::run`].
    pub fn reports(&self) -> Result<Vec<LayerReport>> {
        let mut reports = self.own_reports();
        let network = self.network()?;
        let quantised = network.graph.as_ref().unwrap_or(&self.graph);
        for reports in reports.chunks_mut(WATCHED) {
            let names: Vec<String> = reports.iter().map(|report| report.name.clone()).collect();
            let before = Watched::open(&self.model, &self.graph, &names, self.device)?;
            let after = Watched::open(&self.model, quantised, &names, self.device)?;
            let mut powers = vec![[0.0; 2]; names.len()];
            for recording in self.recordings.iter().take(COMPARED) {
                let mut signals = Vec::new();
                before.run(recording, |_, values| signals.push(values.to_vec()))?;
                after.run(recording, |at, values| {
                    let signal = signals.get(at).map_or(&[][..], Vec::as_slice);
                    if let Some([power, lost]) = powers.get_mut(at) {
                        *power += signal.iter().map(|value| f64::from(*value).powi(2)).sum::<f64>();
                        *lost +=
                            signal.iter().zip(values).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>();
                    }
                })?;
            }
            for (report, [power, lost]) in reports.iter_mut().zip(powers) {
                report.output_snr_db = decibels(power, lost);
            }
        }
        Ok(reports)
    }
}
