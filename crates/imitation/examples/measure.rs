//! Measures ACT, diffusion policy and behaviour cloning on the same demonstrations of an environment:
//! `measure ENVIRONMENT PRIOR [demonstrations] [episodes] [steps] [seed] [clone,act,diffusion]`.

use std::ops::ControlFlow;
use std::time::Instant;

use opendr_engine::environment::Step;
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Random, Result};
use opendr_imitation::{
    Act, ActParams, ChunkMethod, ChunkTraining, ChunkTrainingParams, DemonstrationSet, DiffusionParams,
    DiffusionPolicy, RecordingOptions,
};
use opendr_kernels::Compute;
use opendr_rl::prior::Prior;
use opendr_rl::{
    BehaviourCloningConfig, Bounds, Demonstrations, EvaluationProtocol, EvaluationReport, Head,
    NetworkConfig, ParameterInit, Policy, clone_behaviour, evaluate, evaluate_controller,
};

struct Measurement {
    environment: String,
    set: DemonstrationSet,
    training: ChunkTrainingParams,
    protocol: EvaluationProtocol,
}

fn main() -> Result<()> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let number =
        |at: usize, default: u64| given.get(at).and_then(|text| text.parse().ok()).unwrap_or(default);
    let environment = given.first().cloned().unwrap_or_else(|| "Pendulum-v1".to_owned());
    let prior = given.get(1).cloned().unwrap_or_else(|| "pendulum-energy".to_owned());
    let seed = number(5, 0);
    Prior::provide(opendr_control::priors());
    let mut world = opendr_simulation::make(&environment)?;
    let mut teacher = Prior::newest(&prior)?.controller(&world.spec().observation)?;
    let protocol = EvaluationProtocol { episodes: number(3, 500), ..EvaluationProtocol::default() };
    let success = |step: &Step| step.info.success();
    print(&prior, &evaluate_controller(&mut *teacher, &mut *world, &protocol, &success)?);
    let options = RecordingOptions {
        episodes: number(2, 100) as usize,
        first_seed: (1 << 42) + seed * 10_000,
        successes_only: true,
    };
    let set = DemonstrationSet::record(&mut *teacher, &mut *world, &options, &mut |_| {})?;
    println!("{} demonstrations, {} steps", set.episodes().len(), set.steps());
    let training = ChunkTrainingParams { training_steps: number(4, 10_000), seed, ..Default::default() };
    let measurement = Measurement { environment, set, training, protocol };
    let methods = given.get(6).map_or("clone,act,diffusion", String::as_str);
    if methods.contains("clone") {
        measurement.clone()?;
    }
    if methods.contains("diffusion") {
        let steps =
            [1, 2, 4, 8].map(|n_action_steps| DiffusionParams { n_action_steps, ..Default::default() });
        measurement.chunks::<DiffusionPolicy>(&steps)?;
    }
    if methods.contains("act") {
        let mut act = vec![ActParams::default()];
        for n_action_steps in [1, 4, 10] {
            act.push(ActParams { temporal_ensemble: false, n_action_steps, ..Default::default() });
        }
        measurement.chunks::<Act>(&act)?;
    }
    Ok(())
}

fn print(name: &str, report: &EvaluationReport) {
    let success = report.success.map_or(String::new(), |success| {
        let [low, high] = success.interval;
        format!(", success {:.1} % ({:.1} to {:.1})", 100.0 * success.rate, 100.0 * low, 100.0 * high)
    });
    let steps = report.mean_length * report.episodes.len() as f64;
    println!(
        "{name}: return {:.2} +- {:.2}, length {:.1}{success}, {:.0} us per step",
        report.mean_return,
        report.std_return,
        report.mean_length,
        1e6 * report.seconds / steps
    );
}

