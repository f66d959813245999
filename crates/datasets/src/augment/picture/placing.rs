//! Maps without rotation, as pairs of a window of the input and a rectangle of the output.

use std::ops::Range;

use crate::augment::picture::map::AffineMap;

/// Largest distance from whole pixels that counts as rounding error.
const SLACK: f64 = 1e-6;

/// One axis: whole pixels `from` of the input are mapped to whole pixels `to` of the output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) from: Range<usize>,
    pub(super) to: Range<usize>,
    /// Whether the pixels are in reverse order.
    pub(super) mirrored: bool,
}

impl Span {
    /// Returns whether the size of pixels is unchanged.
    pub(super) fn keeps_size(&self) -> bool {
        self.from.len() == self.to.len()
    }

    /// Returns the span of an axis of the map; `None` if its edges are not on whole pixels.
    fn new([scale, shift]: [f64; 2], input: usize, output: usize) -> Option<Self> {
        let place = |at: f64| scale * at + shift;
        let (first, last) = (place(0.0), place(input as f64));
        let (start, end) = (first.min(last).max(0.0), first.max(last).min(output as f64));
        if start >= end {
            return Some(Self { from: 0..0, to: 0..0, mirrored: false });
        }
        let back = |at: f64| (at - shift) / scale;
        let (low, high) = (back(start).min(back(end)), back(start).max(back(end)));
        let [start, end, low, high] = [start, end, low, high].map(whole);
        let span = Self { from: low?..high?, to: start?..end?, mirrored: scale < 0.0 };
        (!span.from.is_empty() && span.from.end <= input && span.to.end <= output).then_some(span)
    }
}

fn whole(edge: f64) -> Option<usize> {
    let rounded = edge.round();
    ((edge - rounded).abs() <= SLACK * (1.0 + edge.abs()) && rounded >= 0.0).then_some(rounded as usize)
}

/// Returns the spans along x and y; `None` if the map rotates or its edges are not on whole pixels.
pub(super) fn spans(map: &AffineMap) -> Option<[Span; 2]> {
    let [x, y] = map.along_axes()?;
    let ([width, height], [columns, rows]) = (map.input_size(), map.output_size());
    Some([Span::new(x, width, columns)?, Span::new(y, height, rows)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_and_mirrors() {
        let map = AffineMap::crop([10, 8], [-2, 3], [6, 9]);
        let [x, y] = spans(&map).unwrap();
        assert_eq!((x.from, x.to), (0..4, 2..6));
        assert_eq!((y.from, y.to), (3..8, 0..5));
        let [x, y] = spans(&AffineMap::flip_horizontal([10, 8])).unwrap();
        assert!(x.mirrored && !y.mirrored && x.from == (0..10) && x.to == (0..10));
        let [x, y] = spans(&AffineMap::crop([10, 8], [20, 0], [5, 5])).unwrap();
        assert!(x.from.is_empty() && x.to.is_empty() && y.from == (0..5));
        for width in 1..300 {
            let map = AffineMap::window([641, 480], [13, 7, width, 100], [0, 0, 416, 416], [416, 416]);
            let [x, y] = spans(&map).unwrap();
            assert_eq!((x.from, x.to), (13..13 + width, 0..416));
            assert_eq!((y.from, y.to), (7..107, 0..416));
        }
    }

    #[test]
    fn edges_between_pixels_have_no_span() {
        let half = [[1.0, 0.0, 0.5], [0.0, 1.0, 0.0]];
        assert_eq!(spans(&AffineMap::new(half, [10, 8], [10, 8])), None);
        let turn = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
        assert_eq!(spans(&AffineMap::new(turn, [10, 8], [8, 10])), None);
    }
}
