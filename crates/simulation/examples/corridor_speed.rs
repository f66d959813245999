//! Steps of `UavDepthCorridor-v1` per second of CPU time, 64 x 64 pixels of depth included:
//! `cargo run --release -p opendr-simulation --example corridor_speed [ID]`.

use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::{Random, Result};
use opendr_simulation::make;

fn main() -> Result<()> {
    let id = std::env::args().nth(1).unwrap_or_else(|| "UavDepthCorridor-v1".to_owned());
    let mut environment = make(&id)?;
    let spec = environment.spec().clone();
    let mut observation = vec![0.0; spec.observation.len()];
    let mut action = vec![0.0; spec.action.len()];
    let mut random = Random::new(1);
    for _ in 0..5 {
        environment.reset(Some(1), &ResetOptions::new(), &mut observation)?;
        let (begin, steps) = (cpu_seconds(), 20_000);
        for step in 0..steps {
            spec.action.sample_into(&mut random, &mut action);
            let over = environment.step(&action, &mut observation)?.is_over();
            // Random flights end after a few metres: as many resets as in a flight of 40 steps.
            if over || step % 40 == 0 {
                environment.reset(None, &ResetOptions::new(), &mut observation)?;
            }
        }
        println!("{id}: {:.0} steps per CPU second", f64::from(steps) / (cpu_seconds() - begin));
    }
    Ok(())
}

/// Returns the CPU time of this thread, which does not depend on the load of the machine.
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split(' ').next().and_then(|number| number.parse::<f64>().ok());
    nanoseconds.unwrap_or(f64::NAN) * 1e-9
}
