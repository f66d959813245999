use std::sync::Arc;

use opendr_engine::Random;

use super::*;

fn random_unit_vector(random: &mut Random) -> Vector {
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
fn distances_match_closed_forms() {
    let close = |a: f32, b: f32| (a - b).abs() <= 1e-4 * b.abs();
    let met = |shape: &Shape, origin, direction: Vector| {
        let mut scene = Scene::default();
        scene.add(Body::upright(shape.clone(), [10.0, 0.0, 0.0], 3).unwrap());
        let mut hits = [None];
        let direction = direction.map(|part| part / length(direction));
        scene.hits(origin, &[direction], 100.0, &mut hits).unwrap();
        hits[0]
    };
    let sphere = Shape::Sphere { radius: 2.0 };
    let hit = met(&sphere, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]).unwrap();
    assert!(close(hit.distance, 10.0 - 3.0_f32.sqrt()), "{hit:?}");
    assert_eq!(hit.label, 3);
    assert!(close(hit.normal[1], 0.5) && close(hit.normal[0], -0.75_f32.sqrt()), "{hit:?}");
    assert!(close(met(&sphere, [10.0, 0.0, 0.0], [0.0, 1.0, 1.0]).unwrap().distance, 2.0));
    assert_eq!(met(&sphere, [0.0, 2.1, 0.0], [1.0, 0.0, 0.0]), None);
    assert_eq!(met(&sphere, [13.0, 0.0, 0.0], [1.0, 0.0, 0.0]), None);

    let cube = Shape::Box { half: [1.0, 2.0, 3.0] };
    assert!(close(met(&cube, [0.0; 3], [1.0, 0.0, 0.0]).unwrap().distance, 9.0));
    assert!(close(met(&cube, [0.0; 3], [1.0, 0.1, 0.2]).unwrap().distance, 9.0 * 1.05_f32.sqrt()));
    assert_eq!(met(&cube, [0.0; 3], [1.0, 0.3, 0.0]), None);

    let cylinder = Shape::Cylinder { radius: 1.0, half_height: 2.0 };
    assert!(close(
        met(&cylinder, [0.0, 0.5, 1.0], [1.0, 0.0, 0.0]).unwrap().distance,
        10.0 - 0.75_f32.sqrt()
    ));
    let top = met(&cylinder, [10.5, 0.0, 9.0], [0.0, 0.0, -1.0]).unwrap();
    assert!(close(top.distance, 7.0) && top.normal == [0.0, 0.0, 1.0], "{top:?}");
    assert_eq!(met(&cylinder, [11.5, 0.0, 9.0], [0.0, 0.0, -1.0]), None);
    assert!(close(
        met(&Shape::HalfSpace, [0.0, 0.0, 4.0], [1.0, 0.0, -1.0]).unwrap().distance,
        32.0_f32.sqrt()
    ));
}

