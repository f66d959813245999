//! Grasps in the loop: detect, attempt, and detect again until the object is held.

use opendr_engine::Result;
use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::target::PoseList;
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::planar_grasp::{PlanarGrasp, PlanarGraspParams};

use crate::grasp_success::{FIRST_SEED, View, nth_grasp};

/// Returns for each number of attempts, from 1 to `attempts`, how many of the objects of `poses` episodes were held within it.
///
/// In each attempt, `predict` sees the object where the attempts before have pushed it. The first attempt takes the first grasp of its
/// list, the next ones the further grasps: what failed once fails again where nothing has moved.
///
/// # Errors
/// Errors of `predict`, `InvalidParam` for parameters of the environment out of range.
pub fn held_within(
    params: &PlanarGraspParams,
    poses: u64,
    attempts: usize,
    predict: &mut dyn FnMut(View<'_>) -> Result<PoseList>,
) -> Result<Vec<u64>> {
    let mut environment = PlanarGrasp::new(params)?;
    let mut seen = vec![0.0; environment.spec().observation.len()];
    let mut held = vec![0; attempts];
    for seed in FIRST_SEED..FIRST_SEED + poses {
        environment.reset(Some(seed), &ResetOptions::new(), &mut seen)?;
        for attempt in 0..attempts {
            let Some(grasp) = nth_grasp(&environment, attempt, predict)? else { break };
            let step = environment.step(&grasp.action(), &mut seen)?;
            if step.info.success() == Some(true) {
                held[attempt..].iter_mut().for_each(|count| *count += 1);
            }
            if step.terminated {
                break;
            }
        }
    }
    Ok(held)
}
