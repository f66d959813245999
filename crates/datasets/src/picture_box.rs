//! Check of boxes against the borders of their image.

/// Returns whether less than half of a box (`[left, top, width, height]`, pixels) lies in an image of `[width,
/// height]`.
///
/// Annotated boxes may exceed the border a little, by rounding or for truncated objects. A box that is mostly
/// outside belongs to another image or has other units. Unknown sizes (0) and empty boxes at the border pass.
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
    fn boxes_may_exceed_the_border_but_not_lie_outside() {
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