/// The distance is independent code: a ray must end on the surface, and no surface may lie before its end.
#[test]
fn rays_end_on_the_surface() {
    let mut random = Random::new(5);
    for body in bodies() {
        let mut scene = Scene::default();
        scene.add(body.clone());
        let mut met = 0;
        for _ in 0..3000 {
            let origin = [(); 3].map(|()| random.uniform(-2.0, 2.0));
            let directions: Vec<_> = (0..5).map(|_| random_unit_vector(&mut random)).collect();
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

/// A million ways through bodies of all kinds: the sweep must stop no later than a test with small steps.
#[test]
fn a_sweep_misses_no_body() {
    let mut random = Random::new(8);
    let mut all = bodies();
    all.push(Body::upright(Shape::Box { half: [0.001, 3.0, 3.0] }, [0.0; 3], 0).unwrap());
    let (mut touched, mut passed) = (0, 0);
    for way in 0..1_000_000 {
        let mut scene = Scene::default();
        scene.add(all[way % all.len()].clone());
        let from = [(); 3].map(|()| random.uniform(-2.5, 2.5));
        let direction = random_unit_vector(&mut random);
        let far = random.uniform(0.05, 1.5);
        let to = along(from, direction, far);
        let end = scene.sweep(from, to, 0.1);
        touched += usize::from(end.is_some());
        let free = end.unwrap_or(far);
        assert!((0.0..=far).contains(&free), "{from:?} {to:?} {end:?}");
        for step in 0..=15 {
            let at = far * step as f32 / 15.0;
            let gap = scene.distance(along(from, direction, at)) - 0.1;
            assert!(at >= free || gap > -1e-5, "{:?} {from:?} {to:?} {end:?} {gap}", scene.bodies()[0]);
        }
        let is_thin = way % all.len() == all.len() - 1;
        let passes = is_thin
            && (from[0] > 0.0) != (to[0] > 0.0)
            && [from, to].iter().all(|point| point[1].abs() < 3.0 && point[2].abs() < 3.0);
        passed += usize::from(passes);
        assert!(!passes || end.is_some(), "{from:?} {to:?}");
    }
    assert!((100_000..800_000).contains(&touched) && passed > 10_000, "{touched} {passed}");
}

fn cube_of_triangles(half: Vector) -> Mesh {
    let corner =
        |at: u32| std::array::from_fn(|axis| if at >> axis & 1 == 1 { half[axis] } else { -half[axis] });
    let vertices: Vec<Vector> = (0..8).map(corner).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<_> = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Mesh::new(&vertices, &faces).unwrap()
}

fn scene_of(shape: Shape) -> Scene {
    let mut scene = Scene::default();
    scene.add(Body::new(shape, [0.4, -0.3, 0.2], [0.9, 0.3, -0.2, 0.4], 1).unwrap());
    scene
}

#[test]
fn a_cube_of_triangles_is_a_box() {
    let half = [0.3, 1.2, 0.6];
    let (cube, triangles) =
        (scene_of(Shape::Box { half }), scene_of(Shape::Mesh(Arc::new(cube_of_triangles(half)))));
    let mut random = Random::new(3);
    for _ in 0..3000 {
        let origin = [(); 3].map(|()| random.uniform(-2.0, 2.0));
        let directions: Vec<_> = (0..20).map(|_| random_unit_vector(&mut random)).collect();
        let [mut one, mut other] = [vec![None; 20], vec![None; 20]];
        cube.hits(origin, &directions, 9.0, &mut one).unwrap();
        triangles.hits(origin, &directions, 9.0, &mut other).unwrap();
        for (one, other) in one.iter().zip(&other) {
            // A ray that grazes an edge may hit only one of them.
            let (Some(one), Some(other)) = (one, other) else { continue };
            assert!((one.distance - other.distance).abs() <= 1e-4 * one.distance, "{one:?} {other:?}");
        }
        let differing = one.iter().zip(&other).filter(|(one, other)| one.is_some() != other.is_some());
        assert!(differing.count() <= 1);
        let gap = cube.distance(origin).abs() - triangles.distance(origin);
        assert!(gap.abs() < 1e-5, "{gap}");
    }
    let top = Shape::Mesh(Arc::new(cube_of_triangles([1.0; 3])));
    assert!(dot(top.normal([0.2, 0.1, 1.3]), [0.0, 0.0, 1.0]) > 0.999);
}

/// Tests every triangle one by one, in double precision.
#[test]
fn a_tree_of_boxes_loses_no_triangle() {
    let mut random = Random::new(4);
    let vertices: Vec<Vector> = (0..900).map(|_| [(); 3].map(|()| random.uniform(-3.0, 3.0))).collect();
    let near = |random: &mut Random, at: usize| ((at + random.below(30)) % 900) as u32;
    let faces: Vec<_> =
        (0..700).map(|at| [at as u32, near(&mut random, at), near(&mut random, at)]).collect();
    let mesh = Mesh::new(&vertices, &faces).unwrap();
    assert_eq!(mesh.triangles(), 700);
    let mut scene = Scene::default();
    scene.add(Body::upright(Shape::Mesh(Arc::new(mesh)), [0.0; 3], 0).unwrap());
    let mut met = 0;
    for _ in 0..300 {
        let origin = [(); 3].map(|()| random.uniform(-6.0, 6.0));
        let directions: Vec<_> = (0..33).map(|_| random_unit_vector(&mut random)).collect();
        let mut depths = [0.0; 33];
        scene.depths(origin, &directions, 50.0, &mut depths).unwrap();
        for (depth, direction) in depths.into_iter().zip(&directions) {
            let corners = |face: &[u32; 3]| face.map(|at| vertices[at as usize].map(f64::from));
            let all = faces.iter().filter_map(|face| brute_force(corners(face), origin, *direction));
            let (expected, edge) = all.fold((50.0, 1.0), |best, hit| if hit.0 < best.0 { hit } else { best });
            // At an edge, within single precision, both results are right.
            assert!(
                (f64::from(depth) - expected).abs() <= 1e-4 * expected.max(0.1) || edge < 1e-4,
                "{depth} {expected}"
            );
            met += usize::from(expected < 50.0);
        }
    }
    assert!(met > 1000, "{met}");
}

/// Returns where a ray hits a triangle, and the smallest barycentric coordinate, by Cramer's rule.
fn brute_force(corners: [[f64; 3]; 3], origin: Vector, direction: Vector) -> Option<(f64, f64)> {
    let [a, b, c] = corners;
    let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let determinant = |p: [f64; 3], q: [f64; 3], r: [f64; 3]| {
        p[0] * (q[1] * r[2] - q[2] * r[1]) - q[0] * (p[1] * r[2] - p[2] * r[1])
            + r[0] * (p[1] * q[2] - p[2] * q[1])
    };
    let (ab, ac, back) = (minus(b, a), minus(c, a), direction.map(|part| -f64::from(part)));
    let from_a = minus(origin.map(f64::from), a);
    let all = determinant(ab, ac, back);
    let (u, v) = (determinant(from_a, ac, back) / all, determinant(ab, from_a, back) / all);
    let distance = determinant(ab, ac, from_a) / all;
    let within = u.min(v).min(1.0 - u - v);
    (within >= -1e-5 && distance > 0.0).then_some((distance, within.abs()))
}

#[test]
fn an_inclined_height_field_is_a_plane() {
    let (columns, spacing) = (9, 0.5);
    let slope = |x: f32, y: f32| 0.3 * x - 0.2 * y + 0.1;
    let place = |at: usize| (at as f32 - 4.0) * spacing;
    let heights: Vec<_> =
        (0..columns * columns).map(|at| slope(place(at % columns), place(at / columns))).collect();
    let field = HeightField::new(&heights, columns, spacing).unwrap();
    let steep = (1.0_f32 + 0.09 + 0.04).sqrt();
    let mut random = Random::new(6);
    let mut scene = Scene::default();
    scene.add(Body::upright(Shape::HeightField(Arc::new(field.clone())), [0.0; 3], 0).unwrap());
    for _ in 0..3000 {
        let [x, y] = [(); 2].map(|()| random.uniform(-1.4, 1.4));
        assert!((field.height(x, y).unwrap() - slope(x, y)).abs() < 1e-5);
        let above = random.uniform(-0.5, 0.5);
        let distance = scene.distance([x, y, slope(x, y) + above]);
        assert!((distance - above / steep).abs() < 1e-5, "{x} {y} {above} {distance}");
        let mut hits = [None];
        scene.hits([x, y, 5.0], &[[0.0, 0.0, -1.0]], 20.0, &mut hits).unwrap();
        let hit = hits[0].unwrap();
        assert!((hit.distance - (5.0 - slope(x, y))).abs() <= 1e-4 * hit.distance);
        assert!(dot(hit.normal, [-0.3 / steep, 0.2 / steep, 1.0 / steep]) > 0.999_9);
    }
    assert_eq!((field.height(2.1, 0.0), field.height(f32::NAN, 0.0)), (None, None));
    assert!(HeightField::new(&[0.0; 5], 2, 1.0).is_err() && HeightField::new(&[], 0, 1.0).is_err());
    assert!(HeightField::new(&[f32::NAN; 4], 2, 1.0).is_err());
    assert!(Mesh::new(&[[0.0; 3]], &[[0, 0, 1]]).is_err() && Mesh::new(&[], &[]).is_err());
    assert!(Mesh::new(&[[f32::NAN; 3]], &[[0, 0, 0]]).is_err());
}

/// Compares camera images, with patches, axial depth and wide vectors, with single rays.
#[test]
fn camera_images_match_single_rays() {
    let mut random = Random::new(7);
    let camera = Camera::new(37, 21, 0.7).unwrap();
    let mut buffer = DepthBuffer::default();
    let mut nothing = 0;
    for _ in 0..60 {
        let mut scene = Scene::default();
        scene.add(Body::upright(Shape::HalfSpace, [0.0, 0.0, -3.0], 0).unwrap());
        let cube = Shape::Mesh(Arc::new(cube_of_triangles([0.5, 0.4, 0.3])));
        let shapes = bodies().into_iter().take(3).map(|body| body.shape().clone()).chain([cube]);
        for shape in shapes.cycle().take(8) {
            let place = [(); 3].map(|()| random.uniform(-4.0, 4.0));
            let turned = [(); 4].map(|()| random.uniform(0.1, 1.0));
            scene.add(Body::new(shape, place, turned, 0).unwrap());
        }
        let place = [(); 3].map(|()| random.uniform(-4.0, 4.0));
        let pose = Pose::looking_at(place, [(); 3].map(|()| random.uniform(-2.0, 2.0)));
        camera.render_depth(&scene, &pose, 1e4, &mut buffer);
        let mut differing = 0;
        for (at, (depth, body)) in buffer.depths().zip(buffer.bodies()).enumerate() {
            let direction = camera.direction(at % 37, at / 37);
            let size = length(direction);
            let mut hits = [None];
            let unit = pose.to_world(direction).map(|part| part / size);
            scene.hits(pose.position, &[unit], 1e4 * size, &mut hits).unwrap();
            let expected = hits[0].map_or(1e4, |hit| hit.distance / size);
            nothing += usize::from(body.is_none());
            differing += usize::from((depth - expected).abs() > 1e-4 * expected.max(0.1));
        }
        // Grazing rays.
        assert!(differing <= 3, "{differing}");
    }
    assert!((1000..40_000).contains(&nothing), "{nothing}");
    assert!(Camera::new(0, 4, 1.0).is_err() && Camera::new(4, 4, f32::NAN).is_err());
}

#[test]
fn shading_distinguishes_sides_and_sky() {
    let mut scene = Scene::default();
    scene.add(Body::upright(Shape::HalfSpace, [0.0; 3], 0).unwrap());
    scene.add(Body::upright(Shape::Sphere { radius: 1.0 }, [4.0, 0.0, 1.5], 1).unwrap());
    let camera = Camera::new(64, 64, 0.5).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 1.5], [4.0, 0.0, 1.5]);
    let picture = Shading::default().render(&camera, &scene, &pose, 50.0).unwrap();
    let pixels = picture.hwc_u8(opendr_engine::data::PixelFormat::Rgb);
    let pixel = |column: usize, row: usize| &pixels[3 * (64 * row + column)..][..3];
    let brightness = |column, row| pixel(column, row).iter().map(|part| i32::from(*part)).sum::<i32>();
    let [sky, ball, ground] = [pixel(3, 3), pixel(32, 32), pixel(3, 60)];
    assert!(sky[2] > sky[0] && ball[0] > ball[2] && ground[0].abs_diff(ground[2]) < 20, "{sky:?} {ball:?}");
    assert!(brightness(32, 21) > brightness(32, 43) + 50);
    let squares: std::collections::BTreeSet<_> = (0..64).map(|column| brightness(column, 50)).collect();
    assert_eq!(squares.len(), 2);
}

#[test]
fn invalid_bodies_are_refused() {
    let sphere = |radius| Body::upright(Shape::Sphere { radius }, [0.0; 3], 0);
    assert!(sphere(0.0).is_err() && sphere(f32::NAN).is_err() && sphere(f32::INFINITY).is_err());
    assert!(Body::upright(Shape::HalfSpace, [f32::NAN, 0.0, 0.0], 0).is_err());
    assert!(Body::new(Shape::HalfSpace, [0.0; 3], [0.0; 4], 0).is_err());
    assert!(Scene::default().depths([0.0; 3], &[[1.0, 0.0, 0.0]], 9.0, &mut []).is_err());
    assert_eq!(Scene::default().distance([0.0; 3]), f32::INFINITY);
}
