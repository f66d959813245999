//! Where to look closer: from a coarse look at a large picture to the few parts of it that are worth a second one.
//!
//! A first pass marks cells of a [`CellGrid`]; cells that touch become a [`Region`]; regions are grown by a margin,
//! joined where they overlap, and cut into tiles where they are larger than a second pass can magnify. What a
//! [`CoarsePicture`] shows of brightness tells where there is detail, and where something moved.

mod cell_grid;
mod coarse_picture;

pub use cell_grid::CellGrid;
pub use coarse_picture::CoarsePicture;

/// A part of a picture, in whole pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Region {
    /// Left edge.
    pub x: usize,
    /// Upper edge.
    pub y: usize,
    /// Width.
    pub width: usize,
    /// Height.
    pub height: usize,
}

impl Region {
    /// The pixels between `[left, top, right, bottom]`, as far as they lie in a picture of `size` and are finite.
    pub fn from_corners([left, top, right, bottom]: [f32; 4], [width, height]: [usize; 2]) -> Self {
        // Casting cuts: NaN becomes 0.
        let cut = |edge: f32, end: usize| (edge.max(0.0) as usize).min(end);
        let (x, y) = (cut(left.floor(), width), cut(top.floor(), height));
        let (right, bottom) = (cut(right.ceil(), width), cut(bottom.ceil(), height));
        Self { x, y, width: right.saturating_sub(x), height: bottom.saturating_sub(y) }
    }

    /// `[left, top, right, bottom]`.
    pub fn corners(&self) -> [f32; 4] {
        [self.x, self.y, self.x + self.width, self.y + self.height].map(|edge| edge as f32)
    }

    /// Whether it has no pixel.
    pub fn is_empty(&self) -> bool {
        self.width == 0 || self.height == 0
    }

    /// Larger on each side by `share` of its longer side, within a picture of `size`.
    #[must_use]
    pub fn grown(&self, share: f32, size: [usize; 2]) -> Self {
        let by = share * self.width.max(self.height) as f32;
        let [left, top, right, bottom] = self.corners();
        Self::from_corners([left - by, top - by, right + by, bottom + by], size)
    }

    /// The smallest region with both.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let (x, y) = (self.x.min(other.x), self.y.min(other.y));
        let right = (self.x + self.width).max(other.x + other.width);
        let bottom = (self.y + self.height).max(other.y + other.height);
        Self { x, y, width: right - x, height: bottom - y }
    }

    /// Whether a place lies in it.
    pub fn holds(&self, [x, y]: [f32; 2]) -> bool {
        let [left, top, right, bottom] = self.corners();
        (left..right).contains(&x) && (top..bottom).contains(&y)
    }

    /// Whether both share a pixel.
    pub fn overlaps(&self, other: &Self) -> bool {
        let meet = |a: usize, a_long: usize, b: usize, b_long: usize| a < b + b_long && b < a + a_long;
        meet(self.x, self.width, other.x, other.width) && meet(self.y, self.height, other.y, other.height)
    }

    /// The region in tiles with sides of at most `side` pixels, as equal as can be, that overlap by `overlap` where it
    /// takes several; row by row.
    pub fn tiles(self, side: usize, overlap: usize) -> impl Iterator<Item = Self> {
        let overlap = overlap.min(side / 2);
        let cut = move |length: usize| -> (usize, usize) {
            let step = side.saturating_sub(overlap).max(1);
            let count = if length <= side { 1 } else { (length - overlap).div_ceil(step) };
            (count, length.min(side))
        };
        let ((columns, width), (rows, height)) = (cut(self.width), cut(self.height));
        let place = |index: usize, count: usize, room: usize| {
            if count > 1 { index * room / (count - 1) } else { 0 }
        };
        (0..rows * columns).map(move |index| Self {
            x: self.x + place(index % columns, columns, self.width - width),
            y: self.y + place(index / columns, rows, self.height - height),
            width,
            height,
        })
    }
}

/// Joins regions that overlap until none do. Their order is kept as far as it can be.
pub fn join_overlapping(regions: &mut Vec<Region>) {
    let mut at = 0;
    while at < regions.len() {
        let later = (at + 1..regions.len()).find(|other| regions[at].overlaps(&regions[*other]));
        match later {
            // What grew may now overlap an earlier one.
            Some(other) => {
                let joined = regions[at].joined(&regions[other]);
                regions.remove(other);
                regions[at] = joined;
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

    #[test]
    fn strange_corners_are_cut() {
        let size = [100, 50];
        let region = |corners| Region::from_corners(corners, size);
        assert_eq!(region([-5.0, 2.5, 300.0, 9.0]), Region { x: 0, y: 2, width: 100, height: 7 });
        assert!(region([f32::NAN; 4]).is_empty());
        assert!(region([50.0, 50.0, 20.0, 20.0]).is_empty());
        assert!(region([400.0, 400.0, f32::INFINITY, f32::INFINITY]).is_empty());
        let grown = Region { x: 10, y: 10, width: 20, height: 10 }.grown(0.5, size);
        assert_eq!(grown, Region { x: 0, y: 0, width: 40, height: 30 });
    }

    proptest! {
        #[test]
        fn tiles_cover_their_region(
            width in 1usize..900, height in 1usize..700, side in 1usize..400, overlap in 0usize..200,
        ) {
            let region = Region { x: 7, y: 9, width, height };
            let tiles: Vec<_> = region.tiles(side, overlap).collect();
            prop_assert!(tiles.iter().all(|tile| tile.width <= side && tile.height <= side && !tile.is_empty()));
            prop_assert!(tiles.iter().all(|tile| region.joined(tile) == region));
            for x in (0..width).step_by(13) {
                for y in (0..height).step_by(11) {
                    let pixel = Region { x: 7 + x, y: 9 + y, width: 1, height: 1 };
                    prop_assert!(tiles.iter().any(|tile| tile.overlaps(&pixel)), "{:?}", pixel);
                }
            }
        }

        #[test]
        fn joined_regions_do_not_overlap(
            boxes in prop::collection::vec((0usize..90, 0usize..90, 1usize..20, 1usize..20), 0..20),
        ) {
            let all: Vec<_> =
                boxes.into_iter().map(|(x, y, width, height)| Region { x, y, width, height }).collect();
            let mut joined = all.clone();
            join_overlapping(&mut joined);
            for (at, region) in joined.iter().enumerate() {
                prop_assert!(joined[at + 1..].iter().all(|other| !region.overlaps(other)));
            }
            for region in &all {
                prop_assert!(joined.iter().any(|whole| whole.joined(region) == *whole));
            }
        }
    }
}
