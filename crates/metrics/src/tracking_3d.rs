//! 3D tracking: HOTA and CLEAR MOT over the intersection over union of volumes.
//!
//! As in X. Weng et al., "3D Multi-Object Tracking: A Baseline and New Evaluation Metrics", IROS 2020, boxes are compared
//! in space, not in the image, and match from an intersection over union of one quarter. The counts are those of
//! [`Hota`] and [`ClearMot`].

use opendr_engine::overlap::UprightBox3D;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox3D, Name, TrackingAnnotation3DList};
use opendr_engine::{Error, Result};

use crate::clear_mot::TrackMatchingParams;
use crate::{ClearMot, Hota, HotaParams, Metric, Report, TrackingFrame};

/// Parameters of [`Tracking3d`].
#[derive(Debug, Clone, Params)]
pub struct Tracking3dParams {
    /// Minimum intersection over union of volumes of boxes that match for CLEAR MOT; the default is the paper's for cars.
    #[param(default = 0.25, range = 0.0..=1.0)]
    pub overlap: f64,
}

/// HOTA and CLEAR MOT of 3D boxes. Boxes of different classes do not overlap.
#[derive(Debug, Clone)]
pub struct Tracking3d {
    hota: Hota,
    clear: ClearMot,
}

/// Class of ground-truth regions without annotation.
const NOTHING: &str = "DontCare";

impl Metric for Tracking3d {
    const NAME: &'static str = "tracking_3d";
    const ABOUT: &'static str = "HOTA and CLEAR MOT of 3D boxes, by the IoU of their volumes";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("hota", "Geometric mean of detection and association, mean over thresholds .05 to .95."),
        ("deta", "Detection accuracy."),
        ("assa", "Association accuracy."),
        ("loca", "Localisation accuracy: mean IoU of volumes of matches."),
        ("mota", "1 - (misses + false positives + switches) / objects."),
        ("motp", "Mean distance (1 - IoU of volumes) of matches: 0 is best."),
        ("precision", "Fraction of predictions that match."),
        ("recall", "Fraction of ground-truth boxes that match."),
        ("switches", "Matches by another track than before (identity switches)."),
        ("fragmentations", "Number of times that an object is lost and matched again."),
        ("false_positives", "Predicted boxes without a match."),
        ("misses", "Ground-ground truth boxes without a match."),
        ("mostly_tracked", "Objects matched in 80 % of their frames or more."),
        ("mostly_lost", "Objects matched in less than 20 %."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] =
        &["motp", "switches", "fragmentations", "false_positives", "misses", "mostly_lost"];
    type Params = Tracking3dParams;
    type Prediction = TrackingAnnotation3DList;
    type GroundTruth = TrackingAnnotation3DList;

    fn new(params: &Tracking3dParams) -> Result<Self> {
        let clear = TrackMatchingParams { overlap: params.overlap, ..TrackMatchingParams::default() };
        Ok(Self { hota: Hota::new(&HotaParams::default())?, clear: ClearMot::new(&clear)? })
    }

    fn update(
        &mut self,
        _at: usize,
        prediction: &TrackingAnnotation3DList,
        ground_truth: &TrackingAnnotation3DList,
    ) -> Result<f64> {
        let frame = frame_from_lists(prediction, ground_truth)?;
        self.hota.count(&frame);
        self.clear.count(&frame);
        Ok(frame.coverage())
    }

    fn end_sequence(&mut self) {
        self.hota.end_sequence();
        self.clear.end_sequence();
    }

    fn merge(&mut self, other: Self) {
        self.hota.merge(other.hota);
        self.clear.merge(other.clear);
    }

    fn finish(&self) -> Report {
        let mut report = Report { headline: "hota".to_owned(), ..self.hota.finish() };
        let clear = self.clear.finish().statistics.scalars;
        let mut scalars = std::mem::take(&mut report.statistics.scalars);
        scalars.extend(clear);
        scalars.retain(|name, _| Self::NUMBERS.iter().any(|(known, _)| known == name));
        report.statistics.scalars = scalars;
        report
    }
}

/// Creates a frame of ground truth and prediction.
///
/// # Errors
/// Returns `InvalidInput` for a box that is not finite; otherwise as [`TrackingFrame::new`].
fn frame_from_lists(
    found: &TrackingAnnotation3DList,
    ground_truth: &TrackingAnnotation3DList,
) -> Result<TrackingFrame> {
    let (found, ground_truth) = (boxes_from_list(found)?, boxes_from_list(ground_truth)?);
    if found.len().saturating_mul(ground_truth.len()) > TrackingFrame::MOST_PAIRS {
        let (ground_truth, found) = (ground_truth.len(), found.len());
        return Err(Error::invalid_input(format!(
            "{ground_truth} true and {found} predicted objects in one frame are too many pairs; give fewer"
        )));
    }
    let overlaps = ground_truth.iter().flat_map(|(_, name, place)| {
        found.iter().map(move |(_, other, found)| {
            let same = name.eq_ignore_ascii_case(other);
            if same { place.iou(found).clamp(0.0, 1.0) } else { 0.0 }
        })
    });
    let overlaps = overlaps.collect();
    let ids = |boxes: &[(i64, String, UprightBox3D)]| boxes.iter().map(|(id, ..)| *id).collect();
    TrackingFrame::new(ids(&ground_truth), ids(&found), overlaps)
}

