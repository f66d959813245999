//! Parameters of [`super::ImportedDetector`]: its settings, and what is to be known of a network's outputs.

use opendr_engine::params::Params;
use opendr_perception_common::exported_network::InputParams;
use opendr_perception_common::suppression::SuppressionKind;

opendr_engine::choices! {
    /// What the rows of a detector's outputs are.
    pub enum OutputLayout {
        /// Recognised from the network.
        Auto = "auto",
        /// Box and class scores of every cell or anchor, before suppression (YOLOv5 to v12).
        Candidates = "candidates",
        /// The same, with boxes relative to their cells (YOLOX).
        GridCandidates = "grid_candidates",
        /// Detections after suppression, in one output or in one each for boxes, scores and classes.
        Detections = "detections",
        /// Box and class scores of every query, without suppression (DETR).
        Queries = "queries",
    }
}

opendr_engine::choices! {
    /// The four values of a box.
    pub enum BoxFormat {
        /// Recognised from the network.
        Auto = "auto",
        /// Left, top, right, bottom.
        Xyxy = "xyxy",
        /// Centre, width and height.
        Cxcywh = "cxcywh",
        /// Left, top, width and height.
        Xywh = "xywh",
        /// Top, left, bottom, right.
        Yxyx = "yxyx",
    }
}

opendr_engine::choices! {
    /// The unit of a box.
    pub enum BoxUnit {
        /// Recognised from the network.
        Auto = "auto",
        /// Pixels of the network's input.
        Pixels = "pixels",
        /// Fractions of the network's input.
        Fractions = "fractions",
    }
}

opendr_engine::choices! {
    /// The class scores of a network.
    pub enum ScoreFormat {
        /// Recognised from the network.
        Auto = "auto",
        /// Probabilities.
        Probabilities = "probabilities",
        /// Logits of one logistic function each.
        Sigmoid = "sigmoid",
        /// Logits of a softmax whose last class is the background.
        Softmax = "softmax",
    }
}

opendr_engine::choices! {
    /// Whether rows of candidates have an objectness before the class scores.
    pub enum Objectness {
        /// Recognised from the network.
        Auto = "auto",
        /// A row has an objectness, by which class scores are multiplied.
        Present = "present",
        /// A row has none.
        Absent = "absent",
    }
}

opendr_engine::choices! {
    /// Order of the values of a detection in an output with rows of detections.
    pub enum RowOrder {
        /// Recognised from the network.
        Auto = "auto",
        /// Box, score, class.
        BoxScoreClass = "box_score_class",
        /// Class, score, box.
        ClassScoreBox = "class_score_box",
        /// Index in the batch, box, class, score.
        BatchBoxClassScore = "batch_box_class_score",
        /// Index in the batch, box, score, class.
        BatchBoxScoreClass = "batch_box_score_class",
    }
}

opendr_engine::choices! {
    /// Whether the detections have masks.
    pub enum MaskOutput {
        /// Recognised from the network.
        Auto = "auto",
        /// There are no masks.
        Absent = "absent",
        /// Masks are sums of prototypes, an output of four dimensions, by the last values of each row (YOLACT).
        Prototypes = "prototypes",
    }
}

opendr_engine::choices! {
    /// Whether the boxes are rotated.
    pub enum BoxAngle {
        /// Recognised from the network.
        Auto = "auto",
        /// Boxes are upright.
        Absent = "absent",
        /// The last value of each row is the angle by which the box is rotated about its centre, in radians, clockwise.
        Last = "last",
    }
}

/// Parameters of [`super::ImportedDetector`].
#[derive(Debug, Clone, Params)]
pub struct ImportedDetectorParams {
    /// Score below which detections are dropped.
    #[param(default = 0.25, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which candidates of one class count as one object; detections and queries are not suppressed.
    #[param(default = 0.65, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes per image.
    #[param(default = 300, range = 1..=1000, live)]
    pub max_detections: usize,
    /// Whether a candidate may be a detection of several classes, or of that with the highest score only.
    #[param(default = false, live)]
    pub multi_label: bool,
    /// Method of non-maximum suppression of upright candidates; rotated ones have Fast NMS by the probabilistic IoU.
    #[param(live)]
    pub suppression: SuppressionKind,
    /// What the rows of the outputs are.
    pub layout: OutputLayout,
    /// The four values of a box.
    pub boxes: BoxFormat,
    /// Unit of boxes.
    pub unit: BoxUnit,
    /// What the class scores are.
    pub scores: ScoreFormat,
    /// Whether rows of candidates have an objectness.
    pub objectness: Objectness,
    /// Order of the values of a detection in one output.
    pub row_order: RowOrder,
    /// Whether the boxes are rotated; the segment of a rotated box is its polygon.
    pub angle: BoxAngle,
    /// Whether the detections have masks.
    pub masks: MaskOutput,
    /// Class index of the network that is the first of the class names; recognised from the network if absent.
    #[param(range = 0..=1000)]
    pub first_class: Option<usize>,
    /// The network's input.
    #[param(flatten)]
    pub input: InputParams,
}
