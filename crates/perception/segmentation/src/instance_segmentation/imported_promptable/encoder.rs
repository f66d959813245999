//! The image encoder.

use opendr_engine::data::{ImageView, Layout};
use opendr_engine::{Device, Error, Pool, Result};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::exported_network::{Facts, ImageInput, InputLevels};
use opendr_vision::{InputGeometry, LetterboxAlign, Preprocess};

use super::mask::Sides;

/// Side of the input of an encoder of dynamic size.
const SIDE: usize = 1024;

/// The encoder, with the preparation of its input.
pub(super) struct Encoder {
    session: Session,
    preprocess: Preprocess,
    /// Samples of the padding by channel: 0 once they are normalised.
    padding: [f32; 3],
    input: Pool<Vec<f32>>,
}

/// Where the image is in the encoder's input.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    geometry: InputGeometry,
    /// Width and height of the input, and of the image in it.
    input: [usize; 2],
    size: [usize; 2],
}

impl Encoder {
    /// Opens an encoder; `levels` becomes the range of its samples.
    ///
    /// # Errors
    /// `Unsupported` for a network whose only input is not an image in floats, or that does not state the range of its samples.
    pub(super) fn open(
        onnx: &[u8],
        facts: &Facts,
        levels: &mut InputLevels,
        size: Option<usize>,
        device: Device,
    ) -> Result<Self> {
        let image = ImageInput::find(facts, size.unwrap_or(SIDE))?;
        let is_known = facts.inputs.len() == 1 && facts.inputs.iter().all(|input| input.dims.len() == 4);
        if !is_known || image.is_bytes() || image.layout() != Layout::Chw {
            return Err(Error::unsupported(format!(
                "the only input of an encoder must be an image [1, 3, height, width] in floats, normalised and padded ({}); export it so",
                facts.describe()
            )));
        }
        // The encoders of Segment Anything begin with a convolution; others may normalise their input first.
        if *levels == InputLevels::Auto && facts.reads_input_by("Conv") {
            *levels = InputLevels::ImageNet;
        }
        if *levels == InputLevels::Auto {
            return Err(facts.unsettled(&["levels"]));
        }
        let (mean, std) = levels.mean_and_std();
        let (padding, _) = InputLevels::ImageNet.mean_and_std();
        let padding = std::array::from_fn(|channel| (padding[channel] - mean[channel]) / std[channel]);
        let [width, height] = image.size;
        let preprocess = Preprocess::new(width, height).letterbox(LetterboxAlign::TopLeft, 0.0);
        Ok(Self {
            session: Session::open(onnx, device)?,
            preprocess: preprocess.normalise(mean, std),
            padding,
            input: Pool::default(),
        })
    }

    /// Encodes an image. `sink` receives the outputs and where the image is in the input.
    ///
    /// # Errors
    /// Those of the runtime and of `sink`.
    pub(super) fn run(
        &self,
        image: ImageView<'_>,
        mut sink: impl FnMut(&[TensorView<'_>], &Placed) -> Result<()>,
    ) -> Result<()> {
        let mut input = self.input.take();
        input.resize(self.preprocess.len(), 0.0);
        let geometry = self.preprocess.run_into(image, &mut input[..])?;
        let [width, height] = self.preprocess.size();
        let placed = Placed::new(geometry, [width, height]);
        let [right, bottom] = placed.size;
        for (plane, padding) in input.chunks_exact_mut(width * height).zip(self.padding) {
            let (rows, below) = plane.split_at_mut(bottom * width);
            rows.chunks_exact_mut(width).for_each(|row| row[right..].fill(padding));
            below.fill(padding);
        }
        let view = TensorView::new(&self.preprocess.shape(), &input[..])?;
        self.session.run(&[view], |outputs| sink(outputs, &placed))
    }
}

impl Placed {
    fn new(geometry: InputGeometry, input: [usize; 2]) -> Self {
        let side = |axis: usize| {
            let side = (geometry.image_size[axis] / geometry.scale[axis]).round() as usize;
            side.clamp(1, input[axis])
        };
        Self { geometry, input, size: [side(0), side(1)] }
    }

    /// Returns the position in the input of a position in the image.
    pub(super) fn input_from_image(&self, position: [f32; 2]) -> [f32; 2] {
        self.geometry.input_from_image(position)
    }

    /// Returns the sizes along both axes, for masks of `logits` columns and rows.
    pub(super) fn sides(&self, logits: [usize; 2]) -> [Sides; 2] {
        [0, 1].map(|axis| Sides {
            image: self.geometry.image_size[axis] as usize,
            placed: self.size[axis],
            input: self.input[axis],
            logits: logits[axis],
        })
    }
}
