use opendr_engine::target::BoundingBox;
use opendr_perception_common::regions::Region;
use opendr_perception_common::suppression::iou;

/// Sides of a box at which its tile's border cuts it: left, top, right, bottom.
pub type Cut = [bool; 4];

/// A box that was detected in a tile, in pixels of the whole image.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The box.
    pub bounding_box: BoundingBox,
    /// Sides at which its tile cuts it.
    pub cut: Cut,
}

/// Distance to the border of a tile, as a share of its side, within which a box counts as cut.
const NEAR: f32 = 0.015;
/// Minimum IoU along the border of two cut boxes of one object.
const ALONG: f32 = 0.5;
/// Maximum distance between them, in pixels.
const APART: f32 = 4.0;
/// Share of a cut box inside another box above which it is part of that object.
const COVERED: f32 = 0.7;
/// Maximum number of pieces; more are noise, and time grows with the square.
const MOST: usize = 2000;

impl Piece {
    /// Converts a box in pixels of a tile to a piece of an image of `size`.
    pub fn new(mut bounding_box: BoundingBox, tile: &Region, [width, height]: [usize; 2]) -> Self {
        let near = 1.0 + NEAR * tile.width.max(tile.height) as f32;
        let [left, top, right, bottom] = bounding_box.corners();
        let cut = [
            tile.x > 0 && left < near,
            tile.y > 0 && top < near,
            tile.x + tile.width < width && right > tile.width as f32 - near,
            tile.y + tile.height < height && bottom > tile.height as f32 - near,
        ];
        let (x, y) = (tile.x as f32, tile.y as f32);
        (bounding_box.left, bounding_box.top) = (bounding_box.left + x, bounding_box.top + y);
        for point in &mut bounding_box.landmarks {
            *point = [point[0] + x, point[1] + y];
        }
        // Masks are in pixels of the tile and are dropped.
        bounding_box.segment = None;
        Self { bounding_box, cut }
    }

    fn is_cut(&self) -> bool {
        self.cut.contains(&true)
    }

    /// Merges two parts of one object at the border of two tiles; `None` when they are not.
    fn joined(&self, other: &Self) -> Option<Self> {
        if self.bounding_box.name != other.bounding_box.name {
            return None;
        }
        let (a, b) = (self.bounding_box.corners(), other.bounding_box.corners());
        let meet = (0..2).find(|axis| {
            let (first, second, a, b) =
                if a[*axis] <= b[*axis] { (self, other, a, b) } else { (other, self, b, a) };
            let facing = first.cut[axis + 2] && second.cut[*axis];
            // The first begins and ends first, and they touch.
            let in_a_row = b[*axis] <= a[axis + 2] + APART && a[axis + 2] <= b[axis + 2];
            facing && in_a_row && shared_along(1 - axis, &a, &b) >= ALONG
        });
        meet?;
        let corners = [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])];
        // The result is cut where the box that reaches further is.
        let cut = std::array::from_fn(|side| {
            let own = (a[side] - corners[side]).abs() <= APART && self.cut[side];
            own || ((b[side] - corners[side]).abs() <= APART && other.cut[side])
        });
        let best = if self.bounding_box.confidence >= other.bounding_box.confidence { self } else { other };
        let mut found = best.bounding_box.clone();
        [found.left, found.top] = [corners[0], corners[1]];
        [found.width, found.height] = [corners[2] - corners[0], corners[3] - corners[1]];
        Some(Self { bounding_box: found, cut })
    }
}

/// Returns the intersection over union of two boxes along one axis.
fn shared_along(axis: usize, a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let shared = a[axis + 2].min(b[axis + 2]) - a[axis].max(b[axis]);
    let all = a[axis + 2].max(b[axis + 2]) - a[axis].min(b[axis]);
    if all > 0.0 { shared / all } else { 0.0 }
}

/// Returns the share of `a` inside `b`.
fn cover(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let side = |axis: usize| (a[axis + 2].min(b[axis + 2]) - a[axis].max(b[axis])).max(0.0);
    let area = (a[2] - a[0]) * (a[3] - a[1]);
    if area > 0.0 { side(0) * side(1) / area } else { 0.0 }
}

