//! Flights and what is measured in them.

use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::environment::{Controller, Environment as _, ResetOptions};
use opendr_engine::{Error, Result};
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::quad_track::{QuadTrack, QuadTrackParams};

/// What is measured in a flight of 60 s whose plant changes at 20 s.
#[derive(Debug, Clone, Copy, Default)]
pub struct Flight {
    /// RMS of the distance to the reference in the last 20 s, metres.
    pub last: f64,
    /// Seconds from the change until the RMS of 2 s is at most twice that of the 10 s before it.
    pub recovery: f64,
    pub lost: bool,
}

/// Steps in a second.
const RATE: usize = 100;
pub const STEPS: usize = 60 * RATE;

/// Environment and memory of a thread.
pub struct Workspace {
    track: QuadTrack,
    errors: Vec<f64>,
}

impl Workspace {
    pub fn fly(
        &mut self,
        controller: &mut dyn Controller,
        options: &ResetOptions,
        seed: u64,
    ) -> Result<Flight> {
        let Self { track, errors } = self;
        let (mut observation, mut action) = ([0.0; 17], [0.0; 3]);
        track.reset(Some(seed), options, &mut observation)?;
        controller.reset();
        errors.clear();
        let mut lost = false;
        while errors.len() < STEPS && !lost {
            controller.act(&observation, &mut action)?;
            let step = track.step(&action, &mut observation)?;
            errors.push(step.info.get("error").unwrap_or(f64::INFINITY));
            lost = step.terminated;
        }
        let rms = |from: usize, to: usize| {
            let span = errors.get(from.min(errors.len())..to.min(errors.len())).unwrap_or_default();
            (span.iter().map(|error| error * error).sum::<f64>() / span.len().max(1) as f64).sqrt()
        };
        let before = rms(10 * RATE, 20 * RATE);
        let recovered = |half: &usize| rms(half * RATE / 2, half * RATE / 2 + 2 * RATE) <= 2.0 * before;
        let recovery = (40..116).find(recovered).map_or(40.0, |half| 0.5 * (half - 40) as f64);
        Ok(Flight {
            last: if lost { f64::INFINITY } else { rms(40 * RATE, 60 * RATE) },
            recovery: if lost { 40.0 } else { recovery },
            lost,
        })
    }
}

/// Returns the results of `work` for 0 to `count - 1`, computed on all processors.
pub fn on_all_processors<T: Send>(
    count: u64,
    work: impl Fn(&mut Workspace, u64) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let next = AtomicU64::new(0);
    let run = || -> Result<Vec<(u64, T)>> {
        let track = QuadTrack::new(&QuadTrackParams::default())?;
        let mut workspace = Workspace { track, errors: Vec::with_capacity(STEPS) };
        let mut results = Vec::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            if at >= count {
                return Ok(results);
            }
            results.push((at, work(&mut workspace, at)?));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut results = std::thread::scope(|scope| -> Result<Vec<(u64, T)>> {
        let threads: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
        let mut all = Vec::new();
        for thread in threads {
            all.extend(thread.join().map_err(|_| Error::internal("a thread of the flights panicked"))??);
        }
        Ok(all)
    })?;
    results.sort_unstable_by_key(|(at, _)| *at);
    Ok(results.into_iter().map(|(_, result)| result).collect())
}

/// Flies `count` seeds, each with a controller of its own.
pub fn fly_all<C: Controller>(
    count: u64,
    first: u64,
    options: impl Fn(u64) -> ResetOptions + Sync,
    make: impl Fn() -> Result<C> + Sync,
) -> Result<Vec<Flight>> {
    on_all_processors(count, |workspace, at| workspace.fly(&mut make()?, &options(at), first + at))
}
