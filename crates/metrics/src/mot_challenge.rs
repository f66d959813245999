//! The MOT Challenge's rules about the rows of ground truth and predictions that count.

use opendr_engine::assignment::cheapest_pairs;
use opendr_engine::target::{Name, TrackingAnnotationList};
use opendr_engine::{Error, Result, choices};

use crate::TrackingFrame;

/// Classes of the MOT Challenge; class numbers start at 1.
const CLASSES: [&str; 13] = [
    "pedestrian",
    "person_on_vehicle",
    "car",
    "bicycle",
    "motorbike",
    "non_mot_vehicle",
    "static_person",
    "distractor",
    "occluder",
    "occluder_on_ground",
    "occluder_full",
    "reflection",
    "crowd",
];
const PEDESTRIAN: usize = 1;
const NON_MOT_VEHICLE: usize = 6;
/// Person on vehicle, static person, distractor, reflection.
const DISTRACTORS: [usize; 4] = [2, 7, 8, 12];

choices! {
    /// Rows of ground truth and predictions that count.
    ///
    /// The rules of the challenges are those of TrackEval 1.3 (`MotChallenge2DBox`). Rows of ground truth with
    /// confidence 0 do not count. From MOT16 on only pedestrians count, and predictions that match persons on vehicles,
    /// static persons, distractors and reflections (in MOT20 also other vehicles) are removed first. Predictions count
    /// as pedestrians, of any class. A class of the ground truth is its label, e.g. `static_person`, or its number in
    /// the challenge, from 1.
    pub enum MotRules {
        /// All rows.
        All = "all",
        /// MOT15.
        Mot15 = "mot15",
        /// MOT16.
        Mot16 = "mot16",
        /// MOT17.
        Mot17 = "mot17",
        /// MOT20.
        Mot20 = "mot20",
    }
}

impl MotRules {
    /// Returns the rows of one frame that count.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a ground-truth class that the challenge does not have; otherwise as
    /// [`TrackingFrame::from_lists`].
    pub fn frame(
        self,
        found: &TrackingAnnotationList,
        ground_truth: &TrackingAnnotationList,
    ) -> Result<TrackingFrame> {
        let frame = TrackingFrame::from_lists(found, ground_truth)?;
        if self == Self::All {
            return Ok(frame);
        }
        let is_marked = |at: usize| ground_truth.annotations[at].bounding_box.confidence.abs() >= 1.0;
        if self == Self::Mot15 {
            let kept: Vec<_> = (0..frame.ground_truth().len()).map(is_marked).collect();
            return Ok(frame.keep(&kept, &vec![true; frame.predictions().len()]));
        }
        let classes = ground_truth
            .annotations
            .iter()
            .map(|track| class_from_name(&track.bounding_box.name))
            .collect::<Result<Vec<_>>>()?;
        let kept: Vec<_> = (0..classes.len()).map(|at| is_marked(at) && classes[at] == PEDESTRIAN).collect();
        let found = self.without_distractors(&frame, &classes);
        Ok(frame.keep(&kept, &found))
    }

    /// Returns for each prediction whether it matches no distractor.
    fn without_distractors(self, frame: &TrackingFrame, classes: &[usize]) -> Vec<bool> {
        let costs: Vec<_> = frame
            .overlaps()
            .iter()
            .map(|overlap| if *overlap < 0.5 - f64::EPSILON { 0.0 } else { -overlap })
            .collect();
        let mut kept = vec![true; frame.predictions().len()];
        for (ground_truth, found) in cheapest_pairs(&costs, kept.len()) {
            let class = classes[ground_truth];
            let is_distractor =
                DISTRACTORS.contains(&class) || (self == Self::Mot20 && class == NON_MOT_VEHICLE);
            if is_distractor && costs[ground_truth * kept.len() + found] < -f64::EPSILON {
                kept[found] = false;
            }
        }
        kept
    }
}

/// Returns the number of a class in the challenge, from 1, independent of the class names of the list.
fn class_from_name(name: &Name) -> Result<usize> {
    let number = match name {
        Name::Index(index) => usize::try_from(*index).ok(),
        Name::Label(label) => {
            let label = label.to_lowercase().replace([' ', '-'], "_");
            let label = label.replace("motorized", "mot").replace("on_the_", "on_");
            CLASSES.iter().position(|class| *class == label).map(|at| at + 1)
        }
    };
    number.filter(|number| (1..=CLASSES.len()).contains(number)).ok_or_else(|| {
        Error::invalid_input(format!(
            "the MOT Challenge has no class {name}; give 1 to 13, or one of {}",
            CLASSES.join(", ")
        ))
    })
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::{BoundingBox, TrackingAnnotation};

    use super::*;

    fn list(rows: &[(i64, Name, f32, f32)]) -> TrackingAnnotationList {
        let annotation = |(id, name, left, confidence): &(i64, Name, f32, f32)| TrackingAnnotation {
            bounding_box: BoundingBox::new(name.clone(), *left, 0.0, 10.0, 10.0, *confidence),
            id: *id,
            frame: None,
        };
        rows.iter().map(annotation).collect::<Vec<_>>().into()
    }

    #[test]
    fn rules_remove_rows() {
        let ground_truth = list(&[
            (1, 1.into(), 0.0, 1.0),
            (2, "Static person".into(), 20.0, 1.0),
            (3, 1.into(), 40.0, 0.0),
            (4, "non motorized vehicle".into(), 60.0, 1.0),
        ]);
        let found = list(&[
            (1, 0.into(), 0.0, 0.9),
            (2, 0.into(), 21.0, 0.9),
            (3, 0.into(), 41.0, 0.9),
            (4, 0.into(), 61.0, 0.9),
        ]);
        let ids = |rules: MotRules| {
            let frame = rules.frame(&found, &ground_truth).unwrap();
            (frame.ground_truth().to_vec(), frame.predictions().to_vec())
        };
        assert_eq!(ids(MotRules::All), (vec![1, 2, 3, 4], vec![1, 2, 3, 4]));
        assert_eq!(ids(MotRules::Mot15), (vec![1, 2, 4], vec![1, 2, 3, 4]));
        assert_eq!(ids(MotRules::Mot17), (vec![1], vec![1, 3, 4]));
        assert_eq!(ids(MotRules::Mot20), (vec![1], vec![1, 3]));
        let unknown = list(&[(1, 14.into(), 0.0, 1.0)]);
        assert!(MotRules::Mot16.frame(&found, &unknown).is_err());
        assert!(MotRules::Mot15.frame(&found, &unknown).is_ok());
    }
}
