//! Batches of scans with boxes.

use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::target::{BoundingBox3DList, Classes, LidarBox, Name};
use opendr_engine::{Error, Result, Value};

use super::coding::offsets_from_box;
use super::layout::PillarLayout;
use super::matching::{AnchorTarget, GroundTruth, assign_anchors};
use super::scan::Scan;
use crate::pillars::Voxeliser;

/// Collates [`PillarBatch`].
#[derive(Debug)]
pub struct PillarBatches {
    /// Grid and anchors.
    pub layout: PillarLayout,
    /// Classes of the network.
    pub classes: Classes,
}

/// Scans with the training targets of their anchors; anchors are indexed over the batch.
#[derive(Debug, Default)]
pub struct PillarBatch {
    /// Number of scans.
    pub scans: usize,
    /// Features of all points.
    pub points: Vec<f32>,
    /// Pillar index of every point.
    pub pillars: Vec<u32>,
    /// Cell of every pillar, indexed over the batch.
    pub cells: Vec<i64>,
    /// Statistics of every pillar, from the voxeliser.
    pub statistics: Vec<f32>,
    /// Anchors with an object.
    pub objects: Vec<i64>,
    /// Offsets of these anchors, seven each.
    pub offsets: Vec<f32>,
    /// Directions of these anchors: 1 for backward, 0 for forward.
    pub backs: Vec<f32>,
    /// Weight of each anchor in the loss: 1, or 0 for ignored.
    pub counts: Vec<f32>,
}

/// KITTI's occlusion level "unknown"; such objects are ignored.
const HIDDEN: i32 = 3;

impl PillarBatches {
    fn ground_truths(&self, list: &BoundingBox3DList, scan: &Scan<'_>) -> Vec<GroundTruth> {
        let ground_truths = list.boxes.iter().filter_map(|found| {
            let class = match (list.classes.label(&found.name), &found.name) {
                (Some(label), _) => self.classes.index(label),
                (None, Name::Label(label)) => self.classes.index(label),
                (None, Name::Index(index)) => Some(*index).filter(|index| *index < self.classes.len() as i64),
            };
            let class = usize::try_from(class?).ok()?;
            let place = LidarBox::from_camera(found, scan.calibration())?;
            let is_box = place.size.iter().all(|side| (0.05..100.0).contains(side));
            let [x, y, _] = place.center;
            let grid = &self.layout.grid;
            let is_within = (f64::from(grid.x[0])..f64::from(grid.x[1])).contains(&x)
                && (f64::from(grid.y[0])..f64::from(grid.y[1])).contains(&y);
            let class = (is_within && found.occluded < HIDDEN).then_some(class);
            is_box.then_some(GroundTruth { place, class })
        });
        ground_truths.collect()
    }

    fn add_targets(&self, batch: &mut PillarBatch, ground_truths: &[GroundTruth]) {
        let first = batch.counts.len();
        let [columns, rows] = self.layout.maps();
        for (at, wanted) in assign_anchors(&self.layout, ground_truths).into_iter().enumerate() {
            batch.counts.push(if wanted == AnchorTarget::Ignored { 0.0 } else { 1.0 });
            let AnchorTarget::Object(object) = wanted else { continue };
            let (kind, cell) = (at / (columns * rows), at % (columns * rows));
            let middle = self.layout.middle(cell % columns, cell / columns);
            let anchor = self.layout.anchors[kind].at(middle);
            let (offsets, back) = offsets_from_box(&ground_truths[object].place, &anchor);
            batch.objects.push((first + at) as i64);
            batch.offsets.extend(offsets);
            batch.backs.push(back);
        }
    }
}

impl Collate for PillarBatches {
    type Batch = PillarBatch;

    fn start(&self, _: usize) -> PillarBatch {
        PillarBatch::default()
    }

    fn add(&self, batch: &mut PillarBatch, sample: Sample) -> Result<()> {
        let scan = match sample.data.first() {
            Some(Value::PointCloud(cloud)) => Scan::from(cloud),
            Some(Value::PointCloudWithCalibration(scan)) => Scan::from(scan),
            _ => return Err(no_scan()),
        };
        let Some(Value::BoundingBox3DList(list)) = &sample.target else { return Err(no_scan()) };
        let grid = &self.layout.grid;
        let mut voxeliser = Voxeliser::default();
        voxeliser.begin(grid);
        let first = batch.cells.len() as u32;
        for point in scan.cloud().points() {
            if let Some(point) = voxeliser.add(grid, point) {
                batch.points.extend(point.features);
                batch.pillars.push(first + point.pillar);
            }
        }
        let before = batch.scans * grid.cells();
        batch.cells.extend(voxeliser.cells().iter().map(|cell| (before + *cell as usize) as i64));
        batch.statistics.extend(voxeliser.statistics().flatten());
        batch.scans += 1;
        self.add_targets(batch, &self.ground_truths(list, &scan));
        Ok(())
    }
}

fn no_scan() -> Error {
    Error::invalid_input(
        "the sample has no point cloud with 3D boxes; open the data set with 3D boxes as targets",
    )
}
