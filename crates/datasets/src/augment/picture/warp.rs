//! Transformation of pixels.

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::{Error, Result};
use opendr_vision::{ChannelOrder, Preprocess};

use crate::augment::picture::map::AffineMap;
use crate::augment::picture::placing::{Span, spans};

/// Largest number of samples of an image; the limit of the decoder.
const MAX_SAMPLES: usize = 1 << 28;

/// Transforms an image by `map`. Pixels outside of the input are `level` for `u8` samples, otherwise 0.
///
/// Shifts and mirroring are exact for every kind of image. Otherwise `u8` pixels are interpolated bilinearly (and
/// become RGB or grey, `HWC`), and other samples, which are measurements, are taken from the nearest pixel.
pub(super) fn warp(image: &Image, map: &AffineMap, level: u8) -> Result<Image> {
    let [width, height] = map.output_size();
    check_size([width, height], image.channels())?;
    let placing = spans(map);
    let warped = match (image.pixels(), placing) {
        (pixels, Some(spans)) if spans.iter().all(Span::keeps_size) => {
            let show = Moved { spans, width };
            let pixels: Pixels = match pixels {
                Pixels::U8(data) => each_plane(image, data, map, level, &show).into(),
                Pixels::U16(data) => each_plane(image, data, map, 0, &show).into(),
                Pixels::F32(data) => each_plane(image, data, map, 0.0, &show).into(),
            };
            Image::new(pixels, width, height, image.format(), image.layout())?
        }
        (Pixels::U8(_), Some(spans)) => stretched(image, &spans, [width, height], level)?,
        (Pixels::U8(_), None) => blended(image, map, level)?,
        (Pixels::U16(data), _) => {
            let pixels = each_plane(image, data, map, 0, &Nearest::new(map));
            Image::new(pixels, width, height, image.format(), image.layout())?
        }
        (Pixels::F32(data), _) => {
            let pixels = each_plane(image, data, map, 0.0, &Nearest::new(map));
            Image::new(pixels, width, height, image.format(), image.layout())?
        }
    };
    Ok(warped.with_header(image.header.clone()))
}

/// Checks that an image has at least one pixel and at most [`MAX_SAMPLES`] samples.
pub(super) fn check_size([width, height]: [usize; 2], channels: usize) -> Result<()> {
    match width.saturating_mul(height).saturating_mul(channels) {
        1..=MAX_SAMPLES => Ok(()),
        _ => Err(Error::invalid_param(format!(
            "an image or label map would become {width}x{height} of {channels} channels; choose a size of at least one \
            pixel and at most {MAX_SAMPLES} samples"
        ))),
    }
}

/// Transforms a plane of single samples with the nearest neighbour; `fill` outside of the input.
pub(super) fn nearest_plane<T: Copy>(plane: &[T], map: &AffineMap, fill: T) -> Result<Vec<T>> {
    let [width, height] = map.output_size();
    check_size([width, height], 1)?;
    let mut out = vec![fill; width * height];
    match spans(map) {
        Some(spans) if spans.iter().all(Span::keeps_size) => {
            Moved { spans, width }.write(plane, map.input_size()[0], 1, &mut out);
        }
        _ => Nearest::new(map).write(plane, map.input_size()[0], 1, &mut out),
    }
    Ok(out)
}

/// Sampling of one plane into another.
trait Resample {
    /// Writes `plane`, of `width` pixels per row and `pixel` samples per pixel, into `out`.
    fn write<T: Copy>(&self, plane: &[T], width: usize, pixel: usize, out: &mut [T]);
}

/// Transforms the planes of an image: one of whole pixels, or one for each channel, as stored.
fn each_plane<T: Copy>(
    image: &Image,
    samples: &[T],
    map: &AffineMap,
    fill: T,
    show: &impl Resample,
) -> Vec<T> {
    let pixel = if image.layout() == Layout::Hwc { image.channels() } else { 1 };
    let [columns, rows] = map.output_size();
    let mut out = vec![fill; columns * rows * image.channels()];
    let planes = samples.chunks_exact(image.width() * image.height() * pixel);
    for (plane, out) in planes.zip(out.chunks_exact_mut(columns * rows * pixel)) {
        show.write(plane, image.width(), pixel, out);
    }
    out
}

/// Copy of unchanged pixels to another place.
struct Moved {
    spans: [Span; 2],
    /// Width of the output.
    width: usize,
}

impl Resample for Moved {
    fn write<T: Copy>(&self, plane: &[T], width: usize, pixel: usize, out: &mut [T]) {
        let [x, y] = &self.spans;
        for (index, row) in y.to.clone().enumerate() {
            let from = if y.mirrored { y.from.end - 1 - index } else { y.from.start + index };
            let source = &plane[(from * width + x.from.start) * pixel..][..x.from.len() * pixel];
            let target = &mut out[(row * self.width + x.to.start) * pixel..][..x.to.len() * pixel];
            match (x.mirrored, pixel) {
                (false, _) => target.copy_from_slice(source),
                (true, 1) => reverse::<T, 1>(source, target),
                (true, 3) => reverse::<T, 3>(source, target),
                (true, _) => reverse::<T, 4>(source, target),
            }
        }
    }
}

fn reverse<T: Copy, const PIXEL: usize>(source: &[T], target: &mut [T]) {
    let pixels = source.as_chunks::<PIXEL>().0.iter().rev();
    target.as_chunks_mut::<PIXEL>().0.iter_mut().zip(pixels).for_each(|(target, source)| *target = *source);
}

