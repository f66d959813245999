//! Trains a heart anomaly detector on normal and abnormal beats, and measures it on a held-out fifth of the beats.
//!
//! The beats are ECG5000 of the UCR archive (from the BIDMC database of PhysioNet). The example produces the zoo's
//! `gated_recurrent_unit/ecg5000` and `attention_neural_bag_of_feature/ecg5000`:
//!
//! ```console
//! $ cargo run --release -p opendr-signals --features training --example train_heart -- gated_recurrent_unit ECG5000_TRAIN.txt out
//! ```

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::data::Timeseries;
use opendr_engine::dataset::{Dataset, DatasetIterator, ExternalDataset, Sample, Subset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Value};
use opendr_metrics::Roc;
use opendr_signals::heart_anomaly_detection::{
    AttentionNeuralBagOfFeatureFitParams, AttentionNeuralBagOfFeatureKind, AttentionNeuralBagOfFeatureParams,
    GatedRecurrentUnitFitParams, GatedRecurrentUnitKind, GatedRecurrentUnitParams, HeartLearner,
    TrainableHeart,
};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [learner, series, output] = &arguments[..] else {
        return Err(Error::invalid_param("usage: train_heart LEARNER ECG5000_TRAIN.txt OUTPUT_FOLDER"));
    };
    match learner.as_str() {
        "gated_recurrent_unit" => {
            let params = GatedRecurrentUnitParams { recurrent_unit: 64, ..Default::default() };
            let mut fit_params = GatedRecurrentUnitFitParams::default();
            (fit_params.training.epochs, fit_params.training.lr) = (40, 0.002);
            train::<GatedRecurrentUnitKind>(params, &fit_params, series, output)
        }
        "attention_neural_bag_of_feature" => {
            let params = AttentionNeuralBagOfFeatureParams { n_codeword: 64, ..Default::default() };
            let mut fit_params = AttentionNeuralBagOfFeatureFitParams::default();
            (fit_params.training.epochs, fit_params.training.lr) = (40, 0.002);
            train::<AttentionNeuralBagOfFeatureKind>(params, &fit_params, series, output)
        }
        other => Err(Error::invalid_param(format!(
            "unknown learner {other}; choose gated_recurrent_unit or attention_neural_bag_of_feature"
        ))),
    }
}

fn train<K: TrainableHeart>(
    params: K::Params,
    fit_params: &K::FitParams,
    series: &str,
    output: &str,
) -> Result<()> {
    let ecg = open(&ExternalDataset::new(series, "ucr"), &OpenOptions::default(), &Problems::strict())?;
    let beats = Beats(ecg);
    let [training, kept_apart] = Subset::split(&beats, 0.8, 5000)?;
    let mut handle = Handle::<HeartLearner<K>>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(Path::new(output)) };
    let statistics = handle.fit(fit_params, (&training as &dyn DatasetIterator).into(), None, &job)?;
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
    println!("trained on {trained} beats; correct of {count} others: {right}, ROC AUC {area:.4}");
    Ok(())
}

/// ECG5000 with two classes: the first one is the normal beat.
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
        _ => Err(Error::invalid_input("the sample has no heart beat with a class")),
    }
}
