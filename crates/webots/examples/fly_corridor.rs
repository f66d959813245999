//! A controller of the exported corridor: places the drone one metre ahead in each step, towards the freest column of its depth image.
//!
//! `opendr sim export UavDepthCorridor-v1 corridor.wbt --seed 7`, open it in Webots, then
//! `cargo run --release -p opendr-webots --example fly_corridor -- tcp://localhost:1234/drone`.

use std::time::Duration;

use opendr_engine::{Error, Result};
use opendr_webots::{ControllerUrl, FieldValue, NativeLink, StepEnd, Version, WebotsLink};

const STEP_MS: u32 = 32;
const SIDE: usize = 64;
const HALF_VIEW: f64 = std::f64::consts::FRAC_PI_8;
const FINISH: f64 = 20.0;

fn main() -> Result<()> {
    let url = std::env::args().nth(1).ok_or_else(|| Error::invalid_param("give the address of the robot"))?;
    // The requests for nodes and fields are known up to R2023b.
    let url = ControllerUrl::parse(&url)?;
    let mut link = NativeLink::connect(&url, Some(Version::R2023b), Some(Duration::from_secs(60)))?;
    let depth = link.robot().find("depth")?;
    link.enable(depth, STEP_MS as u16)?;
    let supervisor = link.supervisor()?;
    let drone = supervisor.node("ROBOT")?;
    let place = supervisor.field(drone, "translation")?;
    let FieldValue::Vec3(mut position) = supervisor.value(place)? else {
        return Err(Error::format("the translation of the drone is no vector"));
    };
    while position[0] < FINISH && link.step(STEP_MS)? == StepEnd::Running {
        let heading = freest(link.image(depth)?);
        position = [position[0] + heading.cos(), position[1] + heading.sin(), position[2]];
        link.supervisor()?.set_value(place, &FieldValue::Vec3(position))?;
        println!("{:6.2} {:6.2}", position[0], position[1]);
    }
    Ok(())
}

/// Returns the heading of the column whose nearest depth around the middle row is largest; straight on among equals.
fn freest(image: &[u8]) -> f64 {
    let depths: Vec<_> = image.as_chunks().0.iter().map(|depth| f32::from_le_bytes(*depth)).collect();
    let nearest = |column: usize| {
        let rows = SIDE / 4..3 * SIDE / 4;
        rows.filter_map(|row| depths.get(row * SIDE + column))
            .fold(f32::INFINITY, |near, depth| near.min(*depth))
    };
    let aside = |column: usize| 1.0 - (2 * column + 1) as f64 / SIDE as f64;
    let better = |best: usize, column: usize| match nearest(column).total_cmp(&nearest(best)) {
        std::cmp::Ordering::Greater => column,
        std::cmp::Ordering::Equal if aside(column).abs() < aside(best).abs() => column,
        _ => best,
    };
    (aside((0..SIDE).fold(0, better)) * HALF_VIEW.tan()).atan()
}
