//! The tasks of learners.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

macro_rules! tasks {
    ($($(#[$doc:meta])* $variant:ident = $name:literal;)*) => {
        /// The task of a learner. It determines target type, metric and `eval`.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[non_exhaustive]
        pub enum Task {
            $($(#[$doc])* #[serde(rename = $name)] $variant,)*
        }

        impl Task {
            /// All tasks.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Returns the name, as in OpenDR's package, e.g. `"object_detection_2d"`.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }
        }
    };
}

impl Task {
    /// Returns the OpenDR package of its learners.
    pub const fn package(self) -> &'static str {
        match self {
            Self::ReinforcementLearning => "control",
            Self::EndToEndPlanning => "planning",
            _ => "perception",
        }
    }
}

tasks! {
    /// Detection of objects in an image, as boxes with classes.
    ObjectDetection2d = "object_detection_2d";
    /// Detection of objects in space, as 3D boxes with classes.
    ObjectDetection3d = "object_detection_3d";
    /// Tracking of objects in a video: boxes with an identity.
    ObjectTracking2d = "object_tracking_2d";
    /// Tracking of objects in space: 3D boxes with an identity.
    ObjectTracking3d = "object_tracking_3d";
    /// Detection of faces in an image, as boxes.
    FaceDetection = "face_detection";
    /// Recognition of persons by their faces.
    FaceRecognition = "face_recognition";
    /// Landmarks of faces in an image.
    FacialLandmarks = "facial_landmarks";
    /// Classification of facial expressions.
    FacialExpressionRecognition = "facial_expression_recognition";
    /// Classification of whole images.
    ImageClassification = "image_classification";
    /// Class of every pixel.
    SemanticSegmentation = "semantic_segmentation";
    /// Class and object instance of every pixel.
    PanopticSegmentation = "panoptic_segmentation";
    /// Mask of each object.
    InstanceSegmentation = "instance_segmentation";
    /// Disparity or depth from the images of two cameras.
    StereoMatching = "stereo_matching";
    /// Motion of a camera from its images.
    VisualOdometry = "visual_odometry";
    /// Depth of every pixel from one image.
    DepthEstimation = "depth_estimation";
    /// Ambiguity of the best position in a map of scores.
    AmbiguityMeasure = "ambiguity_measure";
    /// Binary classification of the regions of a high-resolution image.
    BinaryHighResolution = "binary_high_resolution";
    /// Detection of grasps for a gripper.
    GraspDetection = "grasp_detection";
    /// Classification of images from compressed measurements.
    CompressiveLearning = "compressive_learning";
    /// Detection and recognition of text in an image.
    TextRecognition = "text_recognition";
    /// Keypoints of persons in an image.
    PoseEstimation = "pose_estimation";
    /// Keypoints of hands in an image.
    HandPoseEstimation = "hand_pose_estimation";
    /// Classification of hand gestures.
    GestureRecognition = "gesture_recognition";
    /// Detection of fallen persons.
    FallDetection = "fall_detection";
    /// Classification of actions from sequences of skeletons.
    SkeletonBasedActionRecognition = "skeleton_based_action_recognition";
    /// Classification of actions in a video.
    ActivityRecognition = "activity_recognition";
    /// Recognition of emotion or speech from two modalities.
    MultimodalHumanCentric = "multimodal_human_centric";
    /// Detection of anomalies in heart signals.
    HeartAnomalyDetection = "heart_anomaly_detection";
    /// Recognition of single spoken words.
    SpeechRecognition = "speech_recognition";
    /// Detection of speech in audio.
    VoiceActivityDetection = "voice_activity_detection";
    /// Transcription of speech to text.
    SpeechTranscription = "speech_transcription";
    /// Recognition from several views, with proposed camera motions.
    ActivePerception = "active_perception";
    /// Control policies trained by reinforcement learning.
    ReinforcementLearning = "reinforcement_learning";
    /// Motion planning from camera images to motion in one network.
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
