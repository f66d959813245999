//! End-to-end motion planning of a drone, from its depth camera to heading and yaw.
//!
//! [`end_to_end::EndToEndPlanningRl`] is the learner and the type to begin with; it trains by PPO in the corridor
//! environments of `opendr-simulation`. The wrappers [`end_to_end::DenseObstacles`] and [`end_to_end::TrainingRewards`]
//! change the corridors during training. PPO itself, policies and rollouts are in `opendr-rl`; the environments, their
//! rewards and the memory of a flight are in `opendr-simulation`.
//!
//! ```
//! use opendr_engine::environment::{Environment, ResetOptions};
//! use opendr_planning::end_to_end::DenseObstacles;
//!
//! let mut corridor = DenseObstacles::new(opendr_simulation::make("UavDepthCorridor-v1")?);
//! let mut observation = vec![0.0; corridor.spec().observation.len()];
//! corridor.reset(Some(3), &ResetOptions::new(), &mut observation)?;
//! let step = corridor.step(&[0.0, 0.0], &mut observation)?;
//! assert!(step.reward.is_finite());
//! # Ok::<_, opendr_engine::Error>(())
//! ```

pub mod end_to_end;
