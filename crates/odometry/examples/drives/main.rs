//! Measures visual odometry on rendered drives: drift, errors before and after loop closure, speed and memory.
//!
//! `cargo run --release -p opendr-odometry --example drives -- [SEEDS [PICTURE]]` drives straight, through curves and around a block for each
//! seed of SEEDS (1,2), with one camera, a stereo pair and a depth camera. `mono+h` is a camera whose height is given, `mono-h` one that
//! did not see the ground. PICTURE is the file of a map of the last loop (PNG or JPEG).

mod picture;
mod run;

use std::path::PathBuf;

use opendr_engine::{Error, Result};
use opendr_odometry::{CameraKind, KITTI_LENGTHS};
use opendr_simulation::drive::{Course, Drive, DriveOptions};

use picture::draw_map;
use run::{Outcome, run};

/// Lengths of the compared pieces: KITTI's first, and shorter ones since the drives are short.
const LENGTHS: [f64; 4] = [25.0, 50.0, KITTI_LENGTHS[0], KITTI_LENGTHS[1]];

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let seeds = arguments.next().unwrap_or_else(|| "1,2".to_owned());
    let picture = arguments.next().map(PathBuf::from);
    println!("course   seed camera way_m drift_% rot_deg/m  ATE_m  closed_m loops  lost  fps_1 fps_2 cpu_ms");
    for seed in seeds.split(',') {
        let seed = seed
            .parse()
            .map_err(|_| Error::invalid_param(format!("{seed} is no seed; give numbers like 1,2")))?;
        for (name, course) in
            [("straight", Course::Straight), ("curves", Course::Curves), ("loop", Course::Loop)]
        {
            let drive = Drive::new(&DriveOptions { seed, course, ..DriveOptions::default() })?;
            let outcomes = run(&drive, &LENGTHS)?;
            outcomes.iter().for_each(|outcome| print_row(name, seed, outcome));
            let stereo = outcomes.iter().find(|outcome| outcome.kind == CameraKind::Stereo);
            if let (Course::Loop, Some(path), Some(stereo)) = (course, &picture, stereo) {
                draw_map(&[&stereo.truth, &stereo.before, &stereo.after], path)?;
            }
        }
    }
    println!("peak memory {} MB, with the renderer and eight odometries", peak_memory());
    Ok(())
}

fn print_row(course: &str, seed: u64, outcome: &Outcome) {
    let camera = match outcome.kind {
        CameraKind::Mono if outcome.has_height && outcome.is_metric => "mono+h",
        CameraKind::Mono if outcome.has_height => "mono-h",
        CameraKind::Mono => "mono",
        CameraKind::Stereo => "stereo",
        CameraKind::Depth => "depth",
    };
    println!(
        "{course:8} {seed:4} {camera:6} {:5.0} {:7.2} {:9.4} {:6.2} {:9.2} {:5} {:5} {:6.0} {:5.0} {:6.1}",
        outcome.truth.way(),
        outcome.drift.translation,
        outcome.drift.rotation,
        outcome.errors[0],
        outcome.errors[1],
        outcome.loops,
        outcome.lost,
        outcome.rates[0],
        outcome.rates[1],
        outcome.cpu
    );
}

/// Returns the most memory the process had, in MB; 0 where the system does not tell.
fn peak_memory() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<usize>().ok())
        .map_or(0, |kilobytes| kilobytes / 1024)
}
