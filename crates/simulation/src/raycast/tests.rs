use opendr_engine::Random;

use super::*;

fn unit_by_chance(random: &mut Random) -> Vector {
    let vector = [(); 3].map(|()| random.normal() as f32);
    vector.map(|part| part / length(vector))
}

fn bodies() -> Vec<Body> {
    let turned = [0.9, 0.3, -0.2, 0.4];
    let shapes = [
        Shape::Sphere { radius: 0.7 },
        Shape::Box { half: [0.3, 1.2, 0.6] },
        Shape::Cylinder { radius: 0.5, half_height: 1.5 },
        Shape::HalfSpace,
    ];
    shapes.into_iter().map(|shape| Body::new(shape, [0.4, -0.3, 0.2], turned, 1).unwrap()).collect()
}

#[test]
fn distances_in_closed_form() {
    let close = |a: f32, b: f32| (a - b).abs() <= 1e-4 * b.abs();
    let met = |shape, origin, direction: Vector| {
        let mut scene = Scene::default();
        scene.add(Body::upright(shape, [10.0, 0.0, 0.0], 3).unwrap());
        let mut hits = [None];
        let direction = direction.map(|part| part / length(direction));
        scene.hits(origin, &[direction], 100.0, &mut hits).unwrap();
        hits[0]
    };
    let sphere = Shape::Sphere { radius: 2.0 };
    let hit = met(sphere, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]).unwrap();
    assert!(close(hit.distance, 10.0 - 3.0_f32.sqrt()), "{hit:?}");
    assert_eq!(hit.label, 3);
    assert!(close(hit.normal[1], 0.5) && close(hit.normal[0], -0.75_f32.sqrt()), "{hit:?}");
    assert!(close(met(sphere, [10.0, 0.0, 0.0], [0.0, 1.0, 1.0]).unwrap().distance, 2.0));
    assert_eq!(met(sphere, [0.0, 2.1, 0.0], [1.0, 0.0, 0.0]), None);
    assert_eq!(met(sphere, [13.0, 0.0, 0.0], [1.0, 0.0, 0.0]), None);

    let cube = Shape::Box { half: [1.0, 2.0, 3.0] };
    assert!(close(met(cube, [0.0; 3], [1.0, 0.0, 0.0]).unwrap().distance, 9.0));
    assert!(close(met(cube, [0.0; 3], [1.0, 0.1, 0.2]).unwrap().distance, 9.0 * 1.05_f32.sqrt()));
    assert_eq!(met(cube, [0.0; 3], [1.0, 0.3, 0.0]), None);

    let cylinder = Shape::Cylinder { radius: 1.0, half_height: 2.0 };
    assert!(close(met(cylinder, [0.0, 0.5, 1.0], [1.0, 0.0, 0.0]).unwrap().distance, 10.0 - 0.75_f32.sqrt()));
    let top = met(cylinder, [10.5, 0.0, 9.0], [0.0, 0.0, -1.0]).unwrap();
    assert!(close(top.distance, 7.0) && top.normal == [0.0, 0.0, 1.0], "{top:?}");
    assert_eq!(met(cylinder, [11.5, 0.0, 9.0], [0.0, 0.0, -1.0]), None);
    assert!(close(
        met(Shape::HalfSpace, [0.0, 0.0, 4.0], [1.0, 0.0, -1.0]).unwrap().distance,
        32.0_f32.sqrt()
    ));
}

/// The distance is independent code: a ray must end on the surface, and nothing may lie before its end.
#[test]
fn rays_end_where_the_distance_says() {
    let mut random = Random::new(5);
    for body in bodies() {
        let mut scene = Scene::default();
        scene.add(body);
        let mut met = 0;
        for _ in 0..3000 {
            let origin = [(); 3].map(|()| random.uniform(-2.0, 2.0));
            let directions: Vec<_> = (0..5).map(|_| unit_by_chance(&mut random)).collect();
            let mut hits = [None; 5];
            scene.hits(origin, &directions, 30.0, &mut hits).unwrap();
            let side = body.distance(origin).signum();
            for (hit, direction) in hits.into_iter().zip(directions) {
                let end = hit.map_or(30.0, |hit| hit.distance);
                for step in 0..20 {
                    let point = along(origin, direction, end * step as f32 / 20.0);
                    assert!(body.distance(point) * side > -2e-5, "{body:?} {origin:?} {direction:?} {hit:?}");
                }
                let Some(hit) = hit else { continue };
                met += 1;
                let point = along(origin, direction, hit.distance);
                assert!(body.distance(point).abs() <= 1e-4 * hit.distance.max(0.1), "{body:?} {hit:?}");
                assert!((length(hit.normal) - 1.0).abs() < 1e-4);
                let outside = body.distance(along(point, hit.normal, 1e-2));
                assert!(outside > 5e-3, "{body:?} {hit:?} {outside}");
            }
        }
        assert!(met > 300, "{body:?} {met}");
    }
}

#[test]
fn a_sweep_misses_nothing() {
    let mut random = Random::new(8);
    let mut scene = Scene::default();
    scene.add(Body::upright(Shape::Box { half: [0.001, 3.0, 3.0] }, [0.0; 3], 0).unwrap());
    bodies().into_iter().take(3).for_each(|body| scene.add(body));
    let mut touched = 0;
    for _ in 0..5000 {
        let [from, to] = [(); 2].map(|()| [(); 3].map(|()| random.uniform(-4.0, 4.0)));
        let far = length(minus(to, from));
        let direction = minus(to, from).map(|part| part / far);
        let end = scene.sweep(from, to, 0.1);
        touched += usize::from(end.is_some());
        let free = end.unwrap_or(far);
        for step in 0..200 {
            let gap = scene.distance(along(from, direction, free * step as f32 / 200.0)) - 0.1;
            assert!(gap > -1e-5 || free == 0.0, "{from:?} {to:?} {end:?} {gap}");
        }
        let passes = (from[0] > 0.0) != (to[0] > 0.0)
            && [from, to].iter().all(|p| p[1].abs() < 3.0 && p[2].abs() < 3.0);
        assert!(!passes || end.is_some(), "{from:?} {to:?}");
    }
    assert!((500..4500).contains(&touched), "{touched}");
}

#[test]
fn wrong_bodies_are_refused() {
    let sphere = |radius| Body::upright(Shape::Sphere { radius }, [0.0; 3], 0);
    assert!(sphere(0.0).is_err() && sphere(f32::NAN).is_err() && sphere(f32::INFINITY).is_err());
    assert!(Body::upright(Shape::HalfSpace, [f32::NAN, 0.0, 0.0], 0).is_err());
    assert!(Body::new(Shape::HalfSpace, [0.0; 3], [0.0; 4], 0).is_err());
    assert!(Scene::default().depths([0.0; 3], &[[1.0, 0.0, 0.0]], 9.0, &mut []).is_err());
    assert_eq!(Scene::default().distance([0.0; 3]), f32::INFINITY);
}
