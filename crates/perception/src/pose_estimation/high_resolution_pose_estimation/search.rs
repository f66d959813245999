//! Which parts of a picture get a closer look.

use opendr_engine::data::ImageView;
use opendr_engine::{Pool, Result};

use super::{HighResolutionPoseEstimationParams, RegionMethod};
use crate::regions::{CellGrid, CoarsePicture, Region, join_overlapping};

/// A part of a picture, and how many pixels high the network sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    pub region: Region,
    pub height: usize,
}

/// How the choice is made, with its work memory.
#[derive(Default)]
pub(super) struct Search {
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    grid: CellGrid,
    detail: CellGrid,
    coarse: CoarsePicture,
    regions: Vec<Region>,
}

/// Parts are magnified at most so many times: beyond, there is nothing more to see.
const MOST_MAGNIFIED: usize = 4;
/// And so many times where much of a picture has detail.
const TILE_MAGNIFIED: usize = 3;
/// A second pass that magnifies less than this, compared with the first, shows nothing new.
const LEAST_GAIN: f32 = 1.2;
/// Sides of the coarse picture's cells.
const CELL: usize = 8;
/// More groups of cells than this are noise.
const MOST_GROUPS: usize = 256;

impl Search {
    /// Runs the `first` pass, which marks the cells of its grid where heat maps are high, and lists what is worth a
    /// closer look: parts with heat before parts with nothing but detail.
    pub fn begin(
        &self,
        params: &HighResolutionPoseEstimationParams,
        view: ImageView<'_>,
        looks: &mut Vec<Look>,
        first: impl FnOnce(&mut CellGrid) -> Result<()>,
    ) -> Result<()> {
        let Scratch { grid, detail, coarse, regions } = &mut *self.scratch.take();
        let size = [view.width(), view.height()];
        looks.clear();
        grid.reset(0, 0);
        first(grid)?;
        regions.clear();
        grid.take_regions(size, MOST_GROUPS, regions);
        let all = regions.iter().copied().reduce(|a, b| a.joined(&b));
        if params.method == RegionMethod::Primary {
            regions.clear();
            regions.extend(all);
        }
        grow(regions, params.percentage_around_crop, size);
        let look = |region: &Region| Look { region: *region, height: height_of(region, params) };
        looks.extend(regions.iter().map(look));
        mark_detail(view, params, coarse, detail)?;
        regions.iter().for_each(|region| detail.unmark(region, size));
        regions.clear();
        detail.take_regions(size, MOST_GROUPS, regions);
        grow(regions, params.percentage_around_crop, size);
        // Where there is much of it, tiles of it follow, magnified as far as small persons need.
        let tile = (params.second_pass_height / TILE_MAGNIFIED).max(CELL);
        let tiles = |region: &Region| {
            let is_large = region.width.max(region.height) > 2 * tile;
            region.tiles(tile, tile / 3).filter(move |_| is_large)
        };
        looks.extend(regions.iter().map(look));
        looks.extend(regions.iter().flat_map(tiles).map(|region| look(&region)));
        let before = params.first_pass_height as f32 / size[1].max(1) as f32;
        looks.retain(|look| look.height as f32 > LEAST_GAIN * before * look.region.height as f32);
        Ok(())
    }

    /// Leaves as many looks as there may be: around the persons of the frame before, then the others, in turn.
    pub fn choose(
        &self,
        params: &HighResolutionPoseEstimationParams,
        size: [usize; 2],
        persons: &[Region],
        turn: &mut usize,
        looks: &mut Vec<Look>,
    ) {
        if looks.len() <= params.max_regions {
            *turn = 0;
            return;
        }
        let Scratch { regions, .. } = &mut *self.scratch.take();
        regions.clear();
        regions.extend(persons.iter().copied());
        grow(regions, params.percentage_around_crop, size);
        // Half of the looks are for known persons, so that others can be found.
        regions.truncate(params.max_regions / 2);
        looks.retain(|look| !regions.iter().any(|region| region.joined(&look.region) == *region));
        let left = params.max_regions - regions.len();
        if !looks.is_empty() {
            let begin = *turn % looks.len();
            looks.rotate_left(begin);
            *turn = begin + left;
        }
        looks.truncate(left);
        looks
            .extend(regions.iter().map(|region| Look { region: *region, height: height_of(region, params) }));
    }
}

/// Marks the cells of the coarse picture in which brightness differs.
fn mark_detail(
    view: ImageView<'_>,
    params: &HighResolutionPoseEstimationParams,
    coarse: &mut CoarsePicture,
    detail: &mut CellGrid,
) -> Result<()> {
    let rows = params.first_pass_height.div_ceil(CELL).max(1);
    let columns = (rows * view.width()).div_ceil(view.height().max(1)).clamp(1, 8 * rows);
    coarse.look(view, columns, rows, CELL)?;
    detail.reset(columns, rows);
    detail.mark(|column, row| f32::from(coarse.range(column, row)) > params.detail_threshold);
    Ok(())
}

fn grow(regions: &mut Vec<Region>, share: f32, size: [usize; 2]) {
    regions.iter_mut().for_each(|region| *region = region.grown(share, size));
    join_overlapping(regions);
}

fn height_of(region: &Region, params: &HighResolutionPoseEstimationParams) -> usize {
    (MOST_MAGNIFIED * region.height).min(params.second_pass_height).max(CELL)
}
