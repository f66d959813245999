use opendr_engine::Result;
use opendr_engine::data::ImageView;
use opendr_perception_common::regions::{CellBrightness, Region};

use super::TilingParams;

/// A tile of an image and the state of its processing.
#[derive(Debug, Clone)]
pub struct Tile {
    /// Region of the tile.
    pub region: Region,
    /// The part to which no other tile is nearer: the cores of all tiles partition the image. Empty for the tile of the
    /// whole image.
    pub core: Region,
    /// Index of the image in which it was processed last, from 0.
    pub last_processed: Option<u64>,
    /// Index of the first image since then in which it had changed.
    pub changed: Option<u64>,
    /// The part to process, with its surroundings: where there is detail, or a change.
    pub changed_part: Region,
    /// The brightness of its cells when it was processed.
    reference: Vec<u8>,
}

/// The tiles of the images of one stream.
#[derive(Debug, Default)]
pub struct Tiles {
    size: [usize; 2],
    /// Side and overlap of the tiles, and whether one is the whole image.
    layout: (usize, usize, bool),
    tiles: Vec<Tile>,
    coarse: CellBrightness,
    /// The brightness of the cells of the last image.
    before: Vec<u8>,
    /// Number of images so far.
    pictures: u64,
    order: Vec<usize>,
    occupied: Vec<usize>,
    rest: Vec<usize>,
}

/// Side of the cells in which brightness is compared, in pixels.
const CELL: usize = 16;
/// Number of samples of a cell along each axis: every fourth pixel.
const POINTS: usize = 4;
/// Margin around a part to process, in pixels on each side, as context of the objects.
const AROUND: usize = 2 * CELL;
/// Share of cells with a change of more than [`OTHER_LEVEL`] since the last image above which the scene is a different one.
const OTHER_SHARE: f32 = 0.4;
const OTHER_LEVEL: u8 = 32;

impl Tiles {
    /// Plans the inferences for the next image; `is_occupied` returns whether something was detected in a tile. Tiles with
    /// objects and others alternate, those that were processed longest ago first. Returns whether the scene is a different
    /// one, so that no previous result is valid.
    ///
    /// # Errors
    /// As [`CellBrightness::compute`].
    pub fn plan(
        &mut self,
        params: &TilingParams,
        view: ImageView<'_>,
        is_occupied: impl Fn(usize, &Tile) -> bool,
    ) -> Result<bool> {
        let size = [view.width(), view.height()];
        let layout = (params.tile.max(1), params.tile_overlap, params.whole);
        let is_new = (self.size, self.layout) != (size, layout);
        if is_new {
            (self.size, self.layout) = (size, layout);
            self.pictures = 0;
            self.before.clear();
            self.cut();
        }
        let [columns, rows] = size.map(|side| side.div_ceil(CELL));
        self.coarse.compute(view, columns, rows, POINTS)?;
        let is_other = self.is_other_scene();
        self.before.clear();
        self.before.extend_from_slice(self.coarse.means());
        self.occupied.clear();
        self.rest.clear();
        let now = self.pictures;
        for (index, tile) in self.tiles.iter_mut().enumerate() {
            if !tile.is_due(&self.coarse, size, params, now) {
                continue;
            }
            match is_occupied(index, tile) {
                true => self.occupied.push(index),
                false => self.rest.push(index),
            }
        }
        self.put_in_order(params);
        self.pictures += 1;
        Ok(is_new || is_other)
    }

    /// Returns the indices of the tiles to process, in order.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Returns all tiles: the whole image first, if it is one, then row by row.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// Records that a tile was processed in the image of the last plan: completely, or the part that was due.
    pub fn record(&mut self, index: usize, is_whole: bool) {
        let Some(tile) = self.tiles.get_mut(index) else { return };
        let [columns, rows] = self.coarse.size();
        let levels = cells_of(&tile.region, self.size, &self.coarse).map(|cell| self.coarse.means()[cell]);
        // Outside the part the change was small: its reference stays, so that slow changes accumulate.
        let is_new = is_whole || tile.last_processed.is_none();
        if is_new {
            tile.reference.clear();
            tile.reference.extend(levels);
        } else {
            let cells = cells_of(&tile.region, self.size, &self.coarse);
            for ((cell, level), reference) in cells.zip(levels).zip(&mut tile.reference) {
                if cell_region(cell, [columns, rows], self.size).overlaps(&tile.changed_part) {
                    *reference = level;
                }
            }
        }
        tile.last_processed = Some(self.pictures.saturating_sub(1));
        tile.changed = None;
    }

