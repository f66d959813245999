//! Tunes the PID of the tracking benchmark on the nominal plant of `QuadTrack-v1`:
//! `cargo run --release -p opendr-control --example tune_pid [TRIALS]`.
//!
//! CMA-ES of `opendr-tuning` minimises the RMS error of eight nominal flights of 40 s each, from 5 s on.

use opendr_control::{PidGains, TrackingPid};
use opendr_engine::environment::{Controller as _, Environment as _, ResetOptions};
use opendr_engine::{Error, Result};
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::quad_track::{CONTROL_PERIOD, QuadTrack, QuadTrackParams};
use opendr_tuning::{
    Budget, CmaEs, Direction, Distribution, Outcome, Progress, SearchSpace, Storage, Study, Trial,
};

fn main() -> Result<()> {
    let trials = std::env::args().nth(1).map_or(Ok(300), |text| text.parse());
    let trials = trials.map_err(|_| Error::invalid_param("the number of trials is no whole number"))?;
    let mut space = SearchSpace::new();
    for axis in ["horizontal", "vertical"] {
        space = space
            .with(format!("{axis}.kp"), Distribution::log_float(0.5, 40.0)?)?
            .with(format!("{axis}.ki"), Distribution::log_float(0.01, 40.0)?)?
            .with(format!("{axis}.kd"), Distribution::log_float(0.5, 20.0)?)?
            .with(format!("{axis}.filter"), Distribution::log_float(0.002, 0.2)?)?;
    }
    let study = Study::open(Storage::memory(), "pid", &[Direction::Minimize])?.with_sampler(CmaEs::new(1));
    let budget = Budget::more(trials).threads(2);
    study.optimize(&space, &budget, |trial| Ok(Outcome::from(flights(trial)?)), |_, _| Progress::Continue)?;
    let best = study.best().ok_or_else(|| Error::internal("no trial was completed"))?;
    println!("RMS {:.4} m after {trials} trials", best.value().unwrap_or(f64::NAN));
    for (name, suggestion) in &best.params {
        println!("{name} = {}", suggestion.value());
    }
    Ok(())
}

fn gains(trial: &Trial<'_>, axis: &str) -> Result<PidGains> {
    let number = |name: &str| trial.float(&format!("{axis}.{name}"));
    Ok(PidGains {
        kp: number("kp")?,
        ki: number("ki")?,
        kd: number("kd")?,
        filter: number("filter")?,
        limit: 8.0,
    })
}

/// The RMS error of nominal flights, metres.
fn flights(trial: &Trial<'_>) -> Result<f64> {
    let (horizontal, vertical) = (gains(trial, "horizontal")?, gains(trial, "vertical")?);
    let spec = QuadTrack::new(&QuadTrackParams::default())?.spec().clone();
    let layout = spec.tracking.as_ref().ok_or_else(|| Error::internal("no tracking task"))?.layout;
    let mut pid = TrackingPid::new(layout, &[horizontal, horizontal, vertical], CONTROL_PERIOD)?;
    let mut track = QuadTrack::new(&QuadTrackParams::default())?;
    let (mut observation, mut action) = (vec![0.0; layout.len], [0.0; 3]);
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in 0..8 {
        track.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
        pid.reset();
        for step in 0..4000 {
            pid.act(&observation, &mut action)?;
            let outcome = track.step(&action, &mut observation)?;
            if step >= 500 || outcome.is_over() {
                sum += outcome.info.get("error").unwrap_or_default().powi(2);
                count += 1.0;
            }
            if outcome.is_over() {
                sum += 1e4;
                break;
            }
        }
    }
    Ok((sum / f64::max(count, 1.0)).sqrt())
}
