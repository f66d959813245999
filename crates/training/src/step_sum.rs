//! The batches of an optimiser step: sums of gradients, and their form as bytes for other processes.

use burn::tensor::Device;
use opendr_engine::Result;

use crate::gradients::NetworkGradients;
use crate::payload::{floats, number, take, write_floats};
use crate::traversal::AnyModule;

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
    pub gradients: NetworkGradients,
}

/// Sums over the batches of a step, in their order.
#[derive(Default)]
pub struct StepSum {
    /// Sum of the gradients.
    pub gradients: NetworkGradients,
    statistics: Vec<Vec<f64>>,
    /// The losses.
    pub losses: Vec<f64>,
    /// Number of samples.
    pub samples: usize,
}

impl StepSum {
    /// Adds the next batch.
    pub fn add(&mut self, batch: BatchResult) {
        self.gradients.add(batch.gradients);
        self.losses.push(batch.loss);
        self.samples += batch.samples;
        if self.statistics.is_empty() {
            self.statistics = batch.statistics.iter().map(|values| vec![0.0; values.len()]).collect();
        }
        for (sums, values) in self.statistics.iter_mut().zip(&batch.statistics) {
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += f64::from(*value));
        }
    }

    /// Returns the means of the running statistics.
    pub fn statistics(&self) -> Vec<Vec<f32>> {
        let count = self.losses.len().max(1) as f64;
        let mean = |sums: &Vec<f64>| sums.iter().map(|sum| (sum / count) as f32).collect();
        self.statistics.iter().map(mean).collect()
    }
}

impl BatchResult {
    /// Appends the bytes of the batch.
    pub fn write(self, bytes: &mut Vec<u8>) {
        bytes.extend((self.number as u64).to_le_bytes());
        bytes.extend((self.samples as u64).to_le_bytes());
        bytes.extend(self.loss.to_le_bytes());
        self.statistics.iter().for_each(|values| write_floats(values, bytes));
        self.gradients.write(bytes);
    }

    /// Reads a batch from the beginning of `bytes`, which are moved past it. `statistics` have the sizes of those of the batch.
    ///
    /// # Errors
    /// `Format` where the bytes are not those of a batch of this network.
    pub fn read(
        network: &dyn AnyModule,
        device: &Device,
        statistics: &[Vec<f32>],
        bytes: &mut &[u8],
    ) -> Result<Self> {
        let (number, samples) = (number(bytes)? as usize, number(bytes)? as usize);
        let loss = f64::from_le_bytes(take(bytes)?);
        let read = statistics.iter().map(|values| floats(bytes, values.len()));
        let statistics = read.collect::<Result<_>>()?;
        let gradients = NetworkGradients::read(network, device, bytes)?;
        Ok(Self { number, samples, loss, statistics, gradients })
    }
}
