//! A network that takes one picture: fused pre-processing in front of a session.

use opendr_engine::data::Image;
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Pool, Result};
use opendr_inference::{Session, TensorInfo, TensorView};
use opendr_vision::{InputGeometry, Preprocess};

/// The file of the network in every container.
const FILE: &str = "model.onnx";

/// A session with the pre-processing of its one input, `[1, 3, height, width]`, and memory used again.
pub(crate) struct PictureNetwork {
    session: Session,
    preprocess: Preprocess,
    inputs: Pool<Vec<f32>>,
}

impl PictureNetwork {
    /// Opens the container's network; `preprocess` is made of what the network says of its input.
    pub fn open(
        model: &Model,
        device: Device,
        preprocess: impl FnOnce(&TensorInfo) -> Preprocess,
    ) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let [input] = session.inputs() else {
            return Err(Error::format(format!(
                "{FILE} has {} inputs instead of one",
                session.inputs().len()
            )));
        };
        let preprocess = preprocess(input);
        Ok(Self { session, preprocess, inputs: Pool::default() })
    }

    /// Where an output stands in what [`PictureNetwork::run`] shows.
    pub fn output(&self, name: &str) -> Result<usize> {
        self.session.output_index(name)
    }

    /// What the network says of its outputs.
    pub fn outputs(&self) -> &[TensorInfo] {
        self.session.outputs()
    }

    /// Runs on a picture; `sink` sees the outputs and how to come back to the picture's pixels.
    pub fn run(
        &self,
        image: &Image,
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_through(&self.preprocess, image, sink)
    }

    /// The same with an input of `width` x `height` pixels, for networks that take several sizes.
    pub fn run_sized(
        &self,
        image: &Image,
        [width, height]: [usize; 2],
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_through(&self.preprocess.with_size(width, height), image, sink)
    }

    fn run_through(
        &self,
        preprocess: &Preprocess,
        image: &Image,
        mut sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        let (shape, count) = (preprocess.shape(), preprocess.len());
        let mut input = self.inputs.take();
        input.resize(count, 0.0);
        let geometry = preprocess.run_into(image.view(), &mut input)?;
        let input = TensorView::new(&shape, &input[..])?;
        self.session.run(&[input], |outputs| sink(outputs, &geometry))
    }
}
