//! Maps of classes at another size.

/// Which of `there` pixels has the middle of pixel `at` of `here`.
pub(crate) fn nearest(at: usize, here: usize, there: usize) -> usize {
    (2 * at + 1) * there / (2 * here)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_pixels_are_those_of_the_middles() {
        assert_eq!((0..4).map(|at| nearest(at, 4, 2)).collect::<Vec<_>>(), [0, 0, 1, 1]);
        assert_eq!((0..2).map(|at| nearest(at, 2, 6)).collect::<Vec<_>>(), [1, 4]);
        for (here, there) in [(1, 513), (513, 1), (1920, 513), (7, 7)] {
            assert!((0..here).all(|at| nearest(at, here, there) < there));
            assert_eq!(nearest(0, here, here), 0);
        }
    }
}
