//! The photographs of the test data as input tensors.

use std::path::Path;

use image::RgbImage;
use image::imageops::{FilterType, resize};
use opendr_engine::data::PixelFormat;
use opendr_inference::{ElementType, TensorInfo, TensorView};

/// Range to which a model's input scales pixels of 0 to 255.
#[derive(Clone, Copy)]
pub enum Scale {
    /// 0 to 255.
    Raw,
    /// 0 to 1.
    Unit,
    /// -1 to 1.
    Signed,
    /// -0.5 to 0.5.
    Centred,
    /// Normalised by ImageNet's mean and standard deviation.
    ImageNet,
}

impl Scale {
    fn apply(self, pixel: u8) -> f32 {
        let pixel = f32::from(pixel);
        match self {
            Self::Raw => pixel,
            Self::Unit => pixel / 255.0,
            Self::Signed => pixel / 127.5 - 1.0,
            Self::Centred => pixel / 255.0 - 0.5,
            Self::ImageNet => (pixel - 116.0) / 57.5,
        }
    }
}

/// An input tensor with its elements.
pub enum Tensor {
    F32(Vec<usize>, Vec<f32>),
    I32(Vec<usize>, Vec<i32>),
    U8(Vec<usize>, Vec<u8>),
    I8(Vec<usize>, Vec<i8>),
}

impl Tensor {
    pub fn view(&self) -> TensorView<'_> {
        match self {
            Self::F32(shape, data) => TensorView::new(shape, data),
            Self::I32(shape, data) => TensorView::new(shape, data),
            Self::U8(shape, data) => TensorView::new(shape, data),
            Self::I8(shape, data) => TensorView::new(shape, data),
        }
        .unwrap()
    }
}

/// Decodes an image.
pub fn read(path: &Path) -> RgbImage {
    let picture = opendr_vision::open(path).unwrap();
    let [width, height] = [picture.width(), picture.height()].map(|size| size as u32);
    RgbImage::from_raw(width, height, picture.hwc_u8(PixelFormat::Rgb)).unwrap()
}

/// Resizes the image to the size of `input`; open sizes become 256, further channels repeat the first ones.
pub fn tensor_from_picture(picture: &RgbImage, input: &TensorInfo, scale: Scale) -> Tensor {
    let dims: Vec<usize> = match input.dims[..] {
        [batch, a, b, c] => {
            // A dimension this small is the channels.
            let free = |dim: Option<usize>| dim.unwrap_or(256);
            vec![batch.unwrap_or(1), free(a), free(b), free(c)]
        }
        _ => panic!("{input} is not an image"),
    };
    let planar = dims[1] <= 4;
    let (height, width, channels) =
        if planar { (dims[2], dims[3], dims[1]) } else { (dims[1], dims[2], dims[3]) };
    let resized = resize(picture, width as u32, height as u32, FilterType::Triangle);
    let pixel = |index: usize| {
        let (channel, place) = if planar {
            (index / (height * width), index % (height * width))
        } else {
            (index % channels, index / channels)
        };
        resized.as_raw()[place * 3 + channel % 3]
    };
    let pixels = (0..dims.iter().product()).map(pixel);
    match input.element_type {
        ElementType::F32 => Tensor::F32(dims, pixels.map(|pixel| scale.apply(pixel)).collect()),
        ElementType::I32 => Tensor::I32(dims, pixels.map(i32::from).collect()),
        ElementType::U8 => Tensor::U8(dims, pixels.collect()),
        ElementType::I8 => Tensor::I8(dims, pixels.map(|pixel| (i16::from(pixel) - 128) as i8).collect()),
        other => panic!("no image of type {other}"),
    }
}
