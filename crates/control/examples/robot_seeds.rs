//! Trains a robot's policy with several seeds and prints success rates on fixed episodes that no training uses, beside those of
//! controllers; further arguments are parameters of the training, and `env.NAME=VALUE` of the environments:
//!
//! ```console
//! $ cargo run --release -p opendr-control --example robot_seeds -- omni [SEEDS [EPISODES [FIRST_SEED]]] [NAME=VALUE ...]
//! $ cargo run --release -p opendr-control --example robot_seeds -- diff
//! $ cargo run --release -p opendr-control --example robot_seeds -- search
//! ```

use std::time::Instant;

use opendr_control::{MobileRl, MultiObjectSearchRl};
use opendr_engine::environment::{Controller, Environment, Step};
use opendr_engine::learner::{FitJob, Handle, LearnerRl};
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::{Device, Error, Result};
use opendr_kernels::Compute;
use opendr_rl::{
    ActionMode, EvaluationProtocol, POLICY_FILE, Policy, PolicyMemory, SuccessRate, evaluate,
    evaluate_controller,
};
use opendr_simulation::mobile_manipulation::{BaseFollows, BaseKind, BaseStill, ReachKeeper};
use opendr_simulation::object_search::{NearestFrontier, ObjectsNearer};
use opendr_simulation::{RegisteredSource, Registry};

const SEARCH: &str = "ObjectSearch2D-frontier-v1";

/// A controller and its name.
type Named = (&'static str, Box<dyn Controller>);

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (pairs, plain): (Vec<_>, Vec<_>) = arguments.iter().partition(|text| text.contains('='));
    let number = |at: usize, default: u64| match plain.get(at).map(|text| text.parse::<u64>()) {
        None => Ok(default),
        Some(number) => number.map_err(|_| {
            Error::invalid_param("give the numbers of seeds and episodes, and the first seed of those")
        }),
    };
    let (seeds, episodes) = (number(1, 5)?, number(2, 500)?);
    let first_seed = number(3, EvaluationProtocol::default().first_seed)?;
    let protocol = EvaluationProtocol { episodes, first_seed, ..EvaluationProtocol::default() };
    let run =
        Run { seeds, protocol, pairs: pairs.into_iter().filter_map(|pair| pair.split_once('=')).collect() };
    match plain.first().map(|text| text.as_str()) {
        Some("omni") => run.all::<MobileRl>(&mobile(""), &controllers(BaseKind::Omni)),
        Some("diff") => run.all::<MobileRl>(&mobile("-diff"), &controllers(BaseKind::Diff)),
        Some("search") => {
            let rules = || -> Vec<Named> {
                vec![
                    ("nearest frontier", Box::new(NearestFrontier)),
                    ("nearest, objects 1 m nearer", Box::new(ObjectsNearer)),
                ]
            };
            run.all::<MultiObjectSearchRl>(&[SEARCH.to_owned()], &rules)
        }
        _ => Err(Error::invalid_param("the first argument is omni, diff or search")),
    }
}

/// Returns the environments of mobile manipulation; the first one is that of the training.
fn mobile(suffix: &str) -> Vec<String> {
    ["Reach", "PickPlace", "Door", "Drawer"].map(|task| format!("MobileManip{task}{suffix}-v1")).to_vec()
}

fn controllers(base: BaseKind) -> impl Fn() -> Vec<Named> {
    move || {
        vec![
            ("base still", Box::new(BaseStill) as Box<dyn Controller>),
            ("base follows the gripper", Box::new(BaseFollows::new(base))),
            ("hand-written controller", Box::new(ReachKeeper::new(base))),
        ]
    }
}

struct Run<'a> {
    seeds: u64,
    protocol: EvaluationProtocol,
    pairs: Vec<(&'a str, &'a str)>,
}

