use super::*;
use opendr_engine::data::PixelFormat;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Keypoint, Pose, PoseList, Skeleton};

fn grey(width: usize, height: usize) -> Image {
    Image::from_rgb8(vec![90; width * height * 3], width, height).unwrap()
}

fn pixel(image: &Image, x: usize, y: usize) -> Colour {
    let at = (y * image.width() + x) * 3;
    image.hwc_u8(PixelFormat::Rgb)[at..at + 3].try_into().unwrap()
}

#[test]
fn box_has_its_classes_colour_on_its_edge_and_nothing_within() {
    let mut image = grey(100, 100);
    let boxes = BoundingBoxList::from(vec![BoundingBox::new(2, 20.0, 30.0, 40.0, 50.0, 0.9)]);
    draw(&mut image, &boxes, &Style { labels: false, ..Style::default() });
    let inside = pixel(&image, 40, 50);
    let edges = [(20, 50), (60, 50), (40, 30), (40, 80)];
    assert!(edges.iter().all(|&(x, y)| pixel(&image, x, y) == colour_of_index(2)));
    assert_eq!((inside, pixel(&image, 5, 5)), ([90; 3], [90; 3]));
}

#[test]
fn label_stands_above_the_box_or_where_there_is_room() {
    for (top, rows) in [(50.0, 35..50), (0.0, 0..15)] {
        let mut image = grey(200, 100);
        let boxes = BoundingBoxList::from(vec![BoundingBox::new("dog", 20.0, top, 100.0, 40.0, 0.9)]);
        draw(&mut image, &boxes, &Style::default());
        let ground = colour_of_name(&"dog".into());
        let close = |colour: Colour| (0..3).all(|part| colour[part].abs_diff(ground[part]) < 40);
        let chip = rows.flat_map(|y| (22..60).map(move |x| (x, y)));
        let painted = chip.filter(|&(x, y)| close(pixel(&image, x, y))).count();
        assert!(painted > 200, "top {top}: {painted}");
    }
}

#[test]
fn hostile_boxes_and_poses_are_cut() {
    let wild = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, -50.0, 0.0, 5.5, 1e9];
    let mut boxes = BoundingBoxList::default();
    let mut poses = PoseList::default();
    for left in wild {
        for width in wild {
            let mut found = BoundingBox::new(i64::MIN, left, width, width, left, left);
            found.landmarks.push([left, width]);
            boxes.boxes.push(found);
            let joint = |x, y| Keypoint { x, y, confidence: x };
            let mut pose = Pose { id: Some(i64::MAX), ..Pose::default() };
            pose.keypoints.extend(
                (0..30).map(|index| if index % 2 == 0 { joint(left, width) } else { joint(3.0, left) }),
            );
            poses.poses.push(pose);
        }
    }
    boxes.boxes[0].name = "\u{0}字".repeat(10_000).as_str().into();
    for (width, height) in [(1, 1), (64, 3), (200, 150)] {
        for scale in [1.0, 0.0, f32::NAN, f32::INFINITY, 50.0] {
            let style = Style { scale, ..Style::default() };
            let mut image = grey(width, height);
            draw(&mut image, &boxes, &style);
            draw(&mut image, &poses, &style);
            assert_eq!((image.width(), image.height()), (width, height));
        }
    }
}

#[test]
fn bones_are_coloured_by_side_and_missing_joints_left_out() {
    let mut image = grey(100, 100);
    let mut pose = Pose { skeleton: Skeleton::Coco17, ..Pose::default() };
    pose.keypoints.resize(17, Keypoint::MISSING);
    let mut put = |name: &str, x, y| {
        let index = Skeleton::Coco17.joint(name).unwrap();
        pose.keypoints[index] = Keypoint { x, y, confidence: 1.0 };
    };
    put("l_sho", 70.5, 20.5);
    put("l_elb", 70.5, 80.5);
    put("r_sho", 30.5, 20.5);
    put("r_elb", 30.5, 80.5);
    draw(&mut image, &PoseList::from(vec![pose]), &Style::default());
    let [left, right, between] = [pixel(&image, 70, 50), pixel(&image, 30, 50), pixel(&image, 50, 20)];
    assert!(left[0] > 200 && left[2] < 100, "{left:?}");
    assert!(right[2] > 200 && right[0] < 100, "{right:?}");
    assert!(between[1] > 200 && between[0] < 200, "{between:?}");
    assert_eq!((pixel(&image, 50, 80), pixel(&image, 0, 0)), ([90; 3], [90; 3]));
}
