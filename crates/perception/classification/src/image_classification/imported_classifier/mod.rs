//! Image classifier from an ONNX file that another tool exported: YOLOv8-cls, YOLO11-cls, timm, torchvision, transformers.
//!
//! The scores are recognised from the network's outputs and operators, its input from the metadata of Ultralytics. A parameter overrides
//! both; what is neither recognised nor given is an error that names the parameter.

mod params;

use opendr_engine::data::{Image, ImageView};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Task};
use opendr_perception_common::category_scores::{category_from_logits, category_from_probabilities};
use opendr_perception_common::exported_network::{
    ExportedNetwork, Facts, ImageInput, InputConvention, InputResize, NetworkKind, is_class_scores,
};

use super::cropped_input::settle_input;
pub use params::{ClassScoreFormat, ImportedClassifierParams};

/// A loaded classifier of another tool.
pub struct ImportedClassifier {
    params: ImportedClassifierParams,
    classes: Classes,
    network: ExportedNetwork,
    output: usize,
    /// Width and height of the network's input, in pixels.
    size: [usize; 2],
}

impl Learner for ImportedClassifier {
    const SPEC: Spec = Spec::new("classifier", Task::ImageClassification)
        .class("ImportedClassifierLearner")
        .about(
            "Runs your own image classifier, exported to ONNX by another tool; recognises input and scores.",
        )
        .recognises_network(|onnx| NetworkKind::Classifier.recognises(onnx));
    type Params = ImportedClassifierParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = ();

    fn load(model: &Model, mut params: ImportedClassifierParams, device: Device) -> Result<Self> {
        let (session, facts) = Facts::open(model, device)?;
        let image = ImageInput::find(&facts, params.input.side())?;
        let output = facts.only_output(is_class_scores).ok_or_else(|| {
            Error::unsupported(format!(
                "the network has not one output of class scores [1, classes], as a classifier has ({})",
                facts.describe()
            ))
        })?;
        let known = recognised(&facts)?;
        let input = settle_input(&mut params.input, &mut params.crop, known, &facts)?;
        if params.scores == ClassScoreFormat::Auto {
            let tail = facts.tail(output);
            let is_final = ["Softmax", "Sigmoid"].iter().any(|name| tail.contains(name));
            params.scores = if is_final { ClassScoreFormat::Probabilities } else { ClassScoreFormat::Logits };
        }
        let classes = facts.classes(model);
        let network = ExportedNetwork::new(session, image, &input)?;
        Ok(Self { params, classes, network, output, size: image.size })
    }

    fn params(&self) -> &ImportedClassifierParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedClassifierParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, category: &mut Category) -> Result<()> {
        let crop = central_crop(image.view(), self.params.crop.unwrap_or_default(), self.size);
        self.network.run(crop, |outputs, _| {
            let scores = outputs[self.output].values::<f32>()?;
            match self.params.scores {
                ClassScoreFormat::Probabilities => {
                    category_from_probabilities(category, scores.iter().copied(), &self.classes)?;
                }
                ClassScoreFormat::Auto | ClassScoreFormat::Logits => {
                    category_from_logits(category, scores, &self.classes)?;
                }
            }
            if !self.params.probabilities {
                category.probabilities.clear();
            }
            Ok(())
        })
    }
}

/// Returns the central crop that keeps `share` of the largest part of an image with the aspect ratio of `size`; the image for a share
/// of 0.
fn central_crop<'a>(image: ImageView<'a>, share: f32, size: [usize; 2]) -> ImageView<'a> {
    if share <= 0.0 {
        return image;
    }
    let sides = [image.width(), image.height()];
    // Pixels of the image per pixel of the input.
    let [horizontal, vertical] = [0, 1].map(|axis| sides[axis] as f32 / size[axis] as f32);
    let scale = share * horizontal.min(vertical);
    let [width, height] =
        [0, 1].map(|axis| ((scale * size[axis] as f32).round() as usize).clamp(1, sides[axis].max(1)));
    let middle = |axis: usize, side: usize| sides[axis].saturating_sub(side) / 2;
    image.crop(middle(0, width), middle(1, height), width, height).unwrap_or(image)
}

/// Returns the input of an export of Ultralytics, which fills its input by a central crop.
///
/// # Errors
/// `Unsupported` for a network whose metadata state another task.
fn recognised(facts: &Facts) -> Result<Option<InputConvention>> {
    if !facts.is_of_ultralytics() {
        return Ok(None);
    }
    match facts.metadata("task") {
        "classify" => Ok(Some(InputConvention { resize: InputResize::Stretch, ..InputConvention::YOLO })),
        other => Err(Error::unsupported(format!(
            "the network's metadata state the task {other:?}; a classifier has the task classify"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crops_are_central_and_have_the_aspect_ratio_of_the_input() {
        let image = Image::from_rgb8((0..=255).cycle().take(100 * 60 * 3).collect(), 100, 60).unwrap();
        let crop = |share, size| {
            let part = central_crop(image.view(), share, size);
            [part.width(), part.height(), usize::from(part.sample_u8(0, 0, 0))]
        };
        let at = |x: usize, y: usize| (3 * (y * 100 + x)) % 256;
        assert_eq!(crop(0.0, [32, 32]), [100, 60, 0]);
        assert_eq!(crop(1.0, [32, 32]), [60, 60, at(20, 0)]);
        assert_eq!(crop(0.5, [32, 32]), [30, 30, at(35, 15)]);
        assert_eq!(crop(1.0, [64, 32]), [100, 50, at(0, 5)]);
        assert_eq!(crop(0.001, [32, 32]), [1, 1, at(49, 29)]);
    }
}
