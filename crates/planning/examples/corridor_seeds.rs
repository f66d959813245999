//! Measures the success rate of policies trained with several seeds, and of the planner without a policy, between few and
//! many obstacles, with a noisy camera, and with inertia and wind:
//!
//! ```console
//! $ cargo run --release -p opendr-planning --example corridor_seeds -- [SEEDS [EPISODES [FIRST_SEED [PARAMETER=VALUE ...]]]]
//! ```

use std::path::Path;
use std::time::Instant;

use opendr_engine::data::Observation;
use opendr_engine::environment::{Controller, Environment, Step};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::params::Params as _;
use opendr_engine::{Device, Error, Result};
use opendr_planning::end_to_end::{
    EndToEndPlanningFitParams, EndToEndPlanningRl, FlightModels, FlightParams,
};
use opendr_rl::{EvaluationProtocol, SuccessRate, evaluate_controller, observation_from_numbers};
use opendr_simulation::uav_corridor::FlightMemoryWrapper;
use opendr_simulation::{RegisteredSource, make};

const EVALUATED: [&str; 4] = [
    "UavDepthCorridor-v1",
    "UavDepthCorridor-dense-v1",
    "UavDepthCorridor-noisy-v1",
    "UavDepthCorridor-dyn-v1",
];

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>());
    let mut next = |default| arguments.next().unwrap_or(Ok(default));
    let (Ok(seeds), Ok(episodes), Ok(first_seed)) = (next(5), next(500), next(1_000_000)) else {
        return Err(Error::invalid_param(
            "give three integers: seeds, episodes and the seed of the first episode",
        ));
    };
    let protocol = &EvaluationProtocol { episodes, first_seed, ..EvaluationProtocol::default() };
    println!("the proposal alone, without learning");
    for id in EVALUATED {
        print_rate(id, success_rate(&mut NoCorrection, &mut FlightMemoryWrapper::new(make(id)?)?, protocol)?);
    }
    let mut rates: [Vec<SuccessRate>; EVALUATED.len()] = Default::default();
    for seed in 0..seeds {
        let folder = std::env::temp_dir().join(format!("opendr-corridor-{}-{seed}", std::process::id()));
        let start = Instant::now();
        let mut learner = trained(seed, &folder)?;
        println!("seed {seed}: {:.1} s", start.elapsed().as_secs_f64());
        let model = learner.model().ok_or_else(|| Error::internal("a learner without a model"))?;
        let models = FlightModels::of(model)?;
        let alone = FlightModels { foresight: None, ..models.clone() };
        for (learnt, models) in [("surroundings", alone), ("surroundings and foresight", models)] {
            println!("  the proposal with learnt {learnt}, without corrections");
            for id in EVALUATED {
                let mut corridor = models.propose_in(FlightMemoryWrapper::new(make(id)?)?);
                print_rate(id, success_rate(&mut NoCorrection, &mut corridor, protocol)?);
            }
        }
        println!("  with corrections");
        for (id, rates) in EVALUATED.iter().zip(&mut rates) {
            let mut corridor = make(id)?;
            let space = corridor.spec().observation.clone();
            let observe = |numbers: &[f32]| observation_from_numbers(&space, numbers);
            let mut pilot = Pilot { learner: &mut learner, observe: &observe };
            rates.extend(print_rate(id, success_rate(&mut pilot, &mut *corridor, protocol)?));
        }
        std::fs::remove_dir_all(folder)?;
    }
    for (id, rates) in EVALUATED.iter().zip(&mut rates) {
        rates.sort_by(|one, other| one.rate.total_cmp(&other.rate));
        if let [first, .., last] = &rates[..] {
            let median = 100.0 * rates[rates.len() / 2].rate;
            println!("{id}: median {median:.1} %, {:.1} to {:.1}", 100.0 * first.rate, 100.0 * last.rate);
        }
    }
    Ok(())
}

/// Returns the parameters of the training from the arguments after the three numbers.
fn fit_params(seed: u64) -> Result<EndToEndPlanningFitParams> {
    let mut params = EndToEndPlanningFitParams { seed, ..Default::default() };
    for text in std::env::args().skip(4) {
        let (name, value) = text.split_once('=').unwrap_or((&text, ""));
        let field = EndToEndPlanningFitParams::FIELDS.iter().find(|field| field.name == name);
        let field = field.ok_or_else(|| Error::invalid_param(format!("no parameter {name:?}")))?;
        params.set(name, field.parse(value)?)?;
    }
    Ok(params)
}

fn trained(seed: u64, folder: &Path) -> Result<Handle<EndToEndPlanningRl>> {
    let mut learner = Handle::<EndToEndPlanningRl>::new(FlightParams::default(), Device::Cpu)?;
    let corridors = RegisteredSource::new(EVALUATED[0], &Default::default())?;
    learner.fit_in(&fit_params(seed)?, &corridors, None, &FitJob::new(folder))?;
    Ok(learner)
}

fn success_rate(
    pilot: &mut dyn Controller,
    corridor: &mut dyn Environment,
    protocol: &EvaluationProtocol,
) -> Result<Option<SuccessRate>> {
    let success = |step: &Step| step.info.success();
    Ok(evaluate_controller(pilot, corridor, protocol, &success)?.success)
}

fn print_rate(id: &str, success: Option<SuccessRate>) -> Option<SuccessRate> {
    if let Some(success) = &success {
        let [low, high] = success.interval.map(|share| 100.0 * share);
        println!("  {id}: {:.1} % (95 %: {low:.1} to {high:.1})", 100.0 * success.rate);
    }
    success
}

/// A controller without corrections.
struct NoCorrection;

impl Controller for NoCorrection {
    fn reset(&mut self) {}

    fn act(&mut self, _: &[f32], correction: &mut [f32]) -> Result<()> {
        correction.fill(0.0);
        Ok(())
    }
}

struct Pilot<'a> {
    learner: &'a mut Handle<EndToEndPlanningRl>,
    observe: &'a dyn Fn(&[f32]) -> Result<Observation>,
}

impl Controller for Pilot<'_> {
    fn reset(&mut self) {
        self.learner.reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        action.copy_from_slice(&self.learner.infer(&(self.observe)(observation)?)?.values);
        Ok(())
    }
}
