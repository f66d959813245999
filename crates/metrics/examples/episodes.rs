//! Computes the statistics of episodes from lines of JSON on standard input and writes a line of JSON each to standard
//! output.
//!
//! An input line is `{"params": {..}, "episodes": [{"task": "reach", "seed": 1, "return": 2.5, "success": true}, ..]}`;
//! the output line is the report, or `{"error": TEXT}`.

use std::io::{self, BufRead, Write};

use opendr_engine::Result;
use opendr_engine::params::{ParamMap, Params};
use opendr_metrics::{Episode, Report, Success, SuccessParams};
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    #[serde(default)]
    params: ParamMap,
    episodes: Vec<Episode>,
}

fn main() -> io::Result<()> {
    let mut output = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        let case = serde_json::from_str(&line?).map_err(|error| error.to_string());
        match case.and_then(|case| compute(&case).map_err(|error| error.to_string())) {
            Ok(report) => serde_json::to_writer(&mut output, &report)?,
            Err(error) => serde_json::to_writer(&mut output, &serde_json::json!({"error": error}))?,
        }
        writeln!(output)?;
    }
    Ok(())
}

fn compute(case: &Case) -> Result<Report> {
    let mut success = Success::new(&SuccessParams::from_map(&case.params)?);
    case.episodes.iter().try_for_each(|episode| success.add(episode))?;
    Ok(success.finish())
}
