//! Semantic segmentation of large images in tiles, with any segmentation network; tiles take precedence over the whole image.
//!
//! The crate [`tiling`](opendr_tiling) selects the tiles. A stream keeps the classes of each tile, so that unchanged tiles cost
//! nothing, and tiles that exceeded the time budget of one frame are processed in the next.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::regions::Region;
use opendr_tiling::{
    ImageLearner, TileImage, Tiles, TilingParams, TimeBudget, open_copies, run_within_budget,
};

use super::SEGMENTERS;

/// Parameters of [`TiledSegmentation`].
#[derive(Debug, Clone, Params)]
pub struct TiledSegmentationParams {
    /// Options of the tiles.
    #[param(flatten, tile = 512, tile_overlap = 64)]
    pub tiling: TilingParams,
}

/// A loaded network, one copy per tile that is processed in parallel.
pub struct TiledSegmentation {
    params: TiledSegmentationParams,
    segmenters: Vec<Box<dyn ImageLearner<Heatmap>>>,
    classes: Classes,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    tile: TileImage,
    map: Heatmap,
}

/// State of a stream: the classes of its tiles.
#[derive(Default)]
pub struct TiledSegmentationState {
    tiles: Tiles,
    /// Class of every pixel from the whole image, and from tiles.
    coarse: Vec<u32>,
    fine: Vec<u32>,
}

/// Name of the part in the container.
const SEGMENTER: &str = "segmenter";
/// Value of pixels without a prediction.
const UNKNOWN: u32 = u32::MAX;

impl Learner for TiledSegmentation {
    const SPEC: Spec = Spec::new("tiled_segmentation", Task::SemanticSegmentation)
        .class("TiledSegmentationLearner")
        .about("Predicts the class of every pixel of large images in tiles, within a time budget.");
    type Params = TiledSegmentationParams;
    type Input<'a> = &'a Image;
    type Target = Heatmap;
    type State = TiledSegmentationState;

    fn load(model: &Model, params: TiledSegmentationParams, device: Device) -> Result<Self> {
        let copies = params.tiling.parallel_tiles;
        let segmenters = open_copies(model, SEGMENTER, SEGMENTERS, copies, &ParamMap::new(), device)?;
        let classes = segmenters.first().map(|segmenter| segmenter.classes()).unwrap_or_default();
        Ok(Self { params, segmenters, classes, scratch: Pool::default() })
    }

    fn params(&self) -> &TiledSegmentationParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut TiledSegmentationParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, state: &mut TiledSegmentationState, image: &Image, map: &mut Heatmap) -> Result<()> {
        let tiling = &self.params.tiling;
        let allowance = TimeBudget::from_milliseconds(tiling.time_budget);
        let TiledSegmentationState { tiles, coarse, fine } = state;
        let (width, height) = (image.width(), image.height());
        if tiles.plan(tiling, image.view(), |_, tile| tile.last_processed.is_some())? {
            for labels in [&mut *coarse, &mut *fine] {
                labels.clear();
                labels.resize(width * height, UNKNOWN);
            }
        }
        let segmented =
            run_within_budget(self.segmenters.len(), tiles.order(), allowance, |worker, index| {
                self.segment(worker, image, tiles, index)
            })?;
        for (index, labels) in segmented {
            tiles.record(index, true);
            let Some(tile) = tiles.tiles().get(index) else { continue };
            match tile.core.is_empty() {
                true => coarse.copy_from_slice(&labels),
                false => copy_region(fine, width, &tile.core, &labels),
            }
        }
        for (index, tile) in tiles.tiles().iter().enumerate() {
            if !tiles.is_valid(index, tiling.memory) && tile.last_processed.is_some() {
                let Region { x, y, width: across, height: down } = tile.core;
                let rows = fine.chunks_exact_mut(width).skip(y).take(down);
                rows.for_each(|row| row[x..x + across].fill(UNKNOWN));
            }
        }
        map.classes.clone_from(&self.classes);
        let output = map.labels_mut(&[height, width]);
        for (output, (fine, coarse)) in output.iter_mut().zip(fine.iter().zip(&*coarse)) {
            let label = if *fine == UNKNOWN { *coarse } else { *fine };
            // Pixels without a prediction are background.
            *output = if label == UNKNOWN { 0 } else { label };
        }
        Ok(())
    }
}

impl TiledSegmentation {
    /// Returns the classes of the pixels of a tile's core, or of the whole image.
    fn segment(&self, worker: usize, image: &Image, tiles: &Tiles, index: usize) -> Result<Vec<u32>> {
        let (Some(tile), Some(segmenter)) = (tiles.tiles().get(index), self.segmenters.get(worker)) else {
            return Ok(Vec::new());
        };
        let Scratch { tile: picture, map } = &mut *self.scratch.take();
        let Region { x, y, width, height } = tile.region;
        let is_whole = [width, height] == [image.width(), image.height()];
        let picture = if is_whole { image } else { picture.crop(image.view(), &tile.region)? };
        segmenter.predict_into(picture, map)?;
        let HeatmapValues::Labels(labels) = map.values() else {
            return Err(Error::format("the network returns scores instead of the class of every pixel"));
        };
        if map.shape() != [height, width] {
            return Err(Error::format(format!(
                "the network returns a map of {:?} for {height}x{width} pixels",
                map.shape()
            )));
        }
        let core = if tile.core.is_empty() { tile.region } else { tile.core };
        let rows = labels.chunks_exact(width).skip(core.y - y).take(core.height);
        Ok(rows.flat_map(|row| &row[core.x - x..core.x - x + core.width]).copied().collect())
    }
}

/// Copies the classes of a region into those of an image `width` pixels wide.
fn copy_region(all: &mut [u32], width: usize, region: &Region, labels: &[u32]) {
    let rows = all.chunks_exact_mut(width).skip(region.y).take(region.height);
    for (row, labels) in rows.zip(labels.chunks_exact(region.width)) {
        row[region.x..region.x + region.width].copy_from_slice(labels);
    }
}
