//! Boxes and the borders of their picture.

/// Whether less than half of a box (`[left, top, width, height]`, pixels) lies in a picture of `[width, height]`.
///
/// Annotators draw objects that the border cuts off beyond it, and round; a box that is mostly elsewhere belongs to
/// another picture, or is in other units. Unknown sizes (0) and empty boxes at the border pass.
pub(crate) fn leaves_picture([left, top, width, height]: [f32; 4], size: [u32; 2]) -> bool {
    if size.contains(&0) {
        return false;
    }
    let inside = |start: f32, length: f32, side: u32| {
        let (start, end, side) = (f64::from(start), f64::from(start) + f64::from(length), f64::from(side));
        if length > 0.0 {
            ((end.min(side) - start.max(0.0)) / f64::from(length)).max(0.0)
        } else {
            f64::from(u8::from((-1.0..=side + 1.0).contains(&start)))
        }
    };
    inside(left, width, size[0]) * inside(top, height, size[1]) < 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_may_stick_out_but_not_be_elsewhere() {
        let leaves = |bbox| leaves_picture(bbox, [640, 480]);
        assert!(!leaves([0.0, 0.0, 640.5, 480.5]));
        assert!(!leaves([-40.0, 10.0, 100.0, 100.0]));
        assert!(!leaves([640.0, 10.0, 0.0, 5.0]));
        assert!(leaves([-60.0, 10.0, 100.0, 100.0]));
        assert!(leaves([700.0, 10.0, 10.0, 10.0]));
        assert!(leaves([0.0, 0.0, 6400.0, 4800.0]));
        assert!(!leaves_picture([9.0, 9.0, 9.0, 9.0], [0, 0]));
    }
}