impl Measurement {
    /// Trains a policy, and measures it with each of these parameters on 200 episodes of their own, then with the best on the protocol's.
    fn chunks<M: ChunkMethod>(&self, candidates: &[M::Params]) -> Result<()>
    where
        M::Config: Default,
    {
        let mut world = opendr_simulation::make(&self.environment)?;
        let spaces = [world.spec().observation.clone(), world.spec().action.clone()];
        let begun = Instant::now();
        let mut training =
            ChunkTraining::<M>::new(&M::Config::default(), &self.training, spaces, &self.set, None)?;
        let mut mean = 0.0;
        training.run(&mut |step, loss| {
            mean += loss;
            if step % 1000 == 0 {
                println!(
                    "  {} step {step}: loss {:.4}, {:.0} s",
                    M::SPEC.name,
                    mean / 1000.0,
                    begun.elapsed().as_secs_f64()
                );
                mean = 0.0;
            }
            ControlFlow::Continue(())
        })?;
        let policy = training.policy();
        println!(
            "{}: {} parameters, {:.0} s of training",
            M::SPEC.name,
            policy.parameter_count(),
            begun.elapsed().as_secs_f64()
        );
        let success = |step: &Step| step.info.success();
        let selection = EvaluationProtocol { episodes: 200, first_seed: 9_000_000, ..self.protocol };
        let evaluated = |params: &M::Params| {
            let mut world = opendr_simulation::make(&self.environment)?;
            let mut controller = policy.controller(params);
            evaluate_controller(&mut controller, &mut *world, &selection, &success)
        };
        let mut best: Option<(f64, &M::Params)> = None;
        for pair in candidates.chunks(2) {
            let reports: Vec<Result<EvaluationReport>> = std::thread::scope(|scope| {
                let threads: Vec<_> = pair.iter().map(|params| scope.spawn(|| evaluated(params))).collect();
                let joined = threads.into_iter().map(|thread| {
                    thread.join().unwrap_or_else(|_| Err(Error::internal("an evaluation panicked")))
                });
                joined.collect()
            });
            for (params, report) in pair.iter().zip(reports) {
                let report = report?;
                print(&format!("  {:?}", params.to_map()), &report);
                let score = report.success.as_ref().map_or(report.mean_return, |success| success.rate);
                if best.is_none_or(|(top, _)| score > top) {
                    best = Some((score, params));
                }
            }
        }
        let Some((_, params)) = best else { return Ok(()) };
        println!("{}: selected {:?}", M::SPEC.name, params.to_map());
        let mut controller = policy.controller(params);
        print(M::SPEC.name, &evaluate_controller(&mut controller, &mut *world, &self.protocol, &success)?);
        Ok(())
    }

    /// Behaviour cloning with the usual network, for as many passes as the others take steps of 64 windows.
    fn clone(&self) -> Result<()> {
        let mut world = opendr_simulation::make(&self.environment)?;
        let spec = world.spec().clone();
        let (mut observations, mut actions) = (Vec::new(), Vec::new());
        for episode in self.set.episodes() {
            observations.extend_from_slice(&episode.observations);
            actions.extend_from_slice(&episode.actions);
        }
        let demonstrations = Demonstrations::new(&spec, observations, actions)?;
        let windows = self.training.training_steps * self.training.batch_size as u64;
        let n_epochs = (windows as usize / self.set.steps()).clamp(10, 200);
        let config = BehaviourCloningConfig { n_epochs, seed: self.training.seed, ..Default::default() };
        let network = NetworkConfig { net_arch: vec![256, 256], ..NetworkConfig::default() };
        let head = Head::Squashed(Bounds::of(&spec.action, true)?);
        let mut policy = Policy::new(&spec, head, &network, Some(10.0))?;
        let mut random = Random::from_key([self.training.seed, 3]);
        policy.initialise(ParameterInit::Orthogonal(0.01), 0.0, &mut random);
        let begun = Instant::now();
        let mut observer = |_, _| ControlFlow::Continue(());
        let losses =
            clone_behaviour(&mut policy, &demonstrations, &config, &Compute::with_threads(2), &mut observer)?;
        println!(
            "behaviour cloning: {n_epochs} epochs, last loss {:?}, {:.0} s of training",
            losses.last(),
            begun.elapsed().as_secs_f64()
        );
        print("behaviour cloning", &evaluate(&policy, &mut *world, &self.protocol)?);
        Ok(())
    }
}
