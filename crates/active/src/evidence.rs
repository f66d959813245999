//! Class probabilities of the toolkit's targets.

use opendr_engine::target::{BoundingBoxList, Category, Name, PoseList};

/// A target from which the probability of each class follows.
pub trait ClassEvidence {
    /// Writes a probability for each class; they sum to 1. What the target does not state is shared equally.
    fn class_probabilities(&self, probabilities: &mut [f32]);
}

/// Replaces probabilities by their logarithms, which stay finite.
pub fn logarithms(probabilities: &mut [f32]) {
    probabilities.iter_mut().for_each(|probability| *probability = probability.max(1e-6).ln());
}

/// Gives a class its confidence, and the others equal shares of the rest.
fn with_confidence(class: Option<usize>, confidence: f32, probabilities: &mut [f32]) {
    let count = probabilities.len();
    let even = 1.0 / count.max(1) as f32;
    let Some(class) = class.filter(|class| *class < count && count > 1 && confidence.is_finite()) else {
        return probabilities.fill(even);
    };
    // Less than an even share would be evidence against the class that was chosen.
    let confidence = confidence.clamp(even, 1.0);
    probabilities.fill((1.0 - confidence) / (count - 1) as f32);
    probabilities[class] = confidence;
}

/// The scores of all classes where the learner gives them, else the confidence of the class.
impl ClassEvidence for Category {
    fn class_probabilities(&self, probabilities: &mut [f32]) {
        let sum: f32 = self.probabilities.iter().sum();
        if self.probabilities.len() == probabilities.len() && sum > 0.0 && sum.is_finite() {
            let shares = probabilities.iter_mut().zip(&self.probabilities);
            return shares.for_each(|(to, share)| *to = share / sum);
        }
        with_confidence(usize::try_from(self.class).ok(), self.confidence.unwrap_or(0.0), probabilities);
    }
}

/// The box with the highest score: detection of one subject, recognition of one face. A label that is no class index is ignored.
impl ClassEvidence for BoundingBoxList {
    fn class_probabilities(&self, probabilities: &mut [f32]) {
        let known = self.boxes.iter().filter_map(|item| match &item.name {
            Name::Index(class) => usize::try_from(*class).ok().map(|class| (class, item.confidence)),
            Name::Label(_) => None,
        });
        let best = known.max_by(|a, b| a.1.total_cmp(&b.1));
        with_confidence(best.map(|(class, _)| class), best.map_or(0.0, |(_, score)| score), probabilities);
    }
}

/// Two classes, by the score of the best pose: 0 no person, 1 a person.
impl ClassEvidence for PoseList {
    fn class_probabilities(&self, probabilities: &mut [f32]) {
        let best = self.poses.iter().map(|pose| pose.confidence).fold(0.0, f32::max);
        let class = usize::from(best >= 0.5);
        with_confidence(Some(class), best.max(1.0 - best), probabilities);
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::{BoundingBox, Pose};

    use super::*;

    fn of(target: &impl ClassEvidence, classes: usize) -> Vec<f32> {
        let mut probabilities = vec![9.0; classes];
        target.class_probabilities(&mut probabilities);
        assert!((probabilities.iter().sum::<f32>() - 1.0).abs() < 1e-6, "{probabilities:?}");
        probabilities
    }

    #[test]
    fn targets_give_probabilities() {
        let mut category = Category::new(2, Some(0.7));
        assert_eq!(of(&category, 4)[2], 0.7);
        category.probabilities = vec![2.0, 1.0, 1.0, 0.0];
        assert_eq!(of(&category, 4), [0.5, 0.25, 0.25, 0.0]);
        assert_eq!(of(&Category::new(9, Some(0.7)), 4), [0.25; 4]);
        assert_eq!(of(&Category::new(1, Some(0.01)), 4), [0.25; 4]);
        let mut boxes = BoundingBoxList::default();
        assert_eq!(of(&boxes, 2), [0.5; 2]);
        boxes.boxes.push(BoundingBox::new(1, 0.0, 0.0, 5.0, 5.0, 0.8));
        boxes.boxes.push(BoundingBox::new("unknown", 0.0, 0.0, 5.0, 5.0, 0.9));
        assert_eq!(of(&boxes, 2)[1], 0.8);
        let mut poses = PoseList::default();
        assert_eq!(of(&poses, 2), [1.0, 0.0]);
        poses.poses.push(Pose { confidence: 0.9, ..Pose::default() });
        assert!((of(&poses, 2)[1] - 0.9).abs() < 1e-6);
    }
}
