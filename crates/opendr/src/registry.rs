//! The learners that are compiled in: one line each.

use std::sync::OnceLock;

use opendr_engine::learner::Registry;
use opendr_engine::learners;
use opendr_perception::activity_recognition::{CoX3d, X3d};
use opendr_perception::ambiguity_measure::AmbiguityMeasure;
use opendr_perception::binary_high_resolution::HighResolutionPatches;
use opendr_perception::compressive_learning::MultilinearCompressive;
use opendr_perception::face_detection::{UltraLightFace, Yunet};
use opendr_perception::face_recognition::FaceRecognition;
use opendr_perception::facial_expression_recognition::{FacialEmotion, ProgressiveSpatioTemporalBln};
use opendr_perception::facial_landmarks::FaceMesh;
use opendr_perception::fall_detection::FallDetector;
use opendr_perception::gesture_recognition::{HandGesture, KeypointGesture};
use opendr_perception::grasp_detection::GrConvNet;
use opendr_perception::hand_pose_estimation::HandPose;
use opendr_perception::heart_anomaly_detection::{AttentionNeuralBagOfFeature, GatedRecurrentUnit};
use opendr_perception::image_classification::ImageClassifier;
use opendr_perception::instance_segmentation::BodyPix;
use opendr_perception::multimodal_human_centric::{AudiovisualEmotion, RgbdHandGesture};
use opendr_perception::object_detection_2d::{
    CenterNet, Gem, Nanodet, Seq2SeqNms, SingleShotDetector, TiledDetection,
};
use opendr_perception::object_detection_3d::VoxelObjectDetection3d;
use opendr_perception::object_tracking_2d::{ByteTrack, DeepSort, FairMot, NanoTrack, OcSort, Sort};
use opendr_perception::object_tracking_3d::{Ab3dmot, Vpit};
use opendr_perception::panoptic_segmentation::{EfficientLps, EfficientPs};
use opendr_perception::pose_estimation::{
    BlazePose, HighResolutionPoseEstimation, LightweightOpenPose, Movenet, Posenet,
};
use opendr_perception::semantic_segmentation::{Bisenet, Deeplab, SelfieSegmentation, TiledSegmentation};
use opendr_perception::skeleton_based_action_recognition::{CoStGcn, SpatioTemporalGcn};
use opendr_perception::speech_recognition::{DsCnn, EdgeSpeechNets, MatchboxNet, QuadraticSelfOnn};
use opendr_perception::speech_transcription::Whisper;
use opendr_perception::stereo_matching::SemiGlobalMatching;
use opendr_perception::voice_activity_detection::SileroVad;
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
            TiledDetection,
            Seq2SeqNms,
            Gem,
            VoxelObjectDetection3d,
            Sort,
            ByteTrack,
            OcSort,
            DeepSort,
            FairMot,
            NanoTrack,
            Ab3dmot,
            Vpit,
            UltraLightFace,
            Yunet,
            FaceRecognition,
            FaceMesh,
            FacialEmotion,
            ProgressiveSpatioTemporalBln,
            Movenet,
            Posenet,
            LightweightOpenPose,
            HighResolutionPoseEstimation,
            BlazePose,
            HandPose,
            KeypointGesture,
            HandGesture,
            FallDetector,
            ImageClassifier,
            Deeplab,
            Bisenet,
            SelfieSegmentation,
            EfficientPs,
            EfficientLps,
            BodyPix,
            SemiGlobalMatching,
            AmbiguityMeasure,
            TiledSegmentation,
            HighResolutionPatches,
            GrConvNet,
            MultilinearCompressive,
            SpatioTemporalGcn,
            CoStGcn,
            X3d,
            CoX3d,
            AudiovisualEmotion,
            RgbdHandGesture,
            GatedRecurrentUnit,
            AttentionNeuralBagOfFeature,
            EdgeSpeechNets,
            QuadraticSelfOnn,
            MatchboxNet,
            DsCnn,
            SileroVad,
            Whisper,
            PpoLearner,
            SacLearner,
            Td3Learner,
            DqnLearner,
            EndToEndPlanningRl,
            #[cfg(feature = "test-learner")] opendr_engine::learner::counter::Counter,
        ]
    })
}
