//! Episodes from the first picture to the stop.

use opendr_engine::target::Action;
use opendr_engine::{Random, Result};

use crate::calibration::Trajectory;
use crate::gain::GainSamples;
use crate::look::Look;
use crate::mover::{Mover, Situation};
use crate::observation::Observer;
use crate::scene::ActiveScene;
use crate::stop::StopRule;

/// How an episode went.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveEpisode {
    /// The seed that it began with.
    pub seed: u64,
    /// The class that the belief holds most likely at the end.
    pub predicted: usize,
    /// Its probability.
    pub confidence: f32,
    /// The best probability after each view.
    pub confidences: Vec<f32>,
    /// The views with their evidence, and the true class.
    pub trajectory: Trajectory,
}

impl ActiveEpisode {
    /// Whether the prediction is the true class.
    pub fn is_correct(&self) -> bool {
        self.predicted == self.trajectory.class
    }

    /// Number of the first view after which the best class had this probability.
    pub fn views_to(&self, confidence: f32) -> Option<usize> {
        self.confidences.iter().position(|reached| *reached >= confidence).map(|at| at + 1)
    }
}

/// Runs an episode; what each movement gained goes into `gains` where it is wanted.
///
/// # Errors
/// Those of the scene and of the mover.
pub fn run_episode<S: ActiveScene>(
    look: &mut Look<S>,
    mover: &mut dyn Mover,
    stop: &StopRule,
    seed: u64,
    mut gains: Option<&mut GainSamples>,
) -> Result<ActiveEpisode> {
    look.begin(&mut Random::from_key([seed, 0xe415]))?;
    mover.begin(seed);
    let axes = look.scene().rig().axes().to_vec();
    let (mut observation, mut action) = (vec![0.0; Observer::LEN], vec![0.0; axes.len()]);
    let mut episode = ActiveEpisode {
        seed,
        predicted: 0,
        confidence: 0.0,
        confidences: Vec::new(),
        trajectory: Trajectory { class: look.class(), poses: Vec::new(), evidence: Vec::new() },
    };
    for moves in 0.. {
        let (predicted, confidence) = look.belief().best();
        (episode.predicted, episode.confidence) = (predicted, confidence);
        episode.confidences.push(confidence);
        episode.trajectory.poses.push(look.pose());
        episode.trajectory.evidence.extend_from_slice(look.evidence());
        if stop.reason(moves, confidence, None).is_some() {
            break;
        }
        look.observe(&mut observation);
        let (pose, best) = (look.pose(), look.scene().best_pose());
        let situation = Situation { observation: &observation, pose, axes: &axes, best };
        let before = look.probability();
        if mover.choose(&situation, &mut action)? {
            look.step(&Action::new(&action)?)?;
        } else {
            look.take()?;
        }
        if let Some(gains) = gains.as_deref_mut() {
            gains.add(&observation, &action, look.probability() - before);
        }
    }
    Ok(episode)
}
