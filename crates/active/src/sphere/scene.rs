//! Episodes around generated subjects.

use opendr_engine::data::Image;
use opendr_engine::rig::{ViewPose, ViewRig};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;
use opendr_simulation::sphere_view::{Conditions, SphereWorld};

use super::{Embedding, EmbeddingFit, SubjectPool};
use crate::recogniser::ViewRecogniser;
use crate::scene::ActiveScene;

/// A sphere camera around the subjects of a pool, with a network in the loop that was trained on static views.
#[derive(Debug, Clone)]
pub struct SphereScene {
    pool: SubjectPool,
    world: SphereWorld,
    image: Image,
    recogniser: EmbeddingRecogniser,
}

/// An embedding against directions of classes.
#[derive(Debug, Clone)]
struct EmbeddingRecogniser {
    embedding: Embedding,
    compute: Compute,
    directions: Vec<f32>,
    classes: usize,
}

impl ViewRecogniser for EmbeddingRecogniser {
    fn classes(&self) -> usize {
        self.classes
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        let embedded = self.embedding.embed(&self.compute, image)?;
        for (logit, direction) in evidence.iter_mut().zip(self.directions.chunks_exact(embedded.len())) {
            *logit = direction.iter().zip(embedded).map(|(a, b)| a * b).sum();
        }
        let highest = evidence.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let sum: f32 = evidence.iter().map(|logit| (logit - highest).exp()).sum();
        evidence.iter_mut().for_each(|logit| *logit -= highest + sum.ln());
        Ok(())
    }
}

impl SphereScene {
    /// A scene over a pool, with a recogniser of its classes.
    ///
    /// # Errors
    /// `InvalidInput` for a recogniser of another number of classes.
    pub fn new(pool: &SubjectPool, fit: &EmbeddingFit) -> Result<Self> {
        let classes = pool.subject.classes() as usize;
        let known = fit.directions.len() / fit.embedding.dimension();
        if known != classes {
            return Err(Error::invalid_input(format!(
                "a recogniser of {known} classes for {classes} of {}; train it on views of these",
                pool.subject.name()
            )));
        }
        let side = fit.embedding.side();
        Ok(Self {
            world: SphereWorld::new(side)?,
            image: Image::from_rgb8(vec![0; 3 * side * side], side, side)?,
            recogniser: EmbeddingRecogniser {
                directions: fit.directions.clone(),
                embedding: fit.embedding.clone(),
                compute: Compute::single(),
                classes,
            },
            pool: pool.clone(),
        })
    }

    /// The camera and its subject.
    pub fn world(&mut self) -> &mut SphereWorld {
        &mut self.world
    }

    /// The last picture.
    pub fn image(&self) -> &Image {
        &self.image
    }
}

impl ActiveScene for SphereScene {
    fn classes(&self) -> usize {
        self.recogniser.classes
    }

    fn begin(&mut self, random: &mut Random) -> Result<usize> {
        let class = random.below(self.recogniser.classes);
        let asset = class * self.pool.each + random.below(self.pool.each);
        let conditions = Conditions::draw(random);
        self.world.begin(&self.pool.assets[asset], &conditions, random.bits())?;
        Ok(class)
    }

    fn rig(&mut self) -> &mut dyn ViewRig {
        &mut self.world
    }

    fn view(&mut self, evidence: &mut [f32]) -> Result<&Image> {
        let pixels = self.image.bytes_mut();
        self.world.capture_into(pixels.ok_or_else(|| Error::internal("a picture that is not of bytes"))?);
        self.recogniser.recognise(&self.image, evidence)?;
        Ok(&self.image)
    }

    fn best_pose(&self) -> Option<ViewPose> {
        let azimuth = -self.world.conditions().azimuth;
        Some(ViewPose { azimuth, elevation: 0.1, distance: 2.7, fourth: 0.0 })
    }
}
