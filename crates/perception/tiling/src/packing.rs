use opendr_engine::target::BoundingBox;
use opendr_perception_common::regions::Region;

use super::Tiles;

/// A part of a tile, and its position in the network's input image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    /// Index of the tile.
    pub tile: usize,
    /// Region of the whole image.
    pub part: Region,
    /// Its left upper corner in the input image.
    pub position: [usize; 2],
}

impl Slot {
    /// Returns whether a position in the input image is in this part.
    pub fn contains(&self, [x, y]: [f32; 2]) -> bool {
        let [left, top] = self.position.map(|at| at as f32);
        Region { x: 0, y: 0, ..self.part }.contains([x - left, y - top])
    }

    /// Converts a box of the input image to pixels of the part, clipped to it.
    pub fn box_in_part(&self, mut found: BoundingBox) -> BoundingBox {
        let [x, y] = self.position.map(|at| at as f32);
        let [left, top, right, bottom] = found.corners();
        let cut = |from: f32, to: f32, at: f32, side: usize| {
            let (from, to) = ((from - at).max(0.0), (to - at).min(side as f32));
            (from, to - from)
        };
        (found.left, found.width) = cut(left, right, x, self.part.width);
        (found.top, found.height) = cut(top, bottom, y, self.part.height);
        found.landmarks.iter_mut().for_each(|point| *point = [point[0] - x, point[1] - y]);
        found
    }
}

/// The inferences for an image: each for one tile, or for small parts of several tiles side by side.
#[derive(Debug, Default)]
pub struct TileInferences {
    slots: Vec<Slot>,
    /// End of each inference in the slots.
    ends: Vec<usize>,
    /// Parts of the inference that is being packed.
    open: Vec<Slot>,
}

/// Pixels between parts in one inference.
const GAP: usize = 8;

impl TileInferences {
    /// Plans one inference per tile, in the order of the tiles.
    pub fn plan_whole(&mut self, tiles: &Tiles) {
        self.clear();
        tiles.order().iter().for_each(|index| self.add_tile(tiles, *index));
    }

    /// Packs the changed parts of tiles side by side into squares of `side` pixels. Parts longer than half of the square
    /// are processed as whole tiles.
    pub fn plan_packed(&mut self, tiles: &Tiles, side: usize) {
        self.clear();
        // The current row: position of the next part, and height of the row.
        let (mut x, mut y, mut high) = (0, 0, 0);
        for index in tiles.order() {
            let Some(part) = tiles.tiles().get(*index).map(|tile| tile.changed_part) else { continue };
            // A tile of the rotation has no such part.
            if part.is_empty() || 2 * part.width.max(part.height) > side {
                self.add_tile(tiles, *index);
                continue;
            }
            if x + part.width > side {
                (x, y, high) = (0, y + high + GAP, 0);
            }
            if y + part.height > side {
                self.close(tiles);
                (x, y, high) = (0, 0, 0);
            }
            self.open.push(Slot { tile: *index, part, position: [x, y] });
            x += part.width + GAP;
            high = high.max(part.height);
        }
        self.close(tiles);
    }

    /// Returns the number of inferences.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns whether there is no inference.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Returns the parts of one inference.
    pub fn slots(&self, number: usize) -> &[Slot] {
        let begin = number.checked_sub(1).map_or(Some(0), |before| self.ends.get(before).copied());
        let range = begin.zip(self.ends.get(number).copied());
        range.and_then(|(begin, end)| self.slots.get(begin..end)).unwrap_or_default()
    }

    fn clear(&mut self) {
        self.slots.clear();
        self.ends.clear();
        self.open.clear();
    }

    fn add_tile(&mut self, tiles: &Tiles, index: usize) {
        if let Some(tile) = tiles.tiles().get(index) {
            self.slots.push(Slot { tile: index, part: tile.region, position: [0, 0] });
            self.ends.push(self.slots.len());
        }
    }

    /// Ends the current inference; a single part is processed as its whole tile.
    fn close(&mut self, tiles: &Tiles) {
        if let [slot] = self.open[..] {
            self.open.clear();
            return self.add_tile(tiles, slot.tile);
        }
        if !self.open.is_empty() {
            self.slots.append(&mut self.open);
            self.ends.push(self.slots.len());
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;

    use super::*;
    use crate::TilingParams;

    const SIZE: [usize; 2] = [1280, 960];

    /// Returns a grey image with dark squares of 20 pixels at the given positions.
    fn scene(squares: &[[usize; 2]]) -> Image {
        let mut samples = vec![120; SIZE[0] * SIZE[1] * 3];
        for [left, top] in squares {
            for row in *top..top + 20 {
                samples[3 * (row * SIZE[0] + left)..][..60].fill(10);
            }
        }
        Image::from_rgb8(samples, SIZE[0], SIZE[1]).unwrap()
    }

    fn plan(squares: &[[usize; 2]]) -> (Tiles, TileInferences) {
        plan_with(&TilingParams { whole: false, rotation: 0, ..TilingParams::default() }, squares)
    }

    fn plan_with(params: &TilingParams, squares: &[[usize; 2]]) -> (Tiles, TileInferences) {
        let (mut tiles, mut looks) = (Tiles::default(), TileInferences::default());
        tiles.plan(params, scene(squares).view(), |_, _| false).unwrap();
        looks.plan_packed(&tiles, params.tile);
        (tiles, looks)
    }

    #[test]
    fn parts_lie_side_by_side() {
        let squares: Vec<[usize; 2]> =
            (0..12).map(|at| [100 + 280 * (at % 4), 90 + 300 * (at / 4)]).collect();
        let (tiles, looks) = plan(&squares);
        assert!(looks.len() < tiles.order().len(), "{} for {}", looks.len(), tiles.order().len());
        let mut seen = Vec::new();
        for look in (0..looks.len()).map(|number| looks.slots(number)) {
            for (at, slot) in look.iter().enumerate() {
                let place = |slot: &Slot| Region { x: slot.position[0], y: slot.position[1], ..slot.part };
                let own = place(slot);
                assert!(own.x + own.width <= 256 && own.y + own.height <= 256, "{slot:?}");
                assert!(look[at + 1..].iter().all(|other| !place(other).overlaps(&own)), "{look:?}");
                seen.push(slot.tile);
            }
        }
        seen.sort_unstable();
        let mut order = tiles.order().to_vec();
        order.sort_unstable();
        assert_eq!(seen, order);
        // The surroundings of a square belong to its part.
        let region = Region { x: 80, y: 70, width: 60, height: 60 };
        let shown = (0..looks.len()).flat_map(|number| looks.slots(number));
        assert!(shown.clone().any(|slot| slot.part.union(&region) == slot.part));
        assert!(looks.slots(looks.len()).is_empty());
    }

    #[test]
    fn a_part_alone_is_its_tile() {
        let (tiles, looks) = plan(&[[130, 130]]);
        assert_eq!((looks.len(), tiles.order().len()), (1, 1));
        assert_eq!(looks.slots(0)[0].part, tiles.tiles()[tiles.order()[0]].region);
        // The tile is empty, but its turn has come.
        let turn = TilingParams { whole: false, rotation: 1, ..TilingParams::default() };
        let (tiles_in_turn, looks) = plan_with(&turn, &[]);
        assert_eq!(looks.slots(0)[0].part, tiles_in_turn.tiles()[0].region);
        let (_, mut looks) = plan(&[]);
        assert!(looks.is_empty());
        looks.plan_whole(&tiles);
        assert_eq!(looks.len(), 1);
    }
}
