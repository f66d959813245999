//! Numbers as they stood in a file.

/// The number that was written, from the `f32` that it was read to.
///
/// Annotations have few decimals. Their shortest text gives them back, so that 12.7 is what pycocotools reads and not
/// 12.699999809: fives of its last place decide which pixel an outline takes.
pub(super) fn f64_from_f32(number: f32) -> f64 {
    if number.fract() == 0.0 {
        return f64::from(number);
    }
    number.to_string().parse().unwrap_or_else(|_| f64::from(number))
}

/// As [`f64_from_f32`], of a box.
pub(super) fn f64_box(found: &opendr_engine::target::BoundingBox) -> [f64; 4] {
    [found.left, found.top, found.width, found.height].map(f64_from_f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_come_back() {
        assert_eq!([12.7f32, -0.1, 1e-7, 3.0, 123.45].map(f64_from_f32), [12.7, -0.1, 1e-7, 3.0, 123.45]);
        assert_eq!(f64_from_f32(f32::INFINITY), f64::INFINITY);
    }
}
