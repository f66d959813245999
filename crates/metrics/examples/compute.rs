//! Computes metrics from lines of JSON on standard input and writes a line of JSON each to standard output. Tests in
//! other languages compare the metrics with the reference tools by it.
//!
//! An input line is
//! `{"metric": NAME, "params": {..}, "samples": [{"prediction": TARGET, "ground truth": TARGET}, ..], "parts": N}`.
//! `"end_sequence": true` in a sample ends a sequence after it. `parts` is the number of accumulators that share the
//! samples (whole sequences, if there are any) and are then merged. The output line is the report, or
//! `{"error": TEXT}`. Targets are in the form of docs/json.md.

use std::error::Error;
use std::io::{self, BufRead, Write};

use opendr_engine::params::ParamMap;
use opendr_engine::{Error as Failure, Result, Value};
use opendr_metrics::{Report, find, undocumented};
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    metric: String,
    #[serde(default)]
    params: ParamMap,
    samples: Vec<Sample>,
    parts: Option<usize>,
}

#[derive(Deserialize)]
struct Sample {
    prediction: Value,
    ground_truth: Value,
    #[serde(default)]
    end_sequence: bool,
}

fn main() -> std::result::Result<(), Box<dyn Error>> {
    let mut output = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        let line = line?;
        match serde_json::from_str::<Case>(&line).map_err(|error| error.to_string()) {
            Ok(case) => match compute(&case) {
                Ok(report) => serde_json::to_writer(&mut output, &report)?,
                Err(error) => {
                    serde_json::to_writer(&mut output, &serde_json::json!({"error": error.to_string()}))?
                }
            },
            Err(error) => serde_json::to_writer(&mut output, &serde_json::json!({"error": error}))?,
        }
        writeln!(output)?;
    }
    Ok(())
}

fn compute(case: &Case) -> Result<Report> {
    let entry = find(&case.metric)?;
    let count = case.parts.unwrap_or(1).max(1);
    let mut parts = (0..count).map(|_| entry.make(&case.params)).collect::<Result<Vec<_>>>()?;
    let in_sequences = case.samples.iter().any(|sample| sample.end_sequence);
    let mut sequence = 0;
    for (at, sample) in case.samples.iter().enumerate() {
        let part = &mut parts[if in_sequences { sequence } else { at } % count];
        part.update(at, (&sample.prediction).into(), (&sample.ground_truth).into())?;
        if sample.end_sequence {
            part.end_sequence();
            sequence += 1;
        }
    }
    // In reverse order: the order of merging must not matter.
    let mut whole = entry.make(&case.params)?;
    for part in parts.into_iter().rev() {
        whole.merge(part)?;
    }
    let report = whole.finish();
    match &undocumented(entry, &report)[..] {
        [] => Ok(report),
        keys => Err(Failure::internal(format!("{} does not document {}", entry.name, keys.join(", ")))),
    }
}
