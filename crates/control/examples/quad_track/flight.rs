//! Flights and what is measured in them.

use std::sync::Mutex;
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

pub fn fly(
    controller: &mut dyn Controller,
    track: &mut QuadTrack,
    options: &ResetOptions,
    seed: u64,
    errors: &mut Vec<f64>,
) -> Result<Flight> {
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

/// Flies `count` seeds on two threads, each with a controller of its own for every flight.
pub fn fly_all<C: Controller>(
    count: u64,
    first: u64,
    options: impl Fn(u64) -> ResetOptions + Sync,
    make: impl Fn() -> Result<C> + Sync,
) -> Result<Vec<Flight>> {
    let (next, flights) = (AtomicU64::new(0), Mutex::new(vec![Flight::default(); count as usize]));
    let work = || -> Result<()> {
        let mut track = QuadTrack::new(&QuadTrackParams::default())?;
        let mut errors = Vec::with_capacity(STEPS);
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            if at >= count {
                return Ok(());
            }
            let flight = fly(&mut make()?, &mut track, &options(at), first + at, &mut errors)?;
            if let Ok(mut flights) = flights.lock() {
                flights[at as usize] = flight;
            }
        }
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(work);
        work()?;
        other.join().map_err(|_| Error::internal("a thread of the flights panicked"))?
    })?;
    flights.into_inner().map_err(|_| Error::internal("a thread of the flights panicked"))
}
