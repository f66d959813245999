//! Registry of the learners in this build, one line each.

use std::sync::OnceLock;

#[cfg(feature = "actions")]
use opendr_actions::{
    activity_recognition::{CoX3d, X3d},
    skeleton_based_action_recognition::{CoStGcn, ProgressiveSpatioTemporalGcn, SpatioTemporalGcn},
};
use opendr_active::{ActiveFaceRecognition, ActiveObjectRecognition, ActivePoseRecognition};
#[cfg(feature = "classification")]
use opendr_classification::{
    compressive_learning::MultilinearCompressive,
    image_classification::{ImageClassifier, ImportedClassifier, ImportedZeroShotClassifier},
};
#[cfg(feature = "clouds")]
use opendr_clouds::object_detection_3d::VoxelObjectDetection3d;
use opendr_control::{MobileRl, MultiObjectSearchRl};
#[cfg(feature = "depth")]
use opendr_depth::depth_estimation::ImportedDepthEstimator;
#[cfg(feature = "detection")]
use opendr_detection::object_detection_2d::{
    CenterNet, FastestDet, Gem, ImportedDetector, Nanodet, Seq2SeqNms, SingleShotDetector, TiledDetection,
    Yolox,
};
use opendr_engine::learner::Registry;
use opendr_engine::learners;
#[cfg(feature = "faces")]
use opendr_face_detection::face_detection::{UltraLightFace, Yunet};
#[cfg(feature = "faces")]
use opendr_faces::{
    face_recognition::FaceRecognition,
    facial_expression_recognition::{FacialEmotion, ProgressiveSpatioTemporalBln},
    facial_landmarks::FaceMesh,
};
#[cfg(feature = "grasping")]
use opendr_grasping::{ambiguity_measure::AmbiguityMeasure, grasp_detection::GrConvNet};
#[cfg(feature = "hands")]
use opendr_hands::{
    gesture_recognition::{HandGesture, KeypointGesture},
    hand_pose_estimation::HandPose,
};
use opendr_imitation::{ActLearner, DiffusionPolicyLearner};
use opendr_manipulation::SingleDemoGrasp;
#[cfg(feature = "multimodal")]
use opendr_multimodal::multimodal_human_centric::{AudiovisualEmotion, RgbdHandGesture};
#[cfg(feature = "odometry")]
use opendr_odometry::VisualOdometryLearner;
#[cfg(feature = "panoptic")]
use opendr_panoptic::panoptic_segmentation::{EfficientLps, EfficientPs};
use opendr_planning::end_to_end::EndToEndPlanningRl;
#[cfg(feature = "pose")]
use opendr_pose::{
    fall_detection::FallDetector,
    pose_estimation::{
        BlazePose, HighResolutionPoseEstimation, ImportedPoseEstimator, ImportedTopDownPoseEstimator,
        LightweightOpenPose, Movenet, Posenet,
    },
};
use opendr_rl::prior::{
    ResidualPpoLearner, ResidualSacLearner, ResidualTd3Learner, ShapedPpoLearner, ShapedSacLearner,
};
use opendr_rl::{DqnLearner, PpoLearner, SacLearner, Td3Learner};
#[cfg(feature = "segmentation")]
use opendr_segmentation::{
    binary_high_resolution::HighResolutionPatches,
    instance_segmentation::{BodyPix, ImportedPromptableSegmenter},
    semantic_segmentation::{Bisenet, Deeplab, ImportedSegmenter, SelfieSegmentation, TiledSegmentation},
};
#[cfg(feature = "signals")]
use opendr_signals::{
    heart_anomaly_detection::{AttentionNeuralBagOfFeature, GatedRecurrentUnit},
    sequence_classification::CoTransEnc,
};
#[cfg(feature = "speech")]
use opendr_speech::{
    speech_recognition::{DsCnn, EdgeSpeechNets, MatchboxNet, QuadraticSelfOnn},
    speech_transcription::Whisper,
    voice_activity_detection::SileroVad,
};
#[cfg(feature = "stereo")]
use opendr_stereo::stereo_matching::SemiGlobalMatching;
#[cfg(feature = "text")]
use opendr_text::text_recognition::PpOcr;
#[cfg(feature = "tracking")]
use opendr_tracking::{
    object_tracking_2d::{ByteTrack, CBiou, DeepSort, FairMot, NanoTrack, OcSort, Sort},
    object_tracking_3d::{Ab3dmot, Vpit},
};

