//! Drives through streets as a data set for tracking.

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Classes, TrackingAnnotation3D, TrackingAnnotation3DList};
use opendr_engine::{Error, Header, Random, Result};

use super::motion::Motion;
use super::{Street, StreetScans};
use crate::lidar::SpinningLidar;

/// Drives through the streets of [`StreetScans`] with moving cars, trucks and pedestrians; each frame has the boxes of its objects
/// and their track ids.
///
/// A frame depends on the seed and its index only; there are ten frames per second.
#[derive(Debug, Clone)]
pub struct StreetDrives {
    scans: StreetScans,
    drives: usize,
    frames: usize,
}

const FRAMES_PER_SECOND: f64 = 10.0;

impl StreetDrives {
    /// Creates `drives` drives of `frames` frames through the streets of `seed`.
    pub fn new(seed: u64, drives: usize, frames: usize) -> Self {
        Self { scans: StreetScans::new(seed, drives), drives, frames }
    }

    /// Scans with another lidar.
    #[must_use]
    pub fn with_lidar(mut self, lidar: SpinningLidar) -> Self {
        self.scans = self.scans.with_lidar(lidar);
        self
    }
}

impl Dataset for StreetDrives {}

impl DatasetIterator for StreetDrives {
    fn len(&self) -> usize {
        self.drives * self.frames
    }

    fn get(&self, index: usize) -> Result<Sample> {
        if index >= self.len() {
            return Err(Error::not_found(format!("no frame {index}; the data set has {}", self.len())));
        }
        let (drive, frame) = (index / self.frames, index % self.frames);
        let mut random = Random::from_key([self.scans.seed(), drive as u64]);
        let street = Street::new(&mut random)?;
        let motion = Motion::new(&street, self.frames as f64 / FRAMES_PER_SECOND, &mut random);
        let time = frame as f64 / FRAMES_PER_SECOND;
        let street = motion.street_at(&street, time)?;
        let header = Header::new((time * 1e9) as i64, "lidar");
        let mut random = Random::from_key([self.scans.seed(), drive as u64, frame as u64]);
        let (returns, cloud) = self.scans.look(&street, header.clone(), &mut random)?;
        let boxes = self.scans.boxes(&street, &returns)?.into_iter();
        let annotations: Vec<_> = boxes
            .map(|(number, bounding_box_3d)| TrackingAnnotation3D {
                bounding_box_3d,
                id: number as i64,
                frame: Some(frame as i64),
            })
            .collect();
        let target = TrackingAnnotation3DList { header, classes: self.classes(), ..annotations.into() };
        Ok(Sample { data: vec![cloud.into()], target: Some(target.into()) })
    }

    fn sequence(&self, index: usize) -> Option<usize> {
        Some(index / self.frames.max(1))
    }

    fn classes(&self) -> Classes {
        self.scans.classes()
    }
}
