use opendr_engine::environment::{Controller, Environment, ResetOptions};
use opendr_engine::params::{ParamMap, ParamValue};

use super::*;
use crate::{Registry, make};

fn with(id: &str, pairs: &[(&str, ParamValue)]) -> Box<dyn Environment> {
    let params: ParamMap = pairs.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    Registry::builtin().get(id).unwrap().make(&params).unwrap()
}

/// Episodes of seeds from 0; returns how many succeeded.
fn successes(id: &str, controller: &mut dyn Controller, episodes: u64) -> u64 {
    let mut robot = with(id, &[("strategy", "dirvel".into())]);
    let mut seen = [0.0; OBSERVATION_LEN];
    let mut action = vec![0.0; robot.spec().action.len()];
    let mut count = 0;
    for seed in 0..episodes {
        robot.reset(Some(seed), &ResetOptions::new(), &mut seen).unwrap();
        loop {
            controller.act(&seen, &mut action).unwrap();
            let step = robot.step(&action, &mut seen).unwrap();
            assert!(step.reward <= 0.0 && seen.iter().all(|number| number.is_finite()));
            if step.is_over() {
                count += u64::from(step.info.success() == Some(true));
                break;
            }
        }
    }
    count
}

#[test]
fn controllers_rank_as_expected() {
    for (base, suffix) in [(BaseKind::Omni, ""), (BaseKind::Diff, "-diff")] {
        let id = format!("MobileManipReach{suffix}-v1");
        let still = successes(&id, &mut BaseStill, 60);
        let follows = successes(&id, &mut BaseFollows::new(base), 60);
        let keeper = successes(&id, &mut ReachKeeper::new(base), 60);
        println!("{id}: {still} {follows} {keeper}");
        assert!(still == 0 && follows > 3 && keeper > 3, "{id}: {still} {follows} {keeper}");
    }
}

#[test]
fn every_task_can_be_done() {
    for task in ["PickPlace", "Door", "Drawer"] {
        let id = format!("MobileManip{task}-v1");
        let keeper = successes(&id, &mut ReachKeeper::new(BaseKind::Omni), 60);
        println!("{id}: {keeper}");
        assert!(keeper > 5, "{id}: {keeper}");
    }
}

/// Runs an episode with small pseudo-random actions and returns all observations and rewards.
fn run(robot: &mut dyn Environment, seen: &mut [f32], steps: usize) -> Vec<u32> {
    let actions = robot.spec().action.len();
    let mut bits = Vec::new();
    for step in 0..steps {
        let action: Vec<_> = (0..actions).map(|at| ((step * 7 + at * 3) % 11) as f32 / 10.0 - 0.5).collect();
        let outcome = robot.step(&action, seen).unwrap();
        bits.extend(seen.iter().map(|number| number.to_bits()));
        bits.push((outcome.reward as f32).to_bits());
        if outcome.is_over() {
            break;
        }
    }
    bits
}

#[test]
fn episodes_repeat_and_come_back() {
    for id in
        ["MobileManipReach-v1", "MobileManipPickPlace-diff-v1", "MobileManipDoor-v1", "MobileManipDrawer-v1"]
    {
        let mut robot = with(id, &[("base_noise", 0.01.into()), ("ik_fail_limit", 5000.into())]);
        let mut seen = [0.0; OBSERVATION_LEN];
        robot.reset(Some(4), &ResetOptions::new(), &mut seen).unwrap();
        let first = run(&mut *robot, &mut seen, 400);
        robot.reset(Some(4), &ResetOptions::new(), &mut seen).unwrap();
        assert_eq!(run(&mut *robot, &mut seen, 400), first, "{id}");
        let (snapshot, mut again) = (robot.snapshot().unwrap(), seen);
        let ahead = run(&mut *robot, &mut seen, 100);
        robot.restore(&snapshot).unwrap();
        assert_eq!(run(&mut *robot, &mut again, 100), ahead, "{id}");
        assert!(robot.render().unwrap().is_some());
    }
}

/// Episodes of this version: others need another version of the environments.
#[test]
fn golden_trajectories_are_the_same_on_every_machine() {
    let mut hash = opendr_engine::model::Sha256Hasher::default();
    for task in ["Reach", "PickPlace", "Door", "Drawer"] {
        for suffix in ["", "-diff"] {
            let mut robot = make(&format!("MobileManip{task}{suffix}-v1")).unwrap();
            let mut seen = [0.0; OBSERVATION_LEN];
            robot.reset(Some(42), &ResetOptions::new(), &mut seen).unwrap();
            run(&mut *robot, &mut seen, 300).iter().for_each(|bits| hash.update(&bits.to_le_bytes()));
        }
    }
    assert_eq!(hash.finish().to_string(), "b22fd60fdbfbffb33650d0d4560730edb9d6c76a9250912886e763f41738aef0");
}

#[test]
fn wrong_options_are_refused() {
    let mut robot = make("MobileManipReach-v1").unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    let options = |name: &str, value: ParamValue| ResetOptions::from([(name.to_owned(), value)]);
    assert!(robot.reset(Some(1), &options("base", "diff".into()), &mut seen).is_err());
    assert!(robot.reset(Some(1), &options("learn_speed", true.into()), &mut seen).is_err());
    assert!(robot.reset(Some(1), &options("base_noise", (-1.0).into()), &mut seen).is_err());
    robot.reset(Some(1), &options("ik_fail_limit", 1.into()), &mut seen).unwrap();
    assert!(robot.step(&[2.0, 0.0, 0.0], &mut seen).is_err());
    assert!(BaseFollows::new(BaseKind::Omni).act(&[0.0; 3], &mut [0.0; 3]).is_err());
    let fast = with("MobileManipReach-diff-v1", &[("learn_speed", true.into())]);
    assert_eq!(fast.spec().action.len(), 3);
}
