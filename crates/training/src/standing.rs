//! How far a training has come: what a checkpoint holds besides weights.

use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::{Error, Result, Statistics};
use serde::{Deserialize, Serialize};

/// How far a training has come.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Standing {
    /// Steps of the optimiser.
    pub step: u64,
    /// The epoch under way.
    pub epoch: u64,
    /// Samples of it that are done.
    pub position: usize,
    /// Sum and number of the losses of this epoch's batches.
    pub loss_sum: f64,
    /// Batches that went into `loss_sum`.
    pub batches: u64,
    /// The best metric so far, and the step that had it.
    pub best: Option<Best>,
    /// Validations since then.
    pub since_best: usize,
    /// Seconds of training, earlier runs included.
    pub seconds: f64,
    /// Curves so far.
    pub statistics: Statistics,
    /// What was trained on, and how; a resumed training must have the same.
    pub setting: Setting,
}

/// The best validation so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Its metric.
    pub value: f64,
    /// Its step.
    pub step: u64,
}

/// What must not change when a training is resumed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// How many samples the data set has.
    pub samples: usize,
    /// The training's parameters.
    pub params: ParamMap,
}

/// Parameters without which a resumed training would be another one.
const FIXED: [&str; 5] = ["batch_size", "accumulate", "seed", "optimizer", "ema"];

impl Setting {
    /// Checks that a training with `self` can go on as one with `now`.
    ///
    /// # Errors
    /// `InvalidParam` with the first difference that matters.
    pub fn check(&self, now: &Self) -> Result<()> {
        if self.samples != now.samples {
            return Err(Error::invalid_input(format!(
                "the training that is to be resumed had a data set of {} samples, this one has {}; give the same, or train \
                 anew into another folder",
                self.samples, now.samples
            )));
        }
        for name in FIXED {
            let (was, is) = (self.params.get(name), now.params.get(name));
            if was != is {
                let shown = |value: Option<&ParamValue>| value.map_or("none".to_owned(), ToString::to_string);
                return Err(Error::invalid_param(format!(
                    "the training that is to be resumed had {name} = {}, not {}; give the same, or train anew into another \
                     folder",
                    shown(was),
                    shown(is)
                )));
            }
        }
        Ok(())
    }
}
