//! Objects of other scenes (ground-truth sampling; Yan et al., SECOND, 2018).

use opendr_engine::data::PointCloud;
use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox3D, BoundingBox3DList, Name};
use opendr_engine::{Error, Random, Result, Value};

use crate::augment::cloud::boxes::{contains, touch};
use crate::augment::cloud::frame::Frame;
use crate::augment::cloud::points::{change_points, cloud, cloud_mut, no_cloud};
use crate::augment::{Augment, Augmentation, Others};

/// Copies annotated objects with their points from other scenes to the places where they are there. Objects that would
/// stand in others are left out; points where an object comes to stand are removed.
#[derive(Debug, Clone, Params)]
pub struct PasteObjects {
    /// From how many other scenes.
    #[param(default = 2, range = 1..=100)]
    pub scenes: usize,
    /// At most this many objects of each.
    #[param(default = 10, range = 1..=1000)]
    pub most: usize,
    /// Objects of fewer points are left out.
    #[param(default = 5, range = 1..=100_000)]
    pub min_points: usize,
}

impl Augmentation for PasteObjects {
    const NAME: &'static str = "paste_objects";
    const ABOUT: &'static str = "puts objects of other point clouds into a scene";
}

impl Augment for PasteObjects {
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &Others<'_>) -> Result<()> {
        for _ in 0..self.scenes {
            let other = others.pick(random)?;
            let (from, _, boxes) = scene(&other)?;
            let mut order: Vec<usize> = (0..boxes.boxes.len()).collect();
            random.shuffle(&mut order);
            let candidates = order
                .into_iter()
                .filter_map(|index| boxes.boxes.get(index))
                .filter(|found| is_object(boxes, found));
            for found in candidates.take(self.most) {
                self.paste(sample, found, boxes, from, Frame::of(&other.data[0])?)?;
            }
        }
        Ok(())
    }
}

impl PasteObjects {
    fn paste(
        &self,
        sample: &mut Sample,
        found: &BoundingBox3D,
        boxes: &BoundingBox3DList,
        from: &PointCloud,
        from_frame: Frame,
    ) -> Result<()> {
        let (into, frame, there) = scene(sample)?;
        if into.channels() != from.channels() {
            return Err(Error::invalid_input(format!(
                "points of {} channels do not go among points of {}; bring the clouds to one form first",
                from.channels(),
                into.channels()
            )));
        }
        if there.boxes.iter().any(|other| is_object(there, other) && touch(other, found)) {
            return Ok(());
        }
        let place =
            |point: &[f32]| from_frame.camera_from_lidar([point[0], point[1], point[2]].map(f64::from));
        let mut points = Vec::new();
        for point in from.points().filter(|point| contains(found, place(point))) {
            points.extend(frame.lidar_from_camera(place(point)).map(|part| part as f32));
            points.extend_from_slice(&point[3..]);
        }
        let channels = into.channels();
        if points.len() < self.min_points * channels {
            return Ok(());
        }
        let label = boxes.classes.label(&found.name).map_or_else(|| found.name.clone(), Name::from);
        let number = boxes.classes == there.classes;
        if let (Some(Value::BoundingBox3DList(list)), Some(cloud)) =
            (&mut sample.target, sample.data.first_mut().and_then(cloud_mut))
        {
            let name = if number { found.name.clone() } else { label };
            list.boxes.push(BoundingBox3D { name, ..found.clone() });
            change_points(cloud, |data| {
                remove_inside(data, channels, found, &frame);
                data.extend_from_slice(&points);
            })?;
        }
        Ok(())
    }
}

/// Cloud, frame and boxes of a sample.
fn scene(sample: &Sample) -> Result<(&PointCloud, Frame, &BoundingBox3DList)> {
    match (&sample.data[..], &sample.target) {
        ([datum], Some(Value::BoundingBox3DList(boxes))) => match cloud(datum) {
            Some(cloud) => Ok((cloud, Frame::of(datum)?, boxes)),
            None => Err(no_cloud(sample)),
        },
        _ => Err(Error::unsupported(
            "objects are copied between samples of one cloud with a BoundingBox3DList; leave the augmentation out",
        )),
    }
}

/// Regions that KITTI excludes are annotated like objects, but have no place.
fn is_object(boxes: &BoundingBox3DList, found: &BoundingBox3D) -> bool {
    boxes.classes.label(&found.name) != Some("DontCare") && found.dimensions.iter().all(|side| *side > 0.0)
}

fn remove_inside(data: &mut Vec<f32>, channels: usize, found: &BoundingBox3D, frame: &Frame) {
    let mut kept = 0;
    for point in 0..data.len() / channels {
        let at = point * channels;
        let place = frame.camera_from_lidar([data[at], data[at + 1], data[at + 2]].map(f64::from));
        if !contains(found, place) {
            data.copy_within(at..at + channels, kept * channels);
            kept += 1;
        }
    }
    data.truncate(kept * channels);
}
