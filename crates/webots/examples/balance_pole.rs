//! A controller of the exported cart-pole: balances the pole by linear feedback, whose gains are not tuned for Webots.
//!
//! `opendr sim export CartPole-v1 cart_pole.wbt`, open it in Webots, then
//! `cargo run --release -p opendr-webots --example balance_pole -- tcp://localhost:1234/cart_pole`.

use std::time::Duration;

use opendr_engine::{Error, Result};
use opendr_webots::{ControllerUrl, MotorCommand, NativeLink, StepEnd, WebotsLink};

const STEP_MS: u32 = 20;
/// Feedback of position, velocity, angle and angular velocity.
const GAINS: [f64; 4] = [1.0, 2.0, 25.0, 4.0];
const MAX_FORCE: f64 = 10.0;

fn main() -> Result<()> {
    let url = std::env::args().nth(1).ok_or_else(|| Error::invalid_param("give the address of the robot"))?;
    let mut link = NativeLink::connect(&ControllerUrl::parse(&url)?, None, Some(Duration::from_secs(60)))?;
    let robot = link.robot();
    let [motor, position, angle] = [robot.find("cart")?, robot.find("position")?, robot.find("angle")?];
    link.enable(position, STEP_MS as u16)?;
    link.enable(angle, STEP_MS as u16)?;
    link.command(motor, MotorCommand::Force(0.0))?;
    link.step(STEP_MS)?;
    let (mut before, mut steps) = (measured(&link, [position, angle])?, 0u32);
    while link.step(STEP_MS)? == StepEnd::Running {
        let now = measured(&link, [position, angle])?;
        let rates = [0, 1].map(|at| (now[at] - before[at]) / (f64::from(STEP_MS) / 1000.0));
        let state = [now[0], rates[0], now[1], rates[1]];
        let force: f64 = state.iter().zip(GAINS).map(|(number, gain)| number * gain).sum();
        link.command(motor, MotorCommand::Force(force.clamp(-MAX_FORCE, MAX_FORCE)))?;
        (before, steps) = (now, steps + 1);
        if now[0].abs() > 2.4 || now[1].abs() > 0.209 {
            println!("fallen after {steps} steps");
            return Ok(());
        }
    }
    println!("balanced for {steps} steps");
    Ok(())
}

fn measured(link: &NativeLink, sensors: [usize; 2]) -> Result<[f64; 2]> {
    let mut values = [0.0; 2];
    for (sensor, value) in sensors.into_iter().zip(&mut values) {
        link.values(sensor, std::slice::from_mut(value))?;
    }
    Ok(values)
}
