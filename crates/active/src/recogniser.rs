//! Recognisers: class probabilities of one image.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::learner::Learner;

use crate::evidence::{ClassEvidence, logarithms};

/// A recogniser of one view.
pub trait ViewRecogniser: Send {
    /// Returns the number of classes.
    fn classes(&self) -> usize;

    /// Writes the logarithm of the probability of each class for an image, under equal prior probabilities.
    ///
    /// # Errors
    /// Returns errors of the network.
    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()>;
}

impl<R: ViewRecogniser + ?Sized> ViewRecogniser for Box<R> {
    fn classes(&self) -> usize {
        (**self).classes()
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        (**self).recognise(image, evidence)
    }
}

/// Any learner of the toolkit whose input is an image and whose target has classes, as a recogniser of views.
pub struct LearnerRecogniser<L: Learner> {
    learner: L,
    classes: usize,
    state: L::State,
    target: L::Target,
}

impl<L: Learner> LearnerRecogniser<L>
where
    L::Target: Default,
{
    /// Creates a recogniser of `classes` classes; class indices of the learner's targets start at 0.
    pub fn new(learner: L, classes: usize) -> Self {
        Self { learner, classes, state: L::State::default(), target: L::Target::default() }
    }

    /// Returns the learner.
    pub fn learner(&self) -> &L {
        &self.learner
    }

    /// Returns the prediction for the last image.
    pub fn target(&self) -> &L::Target {
        &self.target
    }
}

impl<L> ViewRecogniser for LearnerRecogniser<L>
where
    L: for<'a> Learner<Input<'a> = &'a Image>,
    L::Target: ClassEvidence + Default + Send,
{
    fn classes(&self) -> usize {
        self.classes
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        self.learner.infer_into(&mut self.state, image, &mut self.target)?;
        self.target.class_probabilities(evidence);
        logarithms(evidence);
        Ok(())
    }
}
