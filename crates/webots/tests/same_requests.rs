//! The native client and Webots' own `libController` send the same bytes: one script, two links, two protocol fixtures.
//!
//! `OPENDR_LIBCONTROLLER=.../libController.so cargo test -p opendr-webots --features webots-library --test same_requests -- --ignored`
#![cfg(feature = "webots-library")]
#![allow(clippy::unwrap_used, reason = "code of tests")]

mod fixture;

use std::path::Path;
use std::process::Command;

use fixture::{Answer, Bytes, Fixture, Layout, Request, all_devices};
use opendr_webots::{ControllerUrl, FieldValue, LibraryLink, MotorCommand, NativeLink, Version, WebotsLink};

/// The library with which the test was written has the layout of R2023a.
const VERSION: Version = Version::R2023a;

fn answer(request: &Request) -> Answer {
    let time = Bytes::default().u16(0).u8(4).f64(0.5);
    let of_robot =
        request.messages.iter().filter(|(tag, _)| *tag == 0).flat_map(|(_, message)| message.first());
    let messages = of_robot.fold(time, |messages, command| match command {
        84 => messages.u16(0).u8(84).u32(17).u32(80).i32(0).u32(0).u8(0).text("Solid"),
        87 => messages.u16(0).u8(87).i32(2).i32(5).u8(0).i32(-1).text("translation"),
        88 => messages.u16(0).u8(88).i32(5).i32(17).i32(2).f64(1.0).f64(2.0).f64(3.0),
        90 => messages.u16(0).u8(90).f64(4.0).f64(5.0).f64(6.0),
        96 => (0..6).fold(messages.u16(0).u8(96), |messages, _| messages.f64(0.5)),
        _ => messages,
    });
    Answer { messages, images: Vec::new() }
}

fn script(link: &mut dyn WebotsLink) {
    link.step(32).unwrap();
    (0..13).filter(|device| *device != 11).for_each(|device| link.enable(device, 64).unwrap());
    link.step(32).unwrap();
    link.command(0, MotorCommand::Velocity(2.5)).unwrap();
    link.send(11, b"one").unwrap();
    link.send(11, b"two").unwrap();
    link.step(64).unwrap();
    link.command(0, MotorCommand::Position(0.5)).unwrap();
    link.step(32).unwrap();
    link.command(0, MotorCommand::Force(-1.5)).unwrap();
    link.enable(4, 0).unwrap();
    link.step(32).unwrap();
    let scene = link.supervisor().unwrap();
    let ball = scene.node("BALL").unwrap();
    let place = scene.field(ball, "translation").unwrap();
    assert_eq!(scene.value(place).unwrap(), FieldValue::Vec3([1.0, 2.0, 3.0]));
    assert_eq!(scene.position(ball).unwrap(), [4.0, 5.0, 6.0]);
    assert_eq!(scene.velocity(ball).unwrap(), [0.5; 6]);
    scene.set_value(place, &FieldValue::Vec3([3.0, 2.0, 1.0])).unwrap();
    scene.set_velocity(ball, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
    scene.reset_physics(ball).unwrap();
    link.step(32).unwrap();
    link.supervisor().unwrap().reset_simulation().unwrap();
    link.step(32).unwrap();
}

fn robot() -> Fixture {
    Fixture { layout: Layout::Old, is_supervisor: true, devices: all_devices() }
}

#[test]
#[ignore = "needs Webots' libController"]
fn both_links_send_the_same_bytes() {
    let (url, peer) = robot().serve(|request| Some(answer(request)));
    let mut link = NativeLink::connect(&ControllerUrl::parse(&url).unwrap(), Some(VERSION), None).unwrap();
    script(&mut link);
    drop(link);
    let ours = peer.join().unwrap();

    let (url, peer) = robot().serve(|request| Some(answer(request)));
    // The library reads the address from the environment, and serves one robot per process.
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "the_library_follows_the_script"])
        .env("WEBOTS_CONTROLLER_URL", &url)
        .output()
        .unwrap();
    assert!(child.status.success(), "{}", String::from_utf8_lossy(&child.stdout));
    let theirs = peer.join().unwrap();
    assert!(ours.len() >= 15 && theirs.len() >= ours.len(), "{} and {}", ours.len(), theirs.len());
    for (number, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
        assert_eq!(ours, theirs, "request {number}");
    }
}

#[test]
#[ignore = "run by the other test in a process of its own"]
fn the_library_follows_the_script() {
    if std::env::var_os("WEBOTS_CONTROLLER_URL").is_none() {
        return;
    }
    let path = std::env::var("OPENDR_LIBCONTROLLER").unwrap();
    script(&mut LibraryLink::connect(Path::new(&path)).unwrap());
}
