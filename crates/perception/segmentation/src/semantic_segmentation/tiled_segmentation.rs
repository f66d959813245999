//! Any network that tells the class of every pixel, in tiles of a large picture: its finest look counts.
//!
//! How is said in [`tiling`](opendr_tiling). A stream remembers the classes of each tile, so that tiles in which nothing moves
//! cost nothing, and those for which there was no time in one picture are looked at in the next.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::regions::Region;
use opendr_tiling::{
    Allowance, PictureLearner, TilePicture, Tiles, TilingParams, look_side_by_side, open_copies,
};

use super::SEGMENTERS;

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct TiledSegmentationParams {
    /// How the picture is looked at.
    #[param(flatten, tile = 512, tile_overlap = 64)]
    pub tiling: TilingParams,
}

/// A loaded network, as often as tiles are looked at side by side.
pub struct TiledSegmentation {
    params: TiledSegmentationParams,
    segmenters: Vec<Box<dyn PictureLearner<Heatmap>>>,
    classes: Classes,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    tile: TilePicture,
    map: Heatmap,
}

/// What was seen in the tiles of one stream.
#[derive(Default)]
pub struct TiledSegmentationState {
    tiles: Tiles,
    /// The class of every pixel where only the whole picture was looked at, and where tiles were.
    coarse: Vec<u32>,
    fine: Vec<u32>,
}

/// The part of the container.
const SEGMENTER: &str = "segmenter";
/// No tile said anything of a pixel.
const UNKNOWN: u32 = u32::MAX;

impl Learner for TiledSegmentation {
    const SPEC: Spec = Spec::new("tiled_segmentation", Task::SemanticSegmentation)
        .class("TiledSegmentationLearner")
        .about("Tells the class of every pixel of large pictures in tiles, within a time budget.");
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
        let allowance = Allowance::of_milliseconds(tiling.time_budget);
        let TiledSegmentationState { tiles, coarse, fine } = state;
        let (width, height) = (image.width(), image.height());
        if tiles.plan(tiling, image.view(), |_, tile| tile.seen.is_some())? {
            for labels in [&mut *coarse, &mut *fine] {
                labels.clear();
                labels.resize(width * height, UNKNOWN);
            }
        }
        let looked = look_side_by_side(self.segmenters.len(), tiles.order(), allowance, |worker, index| {
            self.look(worker, image, tiles, index)
        })?;
        for (index, labels) in looked {
            tiles.saw(index, true);
            let Some(tile) = tiles.tiles().get(index) else { continue };
            match tile.core.is_empty() {
                true => coarse.copy_from_slice(&labels),
                false => put(fine, width, &tile.core, &labels),
            }
        }
        for (index, tile) in tiles.tiles().iter().enumerate() {
            if !tiles.holds(index, tiling.memory) && tile.seen.is_some() {
                let Region { x, y, width: across, height: down } = tile.core;
                let rows = fine.chunks_exact_mut(width).skip(y).take(down);
                rows.for_each(|row| row[x..x + across].fill(UNKNOWN));
            }
        }
        map.classes.clone_from(&self.classes);
        let answer = map.labels_mut(&[height, width]);
        for (answer, (fine, coarse)) in answer.iter_mut().zip(fine.iter().zip(&*coarse)) {
            let label = if *fine == UNKNOWN { *coarse } else { *fine };
            // Where nobody looked yet, there is background.
            *answer = if label == UNKNOWN { 0 } else { label };
        }
        Ok(())
    }
}

impl TiledSegmentation {
    /// The classes of the pixels of a tile's core, or of the whole picture.
    fn look(&self, worker: usize, image: &Image, tiles: &Tiles, index: usize) -> Result<Vec<u32>> {
        let (Some(tile), Some(segmenter)) = (tiles.tiles().get(index), self.segmenters.get(worker)) else {
            return Ok(Vec::new());
        };
        let Scratch { tile: picture, map } = &mut *self.scratch.take();
        let Region { x, y, width, height } = tile.region;
        let is_whole = [width, height] == [image.width(), image.height()];
        let picture = if is_whole { image } else { picture.cut(image.view(), &tile.region)? };
        segmenter.answer(picture, map)?;
        let HeatmapValues::Labels(labels) = map.values() else {
            return Err(Error::format("the network tells scores instead of the class of every pixel"));
        };
        if map.shape() != [height, width] {
            return Err(Error::format(format!("a map of {:?} for {height}x{width} pixels", map.shape())));
        }
        let core = if tile.core.is_empty() { tile.region } else { tile.core };
        let rows = labels.chunks_exact(width).skip(core.y - y).take(core.height);
        Ok(rows.flat_map(|row| &row[core.x - x..core.x - x + core.width]).copied().collect())
    }
}

/// Puts the classes of a region into those of a picture `width` pixels wide.
fn put(all: &mut [u32], width: usize, region: &Region, labels: &[u32]) {
    let rows = all.chunks_exact_mut(width).skip(region.y).take(region.height);
    for (row, labels) in rows.zip(labels.chunks_exact(region.width)) {
        row[region.x..region.x + region.width].copy_from_slice(labels);
    }
}
