use super::*;
use opendr_engine::data::PixelFormat;
use opendr_engine::target::{
    BoundingBox, BoundingBoxList, Category, Heatmap, Keypoint, Odometry, Pose, PoseList, RigidPose, Rle,
    Segmentation, Skeleton, TextRegion, TextRegionList, TrackingAnnotation, TrackingAnnotationList,
};

fn grey(width: usize, height: usize) -> Image {
    Image::from_rgb8(vec![90; width * height * 3], width, height).unwrap()
}

fn pixel(image: &Image, x: usize, y: usize) -> Colour {
    let at = (y * image.width() + x) * 3;
    image.hwc_u8(PixelFormat::Rgb)[at..at + 3].try_into().unwrap()
}

#[test]
fn box_has_its_class_colour_on_the_edge_and_no_fill() {
    let mut image = grey(100, 100);
    let boxes = BoundingBoxList::from(vec![BoundingBox::new(2, 20.0, 30.0, 40.0, 50.0, 0.9)]);
    draw(&mut image, &boxes, &Style { labels: false, ..Style::default() });
    let inside = pixel(&image, 40, 50);
    let edges = [(20, 50), (60, 50), (40, 30), (40, 80)];
    assert!(edges.iter().all(|&(x, y)| pixel(&image, x, y) == colour_of_index(2)));
    assert_eq!((inside, pixel(&image, 5, 5)), ([90; 3], [90; 3]));
}

#[test]
fn label_is_above_the_box_or_where_space_is_free() {
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

#[test]
fn masks_of_both_kinds_cover_the_same_pixels() {
    // A triangle with corners on pixel corners, once as outline and once as runs of its pixels.
    let inside = |x: usize, y: usize| x + y < 29;
    let mask: Vec<bool> = (0..40 * 40).map(|at| inside(at % 40, at / 40)).collect();
    let runs = Segmentation::Rle(Rle::from_mask(&mask, 40, 40).unwrap());
    let outline = Segmentation::Polygons(vec![vec![0.0, 0.0, 30.0, 0.0, 0.0, 30.0]]);
    let style = Style { opacity: 1.0, ..Style::default() };
    for mask in [&runs, &outline] {
        let mut image = grey(40, 40);
        draw_mask(&mut image, mask, [255, 0, 0], &style);
        let wrong = (0..40 * 40_usize).filter(|at| {
            let (x, y) = (at % 40, at / 40);
            // The polygon's border is one pixel wide.
            x.abs_diff(29usize.saturating_sub(y)) > 2 && (pixel(&image, x, y) == [255, 0, 0]) != inside(x, y)
        });
        assert_eq!(wrong.count(), 0, "{mask:?}");
    }
}

#[test]
fn hostile_masks_are_cut() {
    let wild = [f32::NAN, f32::INFINITY, -1e30, 1e30, 0.0, 5.5];
    let polygons =
        wild.iter().flat_map(|a| wild.iter().map(|b| vec![*a, *b, 3.0, *b, *b, *a, 1.0])).collect();
    let many = Segmentation::Polygons(polygons);
    let tall = Segmentation::Rle(Rle::new(u32::MAX, 1, vec![1, u32::MAX - 1]).unwrap());
    let wide = Segmentation::Rle(Rle::new(1, u32::MAX, vec![0, u32::MAX]).unwrap());
    let none = Segmentation::Rle(Rle::new(0, 9, vec![]).unwrap());
    for mask in [many, tall, wide, none] {
        draw_mask(&mut grey(20, 10), &mask, [1, 2, 3], &Style::default());
    }
}

#[test]
fn labels_are_coloured_and_background_is_clear() {
    let style = Style { opacity: 1.0, labels: false, ..Style::default() };
    let map = Heatmap::from_labels(vec![0, 3, 5, u32::MAX], &[2, 2]).unwrap();
    let mut image = grey(20, 10);
    draw(&mut image, &map, &style);
    assert_eq!(pixel(&image, 0, 0), [90; 3]);
    assert_eq!((pixel(&image, 19, 0), pixel(&image, 0, 9)), (colour_of_index(3), colour_of_index(5)));
    let mut named = map.clone();
    named.classes = ["sky", "", "", "car", "", "tree"].into_iter().collect();
    draw(&mut image, &named, &style);
    assert_eq!(pixel(&image, 0, 0), colour_of_index(0));
}

#[test]
fn high_scores_are_bright_and_low_ones_clear() {
    let map = Heatmap::from_scores(vec![0.0, 0.0, 0.0, 1.0], &[2, 2]).unwrap();
    let mut image = grey(40, 40);
    draw(&mut image, &map, &Style { opacity: 1.0, ..Style::default() });
    assert_eq!(pixel(&image, 0, 0), [90; 3]);
    let [red, green, blue] = pixel(&image, 39, 39);
    assert!(red > 200 && green > 200 && blue < 200);
    let wild = vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 7.0];
    for shape in [&[2, 3][..], &[1, 2, 3], &[3, 1, 2], &[6], &[1, 1, 2, 3]] {
        draw(&mut image, &Heatmap::from_scores(wild.clone(), shape).unwrap(), &Style::default());
    }
    draw(&mut image, &Heatmap::default(), &Style::default());
}

