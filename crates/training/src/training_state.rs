//! Progress of a training: the contents of a checkpoint besides weights.

use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::{Error, JsonFormat, Result, Statistics};
use serde::{Deserialize, Serialize};

/// Progress of a training.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TrainingState {
    /// Number of optimiser steps.
    pub step: u64,
    /// Index of the current epoch.
    pub epoch: u64,
    /// Number of processed samples of the current epoch.
    pub position: usize,
    /// Sum of the losses of the current epoch's batches.
    pub loss_sum: f64,
    /// Number of batches in `loss_sum`.
    pub batches: u64,
    /// Best validation so far.
    pub best: Option<Best>,
    /// Number of validations since the best one.
    pub since_best: usize,
    /// Seconds of training, including earlier runs.
    pub seconds: f64,
    /// Curves so far.
    pub statistics: Statistics,
    /// Data set and parameters, which a resumed training must not change.
    pub setting: Setting,
}

impl TrainingState {
    /// Format of the state in a checkpoint. Version 2 renamed the file `standing.json` to `training_state.json`.
    pub const FORMAT: JsonFormat = JsonFormat::new("state of a training", 2);
}

/// The best validation so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Value of the metric.
    pub value: f64,
    /// Step of the validation.
    pub step: u64,
}

/// Properties that must not change when a training is resumed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Number of samples in the data set.
    pub samples: usize,
    /// Parameters of the training.
    pub params: ParamMap,
}

/// Parameters that a resumed training must not change.
const FIXED: [&str; 5] = ["batch_size", "accumulate", "seed", "optimizer", "ema"];

impl Setting {
    /// Checks that a training with `self` can be resumed as one with `now`.
    ///
    /// # Errors
    /// `InvalidParam` with the first relevant difference.
    pub fn check(&self, now: &Self) -> Result<()> {
        if self.samples != now.samples {
            return Err(Error::invalid_input(format!(
                "the training to resume had a data set of {} samples, this one has {}; use the same data set, or start a \
                 new training in another folder",
                self.samples, now.samples
            )));
        }
        for name in FIXED {
            let (was, is) = (self.params.get(name), now.params.get(name));
            if was != is {
                let shown = |value: Option<&ParamValue>| value.map_or("none".to_owned(), ToString::to_string);
                return Err(Error::invalid_param(format!(
                    "the training to resume had {name} = {}, not {}; use the same value, or start a new training in another \
                     folder",
                    shown(was),
                    shown(is)
                )));
            }
        }
        Ok(())
    }
}
