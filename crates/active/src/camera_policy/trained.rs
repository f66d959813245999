//! The policy of reinforcement learning.

use opendr_engine::Result;
use opendr_kernels::Compute;
use opendr_rl::{ActionMode, Policy, PolicyMemory};

use super::{CameraContext, CameraPolicy};

/// Chooses the most likely motions of a policy that an [`ActiveEnvironment`](crate::ActiveEnvironment) trained.
#[derive(Debug)]
pub struct TrainedPolicy {
    policy: Policy,
    compute: Compute,
    memory: PolicyMemory,
}

impl TrainedPolicy {
    /// Creates it from a policy.
    pub fn new(policy: Policy) -> Self {
        Self { policy, compute: Compute::single(), memory: PolicyMemory::default() }
    }

    /// Returns the number of axes of a motion.
    pub fn axes(&self) -> usize {
        self.policy.action().len()
    }
}

impl CameraPolicy for TrainedPolicy {
    fn begin(&mut self, _: u64) {
        self.memory.reset(0);
    }

    fn choose(&mut self, context: &CameraContext<'_>, action: &mut [f32]) -> Result<()> {
        let Self { policy, compute, memory } = self;
        // The mean of a Gaussian may lie outside of the axes; outputs that are not finite are errors before they are clipped.
        policy.act(compute, context.observation, ActionMode::Deterministic, memory, action)?;
        action.iter_mut().for_each(|axis| *axis = axis.clamp(-1.0, 1.0));
        Ok(())
    }
}
