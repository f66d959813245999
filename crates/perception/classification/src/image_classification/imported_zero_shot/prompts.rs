//! The texts of the classes, and their vectors.

use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, ResultExt};

use super::networks::TextNetwork;
use super::params::ImportedZeroShotClassifierParams;
use super::tokenizer::ClipTokenizer;

/// Maximum number of classes.
const MAX_CLASSES: usize = 10_000;

/// The classes and the vectors of their texts.
pub struct Prompts {
    labels: String,
    template: String,
    /// The classes.
    pub classes: Classes,
    /// A vector of length 1 for each class.
    vectors: Vec<f32>,
    /// Number of values of a vector.
    pub width: usize,
}

/// Returns the classes that parameters state; those of the model without labels.
pub fn classes(labels: &str, model: &Classes) -> Classes {
    if labels.trim().is_empty() {
        return model.clone();
    }
    let separator = if labels.contains(';') { ';' } else { ',' };
    labels.split(separator).map(str::trim).filter(|label| !label.is_empty()).collect()
}

impl Prompts {
    /// Runs the network of texts on the texts of all classes.
    ///
    /// # Errors
    /// `InvalidParam` without classes, with too many, and for a template without a place for them; the errors of the network.
    pub fn new(
        params: &ImportedZeroShotClassifierParams,
        model: &Classes,
        tokenizer: &ClipTokenizer,
        network: &TextNetwork,
    ) -> Result<Self> {
        let classes = classes(&params.labels, model);
        if classes.is_empty() {
            return Err(Error::invalid_param(
                "a zero-shot classifier needs its classes as texts; set labels, such as labels = \"cat; dog; empty room\"",
            ));
        }
        if classes.len() > MAX_CLASSES {
            return Err(Error::invalid_param(format!(
                "labels has {} classes; at most {MAX_CLASSES} are supported",
                classes.len()
            )));
        }
        if !params.template.contains("{}") {
            return Err(Error::invalid_param(format!(
                "template = {:.60?} has no {{}} in place of the class; write such as \"a photo of a {{}}\"",
                params.template
            )));
        }
        let (mut vectors, mut width) = (Vec::new(), 0);
        for class in classes.iter() {
            let begin = vectors.len();
            let text = params.template.replace("{}", class);
            network.embed(tokenizer, &text, &mut vectors).context(|| format!("the text {text:.60?}"))?;
            let vector = vectors.get_mut(begin..).unwrap_or_default();
            if begin > 0 && vector.len() != width {
                return Err(Error::format("the network of texts returns vectors of several lengths"));
            }
            width = vector.len();
            let norm = norm(vector);
            if !(norm.is_finite() && norm > 0.0) {
                return Err(Error::format(format!(
                    "the network of texts returns no direction for {text:.60?}"
                )));
            }
            vector.iter_mut().for_each(|value| *value /= norm);
        }
        let (labels, template) = (params.labels.clone(), params.template.clone());
        Ok(Self { labels, template, classes, vectors, width })
    }

    /// Returns whether the texts are those of the parameters.
    pub fn are_of(&self, params: &ImportedZeroShotClassifierParams) -> bool {
        self.labels == params.labels && self.template == params.template
    }

    /// Writes the cosine similarity of a vector with the text of each class, times `scale`.
    pub fn similarities(&self, vector: &[f32], scale: f32, similarities: &mut Vec<f32>) {
        let scale = scale / norm(vector);
        let dot = |text: &[f32]| text.iter().zip(vector).map(|(text, image)| text * image).sum::<f32>();
        similarities.clear();
        similarities.extend(self.vectors.chunks_exact(self.width.max(1)).map(|text| scale * dot(text)));
    }
}

fn norm(vector: &[f32]) -> f32 {
    vector.iter().map(|value| value * value).sum::<f32>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_separated_by_semicolons_or_commas() {
        let model: Classes = ["ball", "cone"].into_iter().collect();
        let names = |labels: &str| classes(labels, &model).iter().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(names(" cat, red dog ,"), ["cat", "red dog"]);
        assert_eq!(names("a cat, asleep; dog"), ["a cat, asleep", "dog"]);
        assert_eq!(names(" "), ["ball", "cone"]);
        assert!(names(";").is_empty());
    }
}
