//! Label files of unknown origin: nothing panics, and written files are read back unchanged.

use opendr_engine::data::Calibration;
use opendr_engine::target::*;
use proptest::collection::vec;
use proptest::prelude::*;

fn number() -> impl Strategy<Value = f32> {
    any::<f32>().prop_filter("finite", |number| number.is_finite())
}

fn track_3d() -> impl Strategy<Value = TrackingAnnotation3D> {
    let numbers = proptest::array::uniform14(number());
    ("[A-Za-z_]{1,12}", -1i32..=3, numbers, any::<i64>(), prop::option::of(0..=i64::MAX)).prop_map(
        |(name, occluded, numbers, id, frame)| {
            let [truncated, alpha, x0, y0, x1, y1, l, h, w, x, y, z, rotation_y, confidence] = numbers;
            let bounding_box_3d = BoundingBox3D {
                name: Name::from(name.as_str()),
                truncated,
                occluded,
                alpha,
                bbox2d: [x0, y0, x1, y1],
                dimensions: [l, h, w],
                location: [x, y, z],
                rotation_y,
                confidence,
            };
            TrackingAnnotation3D { bounding_box_3d, id, frame }
        },
    )
}

fn track() -> impl Strategy<Value = TrackingAnnotation> {
    let numbers = proptest::array::uniform5(number());
    (numbers, any::<i64>(), prop::option::of(0..=i64::MAX)).prop_map(|(numbers, id, frame)| {
        let [left, top, width, height, confidence] = numbers;
        let bounding_box = BoundingBox::new(0, left, top, width, height, confidence);
        TrackingAnnotation { bounding_box, id, frame }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn kitti_round_trip(tracks in vec(track_3d(), 0..5)) {
        let tracks = TrackingAnnotation3DList::from(tracks);
        prop_assert_eq!(&TrackingAnnotation3DList::from_kitti_text(&tracks.kitti_text()).unwrap(), &tracks);
        prop_assert_eq!(&TrackingAnnotation3DList::from_kitti(&tracks.kitti(true)).unwrap(), &tracks);
        let boxes = tracks.bounding_box_3d_list();
        prop_assert_eq!(&BoundingBox3DList::from_kitti_text(&boxes.kitti_text()).unwrap(), &boxes);
        prop_assert_eq!(&BoundingBox3DList::from_kitti(&boxes.kitti()).unwrap(), &boxes);
    }

    #[test]
    fn mot_round_trip(tracks in vec(track(), 0..5)) {
        let tracks = TrackingAnnotationList::from(tracks);
        prop_assert_eq!(TrackingAnnotationList::from_mot_text(&tracks.mot_text()).unwrap(), tracks);
    }

    #[test]
    fn no_text_panics(text in "([-+0-9.eExna, \n]|\\PC){0,200}") {
        TrackingAnnotationList::from_mot_text(&text).ok();
        BoundingBox3DList::from_kitti_text(&text).ok();
        TrackingAnnotation3DList::from_kitti_text(&text).ok();
        Calibration::from_kitti_text(&format!("P2: {text}")).ok();
        Rle::from_packed(7, 9, &text).ok();
    }
}
