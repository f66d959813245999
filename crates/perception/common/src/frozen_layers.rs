//! The frozen first layers of a network that trains.

use burn::module::Module;
use burn::tensor::{Device, Tensor, TensorData};
use opendr_engine::learner::FitJob;
use opendr_engine::{Device as Place, Error, Result};
use opendr_inference::{Session, TensorView};
use opendr_training::export::{self, Input, Outputs};
use opendr_training::training_device;

/// Layers that keep their weights, run as they will be after the training: by the inference runtime, which folds what can be
/// folded and keeps nothing for a gradient.
#[derive(Debug)]
pub struct FrozenLayers(Session);

/// Returns whether the job trains where the inference runtime runs frozen layers.
///
/// # Errors
/// `InvalidParam` for an environment that names no device.
pub fn is_on_processor(job: &FitJob<'_>) -> Result<bool> {
    Ok(training_device(job.device)? == Device::flex())
}

impl FrozenLayers {
    /// Exports the layers that `forward` runs for pictures of `[width, height]`; `names` are for its outputs.
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

    /// Returns what they answer to `images`, `[batch, 3, height, width]`, in the order of the names.
    pub fn run(&self, images: &[f32], shape: [usize; 4], device: &Device) -> Result<Vec<Tensor<4>>> {
        let mut answers = Vec::with_capacity(self.0.outputs().len());
        self.0.run(&[TensorView::new(&shape, images)?], |outputs| {
            for output in outputs {
                let shape: [usize; 4] = output.shape().try_into().map_err(|_| {
                    Error::internal(format!("frozen layers answered {:?}; please report it", output.shape()))
                })?;
                let data = TensorData::new(output.values::<f32>()?.to_vec(), shape);
                answers.push(Tensor::from_data(data, device));
            }
            Ok(())
        })?;
        Ok(answers)
    }
}
