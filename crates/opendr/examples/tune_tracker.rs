//! Searches a tracker's parameters on videos in the format of the MOT Challenge, by the mean of HOTA and IDF1.
//!
//! ```console
//! $ pip download --no-deps motmetrics && unzip motmetrics-*.whl 'motmetrics/data/TUD-*/*'
//! $ for video in TUD-Campus TUD-Stadtmitte; do
//! >   mkdir -p videos/train/$video/{gt,det}; cp motmetrics/data/$video/gt.txt videos/train/$video/gt/
//! >   awk -F, -v OFS=, '{ print $1, -1, $3, $4, $5, $6, 1 }' motmetrics/data/$video/test.txt > videos/train/$video/det/det.txt
//! > done
//! $ cargo run --release -p opendr --example tune_tracker -- byte_track videos 60 iou_threshold track_buffer=5..60 min_hits=1..5
//! ```
//!
//! A parameter is searched in the learner's range, in `NAME=LOW..HIGH`, or among `NAME=A,B,C`. Prints the score of the defaults, then
//! one line of JSON with the best parameters.

use std::error::Error;

use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::evaluation::EvalOptions;
use opendr::learner::Entry;
use opendr::params::ParamMap;
use opendr::tuning::{Budget, Direction, Outcome, Progress, Storage, Study, Tpe, Trial};
use opendr::{Device, Silent, search_space};
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, folder, trials, search @ ..] = &arguments[..] else {
        return Err("give a tracker, a folder of videos, a number of trials, and parameters to search".into());
    };
    let entry = opendr::registry().find(name)?;
    let videos = ExternalDataset::new(folder, "mot");
    println!("defaults: {:.4}", score(entry, &ParamMap::new(), &videos)?);
    let space = search_space(entry.params, search)?;
    let study = Study::open(Storage::memory(), name, &[Direction::Maximize])?.with_sampler(Tpe::new(0));
    let measure = |trial: &Trial<'_>| score(entry, &trial.param_map()?, &videos).map(Outcome::from);
    study.optimize(&space, &Budget::total(trials.parse()?), measure, |_, _| Progress::Continue)?;
    let best = study.best().ok_or("no trial completed")?;
    let params: serde_json::Map<String, Value> =
        best.params.iter().map(|(name, one)| (name.clone(), one.value())).collect();
    println!("{}", json!({"score": best.value(), "params": params}));
    Ok(())
}

/// Returns the mean of HOTA and IDF1 of the tracker with these parameters.
fn score(entry: &'static Entry, params: &ParamMap, videos: &ExternalDataset) -> opendr::Result<f64> {
    let mut learner = opendr::learner_with(entry.spec.name, params, Device::Cpu, &Silent)?;
    let mut sum = 0.0;
    for (metric, number) in [("hota", "hota"), ("identity", "idf1")] {
        let options = EvalOptions { metric: Some(metric.to_owned()), ..EvalOptions::default() };
        let outcome = options.run(&mut learner, entry, DatasetRef::External(videos), &Silent)?;
        sum += outcome.report.statistics.scalars.get(number).copied().unwrap_or_default();
    }
    Ok(sum / 2.0)
}
