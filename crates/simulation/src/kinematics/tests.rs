use std::time::Instant;

use opendr_engine::{ErrorKind, Random};

use super::*;

fn arm() -> RollArm {
    RollArm::new(SerialChain::from_urdf(SERVICE_ARM, "wrist").unwrap()).unwrap()
}

fn random_angles(arm: &RollArm, random: &mut Random) -> JointAngles {
    arm.ranges().map(|[low, high]| {
        let (low, high) = if low.is_finite() { (low, high) } else { (-3.1, 3.1) };
        low + (high - low) * random.unit()
    })
}

fn distance(one: &Transform, other: &Transform) -> f64 {
    let parts =
        |pose: &Transform| pose.rotation.into_iter().flatten().chain(pose.position).collect::<Vec<_>>();
    parts(one).iter().zip(parts(other)).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

#[test]
fn a_solution_is_at_its_pose_and_in_range() {
    let (arm, mut random) = (arm(), Random::new(1));
    let (mut found, total) = (0, 4000);
    for _ in 0..total {
        let target = arm.forward(&random_angles(&arm, &mut random));
        let Some(angles) = arm.inverse(&target, &random_angles(&arm, &mut random)) else { continue };
        found += 1;
        assert!(distance(&arm.forward(&angles), &target) < 1e-6);
        for (angle, [low, high]) in angles.iter().zip(arm.ranges()) {
            assert!((low..=high).contains(&angle), "{angles:?}");
        }
    }
    // The search has steps; poses that only a sliver of the pan's range reaches are missed.
    assert!(found > total * 98 / 100, "{found}");
}

#[test]
fn poses_out_of_reach_are_refused() {
    let (arm, mut random) = (arm(), Random::new(2));
    for _ in 0..1000 {
        let mut target = arm.forward(&random_angles(&arm, &mut random));
        target.position[2] += 2.0;
        assert_eq!(arm.inverse(&target, &[0.0; 7]), None);
    }
    for part in [f64::NAN, f64::INFINITY, 1e300] {
        let target = Transform { position: [part, 0.0, 0.0], ..Transform::default() };
        assert_eq!(arm.inverse(&target, &[part; 7]), None);
        assert_eq!(
            arm.inverse(&Transform { rotation: [[part; 3]; 3], ..arm.forward(&[0.0; 7]) }, &[0.0; 7]),
            None
        );
    }
}

/// Along a path in joint space the solutions follow without jumps.
#[test]
fn solutions_follow_a_path() {
    let (arm, mut random) = (arm(), Random::new(3));
    let mut jumps = 0;
    for _ in 0..100 {
        let middle = arm.ranges().map(|[low, high]| if low.is_finite() { (low + high) / 2.0 } else { 0.0 });
        let goal = random_angles(&arm, &mut random);
        let mut angles = middle;
        for step in 1..=50 {
            let share = 0.8 * f64::from(step) / 50.0;
            let on_path: JointAngles = std::array::from_fn(|at| middle[at] + share * (goal[at] - middle[at]));
            let next = arm.inverse(&arm.forward(&on_path), &angles).unwrap();
            jumps += usize::from(next.iter().zip(&angles).any(|(one, other)| (one - other).abs() > 0.5));
            angles = next;
        }
    }
    assert!(jumps < 100, "{jumps} of 5000");
}

#[test]
fn quaternions_come_back() {
    let mut random = Random::new(4);
    for _ in 0..1000 {
        let pose = Transform::from_rpy([(); 3].map(|()| 6.3 * random.unit()));
        let again = Transform::from_quaternion([0.0; 3], pose.quaternion());
        assert!(distance(&pose, &again) < 1e-12);
        assert!(distance(&pose.then(&pose.inverse()), &Transform::default()) < 1e-12);
        let other = Transform::from_rpy([(); 3].map(|()| 6.3 * random.unit()));
        let half = Transform { rotation: pose.rotation_towards(&other, 0.5), ..pose };
        assert!((half.angle_to(&pose) - half.angle_to(&other)).abs() < 1e-6);
    }
}

#[test]
fn wrong_descriptions_are_refused() {
    let kind = |text: &str, tip: &str| SerialChain::from_urdf(text, tip).unwrap_err().kind();
    assert_eq!(kind(SERVICE_ARM, "hand"), ErrorKind::NotFound);
    assert_eq!(kind("<robot", "a"), ErrorKind::Format);
    assert_eq!(kind("<model/>", "a"), ErrorKind::Format);
    let joint = |body: &str, joint: &str| {
        format!(
            "<robot><joint name='j' type='{joint}'><parent link='a'/><child link='b'/>{body}</joint></robot>"
        )
    };
    assert_eq!(kind(&joint("", "prismatic"), "b"), ErrorKind::Unsupported);
    for body in ["<axis xyz='0 0 0'/>", "<axis xyz='0 1'/>", "<origin xyz='0 0 nan'/>"] {
        assert_eq!(kind(&joint(body, "continuous"), "b"), ErrorKind::Format);
    }
    assert_eq!(kind(&joint("<limit lower='1' upper='0'/>", "revolute"), "b"), ErrorKind::Format);
    let cycle = "<robot><joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>\
        <joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>";
    assert_eq!(kind(cycle, "b"), ErrorKind::Format);
    let short = SerialChain::from_urdf(&joint("", "continuous"), "b").unwrap();
    assert_eq!(RollArm::new(short).unwrap_err().kind(), ErrorKind::Unsupported);
    let turned = SERVICE_ARM.replacen("xyz=\"0.40 0 0\"", "xyz=\"0.40 0 0\" rpy=\"0 0.1 0\"", 1);
    assert!(RollArm::new(SerialChain::from_urdf(&turned, "wrist").unwrap()).is_err());
}

/// `cargo test --release -p opendr-simulation speed_of_inverse -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn speed_of_inverse_kinematics() {
    let (arm, mut random) = (arm(), Random::new(5));
    let cases: Vec<_> = (0..20_000)
        .map(|_| {
            let near = random_angles(&arm, &mut random);
            let moved = near.map(|angle| angle + 0.02 * random.unit());
            (arm.forward(&moved), near)
        })
        .collect();
    let begun = Instant::now();
    let found = cases.iter().filter(|(target, near)| arm.inverse(target, near).is_some()).count();
    println!("{found} of {}: {:.2} us", cases.len(), begun.elapsed().as_secs_f64() / 0.02);
}
