//! The native client against the protocol fixture.
#![allow(clippy::unwrap_used, reason = "code of tests")]

mod fixture;

use std::time::Duration;

use fixture::{Answer, Bytes, Fixture, Layout, Request, all_devices};
use opendr_engine::ErrorKind;
use opendr_webots::{
    ControllerUrl, DeviceKind, FieldKind, FieldValue, MotorCommand, NativeLink, StepEnd, Version, WebotsLink,
};

fn connect(url: &str, version: Option<Version>) -> opendr_engine::Result<NativeLink> {
    NativeLink::connect(&ControllerUrl::parse(url).unwrap(), version, Some(Duration::from_secs(10)))
}

fn robot(layout: Layout) -> Fixture {
    Fixture { layout, is_supervisor: false, devices: all_devices() }
}

/// Measurements of all devices.
fn measurements() -> Answer {
    let three = |bytes: Bytes, first: f64| bytes.f64(first).f64(first + 1.0).f64(first + 2.0);
    let mut messages = Bytes::default().u16(0).u8(4).f64(0.032);
    messages = messages.u16(1).u8(5).f64(0.5).u16(2).u8(1).f64(0.25).u16(3).u8(50).f64(123.5);
    messages = three(messages.u16(7).u8(2), 1.0).f64(9.0);
    messages = three(messages, 4.0).u16(8).u8(54).f64(0.0).f64(0.0).f64(0.0).f64(1.0);
    messages = three(messages.u16(9).u8(53), 10.0);
    messages = three(messages.u16(10).u8(51), 20.0);
    messages = three(messages.u16(11).u8(52), 30.0);
    messages = messages.u16(13).u8(1).i32(0).f64(1.0).f64(0.0).f64(0.0).f64(0.9).i32(5).bytes(b"hello");
    let ranges = |count: u16| (0..count).flat_map(|at| (f32::from(at) / 4.0).to_le_bytes()).collect();
    Answer { messages, images: vec![(4, (0..32).collect()), (5, ranges(6)), (6, ranges(16))] }
}

#[test]
fn every_device_measures_in_every_layout() {
    let layouts = [
        (Layout::Old, Some(Version::R2023a)),
        (Layout::Stated("R2023b"), Some(Version::R2023b)),
        (Layout::Stated("R2025a"), None),
    ];
    for (layout, version) in layouts {
        let (url, peer) = robot(layout).serve(|_| Some(measurements()));
        let mut link = connect(&url, version).unwrap();
        let robot = link.robot().clone();
        let names: Vec<_> = robot.devices.iter().map(|device| device.name.as_str()).collect();
        assert_eq!(names, all_devices().iter().map(|device| device.name).collect::<Vec<_>>());
        assert_eq!((robot.name.as_str(), robot.basic_step_ms, robot.is_supervisor), ("robot", 32, false));
        assert_eq!(robot.devices[5].kind, Some(DeviceKind::Lidar));
        assert_eq!((robot.devices[5].size, robot.devices[0].range), ((8, 2), (-1.0, 1.0)));
        for device in (0..13).filter(|device| *device != 11) {
            link.enable(device, 32).unwrap();
        }
        link.command(0, MotorCommand::Velocity(2.5)).unwrap();
        link.send(11, b"hi").unwrap();
        assert_eq!(link.step(32).unwrap(), StepEnd::Running);
        let values = |device: usize, count: usize| {
            let mut values = vec![0.0; count];
            link.values(device, &mut values).unwrap();
            values
        };
        assert_eq!((values(0, 1), values(1, 1), values(2, 1)), (vec![0.5], vec![0.25], vec![123.5]));
        assert_eq!(values(6, 7), [1.0, 2.0, 3.0, 9.0, 4.0, 5.0, 6.0]);
        assert_eq!((values(7, 4), values(8, 3)), (vec![0.0, 0.0, 0.0, 1.0], vec![10.0, 11.0, 12.0]));
        assert_eq!((values(9, 3)[0], values(10, 3)[0]), (20.0, 30.0));
        assert_eq!(link.image(3).unwrap(), (0..32).collect::<Vec<u8>>());
        assert_eq!((link.image(4).unwrap().len(), link.image(5).unwrap().len()), (24, 64));
        assert_eq!(link.time(), 0.032);
        let mut packet = Vec::new();
        assert!(link.receive(12, &mut packet).unwrap() && packet == b"hello");
        assert!(!link.receive(12, &mut packet).unwrap());
        drop(link);
        let requests = peer.join().unwrap();
        assert_eq!(requests[0].messages, [(0, vec![35, 0, 0])]);
        let motor = Bytes::default().u16(1).f64(f64::INFINITY).u16(2).f64(2.5).u16(5).u16(32);
        let emitter = Bytes::default().u8(0).i32(0).f64(-1.0).i32(2).bytes(b"hi");
        let of = |tag: u16| &requests[1].messages.iter().find(|(own, _)| *own == tag).unwrap().1;
        assert_eq!((of(1), of(12), of(2)), (&motor.0, &emitter.0, &vec![1, 32, 0]));
        assert_eq!(of(4), &Bytes::default().u8(1).u16(32).0);
    }
}

