//! Any detector over the tiles of a large image, for objects that are small in it.
//!
//! [`opendr_tiling`] describes the method. The state of a stream has the detections of each tile: tiles without motion cost
//! nothing, and tiles for which there was no time in one image are processed in the next. With a time budget, small parts
//! of several tiles share one inference, which keeps up with many small moving objects.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_tiling::{
    ImageLearner, Piece, Slot, TileImage, TileInferences, Tiles, TilingParams, TimeBudget, merge_pieces,
    open_copies, run_within_budget,
};

use super::DETECTORS;

/// Parameters of [`TiledDetection`].
#[derive(Debug, Clone, Params)]
pub struct TiledDetectionParams {
    /// Score below which detections are dropped; the detector itself drops those below 0.1.
    #[param(default = 0.35, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes of one class from different tiles count as one object.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes per image.
    #[param(default = 500, range = 1..=2000, live)]
    pub max_detections: usize,
    /// Tiling of the image.
    #[param(flatten)]
    pub tiling: TilingParams,
}

/// A loaded detector, with one copy per parallel tile.
pub struct TiledDetection {
    params: TiledDetectionParams,
    detectors: Vec<Box<dyn ImageLearner<BoundingBoxList>>>,
    classes: Classes,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    tile: TileImage,
    found: BoundingBoxList,
}

/// Detections in the tiles of one stream.
#[derive(Default)]
pub struct TiledDetectionState {
    tiles: Tiles,
    looks: TileInferences,
    /// Indices of the inferences.
    numbers: Vec<usize>,
    /// Detections of each tile's last inference.
    found: Vec<Vec<Piece>>,
    pieces: Vec<Piece>,
}

/// Name of the detector in the container.
const DETECTOR: &str = "detector";
/// Score below which detections are noise.
const LOWEST: f64 = 0.1;

impl Learner for TiledDetection {
    const SPEC: Spec = Spec::new("tiled_detection", Task::ObjectDetection2d)
        .class("TiledDetectionLearner")
        .about("Runs any detector on the relevant tiles of large images, within a time budget.");
    type Params = TiledDetectionParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = TiledDetectionState;

    fn load(model: &Model, params: TiledDetectionParams, device: Device) -> Result<Self> {
        let overrides = ParamMap::from([("threshold".to_owned(), LOWEST.into())]);
        let copies = params.tiling.parallel_tiles;
        let detectors = open_copies(model, DETECTOR, DETECTORS, copies, &overrides, device)?;
        let classes = detectors.first().map(|detector| detector.classes()).unwrap_or_default();
        Ok(Self { params, detectors, classes, scratch: Pool::default() })
    }

    fn params(&self) -> &TiledDetectionParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut TiledDetectionParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(
        &self,
        state: &mut TiledDetectionState,
        image: &Image,
        boxes: &mut BoundingBoxList,
    ) -> Result<()> {
        let tiling = &self.params.tiling;
        let allowance = TimeBudget::from_milliseconds(tiling.time_budget);
        let TiledDetectionState { tiles, looks, numbers, found, pieces } = state;
        let has_some = |index: usize| found.get(index).is_some_and(|found: &Vec<_>| !found.is_empty());
        if tiles.plan(tiling, image.view(), |index, _| has_some(index))? {
            found.clear();
        }
        found.resize_with(tiles.tiles().len(), Vec::new);
        match tiling.time_budget > 0.0 {
            true => looks.plan_packed(tiles, tiling.tile),
            false => looks.plan_whole(tiles),
        }
        numbers.clear();
        numbers.extend(0..looks.len());
        let looked = run_within_budget(self.detectors.len(), numbers, allowance, |worker, number| {
            self.look(worker, image, looks.slots(number))
        })?;
        for (number, mut seen) in looked {
            for (place, slot) in looks.slots(number).iter().enumerate() {
                let is_whole = tiles.tiles().get(slot.tile).is_some_and(|tile| tile.region == slot.part);
                let found = &mut found[slot.tile];
                found.retain(|piece| !is_whole && !slot.part.contains(middle(&piece.bounding_box)));
                found.extend(seen.extract_if(.., |(of, _)| *of == place).map(|(_, piece)| piece));
                tiles.record(slot.tile, is_whole);
            }
        }
        self.gather(tiles, found, pieces);
        merge_pieces(pieces, self.params.iou_threshold);
        boxes.boxes.clear();
        boxes.classes.clone_from(&self.classes);
        boxes.boxes.extend(pieces.drain(..).take(self.params.max_detections).map(|piece| piece.bounding_box));
        Ok(())
    }
}

impl TiledDetection {
    /// Returns the detections in a tile or in parts of several, each with the index of its part.
    fn look(&self, worker: usize, image: &Image, slots: &[Slot]) -> Result<Vec<(usize, Piece)>> {
        let Some(detector) = self.detectors.get(worker) else { return Ok(Vec::new()) };
        let Scratch { tile: picture, found } = &mut *self.scratch.take();
        let size = [image.width(), image.height()];
        let picture = match slots {
            [Slot { part, .. }] if [part.width, part.height] == size => image,
            [Slot { part, .. }] => picture.crop(image.view(), part)?,
            _ => picture.pack(image.view(), slots, self.params.tiling.tile)?,
        };
        detector.predict_into(picture, found)?;
        let pieces = found.boxes.drain(..).filter_map(|found| {
            if let [slot] = slots {
                return Some((0, Piece::new(found, &slot.part, size)));
            }
            let place = slots.iter().position(|slot| slot.contains(middle(&found)))?;
            let slot = slots.get(place)?;
            Some((place, Piece::new(slot.box_in_part(found), &slot.part, size)))
        });
        Ok(pieces.collect())
    }

    /// Collects the detections of all tiles that are valid for the current image.
    fn gather(&self, tiles: &Tiles, found: &[Vec<Piece>], pieces: &mut Vec<Piece>) {
        pieces.clear();
        for (index, found) in found.iter().enumerate() {
            if !tiles.is_valid(index, self.params.tiling.memory) {
                continue;
            }
            pieces.extend(
                found
                    .iter()
                    .filter(|piece| {
                        let one = &piece.bounding_box;
                        one.confidence >= self.params.threshold && !tiles.is_superseded(index, middle(one))
                    })
                    .cloned(),
            );
        }
    }
}

/// Returns the centre of a box.
fn middle(one: &BoundingBox) -> [f32; 2] {
    [one.left + one.width / 2.0, one.top + one.height / 2.0]
}
