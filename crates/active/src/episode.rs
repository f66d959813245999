//! Episodes from the first view to the stop.

use opendr_engine::target::Action;
use opendr_engine::{Random, Result};

use crate::calibration::Trajectory;
use crate::camera_policy::{CameraContext, CameraPolicy};
use crate::gain::GainSamples;
use crate::observation::Observer;
use crate::scene::ActiveScene;
use crate::stop::StopRule;
use crate::view_loop::ViewLoop;

/// Key of the random numbers of episodes, beside their seed.
pub(crate) const EPISODE_KEY: u64 = 0xe415;

/// The result of an episode.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveEpisode {
    /// Seed of the episode.
    pub seed: u64,
    /// The most likely class at the end.
    pub predicted: usize,
    /// Its probability.
    pub confidence: f32,
    /// The best probability after each view.
    pub confidences: Vec<f32>,
    /// The views with their evidence, and the true class.
    pub trajectory: Trajectory,
}

impl ActiveEpisode {
    /// Returns whether the prediction is the true class.
    pub fn is_correct(&self) -> bool {
        self.predicted == self.trajectory.class
    }

    /// Returns the number of views until the best class had this probability.
    pub fn views_to(&self, confidence: f32) -> Option<usize> {
        self.confidences.iter().position(|reached| *reached >= confidence).map(|at| at + 1)
    }
}

/// Runs an episode, and adds the gain of each motion to `gains`.
///
/// # Errors
/// Returns errors of the scene and of the camera policy.
pub fn run_episode<S: ActiveScene>(
    view_loop: &mut ViewLoop<S>,
    camera_policy: &mut dyn CameraPolicy,
    stop: &StopRule,
    seed: u64,
    mut gains: Option<&mut GainSamples>,
) -> Result<ActiveEpisode> {
    view_loop.begin(&mut Random::from_key([seed, EPISODE_KEY]))?;
    camera_policy.begin(seed);
    let axes = view_loop.scene().rig().axes().to_vec();
    let (mut observation, mut action) = (vec![0.0; Observer::LEN], vec![0.0; axes.len()]);
    let mut episode = ActiveEpisode {
        seed,
        predicted: 0,
        confidence: 0.0,
        confidences: Vec::new(),
        trajectory: Trajectory { class: view_loop.class(), poses: Vec::new(), evidence: Vec::new() },
    };
    for moves in 0.. {
        let (predicted, confidence) = view_loop.belief().best();
        (episode.predicted, episode.confidence) = (predicted, confidence);
        episode.confidences.push(confidence);
        episode.trajectory.poses.push(view_loop.pose());
        episode.trajectory.evidence.extend_from_slice(view_loop.evidence());
        if stop.reason(moves, confidence, None).is_some() {
            break;
        }
        view_loop.observe(&mut observation);
        let (pose, best) = (view_loop.pose(), view_loop.scene().best_pose());
        let context = CameraContext { observation: &observation, pose, axes: &axes, best };
        let before = view_loop.probability();
        camera_policy.choose(&context, &mut action)?;
        view_loop.step(&Action::new(&action)?)?;
        if let Some(gains) = gains.as_deref_mut() {
            gains.add(&observation, &action, view_loop.probability() - before);
        }
    }
    Ok(episode)
}