#[test]
fn best_class_of_each_place_shows() {
    let map = Heatmap::from_scores(vec![0.9, 0.0, 0.1, 1.0], &[2, 1, 2]).unwrap();
    let mut image = grey(20, 10);
    draw(&mut image, &map, &Style { opacity: 1.0, ..Style::default() });
    assert_eq!(pixel(&image, 19, 5), colour_of_index(1));
    assert_ne!(pixel(&image, 0, 5), pixel(&image, 19, 5));
}

#[test]
fn tracks_have_a_colour_and_a_tail() {
    let at = |left: f32| -> TrackingAnnotationList {
        let bounding_box = BoundingBox::new(0, left, 60.0, 20.0, 20.0, 1.0);
        vec![TrackingAnnotation { bounding_box, id: 4, frame: None }].into()
    };
    let mut trails = Trails::default();
    (0..30).for_each(|step| trails.update(&at(10.0 + 4.0 * step as f32)));
    let (mut image, style) = (grey(200, 100), Style { labels: false, ..Style::default() });
    draw(&mut image, &at(126.0), &style);
    assert_eq!((pixel(&image, 126, 70), pixel(&image, 100, 70)), (colour_of_index(4), [90; 3]));
    draw_tracks(&mut image, &at(126.0), &trails, &style);
    assert_ne!(pixel(&image, 100, 70), [90; 3]);
}

#[test]
fn a_category_is_written_into_the_corner() {
    let mut image = grey(200, 100);
    draw(&mut image, &Category::new(3, Some(0.5)), &Style::default());
    assert_ne!(pixel(&image, 4, 6), [90; 3]);
    assert_eq!(pixel(&image, 150, 80), [90; 3]);
}

#[test]
fn masks_by_runs_have_the_border_of_outlines() {
    let inside = |at: usize| (5..30).contains(&(at % 40)) && (8..20).contains(&(at / 40));
    let mask: Vec<bool> = (0..40 * 30).map(inside).collect();
    let runs = Segmentation::Rle(Rle::from_mask(&mask, 30, 40).unwrap());
    let outline = Segmentation::Polygons(vec![vec![5.0, 8.0, 30.0, 8.0, 30.0, 20.0, 5.0, 20.0]]);
    let [by_runs, by_outline] = [runs, outline].map(|mask| {
        let mut image = grey(40, 30);
        draw_mask(&mut image, &mask, [250, 0, 0], &Style::default());
        image
    });
    assert_eq!(by_runs, by_outline);
    let [edge, middle] = [pixel(&by_runs, 5, 12), pixel(&by_runs, 15, 12)];
    assert_eq!((edge, middle), ([250, 0, 0], [170, 45, 45]));
}

#[test]
fn edges_of_coarse_label_maps_are_smooth() {
    let map = Heatmap::from_labels(vec![1, 1, 1, 2], &[2, 2]).unwrap();
    let mut image = grey(80, 80);
    draw(&mut image, &map, &Style { opacity: 1.0, labels: false, ..Style::default() });
    // The inner corner of the square of class 2 is cut.
    let at = |x, y| pixel(&image, x, y);
    assert_eq!((at(41, 41), at(47, 47)), (colour_of_index(1), colour_of_index(1)));
    assert_eq!((at(60, 60), at(79, 79)), (colour_of_index(2), colour_of_index(2)));
}

#[test]
fn trails_have_a_single_colour() {
    let at = |left: f32| -> TrackingAnnotationList {
        let bounding_box = BoundingBox::new(0, left, 50.5, 40.0, 40.0, 1.0);
        vec![TrackingAnnotation { bounding_box, id: 4, frame: None }].into()
    };
    let mut trails = Trails::default();
    (0..12).for_each(|step| trails.update(&at(10.0 * step as f32)));
    let mut image = grey(400, 400);
    draw_tracks(&mut image, &at(300.0), &trails, &Style { labels: false, scale: 4.0, ..Style::default() });
    assert!((30..120).all(|x| pixel(&image, x, 70) == colour_of_index(4)));
}

#[test]
fn text_regions_are_outlined_and_labelled() {
    let region = |corners| TextRegion::new("EXIT", corners, 0.5);
    let regions = TextRegionList::from(vec![
        region([[20.0, 40.0], [60.0, 44.0], [58.0, 60.0], [18.0, 56.0]]),
        region([[f32::NAN, 0.0]; 4]),
    ]);
    let bare = Style { labels: false, ..Style::default() };
    let (mut outlined, mut labelled) = (grey(100, 100), grey(100, 100));
    draw_text_regions(&mut outlined, &regions, &bare);
    draw_text_regions(&mut labelled, &regions, &Style::default());
    let is_lit = |image: &Image, x: usize, y: usize| pixel(image, x, y) != pixel(&grey(100, 100), 0, 0);
    let lit = |image: &Image| (0..10_000).filter(|at| is_lit(image, at % 100, at / 100)).count();
    assert!(lit(&outlined) > 100 && lit(&labelled) > lit(&outlined));
    assert!(is_lit(&outlined, 40, 42) && !is_lit(&outlined, 39, 50));
}

#[test]
fn odometry_is_written_into_the_corner() {
    let draw_one = |odometry: Odometry| {
        let mut image = grey(200, 100);
        draw(&mut image, &odometry, &Style::default());
        image
    };
    let [known, unknown] = [Odometry::new(RigidPose::default(), 90), Odometry::default()].map(draw_one);
    assert_ne!(known, unknown);
    for image in [known, unknown] {
        assert_ne!(pixel(&image, 4, 6), [90; 3]);
        assert_eq!(pixel(&image, 150, 80), [90; 3]);
    }
}
