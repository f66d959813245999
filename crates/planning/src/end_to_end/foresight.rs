//! Learning how flights end after each possible step.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::environment::ResetOptions;
use opendr_engine::{Error, Progress, Result, Unit};
use opendr_kernels::Compute;
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::uav_corridor::{
    FlightMemory, Foresight, ForesightSamples, Surroundings, UavDepthCorridor, UavDepthCorridorParams,
};

use super::cross_entropy::{self, Samples, Settings};
use super::dense_episodes::dense_options;

const EPOCHS: usize = 6;
const BATCH: usize = 256;
const LEARNING_RATE: f32 = 2e-3;
/// Seed of the first flight, far from those of evaluations, of PPO and of the flights for surroundings.
const FIRST_SEED: u64 = 1 << 41;

/// Flies through embedded corridors, three of four with many obstacles, and from places of each flight again with other steps; learns
/// after which steps flights fail.
///
/// # Errors
/// `InvalidParam` for no flights, `Internal` when learning diverges.
pub fn learn_foresight(
    flights: u64,
    surroundings: &Arc<Surroundings>,
    seed: u64,
    threads: usize,
    progress: &dyn Progress,
) -> Result<Foresight> {
    if flights == 0 {
        return Err(Error::invalid_param("a foresight of no flights; give at least one"));
    }
    let memory = FlightMemory::default().with_surroundings(Arc::clone(surroundings));
    let first = FIRST_SEED.wrapping_add(seed.wrapping_mul(1 << 24));
    progress.begin("flights for foresight", Some(flights), Unit::Steps);
    let flown = fly(&memory, first..first.wrapping_add(flights), threads.max(1), progress);
    progress.end();
    let mut samples = ForesightSamples::default();
    for one in flown? {
        samples.features.extend(one.features);
        samples.targets.extend(one.targets);
    }
    train(samples, seed, &Compute::with_threads(threads.max(1)))
}

/// Returns the samples of each flight, in the order of their seeds.
fn fly(
    memory: &FlightMemory,
    seeds: std::ops::Range<u64>,
    threads: usize,
    progress: &dyn Progress,
) -> Result<Vec<ForesightSamples>> {
    let next = AtomicU64::new(seeds.start);
    let work = || -> Result<Vec<(u64, ForesightSamples)>> {
        let mut corridor = UavDepthCorridor::new(&UavDepthCorridorParams::default())?;
        let mut flown = Vec::new();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds.end || progress.stopped() {
                return Ok(flown);
            }
            let mut samples = ForesightSamples::default();
            let options = if seed % 4 == 3 { ResetOptions::new() } else { dense_options() };
            samples.fly(memory, &mut corridor, &options, seed)?;
            flown.push((seed, samples));
            progress.advance(1);
        }
    };
    let parts = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(|worker| {
                worker.join().map_err(|_| Error::internal("a flight for the foresight panicked"))?
            })
            .collect::<Result<Vec<_>>>()
    })?;
    let mut all: Vec<_> = parts.into_iter().flatten().collect();
    all.sort_by_key(|(seed, _)| *seed);
    Ok(all.into_iter().map(|(_, samples)| samples).collect())
}

fn train(mut samples: ForesightSamples, seed: u64, compute: &Compute) -> Result<Foresight> {
    // A corridor and its mirror image are equally likely.
    let mut mirrored = samples.features.clone();
    mirrored.as_chunks_mut::<{ Foresight::FEATURES }>().0.iter_mut().for_each(Foresight::mirror);
    samples.features.extend(mirrored);
    samples.targets.extend_from_within(..);
    let inputs = Foresight::FEATURES;
    let rows = Samples { features: &samples.features, targets: &samples.targets, inputs, outputs: 1 };
    let mut parameters = Vec::new();
    for member in 0..Foresight::MEMBERS as u64 {
        let (hidden, key) = (Foresight::HIDDEN, [seed, 4 + member]);
        let settings = Settings { hidden, epochs: EPOCHS, batch: BATCH, learning_rate: LEARNING_RATE, key };
        parameters.extend(cross_entropy::train(&rows, &settings, compute)?);
    }
    Foresight::new(parameters)
        .map_err(|error| Error::internal("learning a foresight diverged").with_source(error))
}
