//! Anchors: the prior boxes of a single-shot detector (default boxes, Liu et al., SSD, ECCV 2016, section 2.2).
//!
//! The feature map of a level has a cell every [`AnchorLevel::stride`] pixels, and each cell has the same few anchors
//! around its centre. The network predicts class scores and offsets ([`super::coding`]) for each anchor.

use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// A box by its centre and its sides, in pixels of the network's input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anchor {
    /// Centre along x.
    pub x: f32,
    /// Centre along y.
    pub y: f32,
    /// Width.
    pub width: f32,
    /// Height.
    pub height: f32,
}

impl Anchor {
    /// Returns `[x0, y0, x1, y1]`.
    pub fn corners(&self) -> [f32; 4] {
        let Self { x, y, width, height } = self;
        [x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0]
    }
}

/// The anchors of one feature map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AnchorLevel {
    /// Pixels of the network's input per cell.
    pub stride: usize,
    /// Width and height of each anchor of a cell, in pixels of the network's input.
    pub sides: Vec<[f32; 2]>,
}

impl AnchorLevel {
    /// Creates anchors with the areas of squares of `sides` pixels, each in all aspect ratios (width over height): Eq. 4
    /// with several scales per level.
    pub fn new(stride: usize, sides: &[f32], ratios: &[f32]) -> Self {
        let of_side = |side: f32| ratios.iter().map(move |ratio| [side * ratio.sqrt(), side / ratio.sqrt()]);
        Self { stride, sides: sides.iter().copied().flat_map(of_side).collect() }
    }

    /// Returns the number of cells along an axis of `size` pixels.
    pub fn cells(&self, size: usize) -> usize {
        size.div_ceil(self.stride)
    }

    /// Returns the anchors in an input of `[width, height]` pixels, in the order of the network's maps: all of one kind,
    /// row by row, before the next kind.
    pub fn anchors(&self, input_size: [usize; 2]) -> impl Iterator<Item = Anchor> {
        let [columns, rows] = input_size.map(|size| self.cells(size));
        self.sides.iter().flat_map(move |sides| {
            (0..rows * columns).map(move |cell| self.anchor(*sides, cell % columns, cell / columns))
        })
    }

    /// Returns the anchor of the given sides in a cell.
    pub fn anchor(&self, [width, height]: [f32; 2], column: usize, row: usize) -> Anchor {
        let middle = |cell: usize| (cell as f32 + 0.5) * self.stride as f32;
        Anchor { x: middle(column), y: middle(row), width, height }
    }
}

/// Limits for a container: number of levels, of anchors per cell, and pixels of a side.
const MOST_LEVELS: usize = 16;
const MOST_SIDES: usize = 64;
const LARGEST: f32 = 65535.0;

/// The anchors of all levels, finest first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Anchors {
    /// The levels.
    pub levels: Vec<AnchorLevel>,
}

impl Anchors {
    /// Creates levels of the given strides. Anchors have the areas of squares with sides of `scales` strides.
    pub fn new(strides: &[usize], scales: &[f32], ratios: &[f32]) -> Self {
        let level = |stride: &usize| {
            let sides: Vec<_> = scales.iter().map(|scale| scale * *stride as f32).collect();
            AnchorLevel::new(*stride, &sides, ratios)
        };
        Self { levels: strides.iter().map(level).collect() }
    }

    /// Returns all anchors in an input of `[width, height]` pixels, level by level.
    pub fn anchors(&self, input_size: [usize; 2]) -> Vec<Anchor> {
        self.levels.iter().flat_map(|level| level.anchors(input_size)).collect()
    }

    /// Checks the anchors of a container.
    ///
    /// # Errors
    /// `Format` when there are no levels or too many, or a stride or side is out of range.
    pub fn check(&self) -> Result<()> {
        let fits = |side: f32| side > 0.0 && side <= LARGEST;
        let sane = |level: &AnchorLevel| {
            fits(level.stride as f32)
                && (1..=MOST_SIDES).contains(&level.sides.len())
                && level.sides.iter().flatten().all(|side| fits(*side))
        };
        if (1..=MOST_LEVELS).contains(&self.levels.len()) && self.levels.iter().all(sane) {
            return Ok(());
        }
        Err(Error::format(format!(
            "anchors need 1 to {MOST_LEVELS} levels of a stride and 1 to {MOST_SIDES} sides, all between 0 and {LARGEST} \
             pixels; the model has {self:?}"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_has_every_side_in_every_ratio() {
        let level = AnchorLevel::new(16, &[60.0, 80.0], &[1.0, 0.25]);
        assert_eq!(level.sides, [[60.0, 60.0], [30.0, 120.0], [80.0, 80.0], [40.0, 160.0]]);
    }

    #[test]
    fn anchors_lie_kind_by_kind_about_the_middles_of_cells() {
        let level = AnchorLevel { stride: 16, sides: vec![[8.0, 8.0], [4.0, 16.0]] };
        let anchors: Vec<_> = level.anchors([48, 30]).collect();
        assert_eq!(anchors.len(), 2 * 3 * 2);
        assert_eq!(anchors[1], Anchor { x: 24.0, y: 8.0, width: 8.0, height: 8.0 });
        assert_eq!(anchors[6 + 3].corners(), [6.0, 16.0, 10.0, 32.0]);
    }

    #[test]
    fn what_is_no_number_of_pixels_is_refused() {
        let anchors = Anchors::new(&[16, 32], &[3.0], &[1.0, 0.5]);
        anchors.check().unwrap();
        assert_eq!(anchors.anchors([64, 64]).len(), 2 * (16 + 4));
        for (stride, sides) in
            [(0, [8.0, 8.0]), (8, [8.0, f32::NAN]), (8, [-1.0, 8.0]), (1 << 20, [8.0, 8.0])]
        {
            let broken = Anchors { levels: vec![AnchorLevel { stride, sides: vec![sides] }] };
            assert!(broken.check().is_err(), "{broken:?}");
        }
        assert!(Anchors { levels: Vec::new() }.check().is_err());
    }
}