fn boxes_from_list(list: &TrackingAnnotation3DList) -> Result<Vec<(i64, String, UprightBox3D)>> {
    let name = |found: &BoundingBox3D| match (list.classes.label(&found.name), &found.name) {
        (Some(label), _) => label.to_owned(),
        (None, Name::Label(label)) => label.to_string(),
        (None, Name::Index(index)) => index.to_string(),
    };
    let boxes = list.annotations.iter().map(|track| (track, name(&track.bounding_box_3d)));
    let boxes = boxes.filter(|(_, name)| !name.eq_ignore_ascii_case(NOTHING)).map(|(track, name)| {
        let found = &track.bounding_box_3d;
        let (size, place) = (found.dimensions.map(f64::from), found.location.map(f64::from));
        let numbers = size.iter().chain(&place).all(|number| number.is_finite());
        if !numbers || !found.rotation_y.is_finite() {
            return Err(Error::invalid_input(format!(
                "object {} has a box {found:?}; give finite numbers",
                track.id
            )));
        }
        Ok((track.id, name, UprightBox3D::from_kitti(size, place, f64::from(found.rotation_y))))
    });
    boxes.collect()
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::TrackingAnnotation3D;

    use super::*;

    fn car(id: i64, x: f32, name: &str) -> TrackingAnnotation3D {
        let bounding_box_3d = BoundingBox3D {
            name: name.into(),
            dimensions: [4.0, 1.5, 2.0],
            location: [x, 1.6, 20.0],
            ..BoundingBox3D::default()
        };
        TrackingAnnotation3D { bounding_box_3d, id, frame: None }
    }

    fn numbers(frames: &[(Vec<TrackingAnnotation3D>, Vec<TrackingAnnotation3D>)]) -> Vec<f64> {
        let mut metric = Tracking3d::new(&Tracking3dParams::default()).unwrap();
        let list = |annotations: &[TrackingAnnotation3D]| TrackingAnnotation3DList {
            annotations: annotations.to_vec(),
            ..TrackingAnnotation3DList::default()
        };
        for (at, (found, ground_truth)) in frames.iter().enumerate() {
            metric.update(at, &list(found), &list(ground_truth)).unwrap();
        }
        let scalars = metric.finish().statistics.scalars;
        assert_eq!(scalars.len(), Tracking3d::NUMBERS.len());
        ["hota", "mota", "motp", "switches", "misses", "false_positives"].map(|name| scalars[name]).to_vec()
    }

    /// Cars 4 metres long that are predicted 1 metre too far along share 3 of 5 parts, 0.6: a match for CLEAR MOT with a
    /// distance of 0.4, and for HOTA at the 12 of 19 thresholds from .05 to .6. There all objects are detected and keep their
    /// track, so HOTA is 12 / 19.
    #[test]
    fn shifted_cars_by_hand() {
        let frames: Vec<_> =
            (0..4).map(|at| (vec![car(9, 1.0 + at as f32, "Car")], vec![car(1, at as f32, "Car")])).collect();
        let [hota, mota, motp, switches, misses, wrong] = numbers(&frames)[..] else { panic!() };
        assert!((hota - 12.0 / 19.0).abs() < 1e-9, "{hota}");
        assert!((mota, switches, misses, wrong) == (1.0, 0.0, 0.0, 0.0) && (motp - 0.4).abs() < 1e-6);
    }

    #[test]
    fn switches_classes_and_dont_care() {
        let ground_truth = vec![car(1, 0.0, "Car"), car(-1, 50.0, "DontCare")];
        let frames = vec![
            (vec![car(5, 0.0, "car")], ground_truth.clone()),
            (vec![car(6, 0.0, "Car")], ground_truth.clone()),
            (vec![car(6, 0.0, "Pedestrian")], ground_truth.clone()),
            (vec![car(6, 0.0, "Car"), car(7, 50.0, "Car")], ground_truth),
        ];
        let [_, mota, _, switches, misses, wrong] = numbers(&frames)[..] else { panic!() };
        assert_eq!((switches, misses, wrong, mota), (1.0, 1.0, 2.0, 0.0));
    }

    #[test]
    fn invalid_lists_are_rejected() {
        let mut metric = Tracking3d::new(&Tracking3dParams::default()).unwrap();
        let list = |x: f32, count: usize| TrackingAnnotation3DList {
            annotations: (0..count).map(|id| car(id as i64, x, "Car")).collect(),
            ..TrackingAnnotation3DList::default()
        };
        assert!(metric.update(0, &list(f32::NAN, 1), &list(0.0, 1)).is_err());
        assert!(metric.update(0, &list(0.0, 5000), &list(0.0, 5000)).is_err());
        assert!(metric.update(0, &list(0.0, 0), &list(0.0, 0)).is_ok());
    }
}
