//! Scans of streets as a data set for detection.

use opendr_engine::data::{Calibration, PointCloud, PointCloudWithCalibration};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox3D, BoundingBox3DList, Classes};
use opendr_engine::{Error, Header, Random, Result};

use super::{Street, StreetKind, StreetObject};
use crate::lidar::{LidarReturn, SpinningLidar, SurfaceResponse};
use crate::raycast::{Hit, Scene, Vector};

/// Scans of random streets, each with the boxes of its cars, pedestrians and trucks.
///
/// A sample depends on the seed and its index only. The points are those in the camera's field of view, as KITTI annotates no others;
/// boxes have KITTI's annotations: box in the image, truncation, and occlusion measured by rays.
#[derive(Debug, Clone)]
pub struct StreetScans {
    seed: u64,
    count: usize,
    lidar: SpinningLidar,
    calibration: Calibration,
}

/// Height and width of KITTI's images.
const IMAGE_SHAPE: [usize; 2] = [375, 1242];
/// Half of the camera's horizontal field of view, in radians, with a small margin.
const HALF_VIEW: f32 = 0.76;
/// Minimum returns of an annotated object; those with fewer count as occluded.
const MIN_RETURNS: usize = 5;

impl StreetScans {
    /// Creates `count` scans of the streets of `seed`.
    pub fn new(seed: u64, count: usize) -> Self {
        let mut calibration = Calibration::nominal();
        // The offsets of KITTI's sensor rig.
        calibration.tr_velo_to_cam = [[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, -0.08], [1.0, 0.0, 0.0, -0.27]];
        Self { seed, count, lidar: SpinningLidar::hdl64e().with_half_view(HALF_VIEW), calibration }
    }

    /// Scans with another lidar.
    #[must_use]
    pub fn with_lidar(mut self, lidar: SpinningLidar) -> Self {
        self.lidar = lidar;
        self
    }

    /// Returns a street, its returns, and the returns as a point cloud.
    pub(super) fn scan(&self, index: usize) -> Result<(Street, Vec<LidarReturn>, PointCloudWithCalibration)> {
        if index >= self.count {
            return Err(Error::not_found(format!("no street {index}; the data set has {}", self.count)));
        }
        let mut random = Random::from_key([self.seed, index as u64]);
        let street = Street::new(&mut random)?;
        let header = Header::new(index as i64 + 1, "lidar");
        let (returns, cloud) = self.look(&street, header, &mut random)?;
        Ok((street, returns, cloud))
    }

    /// Returns the returns of a street, and the same as a point cloud.
    pub(super) fn look(
        &self,
        street: &Street,
        header: Header,
        random: &mut Random,
    ) -> Result<(Vec<LidarReturn>, PointCloudWithCalibration)> {
        let lost = random.uniform(0.0, 0.15);
        let returns = self.lidar.scan(&street.scene, random, |hit, place| {
            match street.objects.get(usize::from(hit.label)) {
                Some(object) => echo(object, hit, place, lost),
                None => SurfaceResponse { noise: 0.0, lost: 1.0, reflectance: 0.0 },
            }
        })?;
        let points: Vec<f32> = returns.iter().flat_map(|hit| hit.point).collect();
        let cloud = PointCloud::new(points, [returns.len(), 4])?.with_header(header);
        let cloud = PointCloudWithCalibration::new(cloud, self.calibration.clone(), Some(IMAGE_SHAPE));
        Ok((returns, cloud))
    }

    /// Returns the seed of the streets.
    pub(super) fn seed(&self) -> u64 {
        self.seed
    }

