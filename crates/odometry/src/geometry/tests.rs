use opendr_engine::Random;

use super::eigen::eigen;
use super::p3p::p3p;
use super::polynomial::real_roots;
use super::pose::logarithm;
use super::vector::{Vector, minus, unit};
use super::*;

fn random_pose(random: &mut Random, turn: f32, shift: f32) -> Pose {
    let mut vector = |size: f32| [(); 3].map(|()| f64::from(random.uniform(-size, size)));
    Pose { rotation: exponential(vector(turn)), position: vector(shift) }
}

fn camera() -> PinholeCamera {
    PinholeCamera {
        size: [640, 480],
        focal_length: [400.0; 2],
        principal_point: [319.5, 239.5],
        baseline: 0.4,
    }
}

fn assert_near(a: &Pose, b: &Pose, tolerance: f64) {
    let pairs = a.rows().into_iter().flatten().zip(b.rows().into_iter().flatten());
    for (one, other) in pairs {
        assert!((one - other).abs() < tolerance, "{a:?} {b:?}");
    }
}

/// Points 4 to 30 m ahead of the identity.
fn points(random: &mut Random, count: usize) -> Vec<Vector> {
    (0..count)
        .map(|_| {
            let depth = random.uniform(4.0, 30.0);
            let mut aside = || random.uniform(-0.5, 0.5) * depth;
            [f64::from(aside()), f64::from(aside()), f64::from(depth)]
        })
        .collect()
}

#[test]
fn logarithms_and_quaternions_invert() {
    let mut random = Random::new(1);
    for size in [1e-9, 1e-4, 0.3, 3.0] {
        for _ in 0..100 {
            let vector = unit([(); 3].map(|()| random.normal())).map(|part| part * size);
            let rotation = exponential(vector);
            assert!(length(minus(logarithm(&rotation), vector)) < 1e-7 * size.max(1e-2), "{vector:?}");
            let pose = Pose { rotation, position: [1.0, 2.0, 3.0] };
            assert_near(&Pose::from_quaternion(pose.position, pose.quaternion()), &pose, 1e-12);
        }
    }
}

#[test]
fn poses_compose_and_invert() {
    let mut random = Random::new(2);
    let (a, b) = (random_pose(&mut random, 1.0, 5.0), random_pose(&mut random, 1.0, 5.0));
    assert_near(&a.then(&a.inverse()), &Pose::IDENTITY, 1e-12);
    let point = [0.3, -2.0, 7.0];
    assert!(distance(a.then(&b).point(point), a.point(b.point(point))) < 1e-12);
    assert!(distance(a.point_in_frame(a.point(point)), point) < 1e-12);
    assert_near(&Pose::from_rows(a.rows()), &a, 1e-12);
}

#[test]
fn eigenvectors_of_a_symmetric_matrix() {
    let matrix = [[4.0, 1.0, -2.0, 0.5], [1.0, 3.0, 0.0, 1.0], [-2.0, 0.0, 5.0, -1.0], [0.5, 1.0, -1.0, 2.0]];
    let (values, vectors) = eigen(matrix);
    for (value, vector) in values.iter().zip(vectors) {
        for row in 0..4 {
            let product: f64 = (0..4).map(|at| matrix[row][at] * vector[at]).sum();
            assert!((product - value * vector[row]).abs() < 1e-12);
        }
    }
}

#[test]
fn roots_of_quartics() {
    let mut roots = [0.0; 4];
    // (x - 1)(x + 2)(x - 3)(x - 0.5)
    let count = real_roots(&[1.0, -2.5, -4.0, 8.5, -3.0], &mut roots);
    let found = &roots[..count];
    assert_eq!(count, 4, "{found:?}");
    for (root, expected) in found.iter().zip([-2.0, 0.5, 1.0, 3.0]) {
        assert!((root - expected).abs() < 1e-9, "{found:?}");
    }
    assert_eq!(real_roots(&[1.0, 0.0, 2.0, 0.0, 1.0], &mut roots), 0);
    assert_eq!(real_roots(&[0.0; 5], &mut roots), 0);
    assert_eq!(real_roots(&[f64::NAN; 5], &mut roots), 0);
}