#[test]
fn a_peer_that_is_lost_in_a_step_is_an_error() {
    let mut steps = 0;
    let (url, peer) = robot(Layout::Stated("R2023b")).serve(move |_| {
        steps += 1;
        (steps < 3).then(measurements)
    });
    let mut link = connect(&url, None).unwrap();
    assert_eq!(link.step(32).unwrap(), StepEnd::Running);
    link.step(32).unwrap();
    let error = link.step(32).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Network);
    let text = error.to_string();
    assert!(
        text.contains("step 3 of robot at 0.032 s: Webots closed the connection before it answered"),
        "{text}"
    );
    let error = link.step(32).unwrap_err().to_string();
    assert!(error.contains("was lost before"), "{error}");
    peer.join().unwrap();
}

#[test]
fn a_peer_that_falls_silent_is_an_error() {
    let (url, _peer) = robot(Layout::Stated("R2023b")).serve(|_| {
        std::thread::sleep(Duration::from_secs(3));
        None
    });
    let url = ControllerUrl::parse(&url).unwrap();
    let mut link = NativeLink::connect(&url, None, Some(Duration::from_millis(200))).unwrap();
    let error = link.step(32).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Network);
    assert!(error.to_string().contains("did not answer in time"), "{error}");
}

#[test]
fn versions_must_be_known_and_agree() {
    let cases = [
        (Layout::Stated("R2022b"), None, ErrorKind::Unsupported, "R2022b"),
        (
            Layout::Stated("R2025a"),
            Some(Version::R2023b),
            ErrorKind::InvalidParam,
            "states the version R2025a",
        ),
        (Layout::Old, None, ErrorKind::Unsupported, "set the version to R2023a"),
        (Layout::Old, Some(Version::R2023b), ErrorKind::Unsupported, "set the version to R2023a"),
        (Layout::Stated("R2023b"), Some(Version::R2023a), ErrorKind::Format, "version"),
    ];
    for (layout, version, kind, words) in cases {
        let (url, peer) = robot(layout).serve(|_| None);
        let error = connect(&url, version).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(words), "{error}");
        peer.join().unwrap();
    }
}

#[test]
fn wrong_calls_change_nothing() {
    let (url, peer) = robot(Layout::Stated("R2023b")).serve(|_| Some(measurements()));
    let mut link = connect(&url, None).unwrap();
    assert!(link.step(0).is_err() && link.step(33).is_err());
    assert!(link.command(1, MotorCommand::Force(1.0)).is_err());
    assert!(link.command(0, MotorCommand::Velocity(f64::NAN)).is_err());
    assert!(link.command(99, MotorCommand::Force(1.0)).is_err());
    assert!(link.enable(11, 32).is_err() && link.image(0).is_err() && link.values(6, &mut [0.0]).is_err());
    assert!(
        link.send(12, b"a").is_err() && link.send(11, b"").is_err() && link.send(11, &[0; 5000]).is_err()
    );
    assert_eq!(link.supervisor().err().unwrap().kind(), ErrorKind::Unsupported);
    assert!(link.robot().find("wheel").unwrap_err().to_string().contains("motor, position"));
    link.step(64).unwrap();
    drop(link);
    assert_eq!(
        peer.join().unwrap()[1],
        Request { step_ms: 64, messages: vec![], raw: vec![8, 0, 0, 0, 64, 0, 0, 0] }
    );
}

