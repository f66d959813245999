//! Experiments.
use opendr_engine::environment::{Environment as _, ResetOptions};
use super::*;
use crate::Registered as _;
use super::lattice::Lattice;
use super::lookahead::Lookahead;
use super::way_costs::WayCosts;

fn env(dense: bool) -> UavDepthCorridor {
    let mut params = UavDepthCorridorParams::default();
    if dense { params.options.min_obstacles = 8; params.options.max_obstacles = 10; }
    UavDepthCorridor::new(&params).unwrap()
}

/// Points of the slice of the whole world around the drone, along the corridor.
fn oracle(corridor: &UavDepthCorridor, points: &mut Vec<[f32; 2]>) {
    points.clear();
    let [x, y, _] = corridor.position();
    for column in -10..105 {
        for row in -50..=50 {
            let place = [x + column as f32 * 0.1, row as f32 * 0.1, HEIGHT];
            let gap = corridor.world().scene().distance(place);
            if gap.abs() < 0.08 { points.push([place[0] - x, place[1] - y]); }
        }
    }
}

#[test]
#[ignore]
fn analyse() {
    let mode = std::env::var("MODE").unwrap_or_default();
    let full = mode.contains("full");
    let lattice = mode.contains("lattice");
    let worlds: u64 = std::env::var("WORLDS").map_or(300, |t| t.parse().unwrap());
    let mut corridor = env(!mode.contains("plain"));
    let space = corridor.spec().observation.clone();
    let mut observation = vec![0.0; space.len()];
    let mut memory = FlightMemory::default();
    let (mut costs, lookahead, mut kino) = (WayCosts::default(), Lookahead::default(), Lattice::default());
    let mut known = [0.0; FlightMemory::LEN];
    let mut points = Vec::new();
    let [mut good, mut passable, mut hit_known, mut hit_unknown, mut off, mut late] = [0; 6];
    let begun = std::time::Instant::now();
    for world in 0..worlds {
        corridor.reset(Some(std::env::var("FIRST").map_or(1_000_000, |t| t.parse::<u64>().unwrap()) + world), &ResetOptions::new(), &mut observation).unwrap();
        memory.reset();
        let way = corridor.world().is_passable();
        passable += u64::from(way);
        let mut trace = Vec::new();
        for step in 0..100 {
            memory.see(&space, &observation, &mut known).unwrap();
            let yaw = corridor.yaw();
            if full { oracle(&corridor, &mut points); } else { points.clear(); points.extend_from_slice(memory.along()); }
            let [_, y, _] = corridor.position();
            let left = FINISH - corridor.position()[0];
            let action = if lattice {
                kino.find(&points, y, left);
                kino.action(&points, yaw)
            } else {
                costs.find(points.iter().copied(), y, left);
                lookahead.action(&costs, &points, yaw)
            };
            let before = corridor.position();
            let seen = memory.along().to_vec();
            let outcome = corridor.step(&action, &mut observation).unwrap();
            memory.acted(action);
            trace.push((before, yaw, action));
            if outcome.terminated || step == 99 {
                let success = outcome.info.get("success") == Some(1.0);
                if success { good += 1; break; }
                if outcome.info.get("collision") == Some(1.0) {
                    let here = corridor.position();
                    let hit = [here[0] - before[0], here[1] - before[1]];
                    let near = seen.iter().map(|[x, y]| ((x - hit[0]).powi(2) + (y - hit[1]).powi(2)).sqrt()).fold(f32::INFINITY, f32::min);
                    if near < 0.45 { hit_known += 1 } else { hit_unknown += 1 }
                    if mode.contains("verbose") { println!("world {world} way {way} near {near:.2} at {here:?} yaw {:.2} {:?}", yaw, &trace[trace.len().saturating_sub(4)..]); }
                } else if outcome.terminated { off += 1 } else { late += 1 }
                break;
            }
        }
    }
    println!("{mode}: {:.1} % of {worlds} ({passable} passable): known {hit_known} unknown {hit_unknown} off {off} late {late}; {:.1} s", 100.0 * good as f64 / worlds as f64, begun.elapsed().as_secs_f64());
}
