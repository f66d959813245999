//! What maps of flights show, and what was there.

use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::{Random, Result};

use super::map_raster::{CELLS, FEATURES, ROWS, centre};
use super::way_costs::BLOCKED;
use super::{FlightMemory, HALF_TRACK, HEIGHT, Surroundings, UavDepthCorridor};

/// Cells of maps with what was really around them: what [`Surroundings`] are learnt from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurroundingsSamples {
    /// [`Surroundings::FEATURES`] numbers of each cell.
    pub features: Vec<f32>,
    /// For each of [`Surroundings::DISTANCES`], 1 where something was nearer, else 0.
    pub targets: Vec<f32>,
}

/// Cells of each map that are tried; those that were seen to be clear are left out.
const TRIED: usize = 30;

impl SurroundingsSamples {
    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.targets.len() / Surroundings::OUTPUTS
    }

    /// Returns whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// Flies as a [`FlightMemory`] proposes, in the episode of `seed`, and adds cells by chance from the map of each step.
    ///
    /// # Errors
    /// Those of the corridor.
    pub fn fly(&mut self, corridor: &mut UavDepthCorridor, options: &ResetOptions, seed: u64) -> Result<()> {
        let space = corridor.spec().observation.clone();
        let limit = corridor.spec().max_episode_steps.unwrap_or(u32::MAX);
        let (mut memory, mut random) = (FlightMemory::default(), Random::from_key([seed, 1]));
        let (mut observation, mut known) = (vec![0.0; space.len()], [0.0; FlightMemory::LEN]);
        corridor.reset(Some(seed), options, &mut observation)?;
        for _ in 0..limit {
            memory.update(&space, &observation, &mut known)?;
            self.add(&mut memory, corridor, &mut random);
            let action = memory.corrected_action([0.0; 2]);
            if corridor.step(&action, &mut observation)?.is_over() {
                break;
            }
            memory.record_action(action);
        }
        Ok(())
    }

    fn add(&mut self, memory: &mut FlightMemory, corridor: &UavDepthCorridor, random: &mut Random) {
        let ([x, y, _], raster) = (corridor.position(), memory.draw_map());
        let mut features = [0.0; FEATURES];
        for cell in (0..TRIED).map(|_| random.below(CELLS)) {
            if raster.is_clear(cell) || raster.side(cell % ROWS).abs() > HALF_TRACK - BLOCKED.0 {
                continue;
            }
            raster.features(cell, &mut features);
            self.features.extend_from_slice(&features);
            let [ahead, left] = centre(cell);
            let gap = corridor.world().scene().distance([x + ahead, y + left, HEIGHT]);
            self.targets.extend(Surroundings::DISTANCES.map(|distance| f32::from(gap < distance)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RegisteredEnvironment as _;
    use crate::uav_corridor::UavDepthCorridorParams;

    #[test]
    fn flights_show_what_is_there() {
        let mut corridor = UavDepthCorridor::new(&UavDepthCorridorParams::default()).unwrap();
        let mut samples = SurroundingsSamples::default();
        (0..3).for_each(|seed| samples.fly(&mut corridor, &ResetOptions::new(), seed).unwrap());
        assert!(samples.len() > 300 && samples.features.len() == samples.len() * Surroundings::FEATURES);
        // What lies on a point that was seen is near, and what is near is also not far.
        for (features, targets) in samples.features.chunks(FEATURES).zip(samples.targets.chunks(2)) {
            assert!(targets[0] <= targets[1]);
            assert!(features[2] > 0.0 || targets[1] == 1.0, "{features:?} {targets:?}");
        }
        let mut again = SurroundingsSamples::default();
        (0..3).for_each(|seed| again.fly(&mut corridor, &ResetOptions::new(), seed).unwrap());
        assert_eq!(samples, again);
    }
}
