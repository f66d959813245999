//! The reading order of text boxes.

use std::cmp::Ordering;

/// Boxes whose tops differ by less than this are on one line in PaddleOCR, in pixels of the image.
pub const SAME_LINE: f32 = 10.0;

/// Sorts boxes into lines from top to bottom, and each line from left to right. `top_left` gives the top left corner of a box. A line is
/// the highest box that is left and all whose corner is less than `same_line` below that of it. Boxes with equal corners keep their
/// order, and nothing is allocated. It is fast for boxes in about the order of their tops, as `Regions` finds them.
pub fn sort_reading_order<T>(boxes: &mut [T], same_line: f32, top_left: impl Fn(&T) -> [f32; 2]) {
    insertion_sort(boxes, |a, b| {
        let ([ax, ay], [bx, by]) = (top_left(a), top_left(b));
        ay.total_cmp(&by).then(ax.total_cmp(&bx))
    });
    let mut rest = boxes;
    while let Some(first) = rest.first() {
        let top = top_left(first)[1];
        let length = 1 + rest[1..].iter().take_while(|other| top_left(other)[1] - top < same_line).count();
        let (line, below) = rest.split_at_mut(length);
        insertion_sort(line, |a, b| top_left(a)[0].total_cmp(&top_left(b)[0]));
        rest = below;
    }
}

/// A stable sort without memory of its own.
fn insertion_sort<T>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    for end in 1..items.len() {
        let place = items[..end].partition_point(|item| compare(item, &items[end]) != Ordering::Greater);
        items[place..=end].rotate_right(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorted(corners: &[[f32; 2]]) -> Vec<usize> {
        let mut boxes: Vec<(usize, [f32; 2])> = corners.iter().copied().enumerate().collect();
        sort_reading_order(&mut boxes, SAME_LINE, |(_, corner)| *corner);
        boxes.into_iter().map(|(index, _)| index).collect()
    }

    #[test]
    fn lines_from_top_and_words_from_left() {
        assert_eq!(
            sorted(&[[100.0, 55.0], [5.0, 50.0], [60.0, 3.0], [5.0, 9.0], [90.0, 0.0]]),
            [3, 2, 4, 1, 0]
        );
    }

    #[test]
    fn tops_ten_pixels_apart_are_two_lines() {
        assert_eq!(sorted(&[[50.0, 0.0], [0.0, 10.0]]), [0, 1]);
        assert_eq!(sorted(&[[50.0, 0.0], [0.0, 9.9]]), [1, 0]);
        // As PaddleOCR: the third is on the line of neither.
        assert_eq!(sorted(&[[200.0, 0.0], [100.0, 6.0], [0.0, 12.0]]), [1, 0, 2]);
    }

    #[test]
    fn equal_corners_keep_their_order() {
        assert_eq!(sorted(&[[1.0, 1.0], [1.0, 1.0], [0.0, 1.0], [1.0, 1.0]]), [2, 0, 1, 3]);
    }

    #[test]
    fn not_a_number_and_nothing() {
        assert!(sorted(&[]).is_empty());
        let mut found = sorted(&[[f32::NAN, f32::NAN], [1.0, f32::INFINITY], [2.0, 0.0], [f32::NAN, 0.0]]);
        assert_eq!(found[..2], [2, 3]);
        found.sort_unstable();
        assert_eq!(found, [0, 1, 2, 3]);
    }
}
