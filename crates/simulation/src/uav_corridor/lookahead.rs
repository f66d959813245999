//! Choice of the next action by lookahead.

use super::way_costs::WayCosts;
use super::{RADIUS, TURN};
use crate::sine_cosine::sine_cosine;

/// Finds the cheapest flight of two steps under the drone's motion model: each step moves one metre ahead, at most 22.5 degrees from the
/// viewing direction, and turns only then. The costs beyond the two steps are those of [`WayCosts`], which ignore the motion model and
/// would alone lead into dead ends.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lookahead {
    /// Directions ahead and left, from right to left.
    fan: [[f32; 2]; FAN],
}

/// A first step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    /// Heading and change of yaw, each in [-1, 1].
    pub action: [f32; 2],
    /// Where the step leads, along the corridor and to the left.
    pub direction: [f32; 2],
    /// Cost of the cheapest flight that begins with it; infinite for a turn beyond the limit of the yaw.
    pub cost: f32,
}

/// Number of directions in [`TURN`].
const PARTS: usize = 4;
/// Number of directions of the first step.
const HEADINGS: usize = 2 * PARTS + 1;
/// Number of directions of any step, after a turn and with a heading.
const FAN: usize = 2 * HEADINGS - 1;
/// Number of directions of the second step after each turn: every second one.
const ONWARD: usize = PARTS + 1;
/// Changes of yaw: right, none, left.
const TURNS: usize = 3;
/// Number of first steps.
pub(super) const CANDIDATES: usize = HEADINGS * TURNS;
/// Number of points at which a metre is evaluated.
const SAMPLES: u8 = 5;
/// Costs of a contact, of a full heading angle, and of looking aside by [`TURN`].
const TOUCH: f32 = 100.0;
const RUDDER: f32 = 0.05;
const ASIDE: f32 = 0.1;
/// Points nearer to a path than this count as contact.
const TOUCHED: f32 = RADIUS + 0.02;

impl Default for Lookahead {
    fn default() -> Self {
        let direction = |at: usize| {
            let parts = at as f64 - (FAN / 2) as f64;
            let (sine, cosine) = sine_cosine(parts * TURN / PARTS as f64);
            [cosine as f32, sine as f32]
        };
        Self { fan: std::array::from_fn(direction) }
    }
}

impl Lookahead {
    /// Returns heading and change of yaw of the cheapest flight, each in [-1, 1], for a drone in the middle of `costs` and of
    /// `points`, both given along the corridor and to the left.
    pub fn action(&self, costs: &WayCosts, points: &[[f32; 2]], yaw: f64) -> [f32; 2] {
        let candidates = self.candidates(costs, points, yaw);
        let cheapest = |best: Candidate, other: Candidate| if other.cost < best.cost { other } else { best };
        candidates.into_iter().reduce(cheapest).map_or([0.0; 2], |candidate| candidate.action)
    }

    /// Returns all first steps with their costs, for the same arguments as [`Self::action`].
    pub fn candidates(&self, costs: &WayCosts, points: &[[f32; 2]], yaw: f64) -> [Candidate; CANDIDATES] {
        let (sine, cosine) = sine_cosine(yaw);
        let (sine, cosine) = (sine as f32, cosine as f32);
        let fan = self.fan.map(|[ahead, left]| [cosine * ahead - sine * left, sine * ahead + cosine * left]);
        let mut candidates =
            [Candidate { action: [0.0; 2], direction: [0.0; 2], cost: f32::INFINITY }; CANDIDATES];
        for (number, (direction, candidates)) in
            fan[PARTS..][..HEADINGS].iter().zip(candidates.as_chunks_mut::<TURNS>().0).enumerate()
        {
            let heading = number as f32 / PARTS as f32 - 1.0;
            let touch = if is_touched(points, *direction) { TOUCH } else { 0.0 };
            let first = touch + metre(costs, [0.0; 2], *direction);
            let onward: [f32; HEADINGS] = std::array::from_fn(|at| {
                let [x, y] = fan[2 * at];
                metre(costs, *direction, [x, y]) + costs.at([direction[0] + x, direction[1] + y])
            });
            for (turned, candidate) in candidates.iter_mut().enumerate() {
                let turn = turned as f32 - 1.0;
                let aside = (yaw / TURN) as f32 + turn;
                (candidate.action, candidate.direction) = ([heading, turn], *direction);
                // The yaw is limited to a right angle, four times the largest change.
                if turn != 0.0 && aside.abs() > 4.5 {
                    continue;
                }
                let second = onward[2 * turned..][..ONWARD].iter().copied().fold(f32::INFINITY, f32::min);
                let ease = RUDDER * (heading.abs() + turn.abs()) + ASIDE * aside.abs();
                candidate.cost = first + second + ease;
            }
        }
        candidates
    }
}

/// Returns the cost of flying one metre.
fn metre(costs: &WayCosts, [x, y]: [f32; 2], [ahead, left]: [f32; 2]) -> f32 {
    let part = 1.0 / f32::from(SAMPLES);
    let far = |sample| part * f32::from(sample);
    let weights = (1..=SAMPLES).map(far).map(|far| costs.weight([x + far * ahead, y + far * left]));
    part * weights.sum::<f32>()
}

/// Returns whether the drone would touch one of the points in the next metre.
fn is_touched(points: &[[f32; 2]], [ahead, left]: [f32; 2]) -> bool {
    points.iter().any(|[x, y]| {
        let along = (ahead * x + left * y).clamp(0.0, 1.0);
        let (x, y) = (x - along * ahead, y - along * left);
        x * x + y * y < TOUCHED * TOUCHED
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn action(points: &[[f32; 2]], yaw: f64) -> [f32; 2] {
        let mut costs = WayCosts::default();
        costs.find(points.iter().copied(), 0.0, 30.0);
        Lookahead::default().action(&costs, points, yaw)
    }

    #[test]
    fn without_obstacles_it_flies_straight_ahead() {
        assert_eq!(action(&[], 0.0), [0.0; 2]);
        // It turns back along the corridor as soon as possible.
        let [heading, turn] = action(&[], TURN);
        assert!(heading < -0.5 && turn == -1.0, "{heading} {turn}");
        assert_eq!(action(&[], -4.0 * TURN), [1.0; 2]);
    }

    #[test]
    fn it_turns_away_in_time() {
        // A wall 3 m ahead, from 2 m to the right to the left border.
        let wall: Vec<_> = (0..71).map(|step| [3.0, 0.1 * step as f32 - 2.0]).collect();
        let [heading, turn] = action(&wall, 0.0);
        assert!(heading < 0.0 && turn == -1.0, "{heading} {turn}");
        let mirrored: Vec<_> = wall.iter().map(|[x, y]| [*x, -y]).collect();
        assert_eq!(action(&mirrored, 0.0), [-heading, 1.0]);
    }

    #[test]
    fn it_avoids_every_avoidable_point() {
        for left in [-0.2, 0.0, 0.2] {
            let point = [1.0, left];
            let [heading, _] = action(&[point], 0.0);
            let (sine, cosine) = sine_cosine(f64::from(heading) * TURN);
            let way = [cosine as f32, sine as f32];
            assert!(!is_touched(&[point], way), "{left}: {heading}");
        }
    }
}
