//! `cargo xtask realtime`: check of the paper's requirement of 25 frames per second in at most 1 GB for every task; for audio,
//! of a real-time factor of at most 0.2.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::Value;

use crate::shell::{Result, command, output, target};
use crate::speed::write_speed;

const FRAMES_PER_SECOND: f64 = 25.0;
const REAL_TIME_FACTOR: f64 = 0.2;
const MEGABYTES: f64 = 1000.0;
const CORES: &str = "0,1";

/// Measures every available model, and fails if a task has none that meets the requirement.
pub fn run() -> Result<()> {
    measure(|_, _| Ok(()))
}

/// Runs [`run`], and writes the measurements into the cards.
pub fn run_and_write() -> Result<()> {
    measure(write_speed)
}

/// Calls `record` with each model and its report of `opendr bench`.
fn measure(record: impl Fn(&str, &Value) -> Result<()>) -> Result<()> {
    let opendr = |arguments: &[&str]| {
        let mut opendr = bounded_opendr();
        opendr.args(arguments);
        opendr
    };
    let models = json(&mut opendr(&["models", "--json"]))?;
    let mut best = BTreeMap::<String, Vec<String>>::new();
    for model in models.as_array().into_iter().flatten() {
        let [name, task] = ["model", "task"].map(|key| model[key].as_str().unwrap_or_default());
        let fast_models = best.entry(task.to_owned()).or_default();
        let report = match json(&mut opendr(&[
            "bench", name, "--frames", "100", "--warmup", "5", "--json", "--quiet",
        ])) {
            Ok(report) => report,
            Err(error) => {
                println!("{task}: {name}: not measured ({error})");
                continue;
            }
        };
        record(name, &report)?;
        let number = |key: &str| report[key].as_f64().unwrap_or(f64::NAN);
        let (fps, peak) = (number("frames_per_second"), number("peak_memory_mb"));
        let (fast, how_fast) = match report["real_time_factor"].as_f64() {
            Some(factor) => (factor <= REAL_TIME_FACTOR, format!("real-time factor {factor:.3}")),
            None => (fps >= FRAMES_PER_SECOND, format!("{fps:.0} frames per second")),
        };
        println!("{task}: {name}: {how_fast}, {peak:.0} MB, {}", report["runtime"]);
        if fast && peak <= MEGABYTES {
            fast_models.push(name.to_owned());
        }
    }
    let slow: Vec<_> =
        best.iter().filter(|(_, models)| models.is_empty()).map(|(task, _)| task.as_str()).collect();
    match slow.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "no learner with {FRAMES_PER_SECOND} frames per second (or a real-time factor of {REAL_TIME_FACTOR}) in \
             {MEGABYTES} MB for {}",
            slow.join(", ")
        )),
    }
}

/// The release binary on two cores.
fn bounded_opendr() -> Command {
    let binary = target().join("release/opendr");
    let mut opendr = command("taskset");
    opendr.args(["--cpu-list", CORES]).arg(binary).env("OPENDR_THREADS", "2");
    opendr
}

fn json(command: &mut Command) -> Result<Value> {
    serde_json::from_str(&output(command)?).map_err(|error| error.to_string())
}
