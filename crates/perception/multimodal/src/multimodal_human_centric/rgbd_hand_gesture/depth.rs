//! Normalisation of depth images.

use opendr_engine::data::{Image, ImageView, Samples};
use opendr_engine::{Error, Result};

/// Converts depth to nearness relative to the nearest point, independent of the camera's position and unit.
#[derive(Debug, Clone)]
pub(super) struct DepthNormaliser {
    side: usize,
}

/// Distance behind the nearest point, in metres, at which nearness is 0.
const REACH: f32 = 0.6;
/// Divisor of the number of known pixels: the nearest fiftieth counts as outliers.
const OUTLIERS: usize = 50;

impl DepthNormaliser {
    /// Creates a normaliser to images of `side` x `side`.
    pub fn new(side: usize) -> Self {
        Self { side }
    }

    /// Fills `nearness` `[side, side]` with 1 for the nearest point, falling to 0 at [`REACH`] behind it; 0 also for unknown
    /// depth. Resizing is by nearest neighbour, so that edges stay sharp. `depths` is a buffer.
    ///
    /// # Errors
    /// `InvalidInput` when `depth` has more than one channel.
    pub fn run_into(&self, depth: &Image, depths: &mut Vec<f32>, nearness: &mut [f32]) -> Result<()> {
        if depth.channels() != 1 {
            return Err(Error::invalid_input(format!(
                "the depth image has {} channels; it must have one",
                depth.channels()
            )));
        }
        let view = depth.view();
        for (row, line) in nearness.chunks_exact_mut(self.side).enumerate() {
            let y = place(row, self.side, view.height());
            for (column, pixel) in line.iter_mut().enumerate() {
                *pixel = metres(&view, place(column, self.side, view.width()), y);
            }
        }
        depths.clear();
        depths.extend(nearness.iter().filter(|distance| **distance > 0.0));
        if depths.is_empty() {
            return Ok(());
        }
        let rank = depths.len() / OUTLIERS;
        let (_, nearest, _) = depths.select_nth_unstable_by(rank, f32::total_cmp);
        let far = *nearest + REACH;
        for pixel in nearness {
            *pixel = if *pixel > 0.0 { ((far - *pixel) / REACH).clamp(0.0, 1.0) } else { 0.0 };
        }
        Ok(())
    }
}

/// Returns the pixel of a line of `from` pixels at the centre of pixel `at` of `to` pixels.
fn place(at: usize, to: usize, from: usize) -> usize {
    (2 * at + 1) * from / (2 * to)
}

/// Returns the depth at a pixel in metres; 0 where it is unknown.
fn metres(view: &ImageView<'_>, x: usize, y: usize) -> f32 {
    let [row, column, _] = view.strides();
    let at = y * row + x * column;
    let distance = match view.samples() {
        Samples::U8(data) => data.get(at).map(|level| f32::from(*level) / 100.0),
        Samples::U16(data) => data.get(at).map(|level| f32::from(*level) / 1000.0),
        Samples::F32(data) => data.get(at).copied(),
    };
    distance.filter(|distance| distance.is_finite() && *distance > 0.0).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::{Layout, PixelFormat, Pixels};

    use super::*;

    fn nearness(pixels: impl Into<Pixels>) -> Vec<f32> {
        let image = Image::new(pixels, 4, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
        let mut nearness = vec![9.0; 4];
        DepthNormaliser::new(2).run_into(&image, &mut Vec::new(), &mut nearness).unwrap();
        nearness
    }

    #[test]
    fn nearness_is_independent_of_unit_and_camera_position() {
        let metres = vec![0.0f32, 0.5, 0.0, 0.8, 0.0, 9.0, 0.0, f32::NAN];
        let wanted = [1.0, 0.5, 0.0, 0.0];
        let near = |got: Vec<f32>| got.iter().zip(wanted).all(|(got, wanted)| (got - wanted).abs() < 1e-4);
        assert!(near(nearness(metres.clone())));
        let farther = |metres: &f32| if *metres > 0.0 { metres + 2.0 } else { 0.0 };
        assert!(near(nearness(metres.iter().map(farther).collect::<Vec<_>>())));
        let millimetres = |metres: &f32| (metres * 1000.0) as u16;
        assert!(near(nearness(metres.iter().map(millimetres).collect::<Vec<_>>())));
        assert_eq!(nearness(vec![0u16; 8]), [0.0; 4]);
        let colour = Image::from_rgb8(vec![1; 3], 1, 1).unwrap();
        assert!(DepthNormaliser::new(2).run_into(&colour, &mut Vec::new(), &mut [0.0; 4]).is_err());
    }
}
