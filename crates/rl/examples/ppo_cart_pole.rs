//! Trains PPO on CartPole: `cargo run --release -p opendr-rl --example ppo_cart_pole [SEED]`.

use std::ops::ControlFlow;

use opendr_engine::Result;
use opendr_rl::{Algorithm as _, EvaluationProtocol, Ppo, PpoConfig, evaluate};
use opendr_simulation::vector::{Autoreset, VectorOptions};
use opendr_simulation::{make, make_vec};

fn main() -> Result<()> {
    let seed = std::env::args().nth(1).and_then(|seed| seed.parse().ok()).unwrap_or(0);
    let Some(mut preset) = PpoConfig::preset("CartPole-v1") else { return Ok(()) };
    preset.config.seed = seed;
    let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(preset.environments) };
    let mut carts = make_vec("CartPole-v1", options)?;
    let mut ppo = Ppo::new(&preset.config, carts.spec())?;
    let (begun, mut solved) = (std::time::Instant::now(), None);
    let report = ppo.train(&mut *carts, preset.timesteps, &mut |event| {
        let mean = event.report.mean_return.unwrap_or(0.0);
        if solved.is_none() && event.report.episodes >= 100 && mean >= 475.0 {
            solved = Some(event.report.timesteps);
        }
        Ok(ControlFlow::Continue(()))
    })?;
    let (steps, mean) = (report.timesteps, report.mean_return.unwrap_or(0.0));
    let seconds = cpu_seconds().unwrap_or_else(|| begun.elapsed().as_secs_f64());
    let rate = steps as f64 / seconds;
    println!("seed {seed}: {steps} steps in {seconds:.2} CPU-seconds, {rate:.0} steps per second");
    println!("mean return of the last 100 episodes {mean:.1}; 475 first at step {solved:?}");
    let report = evaluate(ppo.policy(), &mut *make("CartPole-v1")?, &EvaluationProtocol::default())?;
    println!(
        "mean return of the most likely actions in {} episodes {:.1}",
        report.episodes.len(),
        report.mean_return
    );
    Ok(())
}

/// Returns the CPU time of this thread in seconds, if the system reports it.
fn cpu_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split(' ').next()?.parse::<f64>().ok().map(|nanoseconds| nanoseconds * 1e-9)
}
