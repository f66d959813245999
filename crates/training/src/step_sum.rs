//! The batches of an optimiser step: sums of gradients, and their form as bytes for other processes.

use burn::module::{Module, ModuleVisitor, Param};
use burn::optim::{GradientsAccumulator, GradientsParams};
use burn::tensor::{Device, Tensor, TensorData};
use opendr_engine::{Error, Result};

/// What a batch adds to a step.
pub struct BatchResult {
    /// Number of the batch within the step.
    pub number: usize,
    /// Number of samples.
    pub samples: usize,
    /// The loss.
    pub loss: f64,
    /// Running statistics after the batch, from those before the step.
    pub statistics: Vec<Vec<f32>>,
    /// Gradients of the batch's part of the loss.
    pub gradients: GradientsParams,
}

/// Sums over the batches of a step, in their order.
pub struct StepSum<M> {
    gradients: GradientsAccumulator<M>,
    statistics: Vec<Vec<f64>>,
    /// The losses.
    pub losses: Vec<f64>,
    /// Number of samples.
    pub samples: usize,
}

impl<M> Default for StepSum<M> {
    fn default() -> Self {
        let gradients = GradientsAccumulator::new();
        Self { gradients, statistics: Vec::new(), losses: Vec::new(), samples: 0 }
    }
}

impl<M: Module> StepSum<M> {
    /// Adds the next batch.
    pub fn add(&mut self, network: &M, batch: BatchResult) {
        self.gradients.accumulate(network, batch.gradients);
        self.losses.push(batch.loss);
        self.samples += batch.samples;
        if self.statistics.is_empty() {
            self.statistics = batch.statistics.iter().map(|values| vec![0.0; values.len()]).collect();
        }
        for (sums, values) in self.statistics.iter_mut().zip(&batch.statistics) {
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += f64::from(*value));
        }
    }

    /// Returns the sum of the gradients, and the means of the running statistics.
    pub fn finish(&mut self) -> (GradientsParams, Vec<Vec<f32>>) {
        let count = self.losses.len().max(1) as f64;
        let mean = |sums: &Vec<f64>| sums.iter().map(|sum| (sum / count) as f32).collect();
        (self.gradients.grads(), self.statistics.iter().map(mean).collect())
    }
}

impl BatchResult {
    /// Appends the bytes of the batch.
    pub fn write<M: Module>(&self, network: &M, bytes: &mut Vec<u8>) {
        bytes.extend((self.number as u64).to_le_bytes());
        bytes.extend((self.samples as u64).to_le_bytes());
        bytes.extend(self.loss.to_le_bytes());
        for values in &self.statistics {
            bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
        network.visit(&mut WriteGradients { gradients: &self.gradients, bytes });
    }

    /// Reads a batch from the beginning of `bytes`, which are moved past it. `statistics` have the sizes of those of the batch.
    ///
    /// # Errors
    /// `Format` where the bytes are not those of a batch of this network.
    pub fn read<M: Module>(
        network: &M,
        device: &Device,
        statistics: &[Vec<f32>],
        bytes: &mut &[u8],
    ) -> Result<Self> {
        let number = u64::from_le_bytes(take(bytes)?) as usize;
        let samples = u64::from_le_bytes(take(bytes)?) as usize;
        let loss = f64::from_le_bytes(take(bytes)?);
        let read = statistics.iter().map(|values| floats(bytes, values.len()));
        let statistics = read.collect::<Result<_>>()?;
        let mut read = ReadGradients { gradients: GradientsParams::new(), device, bytes, error: None };
        network.visit(&mut read);
        match read.error {
            Some(error) => Err(error),
            None => Ok(Self { number, samples, loss, statistics, gradients: read.gradients }),
        }
    }
}

/// Returns the error of a payload that is too short.
pub fn truncated() -> Error {
    Error::format("the payload of another process of the training is cut off")
}

/// Takes `N` bytes.
///
/// # Errors
/// `Format` where there are fewer.
pub fn take<const N: usize>(bytes: &mut &[u8]) -> Result<[u8; N]> {
    let (taken, rest) = bytes.split_first_chunk::<N>().ok_or_else(truncated)?;
    *bytes = rest;
    Ok(*taken)
}

fn floats(bytes: &mut &[u8], count: usize) -> Result<Vec<f32>> {
    let (taken, rest) = bytes.split_at_checked(4 * count).ok_or_else(truncated)?;
    *bytes = rest;
    Ok(taken.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
}

struct WriteGradients<'a> {
    gradients: &'a GradientsParams,
    bytes: &'a mut Vec<u8>,
}

impl ModuleVisitor for WriteGradients<'_> {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        if !param.val().is_require_grad() {
            return;
        }
        let gradient = self.gradients.get::<D>(param.id);
        self.bytes.push(u8::from(gradient.is_some()));
        if let Some(gradient) = gradient {
            self.bytes.extend(gradient.into_data().iter::<f32>().flat_map(f32::to_le_bytes));
        }
    }
}

struct ReadGradients<'a, 'b> {
    gradients: GradientsParams,
    device: &'a Device,
    bytes: &'a mut &'b [u8],
    error: Option<Error>,
}

impl ModuleVisitor for ReadGradients<'_, '_> {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let value = param.val();
        if !value.is_require_grad() || self.error.is_some() {
            return;
        }
        let shape = value.dims();
        let values = match take(self.bytes) {
            Ok([0]) => return,
            Ok(_) => floats(self.bytes, shape.iter().product()),
            Err(error) => Err(error),
        };
        match values {
            Ok(values) => {
                let gradient = Tensor::<D>::from_data(TensorData::new(values, shape), self.device);
                self.gradients.register(param.id, gradient);
            }
            Err(error) => self.error = Some(error),
        }
    }
}