#[test]
fn three_points_give_the_pose_among_up_to_four() {
    let mut random = Random::new(3);
    let mut missed = 0;
    for _ in 0..500 {
        let pose = random_pose(&mut random, 0.8, 2.0);
        let chosen: [Vector; 3] = points(&mut random, 3).try_into().unwrap();
        let rays = chosen.map(unit);
        let world = chosen.map(|point| pose.point(point));
        let mut poses = [Pose::IDENTITY; 4];
        let count = p3p(&world, &rays, &mut poses);
        let best = poses[..count]
            .iter()
            .map(|found| distance(found.position, pose.position))
            .fold(f64::INFINITY, f64::min);
        missed += usize::from(best > 1e-4);
    }
    assert!(missed < 10, "{missed}");
}

#[test]
fn a_pose_is_found_among_wrong_points() {
    let mut random = Random::new(4);
    for share in [0.0, 0.3, 0.6] {
        let pose = random_pose(&mut random, 0.6, 3.0);
        let sights: Vec<Sight> = points(&mut random, 120)
            .into_iter()
            .map(|point| {
                let pixel = camera().project(point).unwrap();
                let wrong = if random.chance(share) { 60.0 } else { 0.3 };
                Sight { point: pose.point(point), pixel: pixel.map(|part| part + wrong * random.normal()) }
            })
            .collect();
        let mut found = Resection::default();
        assert!(resect(&camera(), &sights, None, 1.5, &mut random, &mut found));
        assert_near(&found.pose, &pose, 0.03);
        assert!(found.inliers as f32 > 0.85 * 120.0 * (1.0 - share), "{}", found.inliers);
    }
    let mut found = Resection::default();
    assert!(!resect(&camera(), &[], None, 1.5, &mut random, &mut found));
}

#[test]
fn two_views_give_their_motion_also_of_a_plane() {
    let mut random = Random::new(5);
    for is_plane in [false, true] {
        for direction in [[0.1, 0.0, 1.0], [1.0, 0.1, 0.1], [-0.7, 0.0, 0.7]] {
            let motion = Pose { rotation: exponential([0.02, -0.1, 0.01]), position: unit(direction) };
            let pairs: Vec<TwoViews> = points(&mut random, 150)
                .into_iter()
                .filter_map(|[x, y, z]| {
                    let point = if is_plane { [x, 1.6, z] } else { [x, y, z] };
                    let mut noise = || 0.3 * random.normal();
                    let mut ray = |point: Vector| {
                        camera().project(point).map(|[u, v]| camera().ray([u + noise(), v + noise()]))
                    };
                    Some([ray(point)?, ray(motion.point_in_frame(point))?])
                })
                .collect();
            let mut agrees = Vec::new();
            let found = relative_pose(&pairs, 1.5 / 400.0, 50, &mut random, &mut agrees).unwrap();
            assert_near(&found, &motion, 0.08);
        }
    }
}

#[test]
fn similarities_align() {
    let mut random = Random::new(6);
    let by = Similarity3 { scale: 2.5, pose: random_pose(&mut random, 2.0, 9.0) };
    let from = points(&mut random, 20);
    let to: Vec<Vector> = from.iter().map(|point| by.point(*point)).collect();
    let found = Similarity3::aligning(&from, &to, true).unwrap();
    assert!((found.scale - 2.5).abs() < 1e-9);
    assert_near(&found.pose, &by.pose, 1e-8);
    assert!(Similarity3::aligning(&from[..2], &to[..2], false).is_none());
    assert!(Similarity3::aligning(&[[1.0; 3]; 4], &to[..4], true).is_none());
    assert!(Similarity3::aligning(&[[f64::NAN; 3]; 4], &to[..4], true).is_none());
}
