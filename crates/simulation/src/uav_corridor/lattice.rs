//! Ways that a drone can fly which neither stops nor turns at once.

use super::{HALF_TRACK, RADIUS, TURN};
use crate::sine_cosine::sine_cosine;

/// Cost to the end of the map from every cell and yaw.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lattice {
    pub weights: Vec<f32>,
    /// Of cell after cell, and yaw after yaw: the cheapest way on, and after the best turn.
    values: Vec<f32>,
    turned: Vec<f32>,
    legs: Vec<Leg>,
    pub settings: Settings,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Settings {
    pub blocked: f32,
    pub blocked_cost: f32,
    pub narrow: f32,
    pub narrow_cost: f32,
    pub rudder: f32,
    pub aside: f32,
    pub touch: f32,
    pub touched: f32,
}

impl Default for Settings {
    fn default() -> Self {
        let var = |name: &str, default: f32| std::env::var(name).ok().map_or(default, |t| t.parse().unwrap());
        Self {
            blocked: var("L_BLOCKED", RADIUS + 0.05),
            blocked_cost: var("L_BLOCKED_COST", 10.0),
            narrow: var("L_NARROW", RADIUS + 0.3),
            narrow_cost: var("L_NARROW_COST", 2.0),
            rudder: var("L_RUDDER", 0.05),
            aside: var("L_ASIDE", 0.1),
            touch: var("L_TOUCH", 100.0),
            touched: var("L_TOUCHED", RADIUS + 0.02),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Leg {
    samples: [[f32; 2]; 5],
    end: [f32; 2],
}

const CELL: f32 = 0.2;
const AHEAD: usize = 50;
const BEHIND: usize = 5;
const ASIDE: usize = 25;
const COLUMNS: usize = BEHIND + 1 + AHEAD;
const ROWS: usize = 2 * ASIDE + 1;
const YAWS: usize = 9;
const PARTS: i32 = 4;
const STEEPEST: i32 = 13;

impl Default for Lattice {
    fn default() -> Self {
        let leg = |parts: i32| {
            let (sine, cosine) = sine_cosine(f64::from(parts) * TURN / f64::from(PARTS));
            let at = |far: f32| [far * cosine as f32 / CELL, far * sine as f32 / CELL];
            Leg { samples: [0.2, 0.4, 0.6, 0.8, 1.0].map(at), end: at(1.0) }
        };
        Self {
            weights: vec![1.0; COLUMNS * ROWS],
            values: vec![0.0; COLUMNS * ROWS * YAWS],
            turned: vec![0.0; COLUMNS * ROWS * YAWS],
            legs: (-STEEPEST..=STEEPEST).map(leg).collect(),
            settings: Settings::default(),
        }
    }
}

impl Lattice {
    pub fn find(&mut self, points: &[[f32; 2]], offset: f32, left: f32) {
        let s = self.settings;
        self.weights.fill(1.0);
        for row in 0..ROWS {
            let side = offset + (row as f32 - ASIDE as f32) * CELL;
            if side.abs() > HALF_TRACK - 0.3 {
                (0..COLUMNS).for_each(|column| self.weights[column * ROWS + row] = s.blocked_cost);
            }
        }
        // Exact distances of points to centres of cells.
        let spread = (s.narrow / CELL).ceil() as i32 + 1;
        for [ahead, aside] in points {
            let (x, y) = (ahead / CELL + BEHIND as f32, aside / CELL + ASIDE as f32);
            let (cx, cy) = (x.round() as i32, y.round() as i32);
            for column in (cx - spread).max(0)..=(cx + spread).min(COLUMNS as i32 - 1) {
                for row in (cy - spread).max(0)..=(cy + spread).min(ROWS as i32 - 1) {
                    let (dx, dy) = ((column as f32 - x) * CELL, (row as f32 - y) * CELL);
                    let away = dx * dx + dy * dy;
                    let weight = if away < s.blocked * s.blocked {
                        s.blocked_cost
                    } else if away < s.narrow * s.narrow {
                        s.narrow_cost
                    } else {
                        continue;
                    };
                    let own = &mut self.weights[column as usize * ROWS + row as usize];
                    *own = own.max(weight);
                }
            }
        }
        self.fly_back(left);
    }

    pub fn fly_back(&mut self, left: f32) {
        self.values.fill(0.0);
        self.turned.fill(0.0);
        let last = ((left / CELL).max(0.0) as usize + BEHIND + 1).min(COLUMNS - 1);
        let mut flown = [0.0f32; (2 * STEEPEST + 1) as usize];
        for column in (0..last).rev() {
            for row in 0..ROWS {
                for (leg, flown) in self.legs.iter().zip(&mut flown) {
                    let sum: f32 = leg.samples.iter().map(|[x, y]| weight(&self.weights, column as f32 + x, row as f32 + y)).sum();
                    *flown = 0.2 * sum;
                }
                let cell = (column * ROWS + row) * YAWS;
                for yaw in 0..YAWS {
                    let own = (yaw as i32 - 4) * PARTS;
                    let mut best = f32::INFINITY;
                    for heading in (own - PARTS).max(-STEEPEST)..=(own + PARTS).min(STEEPEST) {
                        let at = (heading + STEEPEST) as usize;
                        let end = self.legs[at].end;
                        let on = between(&self.turned, column as f32 + end[0], row as f32 + end[1], yaw);
                        let ease = self.settings.rudder * (heading - own).abs() as f32 / PARTS as f32;
                        best = best.min(flown[at] + on + ease);
                    }
                    self.values[cell + yaw] = best + self.settings.aside * (yaw as f32 - 4.0).abs();
                }
                for yaw in 0..YAWS {
                    let v = &self.values[cell..cell + YAWS];
                    let mut best = v[yaw];
                    if yaw > 0 { best = best.min(v[yaw - 1] + self.settings.rudder); }
                    if yaw + 1 < YAWS { best = best.min(v[yaw + 1] + self.settings.rudder); }
                    self.turned[cell + yaw] = best;
                }
            }
        }
    }

    pub fn action(&self, points: &[[f32; 2]], yaw: f64) -> [f32; 2] {
        let s = self.settings;
        let (mut least, mut action) = (f32::INFINITY, [0.0; 2]);
        for number in -PARTS..=PARTS {
            let heading = number as f32 / PARTS as f32;
            let (sine, cosine) = sine_cosine(yaw + f64::from(heading) * TURN);
            let (ahead, aside) = (cosine as f32, sine as f32);
            let touch = if points.iter().any(|[x, y]| {
                let along = (ahead * x + aside * y).clamp(0.0, 1.0);
                let (x, y) = (x - along * ahead, y - along * aside);
                x * x + y * y < s.touched * s.touched
            }) { s.touch } else { 0.0 };
            let at = |far: f32| (far * ahead / CELL + BEHIND as f32, far * aside / CELL + ASIDE as f32);
            let flown: f32 = [0.2, 0.4, 0.6, 0.8, 1.0].iter().map(|far| { let (x, y) = at(*far); weight(&self.weights, x, y) }).sum::<f32>() * 0.2;
            for turn in -1..=1 {
                let next = (yaw / TURN) as f32 + turn as f32;
                if turn != 0 && next.abs() > 4.5 { continue; }
                let place = (next.round() + 4.0).clamp(0.0, 8.0) as usize;
                let (x, y) = at(1.0);
                let cost = touch + flown + s.rudder * (heading.abs() + (turn as f32).abs()) + between(&self.values, x, y, place);
                if cost < least {
                    (least, action) = (cost, [heading, turn as f32]);
                }
            }
        }
        action
    }
}

fn weight(weights: &[f32], x: f32, y: f32) -> f32 {
    let column = ((x + 0.5) as usize).min(COLUMNS - 1);
    let row = ((y + 0.5) as usize).min(ROWS - 1);
    weights[column * ROWS + row]
}

fn between(values: &[f32], x: f32, y: f32, yaw: usize) -> f32 {
    let x = x.clamp(0.0, COLUMNS as f32 - 1.001);
    let y = y.clamp(0.0, ROWS as f32 - 1.001);
    let (column, row) = (x as usize, y as usize);
    let (fx, fy) = (x - column as f32, y - row as f32);
    let at = |column: usize, row: usize| values[(column * ROWS + row) * YAWS + yaw];
    let near = at(column, row) * (1.0 - fy) + at(column, row + 1) * fy;
    let far = at(column + 1, row) * (1.0 - fy) + at(column + 1, row + 1) * fy;
    near * (1.0 - fx) + far * fx
}
