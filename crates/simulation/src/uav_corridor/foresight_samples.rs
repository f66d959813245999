//! First steps of flights, and how the flights ended.

use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::{Random, Result};

use super::{FlightMemory, UavDepthCorridor};

/// Steps that were tried from places of flights: what a [`Foresight`](super::Foresight) is learnt from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ForesightSamples {
    /// [`Foresight::FEATURES`](super::Foresight::FEATURES) numbers of each step.
    pub features: Vec<f32>,
    /// 1 where the flight failed after the step, else 0.
    pub targets: Vec<f32>,
}

/// Places of a flight from which steps are tried: the last ones of a flight that failed, random ones of another.
const PLACES: [usize; 2] = [10, 3];
/// Steps tried from each place.
const TRIED: usize = 12;

/// A place of a flight.
struct Place {
    memory: FlightMemory,
    corridor: UavDepthCorridor,
}

impl ForesightSamples {
    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// Flies as `memory` proposes in the episode of `seed`, then again from some places of the flight, with another first step each.
    ///
    /// # Errors
    /// Those of the corridor.
    pub fn fly(
        &mut self,
        memory: &FlightMemory,
        corridor: &mut UavDepthCorridor,
        options: &ResetOptions,
        seed: u64,
    ) -> Result<()> {
        let mut observation = vec![0.0; corridor.spec().observation.len()];
        let mut random = Random::from_key([seed, 3]);
        let mut memory = memory.clone();
        memory.reset();
        corridor.reset(Some(seed), options, &mut observation)?;
        let mut places = Vec::new();
        let failed = finish(&mut memory, corridor, &mut observation, &mut |memory, corridor| {
            places.push(Place { memory: memory.clone(), corridor: corridor.clone() });
        })?;
        let [last, any] = PLACES;
        if failed {
            places.drain(..places.len().saturating_sub(last));
        } else {
            random.shuffle(&mut places);
            places.truncate(any);
        }
        for place in &places {
            self.try_steps(place, &mut observation, &mut random)?;
        }
        Ok(())
    }

    fn try_steps(&mut self, place: &Place, observation: &mut [f32], random: &mut Random) -> Result<()> {
        let mut steps = Vec::new();
        place.memory.each_step(&mut |action, features| steps.push((action, *features)));
        random.shuffle(&mut steps);
        for (action, features) in steps.iter().take(TRIED) {
            let (mut memory, mut corridor) = (place.memory.clone().without_models(), place.corridor.clone());
            let step = corridor.step(action, observation)?;
            let failed = match step.terminated {
                true => step.info.success() != Some(true),
                false => {
                    memory.record_action(*action);
                    finish(&mut memory, &mut corridor, observation, &mut |_, _| {})?
                }
            };
            self.features.extend_from_slice(features);
            self.targets.push(f32::from(u8::from(failed)));
        }
        Ok(())
    }
}

/// Flies on to the end as `memory` proposes; `observer` receives each place before the step from there. Returns whether the flight
/// failed.
fn finish(
    memory: &mut FlightMemory,
    corridor: &mut UavDepthCorridor,
    observation: &mut [f32],
    observer: &mut dyn FnMut(&FlightMemory, &UavDepthCorridor),
) -> Result<bool> {
    let space = corridor.spec().observation.clone();
    let limit = corridor.spec().max_episode_steps.unwrap_or(u32::MAX);
    let mut known = [0.0; FlightMemory::LEN];
    for _ in 0..limit {
        memory.update(&space, observation, &mut known)?;
        observer(memory, corridor);
        let action = memory.corrected_action([0.0; 2]);
        let step = corridor.step(&action, observation)?;
        if step.terminated {
            return Ok(step.info.success() != Some(true));
        }
        memory.record_action(action);
    }
    Ok(true)
}
