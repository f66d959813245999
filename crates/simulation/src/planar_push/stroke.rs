//! Strokes: straight pushes from a place on the outline of the T, and the search for the best.

use opendr_engine::Random;

use super::table::Table;
use super::{PUSHER_RADIUS, REACH};
use crate::planar::Pose;
use crate::planar::vector::{Vector2, plus, turned};

/// Share of the fastest speed at which a stroke pushes.
pub(super) const PUSH_SPEED: f64 = 0.5;
/// Clearance of the pusher from the T before a stroke, m.
const CLEARANCE: f64 = 0.005;
/// Room that the pusher needs on its way to the start of a stroke, m.
const ROOM: f64 = 0.004;
/// Longest stroke, control periods.
const LONGEST: usize = 14;
/// Directions of strokes to the inward normal of the outline, rad.
const DIRECTIONS: [f64; 3] = [-0.25, 0.0, 0.25];
/// Error in tolerances below which a stroke may aim at success alone.
const DONE: f64 = 0.8;
/// Cost of a control period, in tolerances.
const STEP_COST: f64 = 0.02;
/// Strokes at most this much worse than the best are as good, as a share of what the best improves.
const NEARLY_AS_GOOD: f64 = 0.03;

/// A stroke in the frame of the T.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Stroke {
    /// Place of the pusher at the start.
    pub start: Vector2,
    /// Outward normal of the outline.
    pub normal: Vector2,
    /// Angle of the push to the inward normal, rad.
    pub direction: f64,
    /// Control periods.
    pub steps: usize,
}

impl Stroke {
    /// Returns the direction of the push in the world, with the T at a pose: it is kept while the T turns.
    pub fn heading(&self, tee: &Pose) -> Vector2 {
        let (sine, cosine) = tee.turn();
        let inward = turned(self.normal, (sine, cosine)).map(|part| -part);
        turned(inward, crate::sine_cosine::sine_cosine(self.direction))
    }
}

/// Returns the stroke after which the T is nearest to the goal; among those nearly as good, a random one. None where none helps.
pub(super) fn best(table: &Table, random: &mut Random) -> Option<Stroke> {
    let now = table.cost();
    let mut rated: Vec<(f64, Stroke)> = Vec::new();
    for (place, normal) in outline(table) {
        if !reachable(table, place, normal) {
            continue;
        }
        for direction in DIRECTIONS {
            let stroke = Stroke { start: place, normal, direction, steps: 0 };
            if let Some(found) = rated_stroke(table, stroke) {
                rated.push(found);
            }
        }
    }
    let best = rated.iter().map(|(cost, _)| *cost).fold(f64::INFINITY, f64::min);
    if best >= now {
        return None;
    }
    let limit = best + NEARLY_AS_GOOD * (now - best);
    rated.retain(|(cost, _)| *cost <= limit);
    rated.get(random.below(rated.len())).map(|(_, stroke)| *stroke)
}

/// Returns places of the pusher beside the outline with the outward normals, in the frame of the T.
fn outline(table: &Table) -> impl Iterator<Item = (Vector2, Vector2)> + '_ {
    let edges = table.tee().parts().iter().flat_map(|part| part.shape.edges().collect::<Vec<_>>());
    edges.flat_map(|[start, end]| {
        let along = plus(end, start, -1.0);
        let length = crate::planar::vector::norm(along);
        let normal = [along[1] / length, -along[0] / length];
        let count = (length / 0.02).round().max(1.0) as usize;
        (0..count).map(move |at| {
            let place = plus(start, along, (at as f64 + 0.5) / count as f64);
            (plus(place, normal, PUSHER_RADIUS + CLEARANCE), normal)
        })
    })
}

/// Returns whether the pusher can come along the normal, on the table.
fn reachable(table: &Table, place: Vector2, normal: Vector2) -> bool {
    let tee = table.tee();
    (0..8).all(|step| {
        let outside = tee.pose.outside(plus(place, normal, 0.01 * f64::from(step)));
        let near = tee.distance(outside) < PUSHER_RADIUS + ROOM;
        !near && outside.iter().all(|part| part.abs() < REACH)
    })
}

/// Returns the stroke with its best length and the cost behind it.
fn rated_stroke(table: &Table, stroke: Stroke) -> Option<(f64, Stroke)> {
    let mut ahead = table.clone();
    ahead.put_pusher(table.tee().pose.outside(stroke.start));
    let action = stroke.heading(&table.tee().pose).map(|part| part * PUSH_SPEED);
    let mut best: Option<(f64, Stroke)> = None;
    for steps in 1..=LONGEST {
        ahead.advance(action);
        if ahead.off_the_table() {
            break;
        }
        let cost = ahead.cost().max(DONE) + STEP_COST * steps as f64;
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, Stroke { steps, ..stroke }));
        }
    }
    best
}
