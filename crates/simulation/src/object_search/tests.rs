use opendr_engine::Random;
use opendr_engine::environment::{Controller as _, Environment, ResetOptions};
use opendr_engine::params::ParamValue;

use super::grid::{CELLS, distance, middle};
use super::*;
use crate::make;

fn plan(seed: u64) -> FloorPlan {
    FloorPlan::generate(&mut Random::new(seed), &ObjectSearchParams::default())
}

#[test]
fn plans_have_rooms_doors_and_reachable_objects() {
    for seed in 0..40 {
        let plan = plan(seed);
        let occupied = (0..CELLS).filter(|cell| plan.occupies(*cell)).count();
        assert!((700..4000).contains(&occupied), "{seed}: {occupied} cells");
        let [x, y, _] = plan.start();
        for (at, object) in plan.objects().iter().enumerate() {
            assert!(plan.way_to(at, [x, y]).is_some_and(|way| way >= distance(*object, [x, y]) * 0.98));
            assert!(!plan.is_occupied(*object));
        }
        // No way past all objects is shorter than the way to the farthest one.
        let farthest = (0..OBJECTS).filter_map(|at| plan.way_to(at, [x, y])).fold(0.0, f64::max);
        assert!(plan.shortest() >= farthest - 1e-9 && plan.shortest() < 120.0, "{}", plan.shortest());
    }
}

#[test]
fn the_camera_sees_no_farther_than_walls() {
    for seed in 0..10 {
        let plan = plan(seed);
        let mut map = KnownMap::default();
        let params = ObjectSearchParams { field_of_view: 360.0, ..ObjectSearchParams::default() };
        sensor::reveal(&plan, plan.start(), &params, &mut map);
        let [x, y, _] = plan.start();
        let known: Vec<_> = (0..CELLS).filter(|cell| map.cell(*cell) != Cell::Unknown).collect();
        assert!(known.len() > 100);
        for cell in known {
            assert_eq!(map.cell(cell) == Cell::Occupied, plan.occupies(cell));
            assert!(distance(middle(cell), [x, y]) < params.range + 0.15);
        }
    }
}

/// Success rate and mean success weighted by path length of frontier exploration.
fn explored(seeds: &[u64]) -> (f64, f64) {
    let mut flat = make("ObjectSearch2D-frontier-v1").unwrap();
    let mut seen = vec![0.0; flat.spec().observation.len()];
    let (mut successes, mut weighted) = (0.0, 0.0);
    for seed in seeds {
        flat.reset(Some(*seed), &ResetOptions::new(), &mut seen).unwrap();
        let mut action = [0.0];
        loop {
            NearestFrontier.act(&seen, &mut action).unwrap();
            let step = flat.step(&action, &mut seen).unwrap();
            if step.is_over() {
                successes += step.info.get("success").unwrap();
                weighted += step.info.get("spl").unwrap();
                break;
            }
        }
    }
    (successes / seeds.len() as f64, weighted / seeds.len() as f64)
}

#[test]
fn frontier_exploration_finds_the_objects() {
    let (success, weighted) = explored(&(0..60).collect::<Vec<_>>());
    println!("success {success:.3}, weighted by path length {weighted:.3}");
    assert!(success > 0.95 && weighted > 0.6 && weighted < success, "{success} {weighted}");
}

/// Here what the robot drives to is hidden from beside the place from which it can be seen.
#[test]
fn the_robot_drives_to_where_it_can_see() {
    assert_eq!(explored(&[1_000_018, 1_000_020, 1_000_057]).0, 1.0);
}

/// Runs an episode and returns all observations and rewards.
fn run(flat: &mut dyn Environment, seen: &mut [f32], steps: usize) -> Vec<u32> {
    let mut bits = Vec::new();
    for step in 0..steps {
        let action = match flat.spec().action.len() {
            1 => vec![(step % 3) as f32],
            _ => vec![0.9 - (step % 5) as f32 * 0.2, (step % 7) as f32 * 0.2 - 0.5],
        };
        let outcome = flat.step(&action, seen).unwrap();
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
    for (id, steps) in [("ObjectSearch2D-v1", 60), ("ObjectSearch2D-frontier-v1", 6)] {
        let mut flat = make(id).unwrap();
        let mut seen = vec![0.0; flat.spec().observation.len()];
        flat.reset(Some(4), &ResetOptions::new(), &mut seen).unwrap();
        let first = run(&mut *flat, &mut seen, steps);
        flat.reset(Some(4), &ResetOptions::new(), &mut seen).unwrap();
        assert_eq!(run(&mut *flat, &mut seen, steps), first, "{id}");
        let (snapshot, mut again) = (flat.snapshot().unwrap(), seen.clone());
        let ahead = run(&mut *flat, &mut seen, steps);
        flat.restore(&snapshot).unwrap();
        assert_eq!(run(&mut *flat, &mut again, steps), ahead, "{id}");
        assert!(flat.render().unwrap().is_some());
    }
}

/// Episodes of this version: others need another version of the environments.
#[test]
fn golden_trajectories_are_the_same_on_every_machine() {
    let mut hash = opendr_engine::model::Sha256Hasher::default();
    for id in ["ObjectSearch2D-v1", "ObjectSearch2D-frontier-v1"] {
        let mut flat = make(id).unwrap();
        let mut seen = vec![0.0; flat.spec().observation.len()];
        flat.reset(Some(42), &ResetOptions::new(), &mut seen).unwrap();
        run(&mut *flat, &mut seen, 100).iter().for_each(|bits| hash.update(&bits.to_le_bytes()));
    }
    assert_eq!(hash.finish().to_string(), "a6609a6e6a75f121465ffbe17c3f8c570d1d0d974682d0dc9b0a7f655478327e");
}

#[test]
fn wrong_options_are_refused() {
    let mut flat = make("ObjectSearch2D-v1").unwrap();
    let mut seen = vec![0.0; flat.spec().observation.len()];
    for (name, value) in [("range", 0.0), ("field_of_view", 400.0), ("rooms", 3.0)] {
        let options = ResetOptions::from([(name.to_owned(), ParamValue::Float(value))]);
        assert!(flat.reset(Some(1), &options, &mut seen).is_err(), "{name}");
    }
    flat.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
    assert!(flat.step(&[1.5, 0.0], &mut seen).is_err());
}
