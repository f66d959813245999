//! Trains a drone to fly between obstacles, and says how often it arrives:
//! `cargo run --release -p opendr-planning --example ppo_corridor [SEED [FILE]]`.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use opendr_engine::{Error, Result};
use opendr_planning::{EndToEndPlanning, EndToEndPlanningParams};
use opendr_rl::{EvaluationProtocol, PpoConfig};
use opendr_simulation::make;

/// Every second corridor of a training has 8 to 10 obstacles.
const TRAINED: [&str; 2] = ["UavDepthCorridor-v1", "UavDepthCorridor-dense-v1"];
const EVALUATED: [&str; 4] = [
    "UavDepthCorridor-v1",
    "UavDepthCorridor-dense-v1",
    "UavDepthCorridor-noisy-v1",
    "UavDepthCorridor-dyn-v1",
];

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let seed = arguments.next().map_or(Ok(0), |text| text.parse());
    let seed = seed.map_err(|_| Error::invalid_param("the seed is no whole number"))?;
    let Some(preset) = PpoConfig::preset(TRAINED[0]) else { return Ok(()) };
    let params = EndToEndPlanningParams { seed, iters: preset.timesteps, ..Default::default() };
    let mut planning = EndToEndPlanning::new(params)?;
    let corridors = TRAINED.iter().cycle().take(preset.environments).map(|id| make(id));
    let begun = Instant::now();
    let report =
        planning.fit(corridors.collect::<Result<_>>()?, None, &mut |_| Ok(ControlFlow::Continue(())))?;
    let (wall, cpu) = (begun.elapsed().as_secs_f64(), cpu_seconds());
    println!("seed {seed}: {} steps in {wall:.1} s, {cpu:.1} CPU-seconds", report.timesteps);
    let protocol = EvaluationProtocol { episodes: 500, ..EvaluationProtocol::default() };
    for id in EVALUATED {
        let report = planning.eval(&mut *make(id)?, &protocol)?;
        let Some(success) = report.success else { continue };
        let [rate, low, high] =
            [success.rate, success.interval[0], success.interval[1]].map(|share| 100.0 * share);
        println!(
            "{id}: success {rate:.1} % (95 %: {low:.1} to {high:.1}), mean return {:.1}",
            report.mean_return
        );
    }
    arguments.next().map_or(Ok(()), |file| planning.save(Path::new(&file)))
}

/// Seconds that the threads of this process have spent on processors, where the system tells.
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text.rsplit(')').next().unwrap_or_default().split_whitespace();
    // Time in the program and in the system, in hundredths of a second.
    fields.skip(11).take(2).filter_map(|field| field.parse::<f64>().ok()).sum::<f64>() / 100.0
}