    /// Returns whether the last result of a tile is valid: it is unchanged, or changed no more than `memory` images ago.
    pub fn is_valid(&self, index: usize, memory: u32) -> bool {
        self.tiles.get(index).is_some_and(|tile| {
            let age = |changed| self.pictures.saturating_sub(changed);
            tile.last_processed.is_some()
                && tile.changed.is_none_or(|changed| age(changed) <= u64::from(memory))
        })
    }

    /// Returns whether a position in a changed tile was processed later, in another tile.
    pub fn is_superseded(&self, index: usize, place: [f32; 2]) -> bool {
        let Some(own) = self.tiles.get(index).filter(|tile| tile.changed.is_some()) else { return false };
        self.tiles.iter().any(|tile| tile.last_processed > own.last_processed && tile.region.contains(place))
    }

    fn cut(&mut self) {
        let (side, overlap, whole) = self.layout;
        let [width, height] = self.size;
        let picture = Region { x: 0, y: 0, width, height };
        self.tiles.clear();
        let tile = |region, core| Tile {
            region,
            core,
            last_processed: None,
            changed: None,
            changed_part: Region::default(),
            reference: Vec::new(),
        };
        let is_small = width.max(height) <= side;
        if whole || is_small {
            self.tiles.push(tile(picture, if is_small { picture } else { Region::default() }));
        }
        if is_small {
            return;
        }
        let regions: Vec<_> = picture.tiles(side, overlap).collect();
        let columns = regions.iter().take_while(|region| region.y == 0).count().max(1);
        for (index, region) in regions.iter().enumerate() {
            let (column, row) = (index % columns, index / columns);
            let left = column.checked_sub(1).map(|other| &regions[other]);
            let above = row.checked_sub(1).map(|other| &regions[other * columns]);
            let right = (column + 1 < columns).then(|| &regions[column + 1]);
            let below = regions.get((row + 1) * columns);
            // Two neighbours share their overlap equally.
            let begin = |own: usize, other: Option<usize>| other.map_or(own, |end| (own + end) / 2);
            let x = begin(region.x, left.map(|other| other.x + other.width));
            let y = begin(region.y, above.map(|other| other.y + other.height));
            let end_x = right.map_or(width, |other| (other.x + region.x + region.width) / 2);
            let end_y = below.map_or(height, |other| (other.y + region.y + region.height) / 2);
            let core = Region { x, y, width: end_x - x, height: end_y - y };
            self.tiles.push(tile(*region, core));
        }
    }

    fn is_other_scene(&self) -> bool {
        let cells = self.coarse.means().iter().zip(&self.before);
        let other = cells.filter(|(now, before)| now.abs_diff(**before) > OTHER_LEVEL).count();
        other as f32 > OTHER_SHARE * self.coarse.means().len() as f32
    }

    fn put_in_order(&mut self, params: &TilingParams) {
        let tiles = &self.tiles;
        let age = |index: &usize| (tiles[*index].last_processed.map_or(0, |seen| seen + 1), *index);
        self.occupied.sort_unstable_by_key(age);
        self.rest.sort_unstable_by_key(age);
        self.order.clear();
        for at in 0..self.occupied.len().max(self.rest.len()) {
            self.order.extend(self.occupied.get(at));
            self.order.extend(self.rest.get(at));
        }
        let turn = u64::from(params.rotation);
        if turn > 0 && self.pictures % turn == turn - 1 {
            let other = (0..tiles.len()).min_by_key(age);
            self.order.retain(|index| Some(*index) != other);
            if let Some(other) = other {
                self.order.insert(0, other);
            }
        }
        if params.max_tiles > 0 {
            self.order.truncate(params.max_tiles);
        }
    }
}

impl Tile {
    /// Returns whether the tile is to be processed; updates the part and the time of the first change.
    fn is_due(&mut self, coarse: &CellBrightness, size: [usize; 2], params: &TilingParams, now: u64) -> bool {
        let cells = cells_of(&self.region, size, coarse);
        if self.last_processed.is_none() {
            let has_detail = |cell: &usize| f32::from(coarse.ranges()[*cell]) > params.detail_threshold;
            self.changed_part = match params.detail_threshold <= 0.0 || self.core.is_empty() {
                true => self.region,
                false => self.around(cells.filter(has_detail), coarse.size(), size),
            };
            return !self.changed_part.is_empty();
        }
        let differs = |(cell, then): &(usize, &u8)| {
            f32::from(coarse.means()[*cell].abs_diff(**then)) > params.change_threshold
        };
        self.changed_part = match params.change_threshold <= 0.0 {
            true => self.region,
            false => {
                let changed = cells.zip(&self.reference).filter(differs).map(|(cell, _)| cell);
                self.around(changed, coarse.size(), size)
            }
        };
        self.changed = (!self.changed_part.is_empty()).then(|| self.changed.unwrap_or(now));
        self.changed.is_some()
    }

