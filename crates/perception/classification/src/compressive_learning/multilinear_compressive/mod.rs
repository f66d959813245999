//! Multilinear compressive learning: classification of a small linear measurement of an image.
//!
//! Tran, Yamaç, Degerli, Gabbouj and Iosifidis, Multilinear Compressive Learning, IEEE Transactions on Neural Networks and
//! Learning Systems, 2020. Sensing multiplies rows, columns and colours by a matrix each, which a camera could do; a synthesis
//! maps the measurement back to the image's size for the classifier. All are trained jointly. In place of OpenDR's
//! `n_init_iters` the matrices are initialised with the lowest frequencies of a cosine transform, which is close to the best
//! linear measurement of images.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::Preprocess;

#[cfg(feature = "training")]
pub use fit::MultilinearCompressiveFitParams;

opendr_engine::choices! {
    /// Network architecture of the classifier.
    pub enum CompressiveBackbone {
        /// Four convolutions, as in the image classifier.
        Small = "small",
    }
}

/// Parameters of [`MultilinearCompressive`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct MultilinearCompressiveParams {
    /// Height, width and channels (3) of the measured images; other images are stretched.
    #[param(default = vec![32, 32, 3], range = 1..=4096)]
    pub input_shape: Vec<usize>,
    /// Height, width and channels of the measurement.
    #[param(default = vec![16, 16, 1], range = 1..=4096)]
    pub compressed_shape: Vec<usize>,
    /// Network architecture of the classifier.
    #[param(default = CompressiveBackbone::Small)]
    pub backbone: CompressiveBackbone,
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub n_class: Option<usize>,
}

/// A loaded network.
pub struct MultilinearCompressive {
    params: MultilinearCompressiveParams,
    classes: Classes,
    sensing: ImageNetwork,
    /// Shape of a measurement, `[1, channels, height, width]`.
    measured: [usize; 4],
    classifier: Session,
    measurements: Pool<Vec<f32>>,
}

/// File of the classifier: `measurement` `[1, channels, height, width]` to `scores` `[1, classes]`. The file `model.onnx` is
/// the sensing: `image` `[1, 3, height, width]` to `measurement`.
const CLASSIFIER: &str = "classifier.onnx";
/// Mean and divisor that map levels 0..=255 to -1..=1.
const MEAN: [f32; 3] = [127.5; 3];

/// Preprocessing of images to RGB in -1..=1.
fn preprocess([height, width]: [usize; 2]) -> Preprocess {
    Preprocess::new(width, height).normalise(MEAN, MEAN)
}

impl MultilinearCompressive {
    /// Returns the shape of a measurement, `[channels, height, width]`.
    pub fn measured(&self) -> [usize; 3] {
        let [_, channels, height, width] = self.measured;
        [channels, height, width]
    }

    /// Replaces `measurement` by that of an image, `[channels, height, width]`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    pub fn measure(&self, image: &Image, measurement: &mut Vec<f32>) -> Result<()> {
        self.sensing.run(image, |outputs, _| {
            measurement.clear();
            measurement.extend_from_slice(outputs.first().map_or(Ok(&[][..]), TensorView::values)?);
            Ok(())
        })
    }

    /// Classifies a measurement (OpenDR's `infer_from_compressed_measurement`).
    ///
    /// # Errors
    /// `InvalidInput` when its length differs from [`MultilinearCompressive::measured`], or a value is not finite.
    pub fn infer_from_measurement(&self, measurement: &[f32], category: &mut Category) -> Result<()> {
        if let Some(at) = measurement.iter().position(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "value {at} of the measurement is not finite; measure again"
            )));
        }
        self.classifier.run(&[TensorView::new(&self.measured, measurement)?], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}

impl Learner for MultilinearCompressive {
    const SPEC: Spec = Spec::new("multilinear_compressive", Task::CompressiveLearning)
        .class("MultilinearCompressiveLearner")
        .about("Classifies an image from a small multilinear measurement of it; trainable.")
        .without_effect(&[
            ("pretrained_backbone", "there are no pretrained weights for the backbone"),
            ("init_backbone", "there are no pretrained weights for the backbone"),
            ("n_init_iters", "sensing is initialised with a cosine transform, without training"),
            ("test_mode", "OpenDR used it to shorten its own tests"),
        ]);
    type Params = MultilinearCompressiveParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: MultilinearCompressiveParams, device: Device) -> Result<Self> {
        let mut size = [0; 2];
        let sensing = ImageNetwork::open(model, device, |input| {
            if let [_, _, Some(height), Some(width)] = input.dims[..] {
                size = [height, width];
            }
            preprocess(size)
        })?;
        let classifier = Session::open(&model.file(CLASSIFIER)?, device)?;
        let ([input], [output]) = (classifier.inputs(), classifier.outputs()) else {
            return Err(Error::format(format!(
                "{CLASSIFIER} does not have exactly one input and one output"
            )));
        };
        let &[_, Some(channels), Some(height), Some(width)] = &input.dims[..] else {
            return Err(Error::format(format!(
                "{CLASSIFIER} takes {input}; expected a measurement of fixed size"
            )));
        };
        let measured = [1, channels, height, width];
        let gives = sensing.outputs().first().map(|output| output.dims.clone()).unwrap_or_default();
        if size.contains(&0) || gives.len() != 4 || gives[1..] != [Some(channels), Some(height), Some(width)]
        {
            return Err(Error::format(format!(
                "model.onnx does not return the input of {CLASSIFIER}, {input}"
            )));
        }
        if let (Some(wanted), &[_, Some(there)]) = (params.n_class, &output.dims[..])
            && wanted != there
        {
            return Err(Error::invalid_param(format!(
                "n_class = {wanted}, but the model has {there} classes; omit n_class or load another model"
            )));
        }
        let classes = model.classes().clone();
        Ok(Self { params, classes, sensing, measured, classifier, measurements: Pool::default() })
    }

    fn params(&self) -> &MultilinearCompressiveParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut MultilinearCompressiveParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, category: &mut Category) -> Result<()> {
        let measurement = &mut *self.measurements.take();
        self.measure(image, measurement)?;
        self.infer_from_measurement(measurement, category)
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
