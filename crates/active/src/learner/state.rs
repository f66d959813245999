//! The state of a stream of active perception.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::rig::{ViewPose, ViewSphere};
use opendr_engine::target::Action;

use super::ActiveContainer;
use crate::recogniser::ViewRecogniser as _;
use crate::session::{ActiveSession, Decision};
use crate::stop::StopRule;
use crate::view_classifier::ViewClassifier;

/// Belief, pose and work memory of one stream.
#[derive(Debug, Default)]
pub struct ActiveState(Option<Box<Running>>);

#[derive(Debug)]
struct Running {
    session: ActiveSession,
    recogniser: ViewClassifier,
    evidence: Vec<f32>,
    /// Position on the axes, by the motions so far.
    sphere: ViewSphere,
    /// The motion that was proposed last; `None` before the first view of a subject.
    proposed: Option<Action>,
}

impl ActiveState {
    /// Adds a view, and writes the probability of each class.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an image that is not RGB of 8 bits.
    pub(super) fn add(
        &mut self,
        container: &ActiveContainer,
        image: &Image,
        pose: Option<ViewPose>,
        stop: &StopRule,
        probabilities: &mut Vec<f32>,
    ) -> Result<Decision> {
        let running = match &mut self.0 {
            Some(running) => running,
            none => none.insert(Box::new(Running::new(container)?)),
        };
        running.recogniser.recognise(image, &mut running.evidence)?;
        let Running { session, evidence, sphere, proposed, .. } = &mut **running;
        match proposed {
            Some(action) => {
                let mut achieved = sphere.apply(action)?;
                achieved.pose = pose.unwrap_or(achieved.pose);
                session.set_motion(achieved);
            }
            None => session.begin(pose.unwrap_or_else(|| sphere.pose())),
        }
        if let Some(pose) = pose {
            sphere.place(pose)?;
        }
        let decision = session.add(image, pose.unwrap_or_else(|| sphere.pose()), evidence, stop)?;
        *proposed = decision.action;
        probabilities.clear();
        probabilities.extend_from_slice(session.belief().probabilities());
        Ok(decision)
    }
}

impl Running {
    fn new(container: &ActiveContainer) -> Result<Self> {
        let classes = container.recogniser.config().classes;
        let axes = container.model.axes.clone();
        let distance = axes.get(2).map_or(1.0, |axis| 0.5 * (axis.low + axis.high));
        Ok(Self {
            session: ActiveSession::new(&container.model, classes)?,
            recogniser: container.recogniser.clone(),
            evidence: vec![0.0; classes],
            sphere: ViewSphere::new(axes, ViewPose { distance, ..ViewPose::default() })?,
            proposed: None,
        })
    }
}
