use opendr_engine::ErrorKind;
use opendr_engine::data::Pixels;

use super::*;

fn small(course: Course) -> DriveOptions {
    DriveOptions {
        course,
        length: 30.0,
        block: 60.0,
        size: [160, 120],
        noise: 0.0,
        ..DriveOptions::default()
    }
}

fn depths(frame: &DriveFrame) -> &[f32] {
    let Pixels::F32(depths) = frame.depth.pixels() else { panic!("{:?}", frame.depth.format()) };
    depths
}

#[test]
fn the_same_options_give_the_same_frames() {
    let options = DriveOptions { seed: 4, ..small(Course::Curves) };
    let render = |options: &DriveOptions| Drive::new(options).unwrap().render(5).unwrap();
    let (one, other) = (render(&options), render(&options));
    assert_eq!((&one.left, &one.right, &one.depth), (&other.left, &other.right, &other.depth));
    assert_ne!(one.left, render(&DriveOptions { seed: 5, ..options }).left);
}

#[test]
fn a_loop_returns_to_its_start_and_goes_on() {
    let drive = Drive::new(&DriveOptions { shake: 0.0, ..small(Course::Loop) }).unwrap();
    let start = drive.pose(0);
    let aside = |frame: usize| {
        let pose = drive.pose(frame);
        (0..3).map(|axis| (pose[axis][3] - start[axis][3]).powi(2)).sum::<f64>().sqrt()
    };
    let middle = drive.frames() / 2;
    assert!(aside(middle) > 40.0);
    let nearest = (middle..drive.frames()).map(aside).fold(f64::INFINITY, f64::min);
    assert!(nearest < 0.21, "{nearest}");
}

#[test]
fn rotations_are_orthonormal() {
    let drive = Drive::new(&DriveOptions { shake: 0.1, ..small(Course::Curves) }).unwrap();
    for frame in 0..drive.frames() {
        let pose = drive.pose(frame);
        for row in 0..3 {
            for other in 0..3 {
                let product: f64 = (0..3).map(|at| pose[row][at] * pose[other][at]).sum();
                let expected = if row == other { 1.0 } else { 0.0 };
                assert!((product - expected).abs() < 1e-12, "{pose:?}");
            }
        }
    }
}

/// A point that is unprojected from one frame has the same brightness where it projects to in the other camera and the next frame.
#[test]
fn depths_and_poses_map_one_image_to_the_other() {
    let options =
        DriveOptions { depth_noise: 0.0, exposure_swing: 0.0, depth_range: 40.0, ..small(Course::Straight) };
    let options = DriveOptions { size: [320, 240], ..options };
    let drive = Drive::new(&options).unwrap();
    let (one, next) = (drive.render(2).unwrap(), drive.render(3).unwrap());
    let (focal, [cx, cy]) = drive.intrinsics();
    let (from, to) = (drive.pose(2), drive.pose(3));
    let grey =
        |image: &opendr_engine::data::Image, x: usize, y: usize| f64::from(image.view().sample_u8(x, y, 1));
    let mut pairs = [Vec::new(), Vec::new()];
    for (at, depth) in depths(&one).iter().enumerate().filter(|(at, depth)| at % 7 == 0 && **depth > 0.0) {
        let (x, y) = (at % 320, at / 320);
        let z = f64::from(*depth);
        let point = [(x as f64 - cx) * z / focal, (y as f64 - cy) * z / focal, z];
        let world: [f64; 3] =
            std::array::from_fn(|row| (0..3).map(|at| from[row][at] * point[at]).sum::<f64>() + from[row][3]);
        let moved: [f64; 3] =
            std::array::from_fn(|column| (0..3).map(|row| to[row][column] * (world[row] - to[row][3])).sum());
        let right = [point[0] - f64::from(options.baseline), point[1], point[2]];
        for ((seen, image), pairs) in [(right, &one.right), (moved, &next.left)].into_iter().zip(&mut pairs) {
            let place = [0, 1].map(|axis| focal * seen[axis] / seen[2] + [cx, cy][axis]);
            let [u, v] = place.map(|part| part.round());
            if (0.0..320.0).contains(&u) && (0.0..240.0).contains(&v) {
                pairs.push((grey(&one.left, x, y) - grey(image, u as usize, v as usize)).abs());
            }
        }
    }
    for mut differences in pairs {
        assert!(differences.len() > 3000);
        differences.sort_by(f64::total_cmp);
        let median = differences[differences.len() / 2];
        assert!(median < 8.0, "{median}");
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let refused = DriveOptions { block: f64::NAN, ..DriveOptions::default() };
    assert_eq!(Drive::new(&refused).unwrap_err().kind(), ErrorKind::InvalidParam);
    let drive = Drive::new(&small(Course::Straight)).unwrap();
    assert_eq!(drive.render(drive.frames()).unwrap_err().kind(), ErrorKind::NotFound);
}
