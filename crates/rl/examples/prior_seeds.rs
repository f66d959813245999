//! What a prior is worth to learning in the corridor: residual PPO on a hand-written controller, on a worsened one, and PPO
//! without a prior, where only arriving is rewarded, at a tenth of the steps and at the end, on fixed episodes that no training
//! uses:
//!
//! ```console
//! $ cargo run --release -p opendr-rl --example prior_seeds -- [SEEDS [EPISODES [STEPS]]]
//! ```

use std::time::Instant;

use opendr_engine::environment::{Controller, Environment, EnvironmentSpec, Info, ResetOptions, Step};
use opendr_engine::{Error, Result};
use opendr_rl::prior::{
    BoxedController, Prior, PriorReport, Residual, ResidualConfig, ResidualController, Shield,
    ShieldedController, begin_as_prior,
};
use opendr_rl::{
    Algorithm as _, EvaluationProtocol, Policy, Ppo, PpoConfig, SuccessRate, evaluate, evaluate_controller,
};
use opendr_simulation::make;
use opendr_simulation::uav_corridor::{
    CompactController, CompactCorridor, FlightMemory, ReactiveController, compact_space,
};
use opendr_simulation::vector::{Autoreset, EnvironmentVector};

const ID: &str = "UavDepthCorridor-v1";
const WORSENED: &str = "corridor-reactive-worsened";
/// The share of the hand-written heading that the worsened controller flies.
const WORSENED_HEADING: f32 = 0.6;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>());
    let mut next = |default| arguments.next().unwrap_or(Ok(default));
    let (Ok(seeds), Ok(episodes), Ok(steps)) = (next(5), next(500), next(20_480)) else {
        return Err(Error::invalid_param("give three whole numbers: seeds, episodes and steps"));
    };
    let protocol = EvaluationProtocol { episodes, ..EvaluationProtocol::default() };
    Prior::new(WORSENED, 1, |_| {
        Ok(Box::new(Worsened(CompactController::new(ReactiveController::default()))))
    })
    .register()?;
    let priors = ["corridor-reactive", WORSENED];
    for name in priors {
        println!("{name}: {}", percent(measured_alone(name, &protocol)?));
    }
    for prior in [Some(priors[0]), Some(priors[1]), None] {
        let (mut early, mut late) = (Vec::new(), Vec::new());
        for seed in 0..seeds {
            let begun = Instant::now();
            let (first, last, policy) = trained(prior, seed, steps, &protocol)?;
            let seconds = begun.elapsed().as_secs_f64();
            println!(
                "{} seed {seed}: {} at a tenth, {} at the end, {seconds:.0} s",
                prior.unwrap_or("no prior"),
                percent(first),
                percent(last)
            );
            early.push(first);
            late.push(last);
            if let (0, Some(name)) = (seed, prior) {
                println!("{}", reported(name, &policy, &protocol)?);
            }
        }
        for (when, rates) in [("a tenth", &mut early), ("the end", &mut late)] {
            rates.sort_by(|one, other| one.rate.total_cmp(&other.rate));
            println!(
                "{} at {when}: median {}, min {:.1}, max {:.1}",
                prior.unwrap_or("no prior"),
                percent(rates[rates.len() / 2]),
                100.0 * rates[0].rate,
                100.0 * rates[rates.len() - 1].rate
            );
        }
    }
    Ok(())
}

fn corridor() -> Result<Corridor> {
    CompactCorridor::new(OnlyArrival(make(ID)?))
}

type Corridor = CompactCorridor<OnlyArrival>;

/// A corridor in which only the end counts: 1 for the finish, nothing for everything else.
struct OnlyArrival(Box<dyn Environment>);

impl Environment for OnlyArrival {
    fn spec(&self) -> &EnvironmentSpec {
        self.0.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.0.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let step = self.0.step(action, observation)?;
        let reward = f64::from(u8::from(step.info.success() == Some(true)));
        Ok(Step { reward, ..step })
    }
}

fn controller(name: &str) -> Result<BoxedController> {
    Prior::newest(name)?.controller(&compact_space()?)
}

/// The corridor as a policy is trained in it: with a prior or without.
fn environment(prior: Option<&str>, config: &ResidualConfig) -> Result<Box<dyn Environment>> {
    Ok(match prior {
        Some(name) => {
            Box::new(Residual::new(corridor()?, controller(name)?, config.schedule(ENVIRONMENTS)?)?)
        }
        None => Box::new(corridor()?),
    })
}