/// Returns the registry of all learners: those of this build, and those that the program adds. The priors of `opendr-control`, which
/// parameters of these learners name, are provided with it.
#[rustfmt::skip] // One line per learner.
pub fn registry() -> &'static Registry {
    static REGISTRY: OnceLock<Registry> = OnceLock::new();
    REGISTRY.get_or_init(|| {
        opendr_rl::prior::Prior::provide(opendr_control::priors());
        learners![
            #[cfg(feature = "detection")]
            {
                CenterNet,
                Nanodet,
                Yolox,
                FastestDet,
                ImportedDetector,
                SingleShotDetector,
                TiledDetection,
                Seq2SeqNms,
                Gem,
            },
            #[cfg(feature = "clouds")]
            {
                VoxelObjectDetection3d,
            },
            #[cfg(feature = "tracking")]
            {
                Sort,
                ByteTrack,
                OcSort,
                CBiou,
                DeepSort,
                FairMot,
                NanoTrack,
                Ab3dmot,
                Vpit,
            },
            #[cfg(feature = "faces")]
            {
                UltraLightFace,
                Yunet,
                FaceRecognition,
                FaceMesh,
                FacialEmotion,
                ProgressiveSpatioTemporalBln,
            },
            #[cfg(feature = "pose")]
            {
                Movenet,
                Posenet,
                LightweightOpenPose,
                HighResolutionPoseEstimation,
                BlazePose,
                ImportedPoseEstimator,
                ImportedTopDownPoseEstimator,
                FallDetector,
            },
            #[cfg(feature = "hands")]
            {
                HandPose,
                KeypointGesture,
                HandGesture,
            },
            #[cfg(feature = "classification")]
            {
                ImageClassifier,
                ImportedClassifier,
                ImportedZeroShotClassifier,
                MultilinearCompressive,
            },
            #[cfg(feature = "segmentation")]
            {
                Deeplab,
                ImportedSegmenter,
                Bisenet,
                SelfieSegmentation,
                TiledSegmentation,
                BodyPix,
                ImportedPromptableSegmenter,
                HighResolutionPatches,
            },
            #[cfg(feature = "panoptic")]
            {
                EfficientPs,
                EfficientLps,
            },
            #[cfg(feature = "stereo")]
            {
                SemiGlobalMatching,
            },
            #[cfg(feature = "odometry")]
            {
                VisualOdometryLearner,
            },
            #[cfg(feature = "depth")]
            {
                ImportedDepthEstimator,
            },
            #[cfg(feature = "text")]
            {
                PpOcr,
            },
            #[cfg(feature = "grasping")]
            {
                AmbiguityMeasure,
                GrConvNet,
            },
            #[cfg(feature = "actions")]
            {
                SpatioTemporalGcn,
                ProgressiveSpatioTemporalGcn,
                CoStGcn,
                X3d,
                CoX3d,
            },
            #[cfg(feature = "multimodal")]
            {
                AudiovisualEmotion,
                RgbdHandGesture,
            },
            #[cfg(feature = "signals")]
            {
                GatedRecurrentUnit,
                AttentionNeuralBagOfFeature,
                CoTransEnc,
            },
            #[cfg(feature = "speech")]
            {
                EdgeSpeechNets,
                QuadraticSelfOnn,
                MatchboxNet,
                DsCnn,
                SileroVad,
                Whisper,
            },
            {
                PpoLearner,
                SacLearner,
                Td3Learner,
                DqnLearner,
                ResidualPpoLearner,
                ResidualSacLearner,
                ResidualTd3Learner,
                ShapedPpoLearner,
                ShapedSacLearner,
                MobileRl,
                MultiObjectSearchRl,
                ActLearner,
                DiffusionPolicyLearner,
                EndToEndPlanningRl,
                ActiveFaceRecognition,
                ActiveObjectRecognition,
                ActivePoseRecognition,
                SingleDemoGrasp,
            },
            #[cfg(feature = "test-learner")]
            {
                opendr_engine::learner::counter::Counter,
            },
        ]
    })
}