/// Nearest neighbour.
struct Nearest {
    back: Option<[[f64; 3]; 2]>,
    input_size: [usize; 2],
    width: usize,
}

impl Nearest {
    fn new(map: &AffineMap) -> Self {
        let (input_size, [width, _]) = (map.input_size(), map.output_size());
        Self { back: map.input_from_output(), input_size, width }
    }
}

impl Resample for Nearest {
    fn write<T: Copy>(&self, plane: &[T], width: usize, pixel: usize, out: &mut [T]) {
        let Some([[a, b, c], [d, e, f]]) = self.back else { return };
        let [columns, rows] = self.input_size.map(|side| side as f64);
        for (index, target) in out.chunks_exact_mut(pixel).enumerate() {
            let (x, y) = ((index % self.width) as f64 + 0.5, (index / self.width) as f64 + 0.5);
            let (x, y) = (a * x + b * y + c, d * x + e * y + f);
            if x >= 0.0 && y >= 0.0 && x < columns && y < rows {
                let at = (y as usize * width + x as usize) * pixel;
                target.copy_from_slice(&plane[at..at + pixel]);
            }
        }
    }
}

/// Transforms an image by scaling, shifting and mirroring, with the kernels of network inputs.
fn stretched(image: &Image, [x, y]: &[Span; 2], [width, height]: [usize; 2], level: u8) -> Result<Image> {
    let (order, format) = match image.format() {
        PixelFormat::Grey => (ChannelOrder::Grey, PixelFormat::Grey),
        _ => (ChannelOrder::Rgb, PixelFormat::Rgb),
    };
    let channels = format.channels();
    let window = image.view().crop(x.from.start, y.from.start, x.from.len(), y.from.len());
    let Some(window) = window else {
        return Image::new(vec![level; width * height * channels], width, height, format, Layout::Hwc);
    };
    let [columns, rows] = [x.to.len(), y.to.len()];
    // The loader already uses a thread for each core.
    let scaling = Preprocess::new(columns, rows).order(order).layout(Layout::Hwc).threads(1);
    let mut scaled = vec![0u8; scaling.len()];
    scaling.run_into(window, &mut scaled)?;
    if [columns, rows] == [width, height] && !x.mirrored && !y.mirrored {
        return Image::new(scaled, width, height, format, Layout::Hwc);
    }
    let spans = [x, y].map(|span| Span { from: 0..span.to.len(), ..span.clone() });
    let mut canvas = vec![level; width * height * channels];
    Moved { spans, width }.write(&scaled, columns, channels, &mut canvas);
    Image::new(canvas, width, height, format, Layout::Hwc)
}

/// Transforms an image by any map with bilinear interpolation.
fn blended(image: &Image, map: &AffineMap, level: u8) -> Result<Image> {
    let format = match image.format() {
        PixelFormat::Grey => PixelFormat::Grey,
        _ => PixelFormat::Rgb,
    };
    let copy;
    let bytes: &[u8] = match image.pixels() {
        Pixels::U8(bytes) if image.format() == format && image.layout() == Layout::Hwc => bytes,
        _ => {
            copy = image.hwc_u8(format);
            &copy
        }
    };
    let [width, height] = map.output_size();
    let samples = match format {
        PixelFormat::Grey => blended_pixels::<1>(bytes, map, level),
        _ => blended_pixels::<3>(bytes, map, level),
    };
    Image::new(samples, width, height, format, Layout::Hwc)
}

fn blended_pixels<const CHANNELS: usize>(bytes: &[u8], map: &AffineMap, level: u8) -> Vec<u8> {
    let [columns, rows] = map.output_size();
    let mut out = vec![[level; CHANNELS]; columns * rows];
    let Some([[a, b, c], [d, e, f]]) = map.input_from_output() else { return out.into_flattened() };
    let pixels = bytes.as_chunks::<CHANNELS>().0;
    let [width, height] = map.input_size().map(|side| side as i64);
    let pixel = |x: i64, y: i64| {
        let inside = x >= 0 && y >= 0 && x < width && y < height;
        if inside { pixels[(y * width + x) as usize] } else { [level; CHANNELS] }
    };
    for (index, target) in out.iter_mut().enumerate() {
        let (x, y) = ((index % columns) as f64 + 0.5, (index / columns) as f64 + 0.5);
        let (x, y) = (a * x + b * y + c - 0.5, d * x + e * y + f - 0.5);
        // NaN is outside, too.
        if !(x > -1.0 && y > -1.0 && x < width as f64 && y < height as f64) {
            continue;
        }
        let (left, top) = (x.floor(), y.floor());
        let [right, lower] = [x - left, y - top].map(|part| (part * 256.0 + 0.5) as u32);
        let (left, top) = (left as i64, top as i64);
        let four = [pixel(left, top), pixel(left + 1, top), pixel(left, top + 1), pixel(left + 1, top + 1)];
        let weights =
            [(256 - right) * (256 - lower), right * (256 - lower), (256 - right) * lower, right * lower];
        *target = std::array::from_fn(|channel| {
            let sum: u32 =
                four.iter().zip(weights).map(|(pixel, weight)| u32::from(pixel[channel]) * weight).sum();
            ((sum + (1 << 15)) >> 16) as u8
        });
    }
    out.into_flattened()
}
