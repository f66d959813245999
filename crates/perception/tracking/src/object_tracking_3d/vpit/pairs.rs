//! Pairs of scans of the same objects, a few steps apart, and their batches.

use opendr_clouds::object_detection_3d::Scan;
use opendr_datasets::loader::Collate;
use opendr_engine::data::PointCloud;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox3D, Classes, LidarBox, TrackingAnnotation3DList};
use opendr_engine::{Error, Random, Result, Value};

use super::layout::{PLACES, TEMPLATE, VpitLayout};
use super::view::{VIEW_LEN, ViewPainter};

/// Each sample of a data set of recordings, with a later one of its recording.
pub(super) struct Pairs<'a> {
    pub dataset: &'a dyn DatasetIterator,
    /// Maximum number of steps between the two.
    pub apart: usize,
    pub seed: u64,
}

impl Dataset for Pairs<'_> {}

impl DatasetIterator for Pairs<'_> {
    fn len(&self) -> usize {
        self.dataset.len()
    }

    /// Returns data and annotation of the first and data of the second as data, and the annotation of the second.
    fn get(&self, index: usize) -> Result<Sample> {
        let later = index + 1 + Random::from_key([self.seed, index as u64]).below(self.apart);
        let sequence = self.dataset.sequence(index);
        let is_same = |other: &usize| {
            *other < self.len() && sequence.is_some() && self.dataset.sequence(*other) == sequence
        };
        // The last one of a recording is paired with itself, from another view.
        let later = (index + 1..=later).rev().find(is_same).unwrap_or(index);
        let (first, second) = (self.dataset.get(index)?, self.dataset.get(later)?);
        let mut data = first.data;
        data.truncate(1);
        data.extend(first.target);
        data.extend(second.data.into_iter().next());
        Ok(Sample { data, target: second.target })
    }

    fn name(&self, index: usize) -> String {
        self.dataset.name(index)
    }

    fn sequence(&self, index: usize) -> Option<usize> {
        self.dataset.sequence(index)
    }

    fn classes(&self) -> Classes {
        self.dataset.classes()
    }
}

/// Collates pairs of scans into pairs of views.
#[derive(Debug)]
pub struct VpitBatches {
    /// Sizes of a view.
    pub layout: VpitLayout,
    /// Margin around an object, in its mean sides.
    pub context: f64,
    /// Maximum number of objects per pair of scans.
    pub objects: usize,
    /// Whether the views of the second scan are shifted and rotated at random.
    pub augment: bool,
}

/// Pairs of views of the same object.
#[derive(Debug, Default)]
pub struct VpitBatch {
    /// Number of pairs.
    pub pairs: usize,
    /// Views of the objects in the first scan.
    pub templates: Vec<f32>,
    /// Weights of the cells of each template, of sum 1.
    pub shares: Vec<f32>,
    /// Views around the objects in the second scan.
    pub views: Vec<f32>,
    /// Label of each position of these, 0..=1.
    pub labels: Vec<f32>,
    /// Weight of each position, of sum 1 per pair.
    pub weights: Vec<f32>,
}

/// Minimum number of points within an object.
const LEAST_POINTS: usize = 12;
/// KITTI's occlusion value of unknown visibility.
const HIDDEN: i32 = 3;
/// Standard deviation of labels over positions, in cells.
const SPREAD: f64 = 0.8;
/// Standard deviation of labels over rotations, in radians.
const TURN_SPREAD: f64 = 0.12;
/// Maximum shift of views, in metres, and maximum rotation, in radians.
const BESIDE: f32 = 2.4;
const TURNED: f32 = 0.35;

/// Returns the number of points in a box, without those near the ground.
fn points_in(cloud: &PointCloud, place: &LidarBox) -> usize {
    let (sin, cos) = place.yaw.sin_cos();
    let half = place.size.map(|side| side / 2.0);
    let inside = cloud.points().filter(|point| {
        let [x, y, z, ..] = **point else { return false };
        let [x, y, z] = [(x, 0), (y, 1), (z, 2)].map(|(part, axis)| f64::from(part) - place.center[axis]);
        (cos * x + sin * y).abs() < half[0]
            && (cos * y - sin * x).abs() < half[1]
            && (0.2..place.size[2]).contains(&z)
    });
    inside.count()
}

