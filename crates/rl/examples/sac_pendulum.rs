//! Trains SAC on Pendulum: `cargo run --release -p opendr-rl --example sac_pendulum -- [SEED] [THREADS] [THOUSANDS]`.

use std::time::Instant;

use opendr_engine::Result;
use opendr_kernels::Compute;
use opendr_rl::{Algorithm as _, EvaluationProtocol, Sac, SacConfig, evaluate};
use opendr_simulation::vector::{Autoreset, VectorOptions};
use opendr_simulation::{make, make_vec};

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let (seed, threads) = (arguments.next().unwrap_or(0), arguments.next().unwrap_or(1));
    let thousands = arguments.next().unwrap_or(10);
    let Some(mut preset) = SacConfig::preset("Pendulum-v1") else { return Ok(()) };
    preset.config.off_policy.seed = seed;
    let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(1) };
    let mut pendulum = make_vec("Pendulum-v1", options)?;
    let compute = Compute::with_threads(threads as usize);
    let mut sac = Sac::new(&preset.config, pendulum.spec())?.with_compute(compute);
    let protocol = EvaluationProtocol { episodes: 20, ..EvaluationProtocol::default() };
    let (mut judge, begun) = (make("Pendulum-v1")?, Instant::now());
    for thousand in 1..=thousands {
        while sac.report().timesteps < 1000 * thousand {
            sac.iterate(&mut *pendulum, preset.timesteps)?;
        }
        let seconds = begun.elapsed().as_secs_f64();
        let earned = evaluate(sac.policy(), &mut *judge, &protocol)?.mean_return;
        println!("seed {seed}: step {thousand}000, {seconds:.1} s, mean return of 20 episodes {earned:.1}");
    }
    Ok(())
}
