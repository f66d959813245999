//! A network that takes one picture: fused pre-processing in front of a session.

use opendr_engine::data::{Image, ImageView, Layout};
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Pool, Result};
use opendr_inference::{Session, TensorInfo, TensorView};
use opendr_vision::{InputGeometry, Preprocess, Similarity};

/// The file of the network in every container.
const FILE: &str = "model.onnx";

/// A session with the pre-processing of its one input, a picture, and memory used again.
pub struct PictureNetwork {
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
        Self::open_file(model, FILE, device, |input| Ok(preprocess(input)))
    }

    /// The same for the container's network called `file`, of which there are several.
    pub fn open_file(
        model: &Model,
        file: &str,
        device: Device,
        preprocess: impl FnOnce(&TensorInfo) -> Result<Preprocess>,
    ) -> Result<Self> {
        let session = Session::open(&model.file(file)?, device)?;
        let [input] = session.inputs() else {
            return Err(Error::format(format!(
                "{file} has {} inputs instead of one",
                session.inputs().len()
            )));
        };
        let preprocess = preprocess(input)?;
        Ok(Self { session, preprocess, inputs: Pool::default() })
    }

    /// Returns where an output stands in what [`PictureNetwork::run`] shows.
    pub fn output(&self, name: &str) -> Result<usize> {
        self.session.output_index(name)
    }

    /// Returns width and height of the network's input.
    pub fn size(&self) -> [usize; 2] {
        self.preprocess.size()
    }

    /// Returns what the network says of its outputs.
    pub fn outputs(&self) -> &[TensorInfo] {
        self.session.outputs()
    }

    /// Runs on a picture; `sink` sees the outputs and how to come back to the picture's pixels.
    pub fn run(
        &self,
        image: &Image,
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_through(&self.preprocess, image.view(), sink)
    }

    /// The same with an input of `width` x `height` pixels, for networks that take several sizes.
    pub fn run_sized(
        &self,
        image: ImageView<'_>,
        [width, height]: [usize; 2],
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_through(&self.preprocess.with_size(width, height), image, sink)
    }

    /// Runs on the part of a picture that `crop` shows.
    pub fn run_crop(
        &self,
        image: &Image,
        crop: &Similarity,
        sink: impl FnMut(&[TensorView<'_>]) -> Result<()>,
    ) -> Result<()> {
        self.run_warped(image, crop, |_| (), sink)
    }

    /// Runs on the part of a picture that `crop` shows; `edit` may change the network's input before.
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

    /// Swaps left and right of an input.
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

/// Returns size and layout of an input of pictures: `[1, 3, height, width]` or `[1, height, width, 3]`.
///
/// # Errors
/// `Format` when it is none, or leaves its size open.
pub fn input_of(input: &TensorInfo) -> Result<Preprocess> {
    match input.dims[..] {
        [_, Some(3), Some(height), Some(width)] => Ok(Preprocess::new(width, height)),
        [_, Some(height), Some(width), Some(3)] => Ok(Preprocess::new(width, height).layout(Layout::Hwc)),
        _ => Err(Error::format(format!("{input} is no picture of a fixed size"))),
    }
}
