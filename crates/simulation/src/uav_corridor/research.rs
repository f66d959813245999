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

use super::occlusion::*;
use opendr_engine::Random;

fn aheads(observation: &[f32]) -> [f32; SIDE] {
    let slope = |at: usize| HALF_WIDTH * (1.0 - 2.0 * (at as f32 + 0.5) / SIDE as f32);
    let mut nearest = [RANGE; SIDE];
    for row in 0..SIDE {
        let up = slope(row);
        for column in 0..SIDE {
            let depth = observation[row * SIDE + column] * RANGE / 255.0;
            if (depth * up + CAMERA_HEIGHT).abs() < RADIUS + 0.05 {
                nearest[column] = nearest[column].min(depth);
            }
        }
    }
    nearest
}

struct Flyer {
    corridor: UavDepthCorridor,
    memory: FlightMemory,
    frames: Vec<Frame>,
    raster: Raster,
    observation: Vec<f32>,
    costs: WayCosts,
    lookahead: Lookahead,
    kino: Lattice,
    known: [f32; FlightMemory::LEN],
}

impl Flyer {
    fn new(dense: bool) -> Self {
        let corridor = env(dense);
        let observation = vec![0.0; corridor.spec().observation.len()];
        Self { corridor, memory: FlightMemory::default(), frames: Vec::new(), raster: Raster::new(), observation,
            costs: WayCosts::default(), lookahead: Lookahead::default(), kino: Lattice::default(), known: [0.0; FlightMemory::LEN] }
    }
    fn reset(&mut self, seed: u64) {
        self.corridor.reset(Some(seed), &ResetOptions::new(), &mut self.observation).unwrap();
        self.memory.reset();
        self.frames.clear();
    }
    fn see(&mut self, draws: bool) {
        let space = self.corridor.spec().observation.clone();
        self.memory.see(&space, &self.observation, &mut self.known).unwrap();
        let [x, y, _] = self.corridor.position();
        self.frames.push(frame(x, y, self.corridor.yaw(), aheads(&self.observation)));
        let from = self.frames.len().saturating_sub(FlightMemory::FRAMES);
        if draws { self.raster.draw(&self.frames[from..], self.memory.along(), x, y); }
    }
    fn learnt(&mut self, guess: &Guess, gains: [f32; 2]) {
        let (mut x, mut h) = ([0.0; FEATURES], [0.0; HIDDEN]);
        for column in 0..COLUMNS {
            for row in 0..ROWS {
                let cell = column * ROWS + row;
                let side = self.raster.offset + (row as f32 - ASIDE as f32) * CELL;
                let weight = if side.abs() > HALF_TRACK - 0.3 { 10.0 } else if self.raster.is_clear(cell) { 1.0 } else {
                    self.raster.features(column, row, &mut x);
                    let [b, n] = guess.forward(&x, &mut h);
                    1.0 + gains[0] * b + gains[1] * n
                };
                self.costs.weights[cell] = weight;
                self.kino.weights[cell] = weight;
            }
        }
    }
}