    /// Returns the smallest region with all `cells` and the margin, clipped to the tile; empty without cells.
    fn around(&self, cells: impl Iterator<Item = usize>, grid: [usize; 2], size: [usize; 2]) -> Region {
        let regions = cells.map(|cell| cell_region(cell, grid, size));
        let Some(all) = regions.reduce(|all, region| all.union(&region)) else { return Region::default() };
        let (x, y) = (
            all.x.saturating_sub(AROUND).max(self.region.x),
            all.y.saturating_sub(AROUND).max(self.region.y),
        );
        let end =
            |begin: usize, long: usize, own: usize, side: usize| (begin + long + AROUND).min(own + side);
        let right = end(all.x, all.width, self.region.x, self.region.width);
        let below = end(all.y, all.height, self.region.y, self.region.height);
        Region { x, y, width: right.saturating_sub(x), height: below.saturating_sub(y) }
    }
}

/// Returns the pixels of a cell of a coarse image.
fn cell_region(cell: usize, [columns, rows]: [usize; 2], [width, height]: [usize; 2]) -> Region {
    let side = |at: usize, count: usize, long: usize| (at * long / count, ((at + 1) * long).div_ceil(count));
    let (x, right) = side(cell % columns, columns, width);
    let (y, below) = side(cell / columns, rows, height);
    Region { x, y, width: right - x, height: below - y }
}

