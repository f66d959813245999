//! A policy that flies by OpenDR's observations.

use opendr_engine::environment::{Controller, Space};
use opendr_engine::{Error, Result};
use opendr_kernels::Compute;
use opendr_rl::{Acting, Policy, PolicyMemory};
use opendr_simulation::uav_corridor::FlightMemory;

/// A policy with the memory of its flight: it acts on plain observations of a corridor, one after the other.
#[derive(Clone)]
pub struct DepthPilot {
    policy: Policy,
    /// Of the observations that come in.
    space: Space,
    flight: FlightMemory,
    compute: Compute,
    memory: PolicyMemory,
}

impl DepthPilot {
    /// A pilot that sees observations of `space`, OpenDR's dictionary or a flat box.
    ///
    /// # Errors
    /// `InvalidInput` for a policy that was trained on something else than a [`FlightMemory`].
    pub fn new(policy: Policy, space: Space) -> Result<Self> {
        if (policy.observation(), policy.action()) != (&FlightMemory::space()?, &Space::symmetric(&[1.0; 2]))
        {
            return Err(Error::invalid_input(format!(
                "a policy that sees {} and gives {} flies no corridor; train one by EndToEndPlanning",
                policy.observation(),
                policy.action()
            )));
        }
        let (flight, memory) = (FlightMemory::default(), PolicyMemory::default());
        Ok(Self { policy, space, flight, compute: Compute::single(), memory })
    }

    /// Its policy.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }

    /// Forgets the flight.
    pub fn reset(&mut self) {
        self.flight.reset();
    }

    /// Heading and change of yaw for the next observation of a flight, each in [-1, 1] for +-22.5 degrees.
    ///
    /// # Errors
    /// `InvalidInput` for what is no observation of a corridor, or not finite.
    pub fn fly(&mut self, observation: &[f32], acting: Acting<'_>) -> Result<[f32; 2]> {
        let (mut known, mut action) = ([0.0; FlightMemory::LEN], [0.0; 2]);
        self.flight.see(&self.space, observation, &mut known)?;
        self.policy.act(&self.compute, &known, acting, &mut self.memory, &mut action)?;
        self.flight.acted(action);
        Ok(action)
    }
}

impl Controller for DepthPilot {
    fn reset(&mut self) {
        self.reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let own = self.fly(observation, Acting::Deterministic)?;
        let length = action.len();
        let action = action.as_mut_array().ok_or_else(|| {
            Error::invalid_input(format!(
                "room for {length} numbers of an action; a pilot gives heading and yaw"
            ))
        })?;
        *action = own;
        Ok(())
    }
}
