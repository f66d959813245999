//! Learning what lies behind the fronts that a depth camera shows.

use opendr_engine::environment::ResetOptions;
use opendr_engine::{Error, Progress, Result, Unit};
use opendr_kernels::Compute;
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::uav_corridor::{
    Surroundings, SurroundingsSamples, UavDepthCorridor, UavDepthCorridorParams,
};

use super::cross_entropy::{self, Samples, Settings};
use super::dense_episodes::dense_options;

/// How often all samples are gone over, samples of a step, and the first learning rate of Adam, which falls evenly to zero.
const EPOCHS: usize = 4;
const BATCH: usize = 256;
const LEARNING_RATE: f32 = 3e-3;
/// Seeds of the flights, far from those of evaluations and of PPO.
const FIRST_SEED: u64 = 1 << 40;

/// Flies through embedded corridors whose obstacles are known, every second one dense, and learns from their maps how likely a place
/// is near something: supervised, with the truth of the simulation as target, which no flight afterwards needs.
///
/// # Errors
/// `InvalidParam` for no flights, `Internal` when learning diverges.
pub fn learn_surroundings(
    flights: u64,
    seed: u64,
    compute: &Compute,
    progress: &dyn Progress,
) -> Result<Surroundings> {
    if flights == 0 {
        return Err(Error::invalid_param("surroundings of no flights; give at least one"));
    }
    let mut corridor = UavDepthCorridor::new(&UavDepthCorridorParams::default())?;
    let mut samples = SurroundingsSamples::default();
    progress.begin("flights for surroundings", Some(flights), Unit::Steps);
    for flight in 0..flights {
        let options = if flight % 2 == 0 { dense_options() } else { ResetOptions::new() };
        let place = FIRST_SEED.wrapping_add(seed.wrapping_mul(1 << 24)).wrapping_add(flight);
        samples.fly(&mut corridor, &options, place)?;
        progress.advance(1);
    }
    progress.end();
    train(&samples, seed, compute)
}

fn train(samples: &SurroundingsSamples, seed: u64, compute: &Compute) -> Result<Surroundings> {
    let samples = Samples {
        features: &samples.features,
        targets: &samples.targets,
        inputs: Surroundings::FEATURES,
        outputs: Surroundings::OUTPUTS,
    };
    let settings = Settings {
        hidden: Surroundings::HIDDEN,
        epochs: EPOCHS,
        batch: BATCH,
        learning_rate: LEARNING_RATE,
        key: [seed, 2],
    };
    Surroundings::new(cross_entropy::train(&samples, &settings, compute)?)
        .map_err(|error| Error::internal("learning surroundings diverged").with_source(error))
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;

    use super::*;

    #[test]
    fn it_learns_more_than_how_often() {
        let compute = Compute::single();
        let learnt = learn_surroundings(40, 3, &compute, &Silent).unwrap();
        assert_eq!(learnt, learn_surroundings(40, 3, &Compute::with_threads(2), &Silent).unwrap());
        let mut corridor = UavDepthCorridor::new(&UavDepthCorridorParams::default()).unwrap();
        let mut others = SurroundingsSamples::default();
        (0..6).for_each(|seed| others.fly(&mut corridor, &ResetOptions::new(), 900 + seed).unwrap());
        let share = others.targets.iter().step_by(2).sum::<f32>() / others.len() as f32;
        let (mut loss, mut naive) = (0.0, 0.0);
        let rows = others.features.as_chunks::<{ Surroundings::FEATURES }>().0;
        for (features, targets) in rows.iter().zip(others.targets.chunks(2)) {
            let [likely, _] = learnt.probabilities(features);
            let cost = |likely: f32| if targets[0] == 1.0 { -likely.ln() } else { -(1.0 - likely).ln() };
            loss += cost(likely.clamp(1e-6, 1.0 - 1e-6));
            naive += cost(share);
        }
        assert!(loss < 0.7 * naive, "{loss} {naive}");
        assert!(learn_surroundings(0, 3, &compute, &Silent).is_err());
    }
}
