//! Camera policies without training, for comparison.

use opendr_engine::rig::ViewPose;
use opendr_engine::{Random, Result};

use super::{CameraContext, CameraPolicy};

/// Does not move.
#[derive(Debug, Clone, Copy, Default)]
pub struct StaticBaseline;

impl CameraPolicy for StaticBaseline {
    fn choose(&mut self, _: &CameraContext<'_>, action: &mut [f32]) -> Result<()> {
        action.fill(0.0);
        Ok(())
    }
}

/// Moves at random, uniformly on each axis.
#[derive(Debug, Clone)]
pub struct RandomBaseline(Random);

impl Default for RandomBaseline {
    fn default() -> Self {
        Self(Random::new(0))
    }
}

impl CameraPolicy for RandomBaseline {
    fn begin(&mut self, seed: u64) {
        self.0 = Random::from_key([seed, 0x3a4d]);
    }

    fn choose(&mut self, _: &CameraContext<'_>, action: &mut [f32]) -> Result<()> {
        action.iter_mut().for_each(|axis| *axis = self.0.uniform(-1.0, 1.0));
        Ok(())
    }
}

/// Moves around the subject in one direction at full deflection, at the middle of the elevations and as near as possible.
#[derive(Debug, Clone, Copy, Default)]
pub struct OrbitBaseline;

impl CameraPolicy for OrbitBaseline {
    fn choose(&mut self, context: &CameraContext<'_>, action: &mut [f32]) -> Result<()> {
        let middle = context.axes.get(1).map_or(0.0, |axis| 0.5 * (axis.low + axis.high));
        let level = ViewPose { elevation: middle, distance: 0.0, ..context.pose };
        deflections_to(&level, context, action);
        if let Some(azimuth) = action.first_mut() {
            *azimuth = 1.0;
        }
        Ok(())
    }
}

/// Moves the shortest way to the best pose, which only a simulator knows, and stays there. It is no upper bound: a policy that
/// combines several good poses may end more certain.
#[derive(Debug, Clone, Copy, Default)]
pub struct OracleBaseline;

impl CameraPolicy for OracleBaseline {
    fn choose(&mut self, context: &CameraContext<'_>, action: &mut [f32]) -> Result<()> {
        deflections_to(&context.best.unwrap_or(context.pose), context, action);
        Ok(())
    }
}

/// Writes the deflections towards a pose, as far as one motion leads.
pub(crate) fn deflections_to(goal: &ViewPose, context: &CameraContext<'_>, action: &mut [f32]) {
    let (goal, here) = (positions(goal), positions(&context.pose));
    for (at, (axis, deflection)) in context.axes.iter().zip(action).enumerate() {
        let goal = if axis.wraps { goal[at] } else { goal[at].clamp(axis.low, axis.high) };
        let mut way = goal - here[at];
        if axis.wraps {
            let round = axis.high - axis.low;
            way -= round * (way / round).round();
        }
        *deflection = (way / axis.step).clamp(-1.0, 1.0) as f32;
    }
}

fn positions(pose: &ViewPose) -> [f64; 4] {
    [pose.azimuth, pose.elevation, pose.distance, pose.fourth]
}
