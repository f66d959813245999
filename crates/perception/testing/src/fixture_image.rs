//! The image on which the fixtures of exported networks were made.

use opendr_engine::data::Image;

/// Returns the image of `tests/extended/exported_network_fixtures.py`, RGB.
///
/// # Panics
/// Panics for a side of 0.
pub fn fixture_image(width: usize, height: usize) -> Image {
    let level = |x: usize, y: usize, c: usize| ((x * 5 + y * 11 + c * 71 + x * y / 7) % 256) as u8;
    let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = rows.flat_map(|(x, y)| (0..3).map(move |c| level(x, y, c))).collect();
    Image::from_rgb8(pixels, width, height).unwrap()
}