impl Run<'_> {
    /// Measures controllers, then trains and measures policies.
    fn all<L: LearnerRl>(&self, ids: &[String], controllers: &dyn Fn() -> Vec<Named>) -> Result<()> {
        for id in ids {
            for (name, mut controller) in controllers() {
                let rates =
                    self.measured(&mut *self.made(id, id != SEARCH)?, Some(&mut *controller), None)?;
                println!("{id}: {name} {rates}");
            }
        }
        let first = ids.first().ok_or_else(|| Error::internal("no environment"))?;
        let mut successes = vec![Vec::new(); ids.len()];
        for seed in 0..self.seeds {
            let begun = Instant::now();
            let policy = self.trained::<L>(first, seed)?;
            println!("seed {seed}: trained in {:.0} s", begun.elapsed().as_secs_f64());
            println!("  a policy call takes {:.1} us", 1e6 * call_seconds(&policy)?);
            for (id, successes) in ids.iter().zip(&mut successes) {
                let rates = self.measured(&mut *self.made(id, false)?, None, Some(&policy))?;
                println!("  {id}: {rates}");
                successes.push(rates);
            }
        }
        for (id, rates) in ids.iter().zip(&mut successes) {
            rates.sort_by(|one, other| {
                let [one_rate, other_rate] = [one, other].map(|rates| rates.success.rate);
                one_rate.total_cmp(&other_rate).then(one.weighted.total_cmp(&other.weighted))
            });
            if let [lowest, .., highest] = &rates[..] {
                let median = &rates[rates.len() / 2];
                println!("{id}: median {median}; lowest {lowest}; highest {highest}");
            }
        }
        Ok(())
    }

    /// Creates an environment with the parameters of the command; with the velocities of the base as actions if `direct`.
    fn made(&self, id: &str, direct: bool) -> Result<Box<dyn Environment>> {
        let mut params = self.params(id)?;
        if direct {
            params.insert("strategy".to_owned(), "dirvel".into());
        }
        Registry::builtin().get(id)?.make(&params)
    }

    fn params(&self, id: &str) -> Result<ParamMap> {
        let fields = Registry::builtin().get(id)?.fields();
        let own = self.pairs.iter().filter_map(|(name, value)| Some((name.strip_prefix("env.")?, *value)));
        let parsed = own.map(|(name, value)| {
            let field = fields.iter().find(|field| field.name == name);
            let field =
                field.ok_or_else(|| Error::invalid_param(format!("no parameter {name:?} of {id}")))?;
            Ok((name.to_owned(), field.parse(value)?))
        });
        parsed.collect()
    }

    fn trained<L: LearnerRl>(&self, id: &str, seed: u64) -> Result<Policy> {
        let mut params = L::FitParams::default();
        params.set("seed", (seed as i64).into())?;
        for (name, value) in self.pairs.iter().filter(|(name, _)| !name.starts_with("env.")) {
            params.set_text(name, value)?;
        }
        let name = L::SPEC.name;
        let folder = std::env::temp_dir().join(format!("opendr-{name}-{}-{seed}", std::process::id()));
        let mut learner = Handle::<L>::new(L::Params::default(), Device::Cpu)?;
        let source = RegisteredSource::new(id, &self.params(id)?)?;
        learner.fit_in(&params, &source, None, &FitJob::new(&folder))?;
        let model = learner.model().ok_or_else(|| Error::internal("a learner without a model"))?;
        let policy = Policy::from_bytes(&model.file(POLICY_FILE)?)?;
        println!("model in {}", folder.display());
        Ok(policy)
    }

    fn measured(
        &self,
        environment: &mut dyn Environment,
        controller: Option<&mut dyn Controller>,
        policy: Option<&Policy>,
    ) -> Result<Rates> {
        let mut counting = Counting { inner: environment, weighted: 0.0, few_failures: 0 };
        let success = |step: &Step| step.info.success();
        let report = match (controller, policy) {
            (Some(controller), _) => {
                evaluate_controller(controller, &mut counting, &self.protocol, &success)?
            }
            (_, Some(policy)) => evaluate(policy, &mut counting, &self.protocol)?,
            _ => return Err(Error::internal("nothing to measure")),
        };
        let success = report.success.ok_or_else(|| Error::internal("no success"))?;
        let share = |sum: f64| sum / self.protocol.episodes as f64;
        Ok(Rates {
            success,
            weighted: share(counting.weighted),
            few_failures: share(f64::from(counting.few_failures)),
        })
    }
}

/// Returns the mean time of a call of a policy with one observation, in seconds, on one thread.
fn call_seconds(policy: &Policy) -> Result<f64> {
    const CALLS: u32 = 20_000;
    let (compute, mut memory) = (Compute::single(), PolicyMemory::default());
    let observation = vec![0.1; policy.observation().len()];
    let mut action = vec![0.0; policy.action().len()];
    let begun = Instant::now();
    for _ in 0..CALLS {
        policy.act(&compute, &observation, ActionMode::Deterministic, &mut memory, &mut action)?;
    }
    Ok(begun.elapsed().as_secs_f64() / f64::from(CALLS))
}

/// Figures of an evaluation.
#[derive(Debug, Clone)]
struct Rates {
    success: SuccessRate,
    weighted: f64,
    few_failures: f64,
}

impl std::fmt::Display for Rates {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [low, high] = self.success.interval.map(|share| 100.0 * share);
        write!(f, "{:.1} % (95 %: {low:.1} to {high:.1})", 100.0 * self.success.rate)?;
        if self.weighted > 0.0 {
            write!(f, ", weighted by path length {:.3}", self.weighted)?;
        }
        if self.few_failures > 0.0 {
            write!(f, ", fewer than 11 failures {:.1} %", 100.0 * self.few_failures)?;
        }
        Ok(())
    }
}

/// Sums what an environment reports at the ends of episodes beside success.
struct Counting<'a> {
    inner: &'a mut dyn Environment,
    weighted: f64,
    few_failures: u32,
}

impl Environment for Counting<'_> {
    fn spec(&self) -> &opendr_engine::environment::EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(
        &mut self,
        seed: Option<u64>,
        options: &opendr_engine::environment::ResetOptions,
        observation: &mut [f32],
    ) -> Result<opendr_engine::environment::Info> {
        self.inner.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let step = self.inner.step(action, observation)?;
        if step.is_over() {
            self.weighted += step.info.get("spl").unwrap_or(0.0);
            let failures = step.info.get("ik_failures");
            self.few_failures += u32::from(failures.is_some_and(|failures| failures < 11.0));
        }
        Ok(step)
    }
}
