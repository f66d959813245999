//! What cloning of single steps is worth in the planar worlds: trains on demonstrations of the scripted teacher, evaluates 500 episodes.
//!
//! ```console
//! $ cargo run --release -p opendr-rl --example planar_cloning -- [push|peg] [demonstrations] [epochs] [seed]
//! ```

use std::ops::ControlFlow;

use opendr_engine::environment::Controller;
use opendr_engine::{Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{BehaviourCloningConfig, Demonstrations, EvaluationProtocol, clone_behaviour, evaluate};
use opendr_rl::{Bounds, Head, NetworkConfig, ParameterInit, Policy};
use opendr_simulation::make;
use opendr_simulation::planar_peg::PegTeacher;
use opendr_simulation::planar_push::PushTeacher;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, own: u64| arguments.get(at).and_then(|text| text.parse().ok()).unwrap_or(own);
    let (demonstrations, epochs, seed) = (number(1, 100), number(2, 60), number(3, 0));
    let (id, mut teacher): (_, Box<dyn Controller>) = match arguments.first().map(String::as_str) {
        Some("push") => ("PlanarPush-v1", Box::<PushTeacher>::default()),
        _ => ("PlanarPeg-v1", Box::<PegTeacher>::default()),
    };
    let mut environment = make(id)?;
    let spec = environment.spec().clone();
    let steps = Demonstrations::record(&mut *teacher, &mut *environment, 0..demonstrations)?;
    println!("{id}: {demonstrations} demonstrations of {} steps", steps.steps());
    let actions = spec.action.len();
    let bounds = Bounds { low: vec![-1.0; actions], high: vec![1.0; actions] };
    let network = NetworkConfig { net_arch: vec![256, 256], ..NetworkConfig::default() };
    let mut policy = Policy::new(&spec, Head::Squashed(bounds), &network, Some(10.0))?;
    policy.initialise(ParameterInit::Orthogonal(0.1), 0.0, &mut Random::from_key([seed, 3]));
    let protocol = EvaluationProtocol { episodes: 500, ..EvaluationProtocol::default() };
    for learning_rate in [1e-3, 3e-4, 1e-4] {
        let config = BehaviourCloningConfig {
            learning_rate,
            batch_size: 128,
            n_epochs: epochs as usize,
            ent_weight: 0.0,
            seed,
        };
        let mut last = 0.0;
        let mut observer = |_, loss| {
            last = loss;
            ControlFlow::Continue(())
        };
        clone_behaviour(&mut policy, &steps, &config, &Compute::single(), &mut observer)?;
        let report = evaluate(&policy, &mut *environment, &protocol)?;
        println!(
            "rate {learning_rate}: loss {last:.4}, {:?}, {:.0} steps on average",
            report.success, report.mean_length
        );
    }
    Ok(())
}
