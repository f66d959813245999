//! Regions of interest of a large image for a second pass.
//!
//! A first pass marks cells of a [`CellGrid`]; connected cells become a [`Region`]. Regions are grown by a margin, merged
//! where they overlap, and divided into tiles where they are larger than the second pass can magnify. A [`CellBrightness`]
//! has the brightness per cell, which shows detail and motion.

mod cell_grid;
mod coarse_picture;

pub use cell_grid::CellGrid;
pub use coarse_picture::CellBrightness;

/// A region of an image, in whole pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Region {
    /// Left edge in pixels.
    pub x: usize,
    /// Upper edge in pixels.
    pub y: usize,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
}

impl Region {
    /// Returns the pixels between `[left, top, right, bottom]`, clipped to an image of `size`; NaN counts as 0.
    pub fn from_corners([left, top, right, bottom]: [f32; 4], [width, height]: [usize; 2]) -> Self {
        // Casting saturates: NaN becomes 0.
        let cut = |edge: f32, end: usize| (edge.max(0.0) as usize).min(end);
        let (x, y) = (cut(left.floor(), width), cut(top.floor(), height));
        let (right, bottom) = (cut(right.ceil(), width), cut(bottom.ceil(), height));
        Self { x, y, width: right.saturating_sub(x), height: bottom.saturating_sub(y) }
    }

    /// Returns `[left, top, right, bottom]`.
    pub fn corners(&self) -> [f32; 4] {
        [self.x, self.y, self.x + self.width, self.y + self.height].map(|edge| edge as f32)
    }

    /// Returns whether the region has no pixel.
    pub fn is_empty(&self) -> bool {
        self.width == 0 || self.height == 0
    }

    /// Returns the region grown on each side by `share` of its longer side, clipped to an image of `size`.
    #[must_use]
    pub fn grown(&self, share: f32, size: [usize; 2]) -> Self {
        let by = share * self.width.max(self.height) as f32;
        let [left, top, right, bottom] = self.corners();
        Self::from_corners([left - by, top - by, right + by, bottom + by], size)
    }

    /// Returns the smallest region that contains both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let (x, y) = (self.x.min(other.x), self.y.min(other.y));
        let right = (self.x + self.width).max(other.x + other.width);
        let bottom = (self.y + self.height).max(other.y + other.height);
        Self { x, y, width: right - x, height: bottom - y }
    }

    /// Returns whether the region contains a point.
    pub fn contains(&self, [x, y]: [f32; 2]) -> bool {
        let [left, top, right, bottom] = self.corners();
        (left..right).contains(&x) && (top..bottom).contains(&y)
    }

    /// Returns whether both regions share a pixel.
    pub fn overlaps(&self, other: &Self) -> bool {
        let meet = |a: usize, a_long: usize, b: usize, b_long: usize| a < b + b_long && b < a + a_long;
        meet(self.x, self.width, other.x, other.width) && meet(self.y, self.height, other.y, other.height)
    }

    /// Divides the region into tiles of at most `side` pixels per side, as equal as possible, row by row. Neighbouring
    /// tiles overlap by about `overlap` pixels.
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

/// Merges regions that overlap until none do. Their order is kept as far as possible.
pub fn merge_overlapping(regions: &mut Vec<Region>) {
    let mut at = 0;
    while at < regions.len() {
        let later = (at + 1..regions.len()).find(|other| regions[at].overlaps(&regions[*other]));
        match later {
            // A merged region may overlap an earlier one.
            Some(other) => {
                let joined = regions[at].union(&regions[other]);
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
    fn invalid_corners_are_clipped() {
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
            prop_assert!(tiles.iter().all(|tile| region.union(tile) == region));
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
            merge_overlapping(&mut joined);
            for (at, region) in joined.iter().enumerate() {
                prop_assert!(joined[at + 1..].iter().all(|other| !region.overlaps(other)));
            }
            for region in &all {
                prop_assert!(joined.iter().any(|whole| whole.union(region) == *whole));
            }
        }
    }
}
