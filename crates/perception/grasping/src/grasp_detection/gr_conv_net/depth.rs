//! Depth channel of the network's input.

use opendr_engine::data::{Image, PixelFormat, Pixels};
use opendr_engine::{Error, Result};
use opendr_vision::Similarity;

/// Fills `out`, `side` x `side`, with the depths of `crop` in metres minus their mean, within -1..=1. Unknown depths (0, NaN,
/// outside of the image) are replaced by the mean; without any known depth, all values are 0.
///
/// # Errors
/// `InvalidInput` for an image of more than one channel or of 8 bits.
pub fn depth_square(depth: &Image, crop: &Similarity, side: usize, out: &mut [f32]) -> Result<()> {
    let known = |metres: f32| metres.is_finite() && metres > 0.0;
    let metres: &dyn Fn(usize) -> f32 = match (depth.format(), depth.pixels()) {
        (PixelFormat::Grey, Pixels::U16(data)) => {
            &move |at| data.get(at).map_or(0.0, |&mm| f32::from(mm) / 1e3)
        }
        (PixelFormat::Grey, Pixels::F32(data)) => &move |at| data.get(at).copied().unwrap_or_default(),
        _ => {
            return Err(Error::invalid_input(
                "the depth image must have one channel, of 16 bits in millimetres or floats in metres, as the camera returns it",
            ));
        }
    };
    let (width, height) = (depth.width() as f32, depth.height() as f32);
    let (mut sum, mut count) = (0.0, 0u32);
    for (row, places) in out.chunks_exact_mut(side).enumerate() {
        for (column, place) in places.iter_mut().enumerate() {
            let [x, y] = crop.image_from_crop([column as f32 + 0.5, row as f32 + 0.5]);
            let inside = x >= 0.0 && y >= 0.0 && x < width && y < height;
            let here = if inside { metres(y as usize * depth.width() + x as usize) } else { 0.0 };
            *place = if known(here) { here } else { f32::NAN };
            if known(here) {
                sum += f64::from(here);
                count += 1;
            }
        }
    }
    let mean = if count == 0 { 0.0 } else { (sum / f64::from(count)) as f32 };
    for place in out {
        *place = if place.is_nan() { 0.0 } else { (*place - mean).clamp(-1.0, 1.0) };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Layout;

    use super::*;

    #[test]
    fn unknown_depths_are_the_mean_and_millimetres_become_metres() {
        let depth = |pixels: Pixels| Image::new(pixels, 2, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
        let crop = Similarity::rotated_square([1.0, 1.0], 2.0, 0.0, 2);
        let mut out = [9.0; 4];
        depth_square(&depth(vec![500u16, 1000, 0, 1500].into()), &crop, 2, &mut out).unwrap();
        assert_eq!(out, [-0.5, 0.0, 0.0, 0.5]);
        depth_square(&depth(vec![f32::NAN, 5.0, f32::INFINITY, 1.0].into()), &crop, 2, &mut out).unwrap();
        assert_eq!(out, [0.0, 1.0, 0.0, -1.0]);
        depth_square(&depth(vec![0.0f32; 4].into()), &crop, 2, &mut out).unwrap();
        assert_eq!(out, [0.0; 4]);
        let bytes = depth_square(&depth(vec![0u8; 4].into()), &crop, 2, &mut out).unwrap_err();
        assert!(bytes.to_string().contains("millimetres"), "{bytes}");
    }
}
