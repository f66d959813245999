//! What a learner is for.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

macro_rules! tasks {
    ($($(#[$doc:meta])* $variant:ident = $name:literal;)*) => {
        /// A task fixes the target type and the metric of its learners; `eval` belongs to it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[non_exhaustive]
        pub enum Task {
            $($(#[$doc])* #[serde(rename = $name)] $variant,)*
        }

        impl Task {
            /// Every task that has a learner.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The name as OpenDR's package has it, e.g. `"object_detection_2d"`.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }
        }
    };
}

impl Task {
    /// Which of OpenDR's packages its learners are in.
    pub const fn package(self) -> &'static str {
        match self {
            Self::ReinforcementLearning => "control",
            Self::EndToEndPlanning => "planning",
            _ => "perception",
        }
    }
}

tasks! {
    /// Boxes with classes in a picture.
    ObjectDetection2d = "object_detection_2d";
    /// Boxes with classes in space.
    ObjectDetection3d = "object_detection_3d";
    /// Objects that keep their number from frame to frame.
    ObjectTracking2d = "object_tracking_2d";
    /// Objects that keep their number from moment to moment, in space.
    ObjectTracking3d = "object_tracking_3d";
    /// Boxes of faces in a picture.
    FaceDetection = "face_detection";
    /// Whose faces are in a picture.
    FaceRecognition = "face_recognition";
    /// Points of faces in a picture.
    FacialLandmarks = "facial_landmarks";
    /// What a face expresses.
    FacialExpressionRecognition = "facial_expression_recognition";
    /// The class that a whole picture belongs to.
    ImageClassification = "image_classification";
    /// The class of every pixel.
    SemanticSegmentation = "semantic_segmentation";
    /// The class and the object of every pixel.
    PanopticSegmentation = "panoptic_segmentation";
    /// The pixels of each object.
    InstanceSegmentation = "instance_segmentation";
    /// How far away everything is that two cameras see.
    StereoMatching = "stereo_matching";
    /// Whether a map of values leaves a doubt where the best place is.
    AmbiguityMeasure = "ambiguity_measure";
    /// Which parts of a large picture show what is looked for.
    BinaryHighResolution = "binary_high_resolution";
    /// Where a gripper can take hold.
    GraspDetection = "grasp_detection";
    /// The class of a picture that was measured with few numbers.
    CompressiveLearning = "compressive_learning";
    /// Key points of persons in a picture.
    PoseEstimation = "pose_estimation";
    /// Key points of hands in a picture.
    HandPoseEstimation = "hand_pose_estimation";
    /// What hands say.
    GestureRecognition = "gesture_recognition";
    /// Whether persons have fallen.
    FallDetection = "fall_detection";
    /// What persons do, told by their moving skeletons.
    SkeletonBasedActionRecognition = "skeleton_based_action_recognition";
    /// What persons do in a video.
    ActivityRecognition = "activity_recognition";
    /// What persons feel or say, told by two senses at a time.
    MultimodalHumanCentric = "multimodal_human_centric";
    /// Whether a heart signal is normal.
    HeartAnomalyDetection = "heart_anomaly_detection";
    /// Which word was spoken.
    SpeechRecognition = "speech_recognition";
    /// Whether somebody speaks.
    VoiceActivityDetection = "voice_activity_detection";
    /// What was said.
    SpeechTranscription = "speech_transcription";
    /// What a robot does, learnt by acting.
    ReinforcementLearning = "reinforcement_learning";
    /// Where a robot goes, from its camera to its motion.
    EndToEndPlanning = "end_to_end_planning";
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Task {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::ALL.iter().copied().find(|task| task.name() == text).ok_or_else(|| {
            let names: Vec<_> = Self::ALL.iter().map(|task| task.name()).collect();
            Error::not_found(format!("no task {text:?}; there are {}", names.join(", ")))
        })
    }
}
