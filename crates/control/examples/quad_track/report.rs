//! The table of the protocol.

use std::time::Instant;

use opendr_engine::Result;
use opendr_engine::environment::{Controller, Environment as _, ResetOptions};
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::quad_track::{QuadTrack, QuadTrackParams};

use crate::base_policy::{Base, train, tuned_pid};
use crate::cases::{CASES, options, random_plants};
use crate::flight::{Flight, STEPS, fly_all};
use crate::settings::Settings;

/// Flights of one controller in one case, over all seeds of the base.
struct Results {
    flights: Vec<Flight>,
    /// RMS of each seed of the base.
    of_seeds: Vec<f64>,
}

impl Results {
    /// RMS over all flights, metres.
    fn rms(&self) -> f64 {
        rms(&self.flights)
    }

    fn lost(&self) -> usize {
        self.flights.iter().filter(|flight| flight.lost).count()
    }

    fn recovery(&self) -> f64 {
        let mut times: Vec<_> = self.flights.iter().map(|flight| flight.recovery).collect();
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied().unwrap_or_default()
    }

    /// Smallest, median and largest RMS of the seeds.
    fn spread(&self) -> [f64; 3] {
        let mut sorted = self.of_seeds.clone();
        sorted.sort_by(f64::total_cmp);
        let at = |place: usize| sorted.get(place).copied().unwrap_or(f64::NAN);
        [at(0), at(sorted.len() / 2), at(sorted.len().saturating_sub(1))]
    }
}

fn rms(flights: &[Flight]) -> f64 {
    (flights.iter().map(|flight| flight.last.powi(2)).sum::<f64>() / flights.len().max(1) as f64).sqrt()
}

/// Flies the episodes with a controller of each base.
fn measure<C: Controller>(
    bases: &[Base],
    settings: &Settings,
    pairs: &[(&str, f64)],
    make: impl Fn(&Base) -> Result<C> + Sync,
) -> Result<Results> {
    let mut results = Results { flights: Vec::new(), of_seeds: Vec::new() };
    for base in bases {
        let flights =
            fly_all(settings.episodes, settings.first_seed, |_| with_plant(pairs, settings), || make(base))?;
        results.of_seeds.push(rms(&flights));
        results.flights.extend(flights);
    }
    Ok(results)
}

fn with_plant(pairs: &[(&str, f64)], settings: &Settings) -> ResetOptions {
    let own = settings.plant.iter().map(|(name, value)| (name.as_str(), *value));
    options(&own.chain(pairs.iter().copied()).collect::<Vec<_>>())
}

pub fn run(settings: &Settings) -> Result<()> {
    let begun = Instant::now();
    let bases: Vec<_> = (0..settings.seeds).map(train).collect::<Result<_>>()?;
    for (seed, base) in bases.iter().enumerate() {
        println!(
            "base {seed}: imitates to {:.3} m/s^2 RMS; its last layer explains {:.3?} of the reference",
            base.difference,
            base.calibration.features.explained()
        );
    }
    println!("training: {:.1} s for {} bases", begun.elapsed().as_secs_f64(), bases.len());
    println!(
        "RMS in metres, last 20 s of 60 s, {} episodes x {} seeds\n\
         | case | frozen | tuned PID | adapted (min, median, max of seeds) | / frozen | / PID | recovery s | flipped / frozen | lost |\n\
         |---|---|---|---|---|---|---|---|---|",
        settings.episodes, settings.seeds
    );
    for (at, (name, pairs)) in CASES.into_iter().enumerate() {
        if settings.case.is_some_and(|case| case != at) {
            continue;
        }
        let frozen = measure(&bases, settings, pairs, |base| Ok(base.policy.clone()))?;
        let pid = measure(&bases[..bases.len().min(1)], settings, pairs, |_| tuned_pid())?;
        let adapted = measure(&bases, settings, pairs, |base| base.adapter(settings))?;
        let flipped =
            measure(&bases, settings, pairs, |base| Ok(base.adapter(settings)?.with_flipped_signal()))?;
        let [low, median, high] = adapted.spread();
        println!(
            "| {name} | {:.4} | {:.4} | {:.4} ({low:.4}, {median:.4}, {high:.4}) | {:.2} | {:.2} | {:.1} | {:.2} | {} |",
            frozen.rms(),
            pid.rms(),
            adapted.rms(),
            adapted.rms() / frozen.rms(),
            adapted.rms() / pid.rms(),
            adapted.recovery(),
            flipped.rms() / frozen.rms(),
            adapted.lost() + flipped.lost()
        );
    }
    if let Some(base) = bases.first() {
        plants(base, settings)?;
        cost(base, settings)?;
    }
    println!("whole protocol: {:.0} s", begun.elapsed().as_secs_f64());
    Ok(())
}

/// Random plants, everything changed at once.
fn plants(base: &Base, settings: &Settings) -> Result<()> {
    if settings.plants == 0 {
        return Ok(());
    }
    let first = settings.first_seed + 1_000_000;
    let plants = random_plants(settings.plants, first)?;
    let options = |at: u64| plants.get(at as usize).map(|plant| plant.options.clone()).unwrap_or_default();
    let frozen = fly_all(settings.plants, first, options, || Ok(base.policy.clone()))?;
    let pid = fly_all(settings.plants, first, options, tuned_pid)?;
    let adapted = fly_all(settings.plants, first, options, || base.adapter(settings))?;
    let lost = |flights: &[Flight]| flights.iter().filter(|flight| flight.lost).count();
    let is_own_loss = |at: &usize| adapted[*at].lost && !frozen[*at].lost;
    let is_worse = |at: &usize| adapted[*at].last > 1.3 * frozen[*at].last;
    let [own, worse] =
        [(0..plants.len()).filter(is_own_loss).count(), (0..plants.len()).filter(is_worse).count()];
    println!(
        "{} random plants, {} draws refused that the tuned PID loses with the true state: lost {} adapted, {} frozen, {} tuned PID, \
         {own} adapted only; adapted above 1.3 x frozen in {worse}",
        settings.plants,
        plants.iter().map(|plant| plant.refused).sum::<usize>(),
        lost(&adapted),
        lost(&frozen),
        lost(&pid)
    );
    for at in (0..plants.len()).filter(|at| adapted[*at].lost || is_worse(at)) {
        println!(
            "  seed {}: {:.3} m adapted, {:.3} m frozen, {:.3} m tuned PID; {:?}",
            first + at as u64,
            adapted[at].last,
            frozen[at].last,
            pid[at].last,
            plants[at].options
        );
    }
    Ok(())
}

/// Median microseconds of a step of the controllers.
fn cost(base: &Base, settings: &Settings) -> Result<()> {
    let mut track = QuadTrack::new(&QuadTrackParams::default())?;
    let mut time = |controller: &mut dyn Controller| -> Result<f64> {
        let (mut observation, mut action) = ([0.0; 17], [0.0; 3]);
        track.reset(Some(1), &options(&[("mass_factor", 1.3)]), &mut observation)?;
        let mut times = Vec::with_capacity(STEPS);
        for _ in 0..STEPS {
            let begun = Instant::now();
            controller.act(&observation, &mut action)?;
            times.push(begun.elapsed().as_secs_f64() * 1e6);
            track.step(&action, &mut observation)?;
        }
        times.sort_by(f64::total_cmp);
        Ok(times[STEPS / 2])
    };
    let (frozen, adapted) = (time(&mut base.policy.clone())?, time(&mut base.adapter(settings)?)?);
    println!("a step takes {frozen:.2} us frozen and {adapted:.2} us adapted (median of {STEPS})");
    Ok(())
}