    /// Returns the boxes of the visible objects, each with the index of its object in the street.
    pub(super) fn boxes(
        &self,
        street: &Street,
        returns: &[LidarReturn],
    ) -> Result<Vec<(usize, BoundingBox3D)>> {
        let mut counts = vec![0_usize; street.objects.len()];
        for label in returns.iter().map(|hit| usize::from(hit.label)) {
            counts.get_mut(label).into_iter().for_each(|count| *count += 1);
        }
        let rays = self.lidar.directions(&mut Random::new(0))?;
        let mut boxes = Vec::new();
        for (label, object) in street.objects.iter().enumerate() {
            let Some(name) = name_of(object.kind) else { continue };
            let mut annotation = object.bounding_box.to_camera(&self.calibration, Some(IMAGE_SHAPE));
            // The object is outside the image or has no returns.
            if annotation.truncated >= 0.9 || counts[label] == 0 {
                continue;
            }
            annotation.name = name.into();
            annotation.confidence = 1.0;
            annotation.occluded = self.occlusion(street, label, counts[label], &rays)?;
            boxes.push((label, annotation));
        }
        Ok(boxes)
    }

    /// Returns the occlusion level, 0 to 3, from the fraction of the rays that would hit the object alone.
    fn occlusion(&self, street: &Street, label: usize, returns: usize, rays: &[Vector]) -> Result<i32> {
        let mut alone = Scene::default();
        let own = street.scene.bodies().iter().filter(|body| usize::from(body.label()) == label);
        own.for_each(|body| alone.add(body.clone()));
        let place = &street.objects[label].bounding_box;
        let [x, y] = [place.center[0], place.center[1]].map(|part| part as f32);
        let distance = x.hypot(y).max(0.1);
        // Tangent of half the angle it subtends, at most 45 degrees for near objects.
        let reach = (place.size[0].hypot(place.size[1]) / 2.0) as f32;
        let most = (reach / (distance - reach).max(0.1)).min(1.0);
        let [cos, sin] = [x / distance, y / distance];
        let is_near = |[dx, dy, _]: &Vector| (dy * cos - dx * sin).abs() <= most * (dx * cos + dy * sin);
        let rays: Vec<Vector> = rays.iter().copied().filter(is_near).collect();
        let mut hits = vec![None; rays.len()];
        alone.hits([0.0; 3], &rays, self.lidar.range, &mut hits)?;
        let all = hits.iter().flatten().count().max(1);
        // Some returns are lost in any case.
        let share = returns as f64 / all as f64 / 0.85;
        Ok(match share {
            _ if returns < MIN_RETURNS => 3,
            share if share > 0.75 => 0,
            share if share > 0.4 => 1,
            share if share > 0.12 => 2,
            _ => 3,
        })
    }
}

fn name_of(kind: StreetKind) -> Option<&'static str> {
    match kind {
        StreetKind::Car => Some("Car"),
        StreetKind::Pedestrian => Some("Pedestrian"),
        StreetKind::Truck => Some("Truck"),
        StreetKind::Structure | StreetKind::Vegetation | StreetKind::Ground => None,
    }
}

/// Returns the response of an object's surface.
fn echo(object: &StreetObject, hit: &Hit, [.., z]: Vector, lost: f32) -> SurfaceResponse {
    let [.., floor] = object.bounding_box.center;
    let height = (z - floor as f32) / object.bounding_box.size[2].max(0.1) as f32;
    // The upper part of a car, except its roof, is glass.
    let is_glass = object.kind == StreetKind::Car && height > 0.66 && hit.normal[2].abs() < 0.9;
    let noise = match object.kind {
        StreetKind::Vegetation => 0.2,
        _ => 0.02,
    };
    let far = hit.distance / 120.0;
    let lost = lost + if is_glass { 0.5 } else { 0.3 * far * far };
    SurfaceResponse { noise, lost, reflectance: object.reflectance }
}

impl Dataset for StreetScans {}

impl DatasetIterator for StreetScans {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (street, returns, cloud) = self.scan(index)?;
        let boxes: Vec<_> =
            self.boxes(&street, &returns)?.into_iter().map(|(_, annotation)| annotation).collect();
        let header = cloud.cloud.header.clone();
        let target = BoundingBox3DList { header, classes: self.classes(), ..boxes.into() };
        Ok(Sample { data: vec![cloud.into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["Car", "Pedestrian", "Truck"].into_iter().collect()
    }
}