/// Answers the requests of a supervisor.
fn scene(request: &Request) -> Answer {
    let mut messages = Bytes::default();
    for (_, message) in request.messages.iter().filter(|(tag, _)| *tag == 0) {
        messages = match message[0] {
            84 => messages.u16(0).u8(84).u32(if message[1..].starts_with(b"BALL") { 17 } else { 0 }),
            87 => messages.u16(0).u8(87).i32(2).i32(5).u8(0).i32(-1).text("translation"),
            88 => messages.u16(0).u8(88).i32(5).i32(17).i32(2).f64(1.0).f64(2.0).f64(3.0),
            90 => messages.u16(0).u8(90).f64(4.0).f64(5.0).f64(6.0),
            96 => (0..6).fold(messages.u16(0).u8(96), |messages, _| messages.f64(0.5)),
            _ => messages,
        };
        if message[0] == 84 {
            messages = messages.u32(1).i32(0).u32(0).u8(0).text("Solid");
        }
    }
    Answer { messages, images: Vec::new() }
}

#[test]
fn a_supervisor_reads_and_changes_the_scene() {
    let robot = Fixture { is_supervisor: true, ..robot(Layout::Stated("R2023b")) };
    let (url, peer) = robot.serve(|request| Some(scene(request)));
    let mut link = connect(&url, None).unwrap();
    let supervisor = link.supervisor().unwrap();
    let ball = supervisor.node("BALL").unwrap();
    assert_eq!(supervisor.node("CUBE").unwrap_err().kind(), ErrorKind::NotFound);
    let field = supervisor.field(ball, "translation").unwrap();
    assert_eq!(field.kind(), FieldKind::Vec3);
    assert_eq!(supervisor.value(field).unwrap(), FieldValue::Vec3([1.0, 2.0, 3.0]));
    assert_eq!(supervisor.position(ball).unwrap(), [4.0, 5.0, 6.0]);
    assert_eq!(supervisor.velocity(ball).unwrap(), [0.5; 6]);
    assert!(supervisor.set_value(field, &FieldValue::Float(1.0)).is_err());
    assert!(supervisor.set_value(field, &FieldValue::Vec3([f64::NAN; 3])).is_err());
    supervisor.set_value(field, &FieldValue::Vec3([0.0, 0.0, 1.0])).unwrap();
    supervisor.reset_simulation().unwrap();
    link.step(32).unwrap();
    drop(link);
    let requests = peer.join().unwrap();
    assert_eq!(requests[1].messages, [(0, Bytes::default().u8(84).text("BALL").i32(-1).0)]);
    assert_eq!(requests[3].messages, [(0, Bytes::default().u8(87).u32(17).text("translation").u8(0).0)]);
    let set = Bytes::default().u8(62).u32(17).u32(2).u32(5).u32(u32::MAX).f64(0.0).f64(0.0).f64(1.0);
    assert_eq!(requests[requests.len() - 2].messages, [(0, vec![55])]);
    assert_eq!(requests.last().unwrap().messages, [(0, set.0)]);
}

#[test]
fn scene_requests_of_later_versions_are_refused() {
    let robot = Fixture { is_supervisor: true, ..robot(Layout::Stated("R2025a")) };
    let (url, peer) = robot.serve(|request| Some(scene(request)));
    let mut link = connect(&url, None).unwrap();
    let error = link.supervisor().unwrap().node("BALL").unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    link.supervisor().unwrap().reset_simulation().unwrap();
    drop(link);
    assert_eq!(peer.join().unwrap()[1].messages, [(0, vec![55])]);
}