/// Merges the pieces of overlapping tiles to one box per object: both parts of an object at a border are joined, cut boxes
/// are dropped for whole ones, and of boxes of a class that overlap by more than `overlap` (IoU) the one with the highest
/// score is kept. The result is sorted by descending confidence.
pub fn merge_pieces(pieces: &mut Vec<Piece>, overlap: f32) {
    pieces.retain(|piece| {
        piece.bounding_box.corners().iter().all(|edge| edge.is_finite()) && piece.bounding_box.area() > 0.0
    });
    best_first(pieces);
    pieces.truncate(MOST);
    join(pieces);
    // Whole boxes first, then those with more of their object.
    pieces.sort_by(|a, b| {
        let rank = |piece: &Piece| {
            if piece.is_cut() { piece.bounding_box.area() } else { piece.bounding_box.confidence }
        };
        a.is_cut().cmp(&b.is_cut()).then(rank(b).total_cmp(&rank(a)))
    });
    let mut kept = 0;
    for at in 0..pieces.len() {
        let (before, rest) = pieces.split_at_mut(at);
        let Some(piece) = rest.first_mut() else { break };
        let corners = piece.bounding_box.corners();
        let same = before[..kept].iter_mut().find(|other| {
            let whole = other.bounding_box.corners();
            other.bounding_box.name == piece.bounding_box.name
                && (iou(&whole, &corners) > overlap || (piece.is_cut() && cover(&corners, &whole) > COVERED))
        });
        match same {
            Some(other) => {
                other.bounding_box.confidence =
                    other.bounding_box.confidence.max(piece.bounding_box.confidence)
            }
            None => {
                pieces.swap(kept, at);
                kept += 1;
            }
        }
    }
    pieces.truncate(kept);
    best_first(pieces);
}

fn best_first(pieces: &mut [Piece]) {
    pieces.sort_by(|a, b| {
        let place = |piece: &Piece| [piece.bounding_box.top, piece.bounding_box.left];
        let (one, other) = (place(a), place(b));
        let by_place = one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1]));
        b.bounding_box.confidence.total_cmp(&a.bounding_box.confidence).then(by_place)
    });
}

