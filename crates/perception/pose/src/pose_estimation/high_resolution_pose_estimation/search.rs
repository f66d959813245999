//! Selection of regions for the second pass.

use opendr_engine::data::ImageView;
use opendr_engine::{Pool, Result};
use opendr_perception_common::regions::{CellBrightness, CellGrid, Region, merge_overlapping};

use super::params::{HighResolutionPoseEstimationParams, RegionMethod};

/// A region, and the height of the network's input for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    pub region: Region,
    pub height: usize,
}

/// Selection of regions, with its work memory.
#[derive(Default)]
pub(super) struct Search {
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    grid: CellGrid,
    detail: CellGrid,
    coarse: CellBrightness,
    regions: Vec<Region>,
    known: Vec<Look>,
}

/// Maximum magnification of regions.
const MOST_MAGNIFIED: usize = 3;
/// Minimum magnification relative to the first pass.
const LEAST_GAIN: f32 = 1.2;
/// Side of the coarse image's cells, in pixels.
const CELL: usize = 4;
/// Maximum number of groups of cells; more are noise.
const MOST_GROUPS: usize = 256;

impl Search {
    /// Runs the `first` pass, which marks the cells with high values of heatmaps, and lists the regions for a second pass:
    /// those of heatmaps before those of detail only.
    pub fn begin(
        &self,
        params: &HighResolutionPoseEstimationParams,
        view: ImageView<'_>,
        looks: &mut Vec<Look>,
        first: impl FnOnce(&mut CellGrid) -> Result<()>,
    ) -> Result<()> {
        let Scratch { grid, detail, coarse, regions, .. } = &mut *self.scratch.take();
        let size = [view.width(), view.height()];
        looks.clear();
        grid.reset(0, 0);
        first(grid)?;
        regions.clear();
        grid.take_regions(size, MOST_GROUPS, regions);
        let all = regions.iter().copied().reduce(|a, b| a.union(&b));
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
        // Large regions are followed by their tiles, at the magnification that small persons need.
        let tile = (params.second_pass_height / MOST_MAGNIFIED).max(CELL);
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

    /// Selects the regions within the budget: half of them around the persons of the last frame, the others elsewhere; both
    /// in rotation. Returns whether all regions are selected.
    pub fn choose(
        &self,
        params: &HighResolutionPoseEstimationParams,
        size: [usize; 2],
        persons: &[Region],
        turns: &mut [usize; 2],
        looks: &mut Vec<Look>,
    ) -> bool {
        let Scratch { regions, known, .. } = &mut *self.scratch.take();
        let all = Share { looks: params.max_regions, pixels: params.max_pixels };
        if all.taken(looks) == looks.len() {
            *turns = [0; 2];
            return true;
        }
        regions.clear();
        regions.extend(persons.iter().copied());
        grow(regions, params.percentage_around_crop, size);
        looks.retain(|look| !regions.iter().any(|region| region.union(&look.region) == *region));
        known.clear();
        known
            .extend(regions.iter().map(|region| Look { region: *region, height: height_of(region, params) }));
        let half = Share { looks: all.looks / 2, pixels: all.pixels / 2 };
        take(known, if looks.is_empty() { &all } else { &half }, &mut turns[0]);
        let left = Share {
            looks: all.looks.saturating_sub(known.len()),
            pixels: all.pixels.saturating_sub(known.iter().map(Look::pixels).sum()),
        };
        take(looks, &left, &mut turns[1]);
        looks.append(known);
        false
    }
}

impl Look {
    /// Returns the number of pixels of the network's input.
    fn pixels(&self) -> usize {
        self.height * (self.height * self.region.width).div_ceil(self.region.height.max(1))
    }
}

/// Budget of an image.
struct Share {
    looks: usize,
    pixels: usize,
}

impl Share {
    /// Returns the number of `looks` within the budget, from the first; at least one, if any.
    fn taken(&self, looks: &[Look]) -> usize {
        let mut pixels = 0;
        let fitting = looks.iter().take(self.looks).take_while(|look| {
            pixels += look.pixels();
            pixels <= self.pixels
        });
        fitting.count().max(1).min(looks.len()).min(self.looks)
    }
}

/// Keeps the regions whose turn it is.
fn take(looks: &mut Vec<Look>, share: &Share, turn: &mut usize) {
    if looks.is_empty() {
        return;
    }
    let begin = *turn % looks.len();
    looks.rotate_left(begin);
    looks.truncate(share.taken(looks));
    *turn = begin + looks.len();
}

/// Marks the cells of the coarse image with a high range of brightness.
fn mark_detail(
    view: ImageView<'_>,
    params: &HighResolutionPoseEstimationParams,
    coarse: &mut CellBrightness,
    detail: &mut CellGrid,
) -> Result<()> {
    let rows = params.first_pass_height.div_ceil(CELL).max(1);
    let columns = (rows * view.width()).div_ceil(view.height().max(1)).clamp(1, 8 * rows);
    coarse.compute(view, columns, rows, CELL)?;
    detail.reset(columns, rows);
    detail.mark(|column, row| f32::from(coarse.range(column, row)) > params.detail_threshold);
    Ok(())
}

fn grow(regions: &mut Vec<Region>, share: f32, size: [usize; 2]) {
    regions.iter_mut().for_each(|region| *region = region.grown(share, size));
    merge_overlapping(regions);
}

fn height_of(region: &Region, params: &HighResolutionPoseEstimationParams) -> usize {
    (MOST_MAGNIFIED * region.height).min(params.second_pass_height).max(CELL)
}