const ENVIRONMENTS: usize = 8;

/// Success at a tenth of the steps and at the end, and the policy.
fn trained(
    prior: Option<&str>,
    seed: u64,
    steps: u64,
    protocol: &EvaluationProtocol,
) -> Result<(SuccessRate, SuccessRate, Policy)> {
    let residual = ResidualConfig { critic_warmup: steps / 20, ..ResidualConfig::default() };
    let preset = PpoConfig::preset(ID).ok_or_else(|| Error::internal("no settings for the corridor"))?;
    let plain = PpoConfig { seed, ..preset.config };
    let config = if prior.is_some() { residual.ppo(&plain) } else { plain };
    let environments =
        (0..ENVIRONMENTS).map(|_| environment(prior, &residual)).collect::<Result<Vec<_>>>()?;
    let mut vector = EnvironmentVector::new(environments, Autoreset::SameStep, 1)?;
    let mut measuring = environment(prior, &residual)?;
    let mut ppo = Ppo::new(&config, measuring.spec())?;
    if prior.is_some() {
        begin_as_prior(&mut ppo, residual.correction_log_std)?;
    }
    while ppo.report().timesteps < steps / 10 {
        ppo.iterate(&mut vector, steps)?;
    }
    let early = rate(evaluate(ppo.policy(), &mut *measuring, protocol)?.success)?;
    while ppo.report().timesteps < steps {
        ppo.iterate(&mut vector, steps)?;
    }
    let late = rate(evaluate(ppo.policy(), &mut *measuring, protocol)?.success)?;
    Ok((early, late, ppo.policy().clone()))
}

/// Prior, both, and both under a shield.
fn reported(name: &str, policy: &Policy, protocol: &EvaluationProtocol) -> Result<PriorReport> {
    let (mut report, mut corridor) = (PriorReport::default(), corridor()?);
    report.add("prior", &mut *controller(name)?, &mut corridor, protocol)?;
    let both = || ResidualController::new(policy, controller(name)?, ResidualConfig::default().alpha);
    report.add("prior and policy", &mut both()?, &mut corridor, protocol)?;
    let mut shielded = ShieldedController::new(both()?, Shield::new(is_blocked, controller(name)?));
    report.add_shielded("prior and policy, shielded", &mut shielded, &mut corridor, protocol)?;
    Ok(report)
}

/// Whether something seen is on the metre that the action flies, or nearly: nearer than 1.3 m and 0.35 m aside. The view is 16 columns
/// of 45 degrees, from the left to the right, as shares of 15 m.
fn is_blocked(observation: &[f32], action: &[f32]) -> bool {
    let heading = action[0].clamp(-1.0, 1.0) * std::f32::consts::FRAC_PI_8;
    let view = &observation[FlightMemory::STATE..][..16];
    let half_width = std::f32::consts::FRAC_PI_8.tan();
    view.iter().enumerate().any(|(column, share)| {
        let bearing = (half_width * (1.0 - (column as f32 + 0.5) / 8.0)).atan();
        let away = 15.0 * share / bearing.cos();
        let (sine, cosine) = (bearing - heading).sin_cos();
        away * cosine < 1.3 && (away * sine).abs() < 0.35
    })
}

fn measured_alone(name: &str, protocol: &EvaluationProtocol) -> Result<SuccessRate> {
    let report = evaluate_controller(&mut *controller(name)?, &mut corridor()?, protocol, &|step| {
        step.info.success()
    })?;
    rate(report.success)
}

fn rate(success: Option<SuccessRate>) -> Result<SuccessRate> {
    success.ok_or_else(|| Error::internal("the corridor reports no success"))
}

fn percent(success: SuccessRate) -> String {
    let [low, high] = success.interval.map(|share| 100.0 * share);
    format!("{:.1} % ({low:.1} to {high:.1})", 100.0 * success.rate)
}

/// The hand-written controller with weak headings.
struct Worsened(CompactController<ReactiveController>);

impl Controller for Worsened {
    fn reset(&mut self) {
        self.0.reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.0.act(observation, action)?;
        action[0] *= WORSENED_HEADING;
        Ok(())
    }

    fn executed(&mut self, action: &[f32]) {
        self.0.executed(action);
    }
}
