//! What decides on movements: the trained policy, and what it is compared with.

use opendr_engine::rig::{ViewAxis, ViewPose};
use opendr_engine::{Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{ActionMode, Policy, PolicyMemory};

use crate::gain::GainNetwork;

/// What is known when a movement is chosen.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// As [`Observer`](crate::Observer) writes it.
    pub observation: &'a [f32],
    /// Where the camera is.
    pub pose: ViewPose,
    /// Axes of the rig.
    pub axes: &'a [ViewAxis],
    /// The best pose, for the oracle alone.
    pub best: Option<ViewPose>,
}

/// Chooses movements.
pub trait Mover {
    /// Begins an episode.
    fn begin(&mut self, seed: u64) {
        let _ = seed;
    }

    /// Writes the deflection of each axis, each in [-1, 1]; `false` to take the next picture without moving.
    ///
    /// # Errors
    /// Those of a network.
    fn choose(&mut self, situation: &Situation<'_>, action: &mut [f32]) -> Result<bool>;
}

/// Takes all pictures from where it begins.
#[derive(Debug, Clone, Copy, Default)]
pub struct Stare;

impl Mover for Stare {
    fn choose(&mut self, _: &Situation<'_>, action: &mut [f32]) -> Result<bool> {
        action.fill(0.0);
        Ok(false)
    }
}

/// Moves by chance.
#[derive(Debug, Clone)]
pub struct RandomMover(Random);

impl Default for RandomMover {
    fn default() -> Self {
        Self(Random::new(0))
    }
}

impl Mover for RandomMover {
    fn begin(&mut self, seed: u64) {
        self.0 = Random::from_key([seed, 0x3a4d]);
    }

    fn choose(&mut self, _: &Situation<'_>, action: &mut [f32]) -> Result<bool> {
        action.iter_mut().for_each(|axis| *axis = self.0.uniform(-1.0, 1.0));
        Ok(true)
    }
}

/// Goes round one way at full deflection, comes as near as it can and levels out.
#[derive(Debug, Clone, Copy, Default)]
pub struct Orbit;

impl Mover for Orbit {
    fn choose(&mut self, situation: &Situation<'_>, action: &mut [f32]) -> Result<bool> {
        let level = ViewPose { elevation: 0.1, distance: 0.0, ..situation.pose };
        towards(&level, situation, action);
        action[0] = 1.0;
        Ok(true)
    }
}

/// Goes the shortest way to the best pose, which only a simulator knows, and stays there. No upper bound: views from one place
/// count once, and a mover that looks from several good places may end more certain.
#[derive(Debug, Clone, Copy, Default)]
pub struct Oracle;

impl Mover for Oracle {
    fn choose(&mut self, situation: &Situation<'_>, action: &mut [f32]) -> Result<bool> {
        towards(&situation.best.unwrap_or(situation.pose), situation, action);
        Ok(true)
    }
}

/// Deflections that lead to a pose as far as one movement goes.
fn towards(goal: &ViewPose, situation: &Situation<'_>, action: &mut [f32]) {
    let (goal, here) = (positions(goal), positions(&situation.pose));
    for (at, (axis, deflection)) in situation.axes.iter().zip(action).enumerate() {
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

/// Takes, of all movements with each axis at -1, 0 or 1, the one with the highest expected gain.
pub struct Greedy {
    gain: GainNetwork,
    candidates: Vec<f32>,
    compute: Compute,
}

impl Greedy {
    /// By a network of expected gains.
    pub fn new(gain: GainNetwork) -> Self {
        let axes = gain.axes();
        let choices = 3usize.pow(axes as u32);
        let digit = |choice: usize, axis: usize| choice / 3usize.pow(axis as u32) % 3;
        let candidates =
            (0..choices).flat_map(|choice| (0..axes).map(move |axis| digit(choice, axis) as f32 - 1.0));
        Self { candidates: candidates.collect(), gain, compute: Compute::single() }
    }
}

impl Mover for Greedy {
    fn choose(&mut self, situation: &Situation<'_>, action: &mut [f32]) -> Result<bool> {
        let gains = self.gain.predict(&self.compute, situation.observation, &self.candidates);
        let best = gains.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(at, _)| at);
        let axes = action.len();
        action.copy_from_slice(&self.candidates[best * axes..(best + 1) * axes]);
        Ok(true)
    }
}

/// The most likely movements of a policy.
pub struct PolicyMover {
    policy: Policy,
    compute: Compute,
    memory: PolicyMemory,
}

impl PolicyMover {
    /// By a policy that an [`ActiveEnvironment`](crate::ActiveEnvironment) trained.
    pub fn new(policy: Policy) -> Self {
        Self { policy, compute: Compute::single(), memory: PolicyMemory::default() }
    }
}

impl Mover for PolicyMover {
    fn begin(&mut self, _: u64) {
        self.memory.reset(0);
    }

    fn choose(&mut self, situation: &Situation<'_>, action: &mut [f32]) -> Result<bool> {
        let Self { policy, compute, memory } = self;
        policy.act(compute, situation.observation, ActionMode::Deterministic, memory, action)?;
        action.iter_mut().for_each(|axis| *axis = axis.clamp(-1.0, 1.0));
        Ok(true)
    }
}
