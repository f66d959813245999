//! Steps environments on requests as lines of JSON: the counterpart of `tests/simulation/test_gymnasium.py`.
//!
//! `{"id": "Pendulum-v1", "state": [...], "action": [...]}` takes one step from a state;
//! `{"id": "Pendulum-v1", "seed": 1, "actions": [[...], ...]}` runs an episode. Incoming numbers are the bits of
//! doubles, since JSON parsers may lose the last one.

use std::io::{BufRead, BufWriter, Write};

use opendr_engine::environment::{Environment, ResetOptions};
use opendr_engine::{Error, Result};
use opendr_simulation::classic_control::{
    Acrobot, CartPole, Classic, Dynamics, MountainCar, MountainCarContinuous, Pendulum,
};
use opendr_simulation::{RegisteredEnvironment, make};
use serde_json::{Value, json};

fn main() -> Result<()> {
    let mut output = BufWriter::new(std::io::stdout().lock());
    for line in std::io::stdin().lock().lines() {
        let request = serde_json::from_str(&line?).map_err(|error| Error::format(error.to_string()))?;
        writeln!(output, "{}", respond(&request)?)?;
    }
    Ok(output.flush()?)
}

fn respond(request: &Value) -> Result<Value> {
    match (request["id"].as_str().unwrap_or_default(), request["actions"].as_array()) {
        (id, Some(actions)) => episode(id, request["seed"].as_u64(), actions),
        ("Acrobot-v1", _) => one_step::<Acrobot, _>(request),
        ("CartPole-v1", _) => one_step::<CartPole, _>(request),
        ("MountainCar-v0", _) => one_step::<MountainCar, _>(request),
        ("MountainCarContinuous-v0", _) => one_step::<MountainCarContinuous, _>(request),
        ("Pendulum-v1", _) => one_step::<Pendulum, _>(request),
        (id, _) => Err(Error::not_found(format!("no environment {id:?}"))),
    }
}

fn one_step<E: AsClassic<D>, D: Dynamics>(request: &Value) -> Result<Value> {
    let mut environment = Classic::<D>::new(&D::Params::default())?;
    let mut observation = vec![0.0; environment.spec().observation.len()];
    environment.set_state(&numbers(&request["state"]))?;
    let step = environment.step(&singles(&request["action"]), &mut observation)?;
    Ok(json!({
        "state": environment.state(),
        "observation": observation,
        "reward": step.reward,
        "terminated": step.terminated,
        "truncated": step.truncated,
    }))
}

/// Links the type of an environment to its dynamics.
trait AsClassic<D> {}
impl<D: Dynamics> AsClassic<D> for Classic<D> {}

fn episode(id: &str, seed: Option<u64>, actions: &[Value]) -> Result<Value> {
    let mut environment = make(id)?;
    let mut observation = vec![0.0; environment.spec().observation.len()];
    environment.reset(seed, &ResetOptions::new(), &mut observation)?;
    let first = observation.clone();
    let mut steps = Vec::new();
    for action in actions {
        let step = environment.step(&singles(action), &mut observation)?;
        steps.push(json!([observation, step.reward, step.terminated, step.truncated]));
        if step.is_over() {
            break;
        }
    }
    Ok(json!({ "first": first, "steps": steps }))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().filter_map(Value::as_u64).map(f64::from_bits).collect()
}

fn singles(value: &Value) -> Vec<f32> {
    numbers(value).into_iter().map(|number| number as f32).collect()
}
