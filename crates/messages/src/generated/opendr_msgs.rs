//! `opendr_msgs`.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `opendr_msgs/AudioStamped`: Audio with its format.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AudioStamped {
    pub header: crate::std_msgs::Header,
    pub info: crate::audio_common_msgs::AudioInfo,
    pub audio: crate::audio_common_msgs::AudioData,
}

/// `opendr_msgs/Calibration`: KITTI's calibration of a lidar and a camera, matrices row by row.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Calibration {
    pub header: crate::std_msgs::Header,
    /// From the rectified camera frame to pixels, 3 x 4.
    pub p2: [f64; 12],
    /// Rectifying rotation, 3 x 3.
    pub r0_rect: [f64; 9],
    /// From the lidar's frame to the camera's, 3 x 4, metres.
    pub tr_velo_to_cam: [f64; 12],
}

/// `opendr_msgs/Float32MultiArrayStamped`: Numbers with time and frame: a time series, a vector, a clip, a sequence of skeletons.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Float32MultiArrayStamped {
    pub header: crate::std_msgs::Header,
    pub array: crate::std_msgs::Float32MultiArray,
}

/// `opendr_msgs/ImageWithDetections`: An image with detected boxes.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ImageWithDetections {
    pub header: crate::std_msgs::Header,
    pub image: crate::sensor_msgs::Image,
    pub detections: crate::vision_msgs::Detection2DArray,
}

/// `opendr_msgs/Observation`: The observation of an agent.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Observation {
    pub header: crate::std_msgs::Header,
    /// The parts; one without a name if there are no parts.
    pub parts: Vec<ObservationPart>,
}

/// `opendr_msgs/ObservationPart`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ObservationPart {
    pub name: String,
    pub array: crate::std_msgs::Float32MultiArray,
}

/// `opendr_msgs/PointCloudWithCalibration`: A cloud with the calibration between lidar and camera.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PointCloudWithCalibration {
    pub header: crate::std_msgs::Header,
    pub cloud: crate::sensor_msgs::PointCloud2,
    pub calibration: Calibration,
    /// Size of the camera's image in pixels; 0 if unknown.
    pub image_height: u32,
    pub image_width: u32,
}

/// `opendr_msgs/Pose2D`: The joints of one person, hand or animal in an image.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose2D {
    /// The skeleton, e.g. opendr18 or coco17.
    pub skeleton: String,
    /// The joints in the order of the skeleton.
    pub keypoints: Vec<Pose2DKeypoint>,
    /// Score of the whole, 0 to 1.
    pub confidence: f32,
    /// The track; -1 if there is none.
    pub id: i64,
}

/// `opendr_msgs/Pose2DArray`: The poses in one image, best first.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose2DArray {
    pub header: crate::std_msgs::Header,
    pub poses: Vec<Pose2D>,
}

/// `opendr_msgs/Pose2DKeypoint`: A joint in pixels; (-1, -1) if it was not detected.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose2DKeypoint {
    pub name: String,
    pub x: f32,
    pub y: f32,
    /// 0 to 1.
    pub confidence: f32,
}

/// `opendr_msgs/TextRegion`: A line of text in an image.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TextRegion {
    pub text: String,
    /// 0 to 1.
    pub confidence: f32,
    /// Corners in pixels, clockwise from the top left one of the text: x and y of each.
    pub corners: [f32; 8],
}

/// `opendr_msgs/TextRegionArray`: The lines of text in an image, in reading order.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TextRegionArray {
    pub header: crate::std_msgs::Header,
    pub regions: Vec<TextRegion>,
}

/// `opendr_msgs/Transcription`: A transcription of speech.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Transcription {
    pub header: crate::std_msgs::Header,
    pub text: String,
    /// Two letters, e.g. en; empty if unknown.
    pub language: String,
    /// Whether the text is final.
    pub is_final: bool,
    pub segments: Vec<TranscriptionSegment>,
}

/// `opendr_msgs/TranscriptionSegment`: A segment of a transcription, as Whisper returns it.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TranscriptionSegment {
    pub id: i64,
    /// Where its window begins, in frames of the spectrogram (10 ms).
    pub seek: i64,
    /// Start and end within the audio, in seconds.
    pub start: f32,
    pub end: f32,
    pub text: String,
    pub tokens: Vec<i64>,
    pub temperature: f32,
    pub avg_logprob: f32,
    pub compression_ratio: f32,
    pub no_speech_prob: f32,
}

/// `opendr_msgs/ViewAction`: A camera motion to a better view (active perception).
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ViewAction {
    pub header: crate::std_msgs::Header,
    /// 1 to 4 axes, each in [-1, 1]: azimuth, elevation, distance (positive is closer), roll or zoom.
    pub axes: Vec<f32>,
}
