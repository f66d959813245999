//! Multilinear compressive learning: a picture is measured with few numbers, and its class is told by those alone.
//!
//! Tran, Yamaç, Degerli, Gabbouj and Iosifidis, Multilinear Compressive Learning, IEEE Transactions on Neural Networks and
//! Learning Systems, 2020. Sensing multiplies rows, columns and colours by a matrix each, which a camera could do; a
//! synthesis brings the measurement back to the picture's size for the classifier. All are learnt together. In place of
//! OpenDR's `n_init_iters` the matrices begin with the lowest frequencies of a cosine transform, by which no linear measurement
//! of pictures is much surpassed.

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
use opendr_perception_common::picture_network::PictureNetwork;
use opendr_vision::Preprocess;

#[cfg(feature = "training")]
pub use fit::MultilinearCompressiveFitParams;

opendr_engine::choices! {
    /// What tells the class.
    pub enum CompressiveBackbone {
        /// Four convolutions, as the image classifier has them.
        Small = "small",
    }
}

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct MultilinearCompressiveParams {
    /// Height, width and channels (3) of the pictures that are measured; others are stretched to it.
    #[param(default = vec![32, 32, 3], range = 1..=4096)]
    pub input_shape: Vec<usize>,
    /// Height, width and channels of the measurement.
    #[param(default = vec![16, 16, 1], range = 1..=4096)]
    pub compressed_shape: Vec<usize>,
    /// What tells the class.
    #[param(default = CompressiveBackbone::Small)]
    pub backbone: CompressiveBackbone,
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub n_class: Option<usize>,
}

/// A loaded network.
pub struct MultilinearCompressive {
    params: MultilinearCompressiveParams,
    classes: Classes,
    sensing: PictureNetwork,
    /// `[1, channels, height, width]` of a measurement.
    measured: [usize; 4],
    classifier: Session,
    measurements: Pool<Vec<f32>>,
}

/// `measurement` `[1, channels, height, width]` to `scores` `[1, classes]`. The file `model.onnx` measures: `image`
/// `[1, 3, height, width]` to `measurement`.
const CLASSIFIER: &str = "classifier.onnx";
/// Levels 0..=255 become -1..=1.
const MEAN: [f32; 3] = [127.5; 3];

/// Pictures as the network wants them: RGB, -1..=1.
fn preprocess([height, width]: [usize; 2]) -> Preprocess {
    Preprocess::new(width, height).normalise(MEAN, MEAN)
}

impl MultilinearCompressive {
    /// `[channels, height, width]` of a measurement.
    pub fn measured(&self) -> [usize; 3] {
        let [_, channels, height, width] = self.measured;
        [channels, height, width]
    }

    /// Replaces `measurement` by that of a picture, `[channels, height, width]`.
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

    /// Tells the class by a measurement alone (OpenDR's `infer_from_compressed_measurement`).
    ///
    /// # Errors
    /// `InvalidInput` when it has not as many numbers as [`MultilinearCompressive::measured`] says, or one is not finite.
    pub fn infer_from_measurement(&self, measurement: &[f32], category: &mut Category) -> Result<()> {
        if let Some(at) = measurement.iter().position(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "number {at} of the measurement is not finite; measure again"
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
        .about("Tells the class of a picture by few numbers that were measured of it.")
        .without_effect(&[
            ("pretrained_backbone", "there are no weights of others for its backbone"),
            ("init_backbone", "there are no weights of others for its backbone"),
            ("n_init_iters", "sensing begins with a cosine transform, which needs no training"),
            ("test_mode", "it made OpenDR's own tests short"),
        ]);
    type Params = MultilinearCompressiveParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: MultilinearCompressiveParams, device: Device) -> Result<Self> {
        let mut size = [0; 2];
        let sensing = PictureNetwork::open(model, device, |input| {
            if let [_, _, Some(height), Some(width)] = input.dims[..] {
                size = [height, width];
            }
            preprocess(size)
        })?;
        let classifier = Session::open(&model.file(CLASSIFIER)?, device)?;
        let ([input], [output]) = (classifier.inputs(), classifier.outputs()) else {
            return Err(Error::format(format!("{CLASSIFIER} has not one input and one output")));
        };
        let &[_, Some(channels), Some(height), Some(width)] = &input.dims[..] else {
            return Err(Error::format(format!(
                "{CLASSIFIER} takes {input}, which is no measurement of fixed size"
            )));
        };
        let measured = [1, channels, height, width];
        let gives = sensing.outputs().first().map(|output| output.dims.clone()).unwrap_or_default();
        if size.contains(&0) || gives.len() != 4 || gives[1..] != [Some(channels), Some(height), Some(width)]
        {
            return Err(Error::format(format!(
                "model.onnx does not measure what {CLASSIFIER} takes, {input}"
            )));
        }
        if let (Some(wanted), &[_, Some(there)]) = (params.n_class, &output.dims[..])
            && wanted != there
        {
            return Err(Error::invalid_param(format!(
                "n_class = {wanted}, but the model's is {there}; leave it out, or load a model that fits"
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
