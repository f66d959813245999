use opendr_engine::ErrorKind;

use super::*;

#[test]
fn a_box_must_lie_in_the_image() {
    let image = Image::from_rgb8(vec![90; 60 * 40 * 3], 60, 40).unwrap();
    let of = |place: [f32; 4]| {
        let [left, top, width, height] = place;
        Object::of(&image, &vec![BoundingBox::new(3, left, top, width, height, 1.0)].into())
    };
    let object = of([10.0, 5.0, 20.0, 10.0]).unwrap();
    assert_eq!((object.middle, object.size, object.border_level), ([20.0, 10.0], [20.0, 10.0], 90.0));
    // (20 + 15) * (10 + 15), and its root.
    assert!((object.context_side() - 875.0_f32.sqrt()).abs() < 1e-3);
    let wrong = [
        [f32::NAN, 0.0, 5.0, 5.0],
        [0.0, 0.0, f32::INFINITY, 5.0],
        [0.0, 0.0, -5.0, 5.0],
        [0.0, 0.0, 5.0, 0.0],
        [60.0, 0.0, 5.0, 5.0],
        [-9.0, 0.0, 5.0, 5.0],
        [0.0, 0.0, 500.0, 5.0],
    ];
    for place in wrong {
        let error = of(place).err().map(|error| error.kind());
        assert_eq!(error, Some(ErrorKind::InvalidInput), "{place:?}");
    }
    assert!(Object::of(&image, &BoundingBoxList::default()).is_err());
}
