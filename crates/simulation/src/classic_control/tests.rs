use opendr_engine::environment::Environment;
use opendr_engine::params::{ParamMap, ParamValue};

use super::*;
use crate::{RegisteredEnvironment, make};

/// Gymnasium 1.4: `make(id).reset(seed=42)`.
#[test]
fn initial_states_match_gymnasium() {
    for (id, expected) in FIRST {
        let mut observation = vec![0.0; expected.len()];
        make(id).unwrap().reset(Some(42), &ParamMap::new(), &mut observation).unwrap();
        assert_eq!(observation, *expected, "{id}");
    }
}

const FIRST: [(&str, &[f32]); 5] = [
    ("CartPole-v1", &[0.027395604, -0.006112156, 0.035859793, 0.019736802]),
    ("Pendulum-v1", &[-0.14995256, 0.9886932, -0.12224312]),
    ("Acrobot-v1", &[0.99849933, 0.054763798, 0.99992526, -0.012224007, 0.07171959, 0.039473604]),
    ("MountainCar-v0", &[-0.4452088, 0.0]),
    ("MountainCarContinuous-v0", &[-0.4452088, 0.0]),
];

#[test]
fn options_move_the_first_state() {
    let mut environment = CartPole::new(&CartPoleParams::default()).unwrap();
    let options = |low: f64, high: f64| {
        ParamMap::from([("low".to_owned(), ParamValue::from(low)), ("high".to_owned(), high.into())])
    };
    let mut observation = [0.0; 4];
    environment.reset(Some(1), &options(0.1, 0.1), &mut observation).unwrap();
    assert_eq!(observation, [0.1; 4]);
    assert!(environment.reset(Some(1), &options(0.2, 0.1), &mut observation).is_err());
    assert!(environment.reset(Some(1), &options(f64::NAN, 0.1), &mut observation).is_err());
}

#[test]
fn parameters_change_the_world() {
    let run = |params: CartPoleParams| {
        let mut environment = CartPole::new(&params).unwrap();
        let mut observation = [0.0; 4];
        environment.reset(Some(3), &ParamMap::new(), &mut observation).unwrap();
        let mut rewards = Vec::new();
        loop {
            let step = environment.step(&[1.0], &mut observation).unwrap();
            rewards.push(step.reward);
            if step.terminated {
                return (rewards, observation);
            }
        }
    };
    let (plain, explicit) = run(CartPoleParams::default());
    assert!(plain.iter().all(|reward| *reward == 1.0));
    let (sutton, _) = run(CartPoleParams { sutton_barto_reward: true, ..Default::default() });
    assert_eq!((sutton.iter().sum::<f64>(), sutton.last()), (-1.0, Some(&-1.0)));
    assert_ne!(explicit, run(CartPoleParams { semi_implicit: true, ..Default::default() }).1);
}

#[test]
fn states_are_checked() {
    let mut environment = Pendulum::new(&PendulumParams::default()).unwrap();
    let mut observation = [0.0; 3];
    assert!(environment.step(&[0.0], &mut observation).unwrap_err().to_string().contains("never reset"));
    assert!(environment.set_state(&[0.0]).is_err());
    assert!(environment.set_state(&[0.0, f64::INFINITY]).is_err());
    environment.set_state(&[0.5, 0.0]).unwrap();
    assert!(environment.step(&[f32::NAN], &mut observation).is_err());
    assert!(environment.step(&[0.0], &mut observation[..2]).is_err());
    environment.set_state(&[0.5, 0.0]).unwrap();
    environment.step(&[7.0], &mut observation).unwrap();
    let clipped = environment.state().unwrap().to_vec();
    environment.set_state(&[0.5, 0.0]).unwrap();
    environment.step(&[2.0], &mut observation).unwrap();
    assert_eq!(environment.state().unwrap(), clipped);
}
