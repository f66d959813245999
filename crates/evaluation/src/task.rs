//! Metrics of tasks.

use opendr_engine::{Error, Result, Task};

/// Returns the name of a task's metric: the one by which papers rank its learners.
///
/// # Errors
/// `Unsupported` for a task without one.
pub fn metric_of(task: Task) -> Result<&'static str> {
    match task {
        Task::ObjectDetection2d => Ok("coco_detection"),
        Task::ObjectDetection3d => Ok("kitti_detection"),
        Task::ObjectTracking2d => Ok("hota"),
        Task::ObjectTracking3d => Ok("tracking_3d"),
        Task::FaceDetection => Ok("voc_detection"),
        Task::ImageClassification
        | Task::AmbiguityMeasure
        | Task::BinaryHighResolution
        | Task::CompressiveLearning
        | Task::FaceRecognition
        | Task::FacialExpressionRecognition => Ok("classification"),
        Task::FacialLandmarks => Ok("keypoints"),
        Task::SemanticSegmentation => Ok("segmentation"),
        Task::PanopticSegmentation => Ok("panoptic"),
        Task::InstanceSegmentation => Ok("coco_segmentation"),
        Task::PoseEstimation => Ok("coco_keypoints"),
        Task::TextRecognition => Ok("text"),
        Task::DepthEstimation => Ok("depth"),
        Task::GestureRecognition
        | Task::ActivityRecognition
        | Task::MultimodalHumanCentric
        | Task::HeartAnomalyDetection
        | Task::SkeletonBasedActionRecognition
        | Task::SpeechRecognition
        | Task::VoiceActivityDetection => Ok("classification"),
        Task::SpeechTranscription => Ok("transcription"),
        other => Err(Error::unsupported(format!("{other} has no default metric; choose one with metric"))),
    }
}
