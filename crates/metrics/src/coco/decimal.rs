//! Recovery of decimal numbers of a file from `f32`.

/// Returns the decimal number in the file from the `f32` it was read to.
///
/// Annotations have few decimals, which the shortest text of the `f32` recovers: 12.7, as pycocotools reads it, and not
/// 12.699999809. The difference would change pixels of polygons at rounding limits.
pub(super) fn f64_from_f32(number: f32) -> f64 {
    if number.fract() == 0.0 {
        return f64::from(number);
    }
    number.to_string().parse().unwrap_or_else(|_| f64::from(number))
}

/// Like [`f64_from_f32`], for a box.
pub(super) fn f64_box(found: &opendr_engine::target::BoundingBox) -> [f64; 4] {
    [found.left, found.top, found.width, found.height].map(f64_from_f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_recovered() {
        assert_eq!([12.7f32, -0.1, 1e-7, 3.0, 123.45].map(f64_from_f32), [12.7, -0.1, 1e-7, 3.0, 123.45]);
        assert_eq!(f64_from_f32(f32::INFINITY), f64::INFINITY);
    }
}
