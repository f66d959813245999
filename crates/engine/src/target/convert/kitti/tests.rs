use super::*;

/// What OpenDR 3.0.0 prints of the boxes below, with NumPy 2.2 and 2.4.
const PRINTED: &str = include_str!("printed.txt");

fn printed(case: &str) -> &'static str {
    let (_, rest) = PRINTED.split_once(&format!("=== {case}\n")).unwrap();
    rest.split_once("\n===").map_or(rest, |(text, _)| text).trim_end()
}

fn box_3d(number: u8, name: impl Into<Name>) -> BoundingBox3D {
    let at = f32::from(number);
    BoundingBox3D {
        name: name.into(),
        truncated: 0.25 * at,
        occluded: i32::from(number % 3),
        alpha: -1.5 + at,
        bbox2d: [at, 2.5, 3.0, 4.0 + at],
        dimensions: [3.5, 1.5, 1.6],
        location: [-16.0, 2.38, (58.49 + f64::from(number)) as f32],
        rotation_y: -1.57,
        confidence: 0.5,
    }
}

fn track(number: u8) -> TrackingAnnotation3D {
    let name = if number % 2 == 1 { "Car" } else { "Pedestrian" };
    let (id, frame) = (i64::from(number) + 7, Some(i64::from(number)));
    TrackingAnnotation3D { bounding_box_3d: box_3d(number, name), id, frame }
}

#[test]
fn printed_as_opendr_prints() {
    assert_eq!(box_3d(0, "Car").to_string(), printed("one"));
    let two = BoundingBox3DList::from(vec![box_3d(0, "Car"), box_3d(1, "DontCare")]);
    assert_eq!(two.to_string(), printed("two"));
    let names = ["Car", "Pedestrian", "Person's"];
    let forty: Vec<_> = (0..40).map(|number| box_3d(number, names[usize::from(number % 3)])).collect();
    assert_eq!(BoundingBox3DList::from(forty).to_string(), printed("forty"));
    let classes = BoundingBox3DList::from(vec![box_3d(0, 0), box_3d(1, 1)]);
    assert_eq!(classes.to_string(), printed("classes"));
    assert_eq!(track(2).to_string(), printed("track"));
    let tracks: Vec<_> = (0..40).map(track).collect();
    assert_eq!(TrackingAnnotation3DList::from(tracks).to_string(), printed("tracks"));
}

#[test]
fn columns_both_ways() {
    for count in [0, 1, 3] {
        let tracks = TrackingAnnotation3DList::from((0..count).map(track).collect::<Vec<_>>());
        let columns = tracks.kitti(true);
        assert_eq!(TrackingAnnotation3DList::from_kitti(&columns).unwrap(), tracks);
        assert!(TrackingAnnotation3DList::from_kitti(&tracks.kitti(false)).is_err());
        let boxes = tracks.bounding_box_3d_list();
        assert_eq!(BoundingBox3DList::from_kitti(&columns).unwrap(), boxes);
        assert_eq!(boxes.kitti().group_ids, Some((0..i32::from(count)).collect()));
    }
    let ignored = box_3d(0, "DontCare").kitti();
    assert_eq!(ignored.index, Some(vec![-1]));
    let mut short = ignored;
    short.bbox.clear();
    assert!(BoundingBox3DList::from_kitti(&short).is_err());
}

#[test]
fn nothing_is_printed_as_empty_arrays() {
    let text = BoundingBox3DList::default().to_string();
    assert!(
        text.starts_with("{'name': array([], dtype=float64), 'truncated': array([], dtype=float64)"),
        "{text}"
    );
    assert!(
        text.ends_with("'index': array([], dtype=int32), 'group_ids': array([], dtype=int32)}"),
        "{text}"
    );
}
