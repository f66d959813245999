//! Size of an input of dynamic size.

/// The sizes that a network of dynamic size takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DynamicSize {
    /// Side of a square input.
    pub side: usize,
    /// Number of which sides are multiples.
    pub multiple: usize,
    /// Whether the input has the aspect ratio of the image.
    pub keep_aspect: bool,
}

impl DynamicSize {
    /// Returns width and height of the input for an image of `size` pixels: scaled as little as possible until one side is `side`, and
    /// rounded to multiples, as the image processors of `MiDaS`, Depth Anything and transformers do.
    pub fn of(&self, size: [usize; 2]) -> [usize; 2] {
        let square = self.side as f64;
        let [horizontal, vertical] = size.map(|side| square / side.max(1) as f64);
        let scales = match (self.keep_aspect, (1.0 - horizontal).abs() < (1.0 - vertical).abs()) {
            (false, _) => [horizontal, vertical],
            (true, true) => [horizontal; 2],
            (true, false) => [vertical; 2],
        };
        let multiple = self.multiple.max(1);
        let side = |axis: usize| {
            let side = size[axis] as f64 * scales[axis];
            // Python rounds halves to even numbers.
            ((side / multiple as f64).round_ties_even() as usize).max(1).saturating_mul(multiple)
        };
        [side(0), side(1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_those_of_transformers() {
        // transformers.models.dpt.image_processing_dpt.get_resize_output_image_size of transformers 5.24.0.
        let depth_anything = DynamicSize { side: 518, multiple: 14, keep_aspect: true };
        let cases = [
            ([640, 480], [686, 518]),
            ([1920, 1080], [924, 518]),
            ([480, 640], [518, 686]),
            ([300, 200], [518, 350]),
            ([400, 700], [294, 518]),
            ([1242, 375], [1722, 518]),
            ([518, 518], [518, 518]),
            ([651, 700], [518, 560]),
            ([100, 2000], [28, 518]),
        ];
        for (image, input) in cases {
            assert_eq!(depth_anything.of(image), input, "{image:?}");
        }
        let square = DynamicSize { side: 518, multiple: 32, keep_aspect: false };
        assert_eq!(square.of([640, 480]), [512, 512]);
    }

    #[test]
    fn slivers_keep_a_multiple() {
        let size = DynamicSize { side: 384, multiple: 32, keep_aspect: true };
        assert_eq!(size.of([1, 2000]), [32, 384]);
        assert_eq!(size.of([0, 0])[0] % 32, 0);
    }
}
