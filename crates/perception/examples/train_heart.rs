//! Trains a learner to tell normal heart beats from others, and measures it on a fifth of the beats, kept apart.
//!
//! The beats are ECG5000 of the UCR archive (of the BIDMC database of PhysioNet). It makes the zoo's
//! `gated_recurrent_unit/ecg5000`:
//!
//! ```console
//! $ cargo run --release -p opendr-perception --features training --example train_heart -- ECG5000_TRAIN.txt out
//! ```

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::data::Timeseries;
use opendr_engine::dataset::{Dataset, DatasetIterator, ExternalDataset, Sample, Subset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Value};
use opendr_metrics::Roc;
use opendr_perception::heart_anomaly_detection::{
    GatedRecurrentUnit, GatedRecurrentUnitFitParams, GatedRecurrentUnitParams,
};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [series, output] = &arguments[..] else {
        return Err(Error::invalid_param("give ECG5000_TRAIN.txt and a folder for the model"));
    };
    let ecg = open(&ExternalDataset::new(series, "ucr"), &OpenOptions::default(), &Problems::strict())?;
    let beats = Beats(ecg);
    let [training, kept_apart] = Subset::split(&beats, 0.8, 5000)?;
    let params = GatedRecurrentUnitParams { recurrent_unit: 64, ..Default::default() };
    let mut fit_params = GatedRecurrentUnitFitParams::default();
    (fit_params.training.epochs, fit_params.training.lr) = (40, 0.002);
    let mut handle = Handle::<GatedRecurrentUnit>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(Path::new(output)) };
    let statistics = handle.fit(&fit_params, (&training as &dyn DatasetIterator).into(), None, &job)?;
    println!("{statistics}");
    let (mut roc, mut right) = (Roc::default(), 0);
    for index in 0..kept_apart.len() {
        let (series, class) = beat(kept_apart.get(index)?)?;
        let answer = handle.infer(&series)?;
        roc.add(class == 1, f64::from(answer.probabilities[1]))?;
        right += usize::from(answer.class == class);
    }
    let (count, trained) = (kept_apart.len(), training.len());
    let area = roc.curve().area().unwrap_or(f64::NAN);
    println!("trained on {trained} beats; of {count} others {right} are right, ROC AUC {area:.4}");
    Ok(())
}

/// ECG5000 with two classes: its first is the normal beat.
struct Beats(Box<dyn DatasetIterator>);

impl Dataset for Beats {}

impl DatasetIterator for Beats {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let sample = self.0.get(index)?;
        let (series, class) = beat(sample)?;
        let target = Category::new(i64::from(class != 0), None);
        Ok(Sample { data: vec![series.into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["normal", "anomaly"].into_iter().collect()
    }
}

fn beat(sample: Sample) -> Result<(Timeseries, i64)> {
    match (sample.data.into_iter().next(), sample.target) {
        (Some(Value::Timeseries(series)), Some(Value::Category(category))) => Ok((series, category.class)),
        _ => Err(Error::invalid_input("no heart beat with its class")),
    }
}
