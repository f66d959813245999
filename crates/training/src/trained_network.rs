//! The network of a training, its average and its objective.

use std::any::Any;

use burn::module::Module;
use burn::optim::{GradientsParams, ModuleOptimizer};
use burn::tensor::Device;
use opendr_datasets::augment::Pipeline;
use opendr_engine::{Error, Result};

use crate::any_collate::{AnyCollate, other_batch};
use crate::average::Towards;
use crate::checkpoint::{AVERAGE, NETWORK, Saved, network_bytes};
use crate::running_statistics::SetStatistics;
use crate::traversal::{AnyModule, changed};
use crate::{Container, Loss, Objective};

/// Network, average and objective of a training. The loop does not know their types, so that it is compiled once.
pub trait TrainedNetwork {
    /// Returns the augmentation of samples before collation, and a collator.
    fn preparation(&self) -> Result<(Pipeline, AnyCollate)>;

    /// Returns the network.
    fn module(&self) -> Result<&dyn AnyModule>;

    /// Returns the loss of a batch.
    fn loss(&self, batch: &dyn Any, device: &Device) -> Result<Loss>;

    /// Runs a forward and a backward pass on a copy of the network, without side effects.
    fn try_step(&self, batch: &dyn Any, device: &Device) -> Result<()>;

    /// Applies the last update of running statistics, which Burn defers.
    fn settle_statistics(&self) -> Result<()>;

    /// Sets the running statistics.
    fn set_statistics(&mut self, statistics: &[Vec<f32>]) -> Result<()>;

    /// Changes the weights by a step of the optimiser.
    fn step(&mut self, optimizer: &mut ModuleOptimizer, lr: f64, gradients: GradientsParams) -> Result<()>;

    /// Moves the average, where there is one, towards the network after step `step`, from 1.
    fn update_average(&mut self, decay: f64, step: u64) -> Result<()>;

    /// Returns the container of the average where there is one, else of the network.
    fn container(&self) -> Result<Container>;

    /// Returns the files of a checkpoint.
    fn files(&self) -> Result<Vec<(&'static str, Vec<u8>)>>;

    /// Loads the files of a checkpoint, as a network in training on `device`.
    fn load(&mut self, saved: &Saved<'_>, device: &Device) -> Result<()>;
}

/// A [`TrainedNetwork`] of known types.
pub struct NetworkOf<'a, O: Objective> {
    objective: &'a O,
    /// The network in training; `None` after an error.
    network: Option<O::Network>,
    average: Option<O::Network>,
}

impl<'a, O: Objective> NetworkOf<'a, O> {
    /// Prepares `network` for training on `device`, with an average if `is_averaged`.
    pub fn new(objective: &'a O, network: O::Network, is_averaged: bool, device: &Device) -> Self {
        let average = is_averaged.then(|| network.valid());
        Self { objective, network: Some(network.to_device(device).train()), average }
    }

    fn network(&self) -> Result<&O::Network> {
        self.network.as_ref().ok_or_else(no_network)
    }

    fn take(&mut self) -> Result<O::Network> {
        self.network.take().ok_or_else(no_network)
    }
}

#[cold]
fn no_network() -> Error {
    Error::internal("the training has no network")
}

impl<O: Objective> TrainedNetwork for NetworkOf<'_, O> {
    fn preparation(&self) -> Result<(Pipeline, AnyCollate)> {
        Ok((self.objective.pipeline()?, AnyCollate::new(self.objective.collate()?)))
    }

    fn module(&self) -> Result<&dyn AnyModule> {
        Ok(self.network()?)
    }

    fn loss(&self, batch: &dyn Any, device: &Device) -> Result<Loss> {
        self.objective.loss(self.network()?, batch.downcast_ref().ok_or_else(other_batch)?, device)
    }

    fn try_step(&self, batch: &dyn Any, device: &Device) -> Result<()> {
        let network = self.network()?.valid().to_device(device).train();
        let loss = self.objective.loss(&network, batch.downcast_ref().ok_or_else(other_batch)?, device)?;
        drop(loss.total.backward());
        Ok(())
    }

    fn settle_statistics(&self) -> Result<()> {
        self.network().map(|network| drop(network.valid()))
    }

    fn set_statistics(&mut self, statistics: &[Vec<f32>]) -> Result<()> {
        self.network = Some(changed(self.take()?, &mut SetStatistics(statistics.iter())));
        Ok(())
    }

    fn step(&mut self, optimizer: &mut ModuleOptimizer, lr: f64, gradients: GradientsParams) -> Result<()> {
        self.network = Some(optimizer.step(lr, self.take()?, gradients));
        Ok(())
    }

    fn update_average(&mut self, decay: f64, step: u64) -> Result<()> {
        if let Some(average) = self.average.take() {
            let mut towards = Towards::new(&self.network()?.valid(), decay, step);
            self.average = Some(changed(average, &mut towards));
        }
        Ok(())
    }

    fn container(&self) -> Result<Container> {
        match &self.average {
            Some(average) => self.objective.container(average),
            None => self.objective.container(&self.network()?.valid()),
        }
    }

    fn files(&self) -> Result<Vec<(&'static str, Vec<u8>)>> {
        let mut files = vec![(NETWORK, network_bytes(self.network()?.valid().into_record())?)];
        if let Some(average) = &self.average {
            files.push((AVERAGE, network_bytes(average.clone().into_record())?));
        }
        Ok(files)
    }

    fn load(&mut self, saved: &Saved<'_>, device: &Device) -> Result<()> {
        let network = self.take()?.valid().try_load_record(saved.record(NETWORK)?);
        let network = network.map_err(|error| saved.other(NETWORK, error))?;
        self.network = Some(network.to_device(device).train());
        if let Some(average) = self.average.take() {
            let average = average.try_load_record(saved.record(AVERAGE)?);
            self.average = Some(average.map_err(|error| saved.other(AVERAGE, error))?);
        }
        Ok(())
    }
}
