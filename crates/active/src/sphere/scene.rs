//! Episodes around generated subjects.

use opendr_engine::data::Image;
use opendr_engine::rig::{ViewPose, ViewRig};
use opendr_engine::{Random, Result};
use opendr_kernels::Compute;
use opendr_simulation::sphere_view::{Conditions, SphereWorld, Subject};

use super::pool::{blank, capture};
use super::{Embedding, Gallery, SubjectPool};
use crate::recogniser::ViewRecogniser;
use crate::scene::ActiveScene;

/// A sphere camera around the subjects of a pool, with an embedding network in the loop.
///
/// Of persons, each episode chooses as many at random as there are classes, and one of them stands in the middle.
#[derive(Debug, Clone)]
pub struct SphereScene {
    pool: SubjectPool,
    gallery: Gallery,
    world: SphereWorld,
    image: Image,
    recogniser: EmbeddingRecogniser,
    order: Vec<usize>,
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
    /// A scene over a pool, with a gallery that was enrolled by this embedding.
    ///
    /// # Errors
    /// None for an embedding that takes pictures.
    pub fn new(pool: &SubjectPool, embedding: &Embedding, gallery: &Gallery) -> Result<Self> {
        let classes = pool.subject.classes() as usize;
        let embedding = embedding.clone();
        Ok(Self {
            world: SphereWorld::new(embedding.side())?,
            image: blank(embedding.side())?,
            order: (0..pool.each).collect(),
            recogniser: EmbeddingRecogniser {
                directions: gallery.directions[..classes * gallery.dimension].to_vec(),
                embedding,
                compute: Compute::single(),
                classes,
            },
            gallery: gallery.clone(),
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
        let asset = match self.pool.subject {
            Subject::Face => {
                // The first of a shuffled order: Fisher and Yates, as far as it is needed.
                self.order.clear();
                self.order.extend(0..self.pool.each);
                let dimension = self.gallery.dimension;
                let places = self.recogniser.directions.chunks_exact_mut(dimension);
                for (at, place) in places.enumerate() {
                    let other = at + random.below(self.pool.each - at);
                    self.order.swap(at, other);
                    place.copy_from_slice(self.gallery.direction(self.order[at]));
                }
                self.order[class]
            }
            Subject::Object | Subject::Pose => class * self.pool.each + random.below(self.pool.each),
        };
        let conditions = Conditions::draw(random);
        self.world.begin(&self.pool.assets[asset], &conditions, random.bits())?;
        Ok(class)
    }

    fn rig(&mut self) -> &mut dyn ViewRig {
        &mut self.world
    }

    fn view(&mut self, evidence: &mut [f32]) -> Result<&Image> {
        capture(&mut self.world, &mut self.image)?;
        self.recogniser.recognise(&self.image, evidence)?;
        Ok(&self.image)
    }

    fn best_pose(&self) -> Option<ViewPose> {
        let azimuth = -self.world.conditions().azimuth;
        Some(ViewPose { azimuth, elevation: 0.1, distance: 2.7, fourth: 0.0 })
    }
}
