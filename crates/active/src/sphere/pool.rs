//! Subjects that episodes choose from, and what a recogniser knows of them.

use std::sync::Arc;

use opendr_engine::data::Image;
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;
use opendr_simulation::sphere_view::{Asset, Conditions, SphereWorld, Subject};

use super::EmbeddingFit;

/// Generated subjects: persons, or some instances of every class.
#[derive(Debug, Clone)]
pub struct SubjectPool {
    /// What they are.
    pub subject: Subject,
    /// Persons one after the other, or the instances of class 0, of class 1, and so on.
    pub assets: Arc<Vec<Asset>>,
    /// Persons, or instances of each class.
    pub each: usize,
}

impl SubjectPool {
    /// Persons from number `first` on, or instances from number `first` on of every class.
    ///
    /// # Errors
    /// `InvalidParam` for fewer persons than an episode decides between, or no instance.
    pub fn generate(subject: Subject, first: u32, each: usize) -> Result<Self> {
        let fewest = if subject == Subject::Face { subject.classes() as usize } else { 1 };
        if each < fewest {
            return Err(Error::invalid_param(format!(
                "{each} subjects to choose from; give at least {fewest}"
            )));
        }
        let assets: Vec<_> = match subject {
            Subject::Face => (0..each as u32).map(|at| Asset::generate(subject, first + at, 0)).collect(),
            Subject::Object | Subject::Pose => (0..subject.classes())
                .flat_map(|class| (0..each as u64).map(move |at| (class, u64::from(first) + at)))
                .map(|(class, instance)| Asset::generate(subject, class, instance))
                .collect(),
        };
        Ok(Self { subject, assets: Arc::new(assets.into_iter().collect::<Result<_>>()?), each })
    }
}

/// Directions of embeddings, length 1: of each person of a pool, or of each class.
#[derive(Debug, Clone)]
pub struct Gallery {
    pub(super) directions: Arc<Vec<f32>>,
    pub(super) dimension: usize,
}

/// Pictures of a person that is enrolled.
const ENROLLED: usize = 8;

impl Gallery {
    /// What a fitted recogniser knows of the subjects of a pool. Persons are enrolled from eight pictures from the front, near and
    /// without an occluder; classes of objects and poses are those of the training.
    ///
    /// # Errors
    /// `InvalidInput` for a recogniser of other classes.
    pub fn enrol(pool: &SubjectPool, fit: &EmbeddingFit, compute: &Compute) -> Result<Self> {
        let dimension = fit.embedding.dimension();
        if pool.subject != Subject::Face {
            let (known, classes) = (fit.directions.len() / dimension, pool.subject.classes() as usize);
            if known != classes {
                return Err(Error::invalid_input(format!(
                    "a recogniser of {known} classes for {classes} of {}; train it on views of these",
                    pool.subject.name()
                )));
            }
            return Ok(Self { directions: Arc::new(fit.directions.clone()), dimension });
        }
        let mut embedding = fit.embedding.clone();
        let mut world = SphereWorld::new(embedding.side())?;
        let mut image = blank(embedding.side())?;
        let mut directions = Vec::with_capacity(pool.assets.len() * dimension);
        for (person, asset) in pool.assets.iter().enumerate() {
            let mut mean = vec![0.0; dimension];
            let mut random = Random::at([person as u64, 0xe4]);
            for _ in 0..ENROLLED {
                let drawn = Conditions::draw(&mut random);
                let azimuth = f64::from(random.uniform(-0.5, 0.5));
                let distance = f64::from(random.uniform(2.7, 3.3));
                let conditions = Conditions { azimuth, distance, occluder: None, ..drawn };
                world.begin(asset, &conditions, random.bits())?;
                capture(&mut world, &mut image)?;
                mean.iter_mut().zip(embedding.embed(compute, &image)?).for_each(|(sum, part)| *sum += part);
            }
            normalise(&mut mean);
            directions.extend(mean);
        }
        Ok(Self { directions: Arc::new(directions), dimension })
    }

    pub(super) fn direction(&self, at: usize) -> &[f32] {
        &self.directions[at * self.dimension..(at + 1) * self.dimension]
    }
}

/// Scales to length 1 and returns the length it had; of zeros nothing is made.
pub(super) fn normalise(direction: &mut [f32]) -> f32 {
    let length = direction.iter().map(|part| part * part).sum::<f32>().sqrt().max(1e-12);
    direction.iter_mut().for_each(|part| *part /= length);
    length
}

/// A black picture, to be captured into.
pub(super) fn blank(side: usize) -> Result<Image> {
    Image::from_rgb8(vec![0; 3 * side * side], side, side)
}

/// Takes a picture into an image of the world's size.
pub(super) fn capture(world: &mut SphereWorld, image: &mut Image) -> Result<()> {
    let pixels = image.bytes_mut().ok_or_else(|| Error::internal("a picture that is not of bytes"))?;
    world.capture_into(pixels);
    Ok(())
}
