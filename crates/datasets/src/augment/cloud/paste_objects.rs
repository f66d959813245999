//! Objects of other scenes (ground-truth sampling; Yan et al., SECOND, 2018).

use opendr_engine::data::PointCloud;
use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox3D, BoundingBox3DList, Name};
use opendr_engine::{Error, Random, Result, Value};

use crate::augment::cloud::boxes::{contains, touch};
use crate::augment::cloud::frame::Frame;
use crate::augment::cloud::points::{change_points, cloud, cloud_mut, no_cloud};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Copies annotated objects with their points from other scenes, at their original location. Objects that would
/// overlap existing ones are skipped; existing points inside a pasted box are removed.
#[derive(Debug, Clone, Params)]
pub struct PasteObjects {
    /// Number of other scenes.
    #[param(default = 2, range = 1..=100)]
    pub scenes: usize,
    /// Largest number of objects from each scene.
    #[param(default = 10, range = 1..=1000, former = "most")]
    pub max_objects: usize,
    /// Smallest number of points of a pasted object.
    #[param(default = 5, range = 1..=100_000)]
    pub min_points: usize,
}

impl Augmentation for PasteObjects {
    const NAME: &'static str = "paste_objects";
    const ABOUT: &'static str = "pastes objects of other point clouds into a scene";
}

impl Augment for PasteObjects {
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &OtherSamples<'_>) -> Result<()> {
        for _ in 0..self.scenes {
            let other = others.pick(random)?;
            let (from, _, boxes) = scene(&other)?;
            let mut order: Vec<usize> = (0..boxes.boxes.len()).collect();
            random.shuffle(&mut order);
            let candidates = order
                .into_iter()
                .filter_map(|index| boxes.boxes.get(index))
                .filter(|object| is_object(boxes, object));
            for object in candidates.take(self.max_objects) {
                self.paste(sample, object, boxes, from, Frame::of(&other.data[0])?)?;
            }
        }
        Ok(())
    }
}

impl PasteObjects {
    fn paste(
        &self,
        sample: &mut Sample,
        object: &BoundingBox3D,
        boxes: &BoundingBox3DList,
        from: &PointCloud,
        from_frame: Frame,
    ) -> Result<()> {
        let (into, frame, there) = scene(sample)?;
        if into.channels() != from.channels() {
            return Err(Error::invalid_input(format!(
                "clouds with {} and {} channels cannot be combined; convert them to the same channels first",
                from.channels(),
                into.channels()
            )));
        }
        if there.boxes.iter().any(|other| is_object(there, other) && touch(other, object)) {
            return Ok(());
        }
        let in_camera =
            |point: &[f32]| from_frame.camera_from_lidar([point[0], point[1], point[2]].map(f64::from));
        let mut points = Vec::new();
        for point in from.points().filter(|point| contains(object, in_camera(point))) {
            points.extend(frame.lidar_from_camera(in_camera(point)).map(|part| part as f32));
            points.extend_from_slice(&point[3..]);
        }
        let channels = into.channels();
        if points.len() < self.min_points * channels {
            return Ok(());
        }
        let label = boxes.classes.label(&object.name).map_or_else(|| object.name.clone(), Name::from);
        let has_same_classes = boxes.classes == there.classes;
        if let (Some(Value::BoundingBox3DList(list)), Some(cloud)) =
            (&mut sample.target, sample.data.first_mut().and_then(cloud_mut))
        {
            let name = if has_same_classes { object.name.clone() } else { label };
            list.boxes.push(BoundingBox3D { name, ..object.clone() });
            change_points(cloud, |data| {
                remove_inside(data, channels, object, &frame);
                data.extend_from_slice(&points);
            })?;
        }
        Ok(())
    }
}

/// Returns the cloud, transform and boxes of a sample.
fn scene(sample: &Sample) -> Result<(&PointCloud, Frame, &BoundingBox3DList)> {
    match (&sample.data[..], &sample.target) {
        ([datum], Some(Value::BoundingBox3DList(boxes))) => match cloud(datum) {
            Some(cloud) => Ok((cloud, Frame::of(datum)?, boxes)),
            None => Err(no_cloud(sample)),
        },
        _ => Err(Error::unsupported(
            "objects are pasted between samples of one cloud with a BoundingBox3DList only; remove the augmentation",
        )),
    }
}

/// KITTI annotates excluded regions like objects, but without a location.
fn is_object(boxes: &BoundingBox3DList, object: &BoundingBox3D) -> bool {
    boxes.classes.label(&object.name) != Some("DontCare") && object.dimensions.iter().all(|side| *side > 0.0)
}

fn remove_inside(data: &mut Vec<f32>, channels: usize, object: &BoundingBox3D, frame: &Frame) {
    let mut kept = 0;
    for point in 0..data.len() / channels {
        let at = point * channels;
        let place = frame.camera_from_lidar([data[at], data[at + 1], data[at + 2]].map(f64::from));
        if !contains(object, place) {
            data.copy_within(at..at + channels, kept * channels);
            kept += 1;
        }
    }
    data.truncate(kept * channels);
}