/// Joins cut boxes until no more can be joined.
fn join(pieces: &mut Vec<Piece>) {
    let mut at = 0;
    while at < pieces.len() {
        let this = &pieces[at];
        let other = match this.is_cut() {
            true => pieces
                .iter()
                .enumerate()
                .skip(at + 1)
                .find_map(|(index, other)| Some((index, other.is_cut().then(|| this.joined(other))??))),
            false => None,
        };
        match other {
            // A joined box may reach an earlier one.
            Some((index, joined)) => {
                pieces.swap_remove(index);
                pieces[at] = joined;
                at = 0;
            }
            None => at += 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SIZE: [usize; 2] = [1000, 800];

    /// Returns the boxes of a perfect detector for `objects` in each tile.
    fn pieces(objects: &[[f32; 4]], side: usize, overlap: usize) -> Vec<Piece> {
        let picture = Region { x: 0, y: 0, width: SIZE[0], height: SIZE[1] };
        let mut pieces = Vec::new();
        for tile in picture.tiles(side, overlap) {
            let [left, top, right, bottom] = tile.corners();
            for (index, [x0, y0, x1, y1]) in objects.iter().enumerate() {
                let corners = [x0.max(left), y0.max(top), x1.min(right), y1.min(bottom)];
                if corners[2] - corners[0] < 2.0 || corners[3] - corners[1] < 2.0 {
                    continue;
                }
                let local = [corners[0] - left, corners[1] - top, corners[2] - left, corners[3] - top];
                let found = BoundingBox::from_corners(1, local, 0.5 + 0.01 * index as f32);
                pieces.push(Piece::new(found, &tile, SIZE));
            }
        }
        pieces
    }

    fn boxes(pieces: &[Piece]) -> Vec<[f32; 4]> {
        let mut boxes: Vec<_> = pieces.iter().map(|piece| piece.bounding_box.corners()).collect();
        boxes.sort_by(|a, b| a[0].total_cmp(&b[0]));
        boxes
    }

    #[test]
    fn small_and_large_objects_have_one_box() {
        let objects =
            [[150.0, 90.0, 190.0, 130.0], [300.0, 300.0, 620.0, 420.0], [700.0, 60.0, 760.0, 700.0]];
        let mut found = pieces(&objects, 200, 50);
        assert!(found.len() > 8);
        merge_pieces(&mut found, 0.5);
        let found = boxes(&found);
        assert_eq!(found.len(), 3, "{found:?}");
        for (found, expected) in found.iter().zip(objects) {
            assert!(iou(found, &expected) > 0.95, "{found:?} {expected:?}");
        }
    }

    #[test]
    fn classes_and_neighbours_are_not_joined() {
        let tile = |x| Region { x, y: 0, width: 200, height: 200 };
        let left = |name: i64, top: f32| {
            let found = BoundingBox::from_corners(name, [150.0, top, 200.0, top + 40.0], 0.8);
            Piece::new(found, &tile(0), SIZE)
        };
        let right = |name: i64, top: f32| {
            let found = BoundingBox::from_corners(name, [0.0, top, 60.0, top + 40.0], 0.7);
            Piece::new(found, &tile(170), SIZE)
        };
        let mut one = vec![left(1, 50.0), right(1, 50.0)];
        merge_pieces(&mut one, 0.5);
        assert_eq!(boxes(&one), [[150.0, 50.0, 230.0, 90.0]]);
        assert_eq!(one[0].bounding_box.confidence, 0.8);
        let mut classes = vec![left(1, 50.0), right(2, 50.0)];
        merge_pieces(&mut classes, 0.5);
        assert_eq!(classes.len(), 2);
        let mut apart = vec![left(1, 50.0), right(1, 85.0)];
        merge_pieces(&mut apart, 0.5);
        assert_eq!(apart.len(), 2);
    }

    #[test]
    fn whole_boxes_replace_cut_ones() {
        let whole = Piece {
            bounding_box: BoundingBox::from_corners(1, [180.0, 50.0, 260.0, 130.0], 0.4),
            cut: [false; 4],
        };
        let cut = BoundingBox::from_corners(1, [180.0, 50.0, 200.0, 130.0], 0.9);
        let cut = Piece::new(cut, &Region { x: 0, y: 0, width: 200, height: 200 }, SIZE);
        assert_eq!(cut.cut, [false, false, true, false]);
        let mut found = vec![cut, whole.clone()];
        merge_pieces(&mut found, 0.5);
        assert_eq!(boxes(&found), [whole.bounding_box.corners()]);
        assert_eq!(found[0].bounding_box.confidence, 0.9);
    }

    #[test]
    fn invalid_boxes_are_dropped() {
        let odd = |left: f32, width: f32| Piece {
            bounding_box: BoundingBox::new(0, left, 0.0, width, 5.0, 0.5),
            cut: [true; 4],
        };
        let mut found = vec![odd(f32::NAN, 5.0), odd(0.0, f32::INFINITY), odd(0.0, -3.0), odd(0.0, 5.0)];
        merge_pieces(&mut found, 0.5);
        assert_eq!(found.len(), 1);
    }

    proptest! {
        #[test]
        fn every_object_has_one_box(
            places in prop::collection::vec((0usize..8, 0usize..6, 12.0f32..100.0, 12.0f32..100.0), 1..12),
            side in 150usize..400, overlap in 40usize..70,
        ) {
            // At most one object per cell of 120 pixels, so that none overlap.
            let mut cells: Vec<_> = places;
            cells.sort_by_key(|place| (place.0, place.1));
            cells.dedup_by_key(|place| (place.0, place.1));
            let objects: Vec<_> = cells
                .iter()
                .map(|(x, y, width, height)| {
                    let (x, y) = (*x as f32 * 120.0 + 5.0, *y as f32 * 120.0 + 5.0);
                    [x, y, x + width, y + height]
                })
                .collect();
            let mut found = pieces(&objects, side, overlap);
            merge_pieces(&mut found, 0.5);
            prop_assert_eq!(found.len(), objects.len());
            for object in &objects {
                prop_assert!(found.iter().any(|piece| iou(&piece.bounding_box.corners(), object) > 0.85));
            }
        }

        #[test]
        fn merging_ends_for_any_pieces(
            boxes in prop::collection::vec((0.0f32..900.0, 0.0f32..700.0, 0.0f32..300.0, 0.0f32..300.0, 0u8..16), 0..80),
        ) {
            let mut found: Vec<_> = boxes
                .into_iter()
                .map(|(x, y, width, height, cut)| Piece {
                    bounding_box: BoundingBox::new(0, x, y, width, height, 0.5),
                    cut: std::array::from_fn(|side| cut >> side & 1 == 1),
                })
                .collect();
            let before = found.len();
            merge_pieces(&mut found, 0.5);
            prop_assert!(found.len() <= before);
        }
    }
}
