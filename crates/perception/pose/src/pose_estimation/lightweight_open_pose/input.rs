//! Size of the network's input.

/// Pixels per cell.
pub(super) const STRIDE: usize = 8;

/// Input sizes of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum InputSize {
    /// Dynamic: any whole number of cells.
    Free,
    /// Fixed width and height, in pixels.
    Fixed([usize; 2]),
}

/// Maximum aspect ratio of the input, which limits the memory for extreme images.
const MOST_HEIGHTS: usize = 4;

impl InputSize {
    /// Returns the input size of a network with an input `[1, 3, height, width]`.
    pub(super) fn of_network(dims: &[Option<usize>]) -> Self {
        match dims {
            [_, _, Some(height), Some(width)] if *height > 0 && *width > 0 => Self::Fixed([*width, *height]),
            _ => Self::Free,
        }
    }

    /// Returns width and height of the input for an image of `[width, height]` pixels.
    pub(super) fn of_picture(self, [width, height]: [usize; 2], base_height: usize) -> [usize; 2] {
        match self {
            Self::Fixed(size) => size,
            Self::Free => {
                let rows = base_height.div_ceil(STRIDE).max(1);
                let columns = (rows * width).div_ceil(height.max(1)).clamp(1, MOST_HEIGHTS * rows);
                [columns * STRIDE, rows * STRIDE]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_whole_cells() {
        let free = InputSize::of_network(&[Some(1), Some(3), None, None]);
        assert_eq!(free.of_picture([1920, 1080], 256), [456, 256]);
        assert_eq!(free.of_picture([480, 640], 256), [192, 256]);
        assert_eq!(free.of_picture([100_000, 1], 250), [1024, 256]);
        assert_eq!(free.of_picture([1, 100_000], 64), [8, 64]);
        let fixed = InputSize::of_network(&[Some(1), Some(3), Some(64), Some(96)]);
        assert_eq!(fixed.of_picture([1920, 1080], 256), [96, 64]);
    }
}