impl VpitBatches {
    fn add_pair(
        &self,
        batch: &mut VpitBatch,
        random: &mut Random,
        painter: &mut ViewPainter,
        clouds: [&PointCloud; 2],
        [first, second]: [&LidarBox; 2],
    ) {
        let (layout, begin) = (&self.layout, batch.pairs * VIEW_LEN);
        batch.templates.resize(begin + VIEW_LEN, 0.0);
        painter.gather(layout, clouds[0], first.center);
        painter.paint(layout, first.yaw, &mut batch.templates[begin..]);
        let mut beside = |most: f32| match self.augment {
            // Small errors are the most frequent in tracking.
            true if random.chance(0.5) => f64::from(most) * 0.2 * random.normal(),
            true => f64::from(random.uniform(-most, most)),
            false => 0.0,
        };
        let (ahead, aside, turn) = (beside(BESIDE), beside(BESIDE), beside(TURNED));
        let rise = beside(0.2);
        let yaw = second.yaw + turn;
        let (sin, cos) = yaw.sin_cos();
        let [x, y, z] = second.center;
        // The object is at (`ahead`, `aside`) in the view's frame.
        let middle = [x - (cos * ahead - sin * aside), y - (sin * ahead + cos * aside), z + rise];
        batch.views.resize(begin + VIEW_LEN, 0.0);
        painter.gather(layout, clouds[1], middle);
        painter.paint(layout, yaw, &mut batch.views[begin..]);
        let covered: Vec<_> = layout.covered([first.size[0], first.size[1]], self.context).collect();
        let at = batch.shares.len();
        batch.shares.resize(at + TEMPLATE * TEMPLATE, 0.0);
        for [row, column] in &covered {
            batch.shares[at + row * TEMPLATE + column] = 1.0 / covered.len() as f32;
        }
        self.add_labels(batch, [ahead, aside].map(|way| way / f64::from(layout.cell())), turn);
        batch.pairs += 1;
    }

    /// Adds labels and weights; positive and negative positions have the same total weight.
    fn add_labels(&self, batch: &mut VpitBatch, [ahead, aside]: [f64; 2], turn: f64) {
        let begin = batch.labels.len();
        let turned = (turn / TURN_SPREAD).powi(2);
        for place in 0..PLACES * PLACES {
            let away = |at: usize, way: f64| ((at as f64 - (PLACES / 2) as f64 - way) / SPREAD).powi(2);
            let squares = away(place % PLACES, ahead) + away(place / PLACES, aside) + turned;
            batch.labels.push((-0.5 * squares).exp() as f32);
        }
        let labels = &batch.labels[begin..];
        let right: f32 = labels.iter().sum();
        let wrong = labels.len() as f32 - right;
        let of = |label: f32| 0.5 * label / right.max(1.0) + 0.5 * (1.0 - label) / wrong;
        batch.weights.extend(labels.iter().map(|label| of(*label)));
    }
}

fn known(track: &BoundingBox3D, scan: &Scan<'_>) -> Option<LidarBox> {
    let place = LidarBox::from_camera(track, scan.calibration()).filter(|_| track.occluded < HIDDEN)?;
    let is_box = place.size.iter().all(|side| (0.05..50.0).contains(side));
    (is_box && points_in(scan.cloud(), &place) >= LEAST_POINTS).then_some(place)
}

impl Collate for VpitBatches {
    type Batch = VpitBatch;

    fn start(&self, _: usize) -> VpitBatch {
        VpitBatch::default()
    }

    fn add(&self, batch: &mut VpitBatch, sample: Sample) -> Result<()> {
        let (
            [one, Value::TrackingAnnotation3DList(before), other],
            Some(Value::TrackingAnnotation3DList(after)),
        ) = (&sample.data[..], &sample.target)
        else {
            return Err(no_pair());
        };
        let scans = [scan_of(one)?, scan_of(other)?];
        let of = |tracks: &TrackingAnnotation3DList, id: i64| {
            tracks.annotations.iter().find(|track| track.id == id).map(|track| track.bounding_box_3d.clone())
        };
        let stamp = before.header.stamp_ns.unwrap_or_default() as u64;
        let mut random = Random::from_key([stamp, scans[0].cloud().len() as u64]);
        let mut ids: Vec<i64> =
            before.annotations.iter().map(|track| track.id).filter(|id| *id >= 0).collect();
        random.shuffle(&mut ids);
        let mut painter = ViewPainter::default();
        let mut left = self.objects;
        for id in ids {
            let places = [of(before, id), of(after, id)];
            let [Some(first), Some(second)] = places else { continue };
            let (Some(first), Some(second)) = (known(&first, &scans[0]), known(&second, &scans[1])) else {
                continue;
            };
            let clouds = [scans[0].cloud(), scans[1].cloud()];
            self.add_pair(batch, &mut random, &mut painter, clouds, [&first, &second]);
            left -= 1;
            if left == 0 {
                break;
            }
        }
        Ok(())
    }
}

fn scan_of(value: &Value) -> Result<Scan<'_>> {
    match value {
        Value::PointCloud(cloud) => Ok(Scan::from(cloud)),
        Value::PointCloudWithCalibration(scan) => Ok(Scan::from(scan)),
        _ => Err(no_pair()),
    }
}

fn no_pair() -> Error {
    Error::invalid_input(
        "VPIT trains on recordings of point clouds with 3D boxes with identities; open such a data set \
         (kitti_tracking)",
    )
}
