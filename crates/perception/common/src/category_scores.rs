//! Categories from the outputs of a classifier.

use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Result};

/// Fills `category` with the class of the highest of `logits`, and with the softmax of all.
///
/// # Errors
/// `Format` when there are no logits, or their number differs from that of `classes`; `InvalidInput` when one is not
/// finite.
pub fn category_from_logits(category: &mut Category, logits: &[f32], classes: &Classes) -> Result<()> {
    let highest = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    category.probabilities.clear();
    category.probabilities.extend(logits.iter().map(|logit| (logit - highest).exp()));
    normalise(category);
    fill_from_highest(category, classes)
}

/// Fills `category` with the class of the highest of the non-negative `scores`; its probabilities are the scores divided by
/// their sum.
///
/// # Errors
/// As [`category_from_logits`].
pub fn category_from_scores(
    category: &mut Category,
    scores: impl Iterator<Item = f32>,
    classes: &Classes,
) -> Result<()> {
    category.probabilities.clear();
    category.probabilities.extend(scores);
    normalise(category);
    fill_from_highest(category, classes)
}

fn normalise(category: &mut Category) {
    let sum: f32 = category.probabilities.iter().sum();
    category.probabilities.iter_mut().for_each(|probability| *probability /= sum);
}

/// Fills `category` with the class of the highest of `probabilities`, and with all probabilities.
///
/// # Errors
/// As [`category_from_logits`].
pub fn category_from_probabilities(
    category: &mut Category,
    probabilities: impl Iterator<Item = f32>,
    classes: &Classes,
) -> Result<()> {
    category.probabilities.clear();
    category.probabilities.extend(probabilities);
    fill_from_highest(category, classes)
}

/// Fills the binary `category`: class 1 where `holds`, else class 0; `probability` is that of class 1.
pub fn binary_category(category: &mut Category, holds: bool, probability: f32, classes: &Classes) {
    category.class = i64::from(holds);
    category.description = classes.name(category.class).cloned();
    category.confidence = Some(if holds { probability } else { 1.0 - probability });
    category.probabilities.clear();
    category.probabilities.extend([1.0 - probability, probability]);
}

fn fill_from_highest(category: &mut Category, classes: &Classes) -> Result<()> {
    let (scores, names) = (category.probabilities.len(), classes.len());
    if scores == 0 || !(names == 0 || names == scores) {
        return Err(Error::format(format!(
            "the model has {scores} scores for {names} classes; export it with the classes of its training"
        )));
    }
    if !category.probabilities.iter().all(|probability| probability.is_finite()) {
        return Err(Error::invalid_input(
            "the network's scores are not finite; check that the values of the input are in the range of its training data",
        ));
    }
    let highest = category.probabilities.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let class =
        category.probabilities.iter().position(|probability| *probability == highest).unwrap_or_default();
    category.class = class as i64;
    category.confidence = category.probabilities.get(class).copied();
    category.description = classes.name(category.class).cloned();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_logit_wins() {
        let classes: Classes = ["no", "yes"].into_iter().collect();
        let mut category = Category::default();
        category_from_logits(&mut category, &[1000.0, 1000.0 + 3f32.ln()], &classes).unwrap();
        assert_eq!((category.class, category.description.as_deref()), (1, Some("yes")));
        assert!((category.confidence.unwrap() - 0.75).abs() < 1e-4);
        assert!((category.probabilities[0] - 0.25).abs() < 1e-4);
        assert!(category_from_logits(&mut category, &[1.0], &classes).is_err());
        assert!(category_from_logits(&mut category, &[], &Classes::default()).is_err());
    }
}