/// Returns the indices of the cells of a coarse image that a region touches.
fn cells_of(
    region: &Region,
    [width, height]: [usize; 2],
    coarse: &CellBrightness,
) -> impl Iterator<Item = usize> + use<> {
    let [columns, rows] = coarse.size();
    let touched = |begin: usize, long: usize, all: usize, cells: usize| {
        let all = all.max(1);
        (begin * cells / all, ((begin + long) * cells).div_ceil(all).min(cells))
    };
    let (left, right) = touched(region.x, region.width, width, columns);
    let (top, bottom) = touched(region.y, region.height, height, rows);
    (top..bottom).flat_map(move |row| (left..right).map(move |column| row * columns + column))
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;
    use opendr_engine::params::Params as _;

    use super::*;

    const SIZE: [usize; 2] = [640, 480];

    fn params(values: &[(&str, f64)]) -> TilingParams {
        let mut params = TilingParams { tile: 128, tile_overlap: 32, ..TilingParams::default() };
        for (name, value) in values {
            params.set(name, (*value).into()).or_else(|_| params.set(name, (*value as i64).into())).unwrap();
        }
        params
    }

    /// Returns a grey image with white squares of 24 pixels with a black centre at the given positions.
    fn scene(squares: &[[usize; 2]]) -> Image {
        let level = |at: usize| {
            let (x, y) = (at % SIZE[0], at / SIZE[0]);
            let within = |side: usize| {
                squares.iter().any(|[left, top]| {
                    let at = (x.wrapping_sub(left + (24 - side) / 2), y.wrapping_sub(top + (24 - side) / 2));
                    at.0 < side && at.1 < side
                })
            };
            if within(12) {
                0
            } else if within(24) {
                255
            } else {
                120
            }
        };
        let samples = (0..SIZE[0] * SIZE[1]).flat_map(|at| [level(at); 3]).collect();
        Image::from_rgb8(samples, SIZE[0], SIZE[1]).unwrap()
    }

    fn process(tiles: &mut Tiles, params: &TilingParams, image: &Image) -> Vec<usize> {
        tiles.plan(params, image.view(), |_, _| false).unwrap();
        let order = tiles.order().to_vec();
        order.iter().for_each(|index| tiles.record(*index, true));
        order
    }

    #[test]
    fn cores_partition_the_image() {
        let mut tiles = Tiles::default();
        tiles.plan(&params(&[]), scene(&[]).view(), |_, _| false).unwrap();
        let cores: Vec<_> =
            tiles.tiles().iter().map(|tile| tile.core).filter(|core| !core.is_empty()).collect();
        assert_eq!(cores.iter().map(|core| core.width * core.height).sum::<usize>(), SIZE[0] * SIZE[1]);
        for (at, core) in cores.iter().enumerate() {
            assert!(cores[at + 1..].iter().all(|other| !core.overlaps(other)));
        }
        assert!(tiles.tiles().iter().skip(1).all(|tile| tile.region.union(&tile.core) == tile.region));
    }

    #[test]
    fn tiles_with_objects_are_processed_once() {
        let mut tiles = Tiles::default();
        let params = params(&[("rotation", 0.0)]);
        let image = scene(&[[300, 200]]);
        let first = process(&mut tiles, &params, &image);
        assert_eq!(first[0], 0, "the whole picture");
        let shows = |index: &usize| {
            tiles.tiles()[*index].region.overlaps(&Region { x: 284, y: 184, width: 56, height: 56 })
        };
        assert!(first.len() >= 2 && first.iter().all(shows));
        assert!(process(&mut tiles, &params, &image).is_empty(), "nothing changed");
        // After a motion only the old and the new position are processed.
        let moved = process(&mut tiles, &params, &scene(&[[310, 205]]));
        assert!((2..6).contains(&moved.len()), "{moved:?}");
    }

    #[test]
    fn without_thresholds_every_tile_is_always_processed() {
        let mut tiles = Tiles::default();
        let params = params(&[("detail_threshold", 0.0), ("change_threshold", 0.0)]);
        for _ in 0..6 {
            let mut order = process(&mut tiles, &params, &scene(&[]));
            order.sort_unstable();
            assert_eq!(order, (0..tiles.tiles().len()).collect::<Vec<_>>());
        }
    }

    #[test]
    fn rotation_processes_every_tile() {
        let mut tiles = Tiles::default();
        let params = params(&[("max_tiles", 1.0), ("rotation", 1.0)]);
        let mut seen: Vec<usize> = Vec::new();
        for _ in 0..60 {
            seen.extend(process(&mut tiles, &params, &scene(&[])));
        }
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), tiles.tiles().len());
    }

    #[test]
    fn nothing_starves_when_everything_changes() {
        let mut tiles = Tiles::default();
        let params = params(&[("max_tiles", 3.0), ("change_threshold", 0.0), ("detail_threshold", 0.0)]);
        let mut last = vec![0; 100];
        for picture in 1..200 {
            tiles.plan(&params, scene(&[]).view(), |index, _| index % 7 == 0).unwrap();
            for index in tiles.order().to_vec() {
                tiles.record(index, true);
                last[index] = picture;
            }
        }
        let count = tiles.tiles().len();
        assert!(last[..count].iter().all(|at| *at > 199 - 40), "{:?}", &last[..count]);
    }

    #[test]
    fn results_of_changed_tiles_stay_valid_for_a_while() {
        let mut tiles = Tiles::default();
        let few = params(&[("rotation", 0.0), ("max_tiles", 1.0)]);
        let all = params(&[("rotation", 0.0)]);
        process(&mut tiles, &all, &scene(&[[300, 200]]));
        let index =
            (1..tiles.tiles().len()).find(|index| tiles.tiles()[*index].last_processed.is_some()).unwrap();
        for picture in 0..5 {
            tiles.plan(&few, scene(&[[0, 400]]).view(), |_, _| false).unwrap();
            assert_eq!(tiles.is_valid(index, 3), picture < 3, "{picture}");
        }
        tiles.plan(&few, scene(&[[300, 200]]).view(), |_, _| false).unwrap();
        assert!(tiles.is_valid(index, 0), "it is as it was");
    }

    #[test]
    fn another_scene_is_reported() {
        let mut tiles = Tiles::default();
        let params = params(&[]);
        assert!(tiles.plan(&params, scene(&[]).view(), |_, _| false).unwrap());
        assert!(!tiles.plan(&params, scene(&[[9, 9]]).view(), |_, _| false).unwrap());
        let dark = Image::from_rgb8(vec![0; SIZE[0] * SIZE[1] * 3], SIZE[0], SIZE[1]).unwrap();
        assert!(tiles.plan(&params, dark.view(), |_, _| false).unwrap());
        let small = Image::from_rgb8(vec![0; 27], 3, 3).unwrap();
        assert!(tiles.plan(&params, small.view(), |_, _| false).unwrap());
        assert_eq!(tiles.tiles().len(), 1);
        assert!(!tiles.tiles()[0].core.is_empty());
    }
}
