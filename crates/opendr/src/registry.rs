//! The learners that are compiled in: one line each.

use std::sync::OnceLock;

use opendr_engine::learner::Registry;
use opendr_engine::learners;
use opendr_perception::face_detection::{UltraLightFace, Yunet};
use opendr_perception::heart_anomaly_detection::GatedRecurrentUnit;
use opendr_perception::image_classification::ImageClassifier;
use opendr_perception::object_detection_2d::{CenterNet, Nanodet, SingleShotDetector};
use opendr_perception::pose_estimation::{LightweightOpenPose, Movenet, Posenet};
use opendr_perception::skeleton_based_action_recognition::{CoStGcn, SpatioTemporalGcn};
use opendr_perception::speech_recognition::MatchboxNet;
use opendr_planning::end_to_end::EndToEndPlanningRl;
use opendr_rl::{DqnLearner, PpoLearner, SacLearner, Td3Learner};

/// Every learner: those compiled in, and those that the program adds.
#[rustfmt::skip] // One line a learner.
pub fn registry() -> &'static Registry {
    static REGISTRY: OnceLock<Registry> = OnceLock::new();
    REGISTRY.get_or_init(|| {
        learners![
            CenterNet,
            Nanodet,
            SingleShotDetector,
            UltraLightFace,
            Yunet,
            Movenet,
            Posenet,
            LightweightOpenPose,
            ImageClassifier,
            SpatioTemporalGcn,
            CoStGcn,
            GatedRecurrentUnit,
            MatchboxNet,
            PpoLearner,
            SacLearner,
            Td3Learner,
            DqnLearner,
            EndToEndPlanningRl,
            #[cfg(feature = "test-learner")] opendr_engine::learner::counter::Counter,
        ]
    })
}
