//! A robot of the protocol fixture as an environment.
#![allow(clippy::unwrap_used, reason = "code of tests")]

mod fixture;

use fixture::{Answer, Bytes, Fixture, Layout, Request, all_devices};
use opendr_engine::ErrorKind;
use opendr_engine::environment::{Environment, Space};
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_test_allocator::{CountingAllocator, allocations_of_thread};
use opendr_webots::{ControllerUrl, NativeLink, WebotsEnvironment, WebotsParams, registration};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn measured(reward: f64, flags: u8) -> Answer {
    let mut messages =
        Bytes::default().u16(0).u8(4).f64(0.032).u16(2).u8(1).f64(0.25).u16(3).u8(50).f64(123.5);
    messages = messages.u16(9).u8(53).f64(1.0).f64(2.0).f64(3.0);
    messages = messages.u16(13).u8(1).i32(0).f64(1.0).f64(0.0).f64(0.0).f64(0.9).i32(9).f64(reward).u8(flags);
    let ranges =
        [0.5, 4.0, f32::INFINITY, 1.0, 2.0, 3.0].iter().flat_map(|range| range.to_le_bytes()).collect();
    Answer { messages, images: vec![(4, (0..32).collect()), (5, ranges)] }
}

fn serve(is_supervisor: bool, answer: impl FnMut(&Request) -> Option<Answer> + Send + 'static) -> String {
    Fixture { layout: Layout::Stated("R2023b"), is_supervisor, devices: all_devices() }.serve(answer).0
}

fn environment(url: &str, params: &WebotsParams) -> opendr_engine::Result<WebotsEnvironment> {
    let link = NativeLink::connect(&ControllerUrl::parse(url).unwrap(), None, None)?;
    WebotsEnvironment::new(Box::new(link), params)
}

#[test]
fn sensors_are_observed_by_name() {
    let mut steps = 0;
    let url = serve(true, move |request| {
        steps += u32::from(request.step_ms > 0);
        Some(measured(f64::from(steps), u8::from(steps == 3)))
    });
    let sensors = "gyro, position, depth, camera".to_owned();
    let params = WebotsParams {
        sensors,
        reward: "receiver".to_owned(),
        motors: "motor:position".to_owned(),
        ..Default::default()
    };
    let mut robot = environment(&url, &params).unwrap();
    let Space::Dict(parts) = &robot.spec().observation else { panic!("{}", robot.spec().observation) };
    assert_eq!(parts.keys().collect::<Vec<_>>(), ["camera", "depth", "gyro", "position"]);
    assert_eq!(robot.spec().action, Space::symmetric(&[1.0]));
    let mut observation = vec![0.0; robot.spec().observation.len()];
    assert_eq!(observation.len(), 24 + 6 + 3 + 1);
    robot.reset(Some(1), &ParamMap::new(), &mut observation).unwrap();
    assert_eq!(observation[..6], [2.0, 1.0, 0.0, 6.0, 5.0, 4.0]);
    assert_eq!(observation[24..], [0.5, 4.0, 5.0, 1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 0.25]);
    let step = robot.step(&[0.5], &mut observation).unwrap();
    assert_eq!((step.reward, step.terminated), (2.0, false));
    let step = robot.step(&[0.5], &mut observation).unwrap();
    assert_eq!((step.reward, step.terminated, step.info.get("time")), (3.0, true, Some(0.032)));
    assert_eq!(robot.render().unwrap().unwrap().width(), 4);
}

#[test]
fn only_a_supervisor_resets_twice() {
    let url = serve(false, |_| Some(measured(0.0, 0)));
    let params = WebotsParams { sensors: "distance".to_owned(), ..Default::default() };
    let mut robot = environment(&url, &params).unwrap();
    let mut observation = [0.0];
    robot.reset(None, &ParamMap::new(), &mut observation).unwrap();
    assert_eq!(observation, [123.5]);
    assert_eq!(
        robot.reset(None, &ParamMap::new(), &mut observation).unwrap_err().kind(),
        ErrorKind::Unsupported
    );
}

#[test]
fn what_is_silent_is_an_error() {
    let url = serve(true, |_| Some(Answer::default()));
    let mut robot =
        environment(&url, &WebotsParams { sensors: "gyro".to_owned(), ..Default::default() }).unwrap();
    let error = robot.reset(None, &ParamMap::new(), &mut [0.0; 3]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Device);
    assert!(error.to_string().contains("\"gyro\" measured nothing"), "{error}");
}

#[test]
fn devices_are_checked() {
    let wrong = |params: WebotsParams| environment(&serve(false, |_| None), &params).err().unwrap().kind();
    let params = WebotsParams::default;
    assert_eq!(wrong(WebotsParams { sensors: "nose".to_owned(), ..params() }), ErrorKind::NotFound);
    assert_eq!(wrong(WebotsParams { sensors: "motor".to_owned(), ..params() }), ErrorKind::InvalidParam);
    assert_eq!(wrong(WebotsParams { motors: "gyro".to_owned(), ..params() }), ErrorKind::InvalidParam);
    assert_eq!(wrong(WebotsParams { motors: "motor:power".to_owned(), ..params() }), ErrorKind::InvalidParam);
    assert_eq!(
        wrong(WebotsParams { motors: "motor, motor".to_owned(), ..params() }),
        ErrorKind::InvalidParam
    );
    assert_eq!(wrong(WebotsParams { reward: "gyro".to_owned(), ..params() }), ErrorKind::InvalidParam);
    assert_eq!(wrong(WebotsParams { step_ms: 33, ..params() }), ErrorKind::InvalidParam);
}

#[test]
fn a_step_allocates_nothing() {
    let url = serve(true, |_| Some(measured(1.0, 0)));
    let params = WebotsParams {
        reward: "receiver".to_owned(),
        sensors: "gyro,depth,camera".to_owned(),
        ..Default::default()
    };
    let mut robot = environment(&url, &params).unwrap();
    let mut observation = vec![0.0; robot.spec().observation.len()];
    robot.reset(None, &ParamMap::new(), &mut observation).unwrap();
    for _ in 0..3 {
        robot.step(&[0.0], &mut observation).unwrap();
    }
    let before = allocations_of_thread();
    for _ in 0..10 {
        robot.step(&[1.0], &mut observation).unwrap();
    }
    assert_eq!(allocations_of_thread() - before, 0);
}

#[test]
fn the_registered_environment_connects() {
    let url = serve(true, |_| Some(measured(0.0, 0)));
    let text = |text: &str| ParamValue::Text(text.to_owned());
    let mut params =
        ParamMap::from([("url".to_owned(), text(&url)), ("sensors".to_owned(), text("distance"))]);
    params.insert("max_steps".to_owned(), ParamValue::Int(2));
    let mut robot = registration().make(&params).unwrap();
    assert_eq!((robot.spec().id.as_str(), robot.spec().max_episode_steps), ("Webots-v0", Some(2)));
    let mut observation = [0.0];
    robot.reset(None, &ParamMap::new(), &mut observation).unwrap();
    assert!(!robot.step(&[0.0], &mut observation).unwrap().truncated);
    assert!(robot.step(&[0.0], &mut observation).unwrap().truncated);
    let none = registration().make(&ParamMap::from([("url".to_owned(), text("tcp://127.0.0.1:9/robot"))]));
    assert_eq!(none.err().unwrap().kind(), ErrorKind::Network);
}
