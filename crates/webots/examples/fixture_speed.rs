//! Steps per second of the native client against the protocol fixture over loopback TCP: a motor is commanded, a position and a
//! distance are measured in each step. It measures the client, not Webots.
#![allow(clippy::unwrap_used, reason = "an example on the tests' fixture")]

#[path = "../tests/fixture/mod.rs"]
mod fixture;

use std::time::Instant;

use fixture::{Answer, Bytes, Fixture, FixtureDevice, Layout, motor};
use opendr_webots::{ControllerUrl, MotorCommand, NativeLink, WebotsLink};

const STEPS: u32 = 100_000;

fn main() -> opendr_engine::Result<()> {
    let device = |node, name, configuration| FixtureDevice { node, name, configuration };
    let distance = Bytes::default().i32(0).f64(0.0).f64(1000.0).f64(0.1).i32(0);
    let devices = vec![
        device(56, "motor", motor()),
        device(51, "position", Bytes::default().i32(0)),
        device(41, "distance", distance),
    ];
    let robot = Fixture { layout: Layout::Stated("R2025a"), is_supervisor: false, devices };
    let answer = Bytes::default().u16(0).u8(4).f64(1.0).u16(2).u8(1).f64(0.25).u16(3).u8(50).f64(123.5);
    let answer = Answer { messages: answer, images: Vec::new() };
    let url = robot.serve_frame(&answer.frame(0));
    let mut link = NativeLink::connect(&ControllerUrl::parse(&url)?, None, None)?;
    (1..3).try_for_each(|sensor| link.enable(sensor, 32))?;
    let mut values = [0.0];
    let begin = Instant::now();
    for step in 0..STEPS {
        link.command(0, MotorCommand::Velocity(f64::from(step % 10)))?;
        link.step(32)?;
        link.values(1, &mut values)?;
    }
    println!("{:.0} steps/s", f64::from(STEPS) / begin.elapsed().as_secs_f64());
    Ok(())
}
