//! The inputs of a network: an image, and constants that describe it.

use opendr_engine::data::{ImageView, Layout};
use opendr_engine::{Error, Pool, Result};
use opendr_inference::{ElementType, Session, TensorInfo, TensorView};
use opendr_vision::{ChannelOrder, InputGeometry, InputSample, LetterboxAlign, Preprocess, Warp};

use super::{Facts, InputColour, InputConvention, InputResize};

/// Maximum number of inputs of a network.
const MAX_INPUTS: usize = 4;
/// Maximum number of pixels of the network's input.
const MAX_PIXELS: usize = 1 << 24;

/// The image input of a network.
#[derive(Debug, Clone, Copy)]
pub struct ImageInput {
    index: usize,
    is_bytes: bool,
    layout: Layout,
    has_batch: bool,
    /// Width and height, in pixels.
    pub size: [usize; 2],
    /// Whether the network takes images of any width and height.
    pub is_dynamic: bool,
}

impl ImageInput {
    /// Finds the image among the inputs; sides that are not fixed have `side` pixels.
    ///
    /// # Errors
    /// `Unsupported` for a network without an image of three channels, or with a batch of several.
    pub fn find(facts: &Facts, side: usize) -> Result<Self> {
        let images =
            facts.inputs.iter().enumerate().filter_map(|(index, input)| Self::of(index, input, side));
        let found =
            images.max_by_key(|image| image.size[0].saturating_mul(image.size[1])).ok_or_else(|| {
                Error::unsupported(format!(
                    "no input of the network is an image [1, 3, height, width] or [1, height, width, 3]: {}",
                    facts.describe()
                ))
            })?;
        check_size(found.size)?;
        Ok(found)
    }

    /// Returns whether the input consists of bytes, not floats.
    pub fn is_bytes(&self) -> bool {
        self.is_bytes
    }

    /// Returns whether channels or pixels are next to each other in memory.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    fn of(index: usize, input: &TensorInfo, side: usize) -> Option<Self> {
        let is_bytes = match input.element_type {
            ElementType::F32 => false,
            ElementType::U8 => true,
            _ => return None,
        };
        let (batch, image) = match input.dims[..] {
            [batch, a, b, c] => (Some(batch), [a, b, c]),
            [a, b, c] => (None, [a, b, c]),
            _ => return None,
        };
        let (layout, height, width) = match image {
            [Some(3), height, width] => (Layout::Chw, height, width),
            [height, width, Some(3)] => (Layout::Hwc, height, width),
            [None, None, None] => (Layout::Chw, None, None),
            _ => return None,
        };
        let is_single = batch.flatten().is_none_or(|batch| batch == 1);
        let size = [width.unwrap_or(side), height.unwrap_or(side)];
        let is_dynamic = width.is_none() && height.is_none();
        is_single.then_some(Self { index, is_bytes, layout, has_batch: batch.is_some(), size, is_dynamic })
    }
}

/// Checks width and height of the network's input.
fn check_size([width, height]: [usize; 2]) -> Result<()> {
    if (1..=MAX_PIXELS).contains(&width.saturating_mul(height)) {
        return Ok(());
    }
    Err(Error::unsupported(format!(
        "the network's input has {width} x {height} pixels; at most {MAX_PIXELS} are supported"
    )))
}

/// The inputs of a network, with its session.
pub struct ExportedNetwork {
    session: Session,
    image: ImageInput,
    preprocess: Preprocess,
    constants: Vec<(usize, Constant)>,
    floats: Pool<Vec<f32>>,
    bytes: Pool<Vec<u8>>,
}

/// An input that does not depend on the image.
enum Constant {
    Floats(Vec<usize>, Vec<f32>),
    Integers(Vec<usize>, Vec<i64>),
}

impl Constant {
    /// Makes the value of an input: sizes are those of the network's input, so that boxes are in its pixels.
    fn of(input: &TensorInfo, [width, height]: [usize; 2]) -> Option<Self> {
        let dims: Vec<usize> = input.dims.iter().map(|dim| dim.unwrap_or(1)).collect();
        let values = match () {
            () if input.name.contains("mask") => {
                let dims = vec![1, height, width];
                return (input.element_type == ElementType::I64 && input.dims.len() == 3)
                    .then(|| Self::Integers(dims, vec![1; width * height]));
            }
            () if input.name.contains("scale") => [1, 1],
            () if input.name.contains("shape") => [height, width],
            () if input.name.contains("size") => [width, height],
            () => return None,
        };
        if dims.iter().product::<usize>() != values.len() {
            return None;
        }
        Some(match input.element_type {
            ElementType::F32 => Self::Floats(dims, values.map(|value| value as f32).to_vec()),
            ElementType::I64 => Self::Integers(dims, values.map(|value| value as i64).to_vec()),
            _ => return None,
        })
    }

    fn view(&self) -> Result<TensorView<'_>> {
        match self {
            Self::Floats(dims, values) => TensorView::new(dims, values),
            Self::Integers(dims, values) => TensorView::new(dims, values),
        }
    }
}