#[test]
#[ignore]
fn guess() {
    let var = |name: &str, d: f32| std::env::var(name).map_or(d, |t| t.parse::<f32>().unwrap());
    let train = var("TRAIN", 500.0) as u64;
    let begun = std::time::Instant::now();
    let (mut xs, mut ts) = (Vec::<[f32; FEATURES]>::new(), Vec::<[f32; 2]>::new());
    let mut random = Random::new(7);
    for dense in [true, false] {
        let mut f = Flyer::new(dense);
        for seed in 0..train / (1 + u64::from(!dense)) {
            f.reset(10_000 + seed);
            for _ in 0..100 {
                f.see(true);
                let [x, y, _] = f.corridor.position();
                for _ in 0..30 {
                    let (column, row) = (random.below(COLUMNS), random.below(ROWS));
                    let side = y + (row as f32 - ASIDE as f32) * CELL;
                    if f.raster.is_clear(column * ROWS + row) || side.abs() > HALF_TRACK - 0.3 { continue; }
                    let mut features = [0.0; FEATURES];
                    f.raster.features(column, row, &mut features);
                    let gap = f.corridor.world().scene().distance([x + (column as f32 - BEHIND as f32) * CELL, side, HEIGHT]);
                    xs.push(features);
                    ts.push([f32::from(gap < 0.3), f32::from(gap < 0.55)]);
                }
                let yaw = f.corridor.yaw();
                f.costs.find(f.memory.along().iter().copied(), y, FINISH - x);
                let action = f.lookahead.action(&f.costs, f.memory.along(), yaw);
                let step = f.corridor.step(&action, &mut f.observation).unwrap();
                f.memory.acted(action);
                if step.terminated { break; }
            }
        }
    }
    let means = ts.iter().fold([0.0f64; 2], |s, t| [s[0] + f64::from(t[0]), s[1] + f64::from(t[1])]).map(|s| s / ts.len() as f64);
    println!("{} samples, {means:?}, {:.1} s", xs.len(), begun.elapsed().as_secs_f64());
    let mut g = Guess { w: (0..TOTAL).map(|i| if i < W1 { random.uniform(-0.15, 0.15) } else if (B1..W2).contains(&i) { random.uniform(-0.2, 0.2) } else { 0.0 }).collect() };
    let (mut m, mut v, mut d) = (vec![0.0f32; TOTAL], vec![0.0f32; TOTAL], vec![0.0f32; TOTAL]);
    let epochs = var("EPOCHS", 4.0) as usize;
    let batch = 256;
    let steps = epochs * xs.len() / batch;
    let mut loss = 0.0;
    for step in 1..=steps {
        d.fill(0.0);
        for _ in 0..batch {
            let at = random.below(xs.len());
            let (x, t) = (&xs[at], &ts[at]);
            let mut h = [0.0; HIDDEN];
            let p = g.forward(x, &mut h);
            let e = [p[0] - t[0], p[1] - t[1]];
            loss -= (0..2).map(|k| if t[k] > 0.5 { p[k].max(1e-7).ln() } else { (1.0 - p[k]).max(1e-7).ln() }).sum::<f32>() / (batch as f32 * 500.0);
            d[W2] += e[0]; d[W2 + 1] += e[1];
            let mut dh = [0.0; HIDDEN];
            for k in 0..HIDDEN {
                d[B1 + 2 * k] += e[0] * h[k];
                d[B1 + 2 * k + 1] += e[1] * h[k];
                if h[k] > 0.0 { dh[k] = e[0] * g.w[B1 + 2 * k] + e[1] * g.w[B1 + 2 * k + 1]; d[W1 + k] += dh[k]; }
            }
            for (x, row) in x.iter().zip(d[..W1].chunks_exact_mut(HIDDEN)) {
                for (d, dh) in row.iter_mut().zip(&dh) { *d += x * dh; }
            }
        }
        let rate = 3e-3 * (1.0 - step as f32 / steps as f32) + 1e-5;
        let (c1, c2) = (1.0 - 0.9f32.powi(step as i32), 1.0 - 0.999f32.powi(step as i32));
        for i in 0..TOTAL {
            let gr = d[i] / batch as f32;
            m[i] = 0.9 * m[i] + 0.1 * gr;
            v[i] = 0.999 * v[i] + 0.001 * gr * gr;
            g.w[i] -= rate * (m[i] / c1) / ((v[i] / c2).sqrt() + 1e-8);
        }
        if step % 500 == 0 { if step % 2000 == 0 { println!("{step}/{steps}: loss {loss:.4}"); } loss = 0.0; }
    }
    println!("trained, {:.1} s", begun.elapsed().as_secs_f64());
    let worlds = var("WORLDS", 300.0) as u64;
    let first = std::env::var("FIRST").map_or(5_000_000, |t| t.parse::<u64>().unwrap());
    for (kino, gains) in [(false, [9.0, 1.0]), (false, [12.0, 3.0]), (false, [9.0, 3.0]), (false, [5.0, 1.0]), (false, [9.0, 0.3])] {
        let mut f = Flyer::new(true);
        let begun = std::time::Instant::now();
        let mut good = 0;
        for world in 0..worlds {
            f.reset(first + world);
            for _ in 0..100 {
                f.see(true);
                let [x, y, _] = f.corridor.position();
                let yaw = f.corridor.yaw();
                f.learnt(&g, gains);
                let action = if kino {
                    f.kino.fly_back(FINISH - x);
                    f.kino.action(f.memory.along(), yaw)
                } else {
                    let _ = y;
                    f.costs.fly_back(FINISH - x);
                    f.lookahead.action(&f.costs, f.memory.along(), yaw)
                };
                let step = f.corridor.step(&action, &mut f.observation).unwrap();
                f.memory.acted(action);
                if step.terminated { good += u64::from(step.info.get("success") == Some(1.0)); break; }
            }
        }
        println!("kino {kino} gains {gains:?}: {:.1} %, {:.1} s", 100.0 * good as f64 / worlds as f64, begun.elapsed().as_secs_f64());
    }
}
