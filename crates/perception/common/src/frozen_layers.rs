//! Frozen first layers of a network in training.

use burn::module::Module;
use burn::tensor::{Device, Tensor, TensorData};
use opendr_engine::learner::FitJob;
use opendr_engine::{Device as Place, Error, Result};
use opendr_inference::{Session, TensorView};
use opendr_training::export::{self, Input, Outputs};
use opendr_training::training_device;

/// Layers whose weights do not train. The inference runtime runs them, as after the training: with folded constants and
/// without gradients.
#[derive(Debug)]
pub struct FrozenLayers(Session);

/// Returns whether the job trains on the CPU, where the inference runtime runs frozen layers.
///
/// # Errors
/// `InvalidParam` when the environment variable names no device.
pub fn is_on_cpu(job: &FitJob<'_>) -> Result<bool> {
    Ok(training_device(job.device)? == Device::flex())
}

impl FrozenLayers {
    /// Exports the layers of `forward` for images of `[width, height]`; `names` are those of its outputs.
    pub fn new<M: Module, O: Outputs>(
        network: &M,
        [width, height]: [usize; 2],
        names: &[&str],
        forward: impl Fn(&M, Tensor<4>) -> O,
    ) -> Result<Self> {
        let input = Input::new("image", [1, 3, height, width]).open(0);
        let model = export::onnx(network, input, names, forward)?;
        Session::open(&model, Place::Cpu).map(Self)
    }

    /// Returns the outputs for `images`, `[batch, 3, height, width]`, in the order of the names.
    pub fn run(&self, images: &[f32], shape: [usize; 4], device: &Device) -> Result<Vec<Tensor<4>>> {
        let mut tensors = Vec::with_capacity(self.0.outputs().len());
        self.0.run(&[TensorView::new(&shape, images)?], |outputs| {
            for output in outputs {
                let shape: [usize; 4] = output.shape().try_into().map_err(|_| {
                    Error::internal(format!(
                        "the frozen layers have an output of shape {:?}; please report it",
                        output.shape()
                    ))
                })?;
                let data = TensorData::new(output.values::<f32>()?.to_vec(), shape);
                tensors.push(Tensor::from_data(data, device));
            }
            Ok(())
        })?;
        Ok(tensors)
    }
}