impl ExportedNetwork {
    /// Prepares the inputs of `session`.
    ///
    /// # Errors
    /// `Unsupported` for an input that is neither the image nor known.
    pub fn new(session: Session, image: ImageInput, convention: &InputConvention) -> Result<Self> {
        let count = session.inputs().len();
        let others = session.inputs().iter().enumerate().filter(|(index, _)| *index != image.index);
        let constants = others.map(|(index, input)| Some((index, Constant::of(input, image.size)?)));
        let constants: Option<Vec<_>> = constants.collect();
        let Some(constants) = constants.filter(|_| count <= MAX_INPUTS) else {
            let inputs: Vec<String> = session.inputs().iter().map(ToString::to_string).collect();
            return Err(Error::unsupported(format!(
                "the network's inputs {} are not those of a known network; export it with an image as its only input",
                inputs.join(", ")
            )));
        };
        let preprocess = preprocess(&image, convention);
        Ok(Self { session, image, preprocess, constants, floats: Pool::default(), bytes: Pool::default() })
    }

    /// Runs the network on an image. `sink` receives the outputs and the mapping back to image pixels.
    pub fn run(
        &self,
        image: ImageView<'_>,
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_through(&self.preprocess, image, sink)
    }

    /// Runs a network of dynamic size, whose only input is the image, with an input of `width` x `height` pixels.
    ///
    /// # Errors
    /// `Unsupported` for an input that is too large.
    pub fn run_sized(
        &self,
        image: ImageView<'_>,
        [width, height]: [usize; 2],
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        check_size([width, height])?;
        self.run_through(&self.preprocess.with_size(width, height), image, sink)
    }

    /// Runs the network on the part of an image that `crop` covers, black outside the image.
    pub fn run_crop(
        &self,
        image: ImageView<'_>,
        crop: Warp,
        mut sink: impl FnMut(&[TensorView<'_>]) -> Result<()>,
    ) -> Result<()> {
        self.run_filled(&self.preprocess, &Crop { image, warp: crop }, |outputs, ()| sink(outputs))
    }

    fn run_through(
        &self,
        preprocess: &Preprocess,
        image: ImageView<'_>,
        sink: impl FnMut(&[TensorView<'_>], &InputGeometry) -> Result<()>,
    ) -> Result<()> {
        self.run_filled(preprocess, &image, sink)
    }

    fn run_filled<F: Fill>(
        &self,
        preprocess: &Preprocess,
        image: &F,
        mut sink: impl FnMut(&[TensorView<'_>], &F::Placed) -> Result<()>,
    ) -> Result<()> {
        let shape = preprocess.shape();
        let shape = if self.image.has_batch { &shape[..] } else { &shape[1..] };
        if self.image.is_bytes {
            let mut input = self.bytes.take();
            input.resize(preprocess.len(), 0);
            let placed = image.fill(preprocess, &mut input)?;
            self.run_on(TensorView::new(shape, &input[..])?, |outputs| sink(outputs, &placed))
        } else {
            let mut input = self.floats.take();
            input.resize(preprocess.len(), 0.0);
            let placed = image.fill(preprocess, &mut input)?;
            self.run_on(TensorView::new(shape, &input[..])?, |outputs| sink(outputs, &placed))
        }
    }

    fn run_on(&self, image: TensorView<'_>, sink: impl FnMut(&[TensorView<'_>]) -> Result<()>) -> Result<()> {
        let mut inputs = [image; MAX_INPUTS];
        for (index, constant) in &self.constants {
            inputs[*index] = constant.view()?;
        }
        self.session.run(&inputs[..=self.constants.len()], sink)
    }
}

/// What fills the image input.
trait Fill {
    /// Where the image is in the input.
    type Placed;

    fn fill<T: InputSample>(&self, preprocess: &Preprocess, input: &mut [T]) -> Result<Self::Placed>;
}

impl Fill for ImageView<'_> {
    type Placed = InputGeometry;

    fn fill<T: InputSample>(&self, preprocess: &Preprocess, input: &mut [T]) -> Result<InputGeometry> {
        preprocess.run_into(*self, input)
    }
}

/// A part of an image.
struct Crop<'a> {
    image: ImageView<'a>,
    warp: Warp,
}

impl Fill for Crop<'_> {
    type Placed = ();

    fn fill<T: InputSample>(&self, preprocess: &Preprocess, input: &mut [T]) -> Result<()> {
        preprocess.warp_into(self.image, self.warp, input)
    }
}

/// Returns values of red, green and blue in the order of the network's channels, or back.
pub fn in_order(order: ChannelOrder, [red, green, blue]: [f32; 3]) -> [f32; 3] {
    match order {
        ChannelOrder::Bgr => [blue, green, red],
        _ => [red, green, blue],
    }
}

fn preprocess(image: &ImageInput, convention: &InputConvention) -> Preprocess {
    let padding = convention.padding as f32;
    let order = match convention.colour {
        InputColour::Bgr => ChannelOrder::Bgr,
        InputColour::Auto | InputColour::Rgb => ChannelOrder::Rgb,
    };
    let (mean, std) = convention.levels.mean_and_std();
    let [width, height] = image.size;
    let base = Preprocess::new(width, height).layout(image.layout);
    let base = base.order(order).normalise(in_order(order, mean), in_order(order, std));
    match convention.resize {
        InputResize::Letterbox => base.letterbox(LetterboxAlign::Centre, padding),
        InputResize::TopLeft => base.letterbox(LetterboxAlign::TopLeft, padding),
        InputResize::TopLeftTruncated => base.letterbox(LetterboxAlign::TopLeftTruncated, padding),
        InputResize::Auto | InputResize::Stretch => base.stretch(),
    }
}
