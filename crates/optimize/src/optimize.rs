//! Optimisation of a container.

use std::path::Path;

use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::params::Params;
use opendr_engine::{Device, Error, Progress, Result, ResultExt};
use opendr_inference::Session;
use opendr_inference::recording::Recording;
use opendr_onnx::passes::{constants_to_initializers, weights_to_fp16};
use opendr_onnx::proto::ModelProto;
use opendr_onnx::{bytes_from_model, model_from_bytes};

use crate::options::{OptimizeOptions, Precision};
use crate::quantise::{Quantiser, check_version};
use crate::report::{Accuracy, Report};

/// A value of a metric.
#[derive(Debug, Clone, PartialEq)]
pub struct MetricValue {
    /// Key of the value, e.g. `"map50"`.
    pub name: String,
    /// The value.
    pub value: f64,
    /// Whether lower is better.
    pub is_error: bool,
}

/// A function that measures a model.
pub type MeasureFn<'a> = dyn FnMut(&Model) -> Result<MetricValue> + 'a;

/// One in this many layers returns to floats at a time.
const FLOAT_LAYERS_DIVISOR: usize = 8;

/// Writes `model` to `output` with its networks in the precision of `options`.
///
/// `recordings` are the inputs of the learner's sessions, from which the ranges for `int8` follow; each is assigned
/// to the network of the container with the same declared inputs and outputs. `judge` measures the model before and
/// after, where there is validation data.
///
/// # Errors
/// `InvalidParam` for invalid options, `InvalidInput` without recordings, `Unsupported` for a network that cannot be
/// quantised, and the errors of `judge`.
pub fn optimize(
    model: &Model,
    options: &OptimizeOptions,
    recordings: &[Recording],
    mut judge: Option<&mut MeasureFn<'_>>,
    device: Device,
    output: &Path,
    progress: &dyn Progress,
) -> Result<Report> {
    options.check()?;
    if options.max_drop.is_some() && judge.is_none() {
        return Err(Error::invalid_param("max_drop needs validation data with annotations; pass a data set"));
    }
    let mut networks = networks(model, options, recordings, device, progress)?;
    let before = judge.as_mut().map(|judge| judge(model)).transpose()?;
    loop {
        let written = write(model, &networks, options, output)?;
        let after = judge.as_mut().map(|judge| judge(&written)).transpose()?;
        let measured = before.as_ref().zip(after);
        let drop = measured.as_ref().map_or(0.0, |(before, after)| {
            if before.is_error { after.value - before.value } else { before.value - after.value }
        });
        let accuracy = measured.map(|(before, after)| Accuracy {
            metric: before.name.clone(),
            before: before.value,
            after: after.value,
        });
        if drop > options.max_drop.unwrap_or(f64::INFINITY) {
            progress.note(&format!("the metric is worse by {drop:.4}: more layers stay in floats"));
            let kept = networks.iter_mut().map(Network::keep_worst).filter(|kept| *kept).count();
            if kept > 0 {
                continue;
            }
        }
        return report(model, &written, &networks, options, accuracy, recordings.len());
    }
}

/// An ONNX file of a container.
struct Network<'a> {
    name: String,
    kind: Kind<'a>,
}

enum Kind<'a> {
    Half(Box<ModelProto>),
    Bytes(Box<Quantiser<'a>>),
}

impl Network<'_> {
    fn keep_worst(&mut self) -> bool {
        match &mut self.kind {
            Kind::Half(_) => false,
            Kind::Bytes(quantiser) => {
                let count = quantiser.layer_count().div_ceil(FLOAT_LAYERS_DIVISOR);
                quantiser.keep_worst(count)
            }
        }
    }

    fn bytes(&self) -> Result<Vec<u8>> {
        match &self.kind {
            Kind::Half(network) => Ok(bytes_from_model(network)),
            Kind::Bytes(quantiser) => Ok(bytes_from_model(&quantiser.network()?)),
        }
    }
}

fn networks<'a>(
    model: &Model,
    options: &'a OptimizeOptions,
    recordings: &'a [Recording],
    device: Device,
    progress: &dyn Progress,
) -> Result<Vec<Network<'a>>> {
    let names = model.manifest().files.iter().map(|file| &file.name);
    let names: Vec<_> = names.filter(|name| name.to_lowercase().ends_with(".onnx")).collect();
    if names.is_empty() {
        return Err(Error::unsupported(format!("the model {} has no ONNX network", model.path().display())));
    }
    let network = |name: &String| -> Result<Network<'a>> {
        let bytes = model.file(name)?;
        let mut network = model_from_bytes(&bytes)?;
        let kind = match options.precision {
            Precision::Fp16 => {
                if let Some(graph) = &mut network.graph {
                    constants_to_initializers(graph);
                    weights_to_fp16(graph);
                }
                Kind::Half(Box::new(network))
            }
            Precision::Int8 => {
                check_version(&network)?;
                let own = of_network(recordings, &Session::open(&bytes, device)?);
                Kind::Bytes(Box::new(Quantiser::new(network, own, options, device, progress)?))
            }
        };
        Ok(Network { name: name.clone(), kind })
    };
    names.iter().map(|name| network(name).context(|| format!("the network {name}"))).collect()
}

/// Returns the recordings of a network, identified by its declared inputs and outputs.
fn of_network<'a>(recordings: &'a [Recording], network: &Session) -> Vec<&'a Recording> {
    let is_own = |recording: &&Recording| {
        recording.inputs == network.inputs() && recording.outputs == network.outputs()
    };
    recordings.iter().filter(is_own).collect()
}

fn write(model: &Model, networks: &[Network<'_>], options: &OptimizeOptions, output: &Path) -> Result<Model> {
    let mut manifest = model.manifest().clone();
    // The metrics belong to the original weights.
    manifest.metrics.clear();
    let steps =
        [manifest.lineage.importer.as_str(), &format!("opendr optimize --{}", options.precision.name())];
    manifest.lineage.importer =
        steps.into_iter().filter(|step| !step.is_empty()).collect::<Vec<_>>().join("; ");
    let mut writer = ModelWriter::new(output, manifest)?;
    for file in &model.manifest().files {
        match networks.iter().find(|network| network.name == file.name) {
            Some(network) => writer.add(&file.name, &network.bytes()?)?,
            None => writer.add(&file.name, &model.file(&file.name)?)?,
        }
    }
    writer.finish()
}

fn report(
    model: &Model,
    written: &Model,
    networks: &[Network<'_>],
    options: &OptimizeOptions,
    accuracy: Option<Accuracy>,
    samples: usize,
) -> Result<Report> {
    let size = |model: &Model| -> Result<u64> {
        let sizes = networks.iter().map(|network| Ok(model.file(&network.name)?.len() as u64));
        sizes.sum()
    };
    let mut layers = Vec::new();
    for network in networks {
        if let Kind::Bytes(quantiser) = &network.kind {
            layers.extend(quantiser.reports()?);
        }
    }
    let precision = options.precision.name().to_owned();
    Ok(Report { precision, bytes: [size(model)?, size(written)?], accuracy, samples, layers })
}
