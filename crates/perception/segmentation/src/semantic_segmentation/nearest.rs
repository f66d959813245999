//! Nearest-neighbour resizing of class maps.

/// Returns which of `there` pixels contains the centre of pixel `at` of `here` pixels.
pub(crate) fn nearest(at: usize, here: usize, there: usize) -> usize {
    (2 * at + 1) * there / (2 * here)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_pixels_contain_the_centres() {
        assert_eq!((0..4).map(|at| nearest(at, 4, 2)).collect::<Vec<_>>(), [0, 0, 1, 1]);
        assert_eq!((0..2).map(|at| nearest(at, 2, 6)).collect::<Vec<_>>(), [1, 4]);
        for (here, there) in [(1, 513), (513, 1), (1920, 513), (7, 7)] {
            assert!((0..here).all(|at| nearest(at, here, there) < there));
            assert_eq!(nearest(0, here, here), 0);
        }
    }
}
