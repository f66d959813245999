//! Views of generated subjects as a data set.

use opendr_engine::data::Image;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Random, Result};

use super::{Asset, Conditions, SphereWorld, Subject};

/// Views of heads, objects or figures from a grid of azimuths around their front, with the class as target.
///
/// A sample depends on the seed and its index only. Light, background, elevation, distance and noise differ from view to view; nothing
/// stands between the camera and the front.
#[derive(Debug, Clone)]
pub struct SubjectViews {
    seed: u64,
    subject: Subject,
    classes: u32,
    count: usize,
    side: usize,
}

/// Views of a subject, one for each azimuth.
const VIEWS: usize = 13;
/// Largest azimuth from the front, rad.
const AROUND: f64 = 1.3;
/// Largest elevation, rad.
const ABOVE: f32 = 0.6;

impl SubjectViews {
    /// Creates `count` views with `side` x `side` pixels; `classes` is the number of persons for [`Subject::Face`], and has no
    /// effect on other subjects.
    ///
    /// # Errors
    /// `InvalidParam` for no class and for a side outside 16 to 2048 pixels.
    pub fn new(seed: u64, subject: Subject, classes: u32, count: usize, side: usize) -> Result<Self> {
        let classes = if subject == Subject::Face { classes } else { subject.classes() };
        if classes == 0 || !(16..=2048).contains(&side) {
            return Err(Error::invalid_param(format!(
                "{classes} classes in images of {side} pixels; give at least one class and 16 to 2048 pixels"
            )));
        }
        Ok(Self { seed, subject, classes, count, side })
    }

    /// Returns class, instance and number of the view of a sample: all views of a subject before those of the next.
    fn place(&self, index: usize) -> (u32, u64, usize) {
        let (subject, view) = (index / VIEWS, index % VIEWS);
        let class = subject % self.classes as usize;
        (class as u32, (subject / self.classes as usize) as u64, view)
    }
}

impl Dataset for SubjectViews {}

impl DatasetIterator for SubjectViews {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        if index >= self.count {
            return Err(Error::not_found(format!("no view {index}; the data set has {}", self.count)));
        }
        let (class, instance, view) = self.place(index);
        let mut random = Random::from_key([self.seed, index as u64, 0xface]);
        let azimuth = AROUND * (2.0 * view as f64 / (VIEWS - 1) as f64 - 1.0);
        let conditions = Conditions {
            azimuth,
            elevation: f64::from(random.uniform(-ABOVE, ABOVE)),
            distance: f64::from(random.uniform(2.7, 3.6)),
            tilt: 0.0,
            occluder: None,
            ..Conditions::draw(&mut random)
        };
        let mut world = SphereWorld::new(self.side)?;
        let asset = Asset::generate(self.subject, class, self.seed.wrapping_add(instance))?;
        world.begin(&asset, &conditions, self.seed ^ index as u64)?;
        let mut pixels = vec![0; 3 * self.side * self.side];
        world.capture_into(&mut pixels);
        let image = Image::from_rgb8(pixels, self.side, self.side)?;
        let target = Category::new(i64::from(class), Some(1.0));
        Ok(Sample { data: vec![image.into()], target: Some(target.into()) })
    }

    fn name(&self, index: usize) -> String {
        let (class, instance, view) = self.place(index);
        format!("{}_{class:03}_{instance:03}_{view:02}", self.subject.name())
    }

    fn image_size(&self, _index: usize) -> Option<[u32; 2]> {
        Some([self.side as u32; 2])
    }

    fn classes(&self) -> Classes {
        (0..self.classes).map(|class| format!("{}_{class:03}", self.subject.name())).collect()
    }
}
