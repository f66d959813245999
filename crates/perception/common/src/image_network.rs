//! A session with one image as input and fused pre-processing.

use opendr_engine::data::{Image, ImageView, Layout};
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Pool, Result};
use opendr_inference::{Session, TensorInfo, TensorView};
use opendr_vision::{InputGeometry, Preprocess, Similarity};

/// File name of the network in a container.
pub(crate) const FILE: &str = "model.onnx";

/// A session with the pre-processing of its only input, an image, and reused input memory.
pub struct ImageNetwork {
    session: Session,
    preprocess: Preprocess,
    inputs: Pool<Vec<f32>>,
}

impl ImageNetwork {
    /// Opens the container's network `model.onnx`. `preprocess` returns the pre-processing for the network's input.
    pub fn open(
        model: &Model,
        device: Device,
        preprocess: impl FnOnce(&TensorInfo) -> Preprocess,
    ) -> Result<Self> {
        Self::open_file(model, FILE, device, |input| Ok(preprocess(input)))
    }

    /// Opens the container's network `file`, for containers with several networks.
    pub fn open_file(
        model: &Model,
        file: &str,
        device: Device,
        preprocess: impl FnOnce(&TensorInfo) -> Result<Preprocess>,
    ) -> Result<Self> {
        let session = Session::open(&model.file(file)?, device)?;
        let [input] = session.inputs() else {
            return Err(Error::format(format!(
                "{file} has {} inputs instead of one; export the network with one image as input",
                session.inputs().len()
            )));
        };
        let preprocess = preprocess(input)?;
        Ok(Self { session, preprocess, inputs: Pool::default() })
    }

    /// Returns the index of an output in the slice that [`ImageNetwork::run`] passes to its sink.
    pub fn output(&self, name: &str) -> Result<usize> {
        self.session.output_index(name)
    }

    /// Returns width and height of the network's input.
    pub fn size(&self) -> [usize; 2] {
        self.preprocess.size()
    }

    /// Returns names, types and shapes of the network's outputs.
    pub fn outputs(&self) -> &[TensorInfo] {
        self.session.outputs()
    }

    /// Runs the network on an image. `sink` receives the outputs and the mapping back to image pixels.
    pub fn run(
        &self,
        image: &Image,
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_through(&self.preprocess, image.view(), sink)
    }

    /// Runs the network with an input of `width` x `height` pixels, for networks of dynamic size.
    pub fn run_sized(
        &self,
        image: ImageView<'_>,
        [width, height]: [usize; 2],
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_through(&self.preprocess.with_size(width, height), image, sink)
    }

    /// Runs the network on the part of an image that `crop` covers.
    pub fn run_crop(
        &self,
        image: &Image,
        crop: &Similarity,
        sink: impl FnMut(&[TensorView<'_>]) -> Result<()>,
    ) -> Result<()> {
        self.run_warped(image, crop, |_| (), sink)
    }

    /// Runs the network on the part of an image that `crop` covers; `edit` may change the network's input before.
    pub fn run_warped(
        &self,
        image: &Image,
        crop: &Similarity,
        edit: impl FnOnce(&mut [f32]),
        sink: impl FnMut(&[TensorView<'_>]) -> Result<()>,
    ) -> Result<()> {
        let (shape, count) = (self.preprocess.shape(), self.preprocess.len());
        let mut input = self.inputs.take();
        input.resize(count, 0.0);
        self.preprocess.warp_into(image.view(), crop, &mut input[..])?;
        edit(&mut input);
        self.session.run(&[TensorView::new(&shape, &input[..])?], sink)
    }

    /// Flips an input horizontally.
    pub fn mirror(&self, input: &mut [f32]) {
        let [_, _, _, last] = self.preprocess.shape();
        let [width, _] = self.preprocess.size();
        if last == width {
            return input.chunks_exact_mut(width).for_each(<[f32]>::reverse);
        }
        for row in input.chunks_exact_mut(width * last) {
            row.reverse();
            row.chunks_exact_mut(last).for_each(<[f32]>::reverse);
        }
    }

    fn run_through(
        &self,
        preprocess: &Preprocess,
        image: ImageView<'_>,
        mut sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        let (shape, count) = (preprocess.shape(), preprocess.len());
        let mut input = self.inputs.take();
        input.resize(count, 0.0);
        let geometry = preprocess.run_into(image, &mut input)?;
        let input = TensorView::new(&shape, &input[..])?;
        self.session.run(&[input], |outputs| sink(outputs, &geometry))
    }
}

/// Returns the pre-processing for an image input `[1, 3, height, width]` or `[1, height, width, 3]`.
///
/// # Errors
/// `Format` for other shapes, and for a dynamic size.
pub fn preprocess_from_input(input: &TensorInfo) -> Result<Preprocess> {
    match input.dims[..] {
        [_, Some(3), Some(height), Some(width)] => Ok(Preprocess::new(width, height)),
        [_, Some(height), Some(width), Some(3)] => Ok(Preprocess::new(width, height).layout(Layout::Hwc)),
        _ => Err(Error::format(format!(
            "{input} is not an image of a fixed size; export the network with a fixed height and width"
        ))),
    }
}
