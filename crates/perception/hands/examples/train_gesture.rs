//! Trains a classifier of gestures and evaluates it on a fifth of the rows, which are held out.
//!
//! The rows are those of Kazuhito Takahashi's hand-gesture-recognition-using-mediapipe: a class, then the values. It trains the
//! zoo's `keypoint_gesture/hand` and `keypoint_gesture/path`:
//!
//! ```console
//! $ cargo run --release -p opendr-hands --features training --example train_gesture -- keypoint.csv out open close pointer
//! ```

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::data::Vector;
use opendr_engine::dataset::{Dataset, DatasetIterator, ExternalDataset, Sample, Subset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::Classes;
use opendr_engine::{Device, Error, Result, Value};
use opendr_hands::gesture_recognition::{KeypointGesture, KeypointGestureFitParams, KeypointGestureParams};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [rows, output, names @ ..] = &arguments[..] else {
        return Err(Error::invalid_param(
            "give a file of rows, a folder for the model, and the classes' names",
        ));
    };
    let rows = open(&ExternalDataset::new(rows, "ucr"), &OpenOptions::default(), &Problems::strict())?;
    let rows = Rows { rows, classes: names.iter().map(String::as_str).collect() };
    let [training, held_out] = Subset::split(&rows, 0.8, 2024)?;
    let mut handle = Handle::<KeypointGesture>::new(KeypointGestureParams::default(), Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(Path::new(output)) };
    let fit_params = KeypointGestureFitParams::default();
    let statistics = handle.fit(&fit_params, (&training as &dyn DatasetIterator).into(), None, &job)?;
    println!("{statistics}");
    let mut right = 0;
    for index in 0..held_out.len() {
        let sample = held_out.get(index)?;
        let (Some(Value::Timeseries(row)), Some(Value::Category(expected))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("the sample is not a row with its class"));
        };
        right +=
            usize::from(handle.infer(&Vector::from_data(row.as_slice().to_vec())?)?.class == expected.class);
    }
    let (count, trained) = (held_out.len(), training.len());
    println!(
        "trained on {trained} rows; {right} of {count} held out rows are correct: {:.4}",
        right as f64 / count as f64
    );
    Ok(())
}

/// Rows whose classes have names.
struct Rows {
    rows: Box<dyn DatasetIterator>,
    classes: Classes,
}

impl Dataset for Rows {}

impl DatasetIterator for Rows {
    fn len(&self) -> usize {
        self.rows.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        self.rows.get(index)
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}
