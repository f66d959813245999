//! Time series as an image.

use opendr_engine::data::Image;
use opendr_engine::{Error, Result};
use opendr_vision::draw::{Canvas, Colour, colour_of_index};

/// Width and height in pixels.
const SIZE: [usize; 2] = [320, 240];
const BACKGROUND: u8 = 24;
/// Largest number of features that are drawn.
const MAX_FEATURES: usize = 8;

/// Draws values `[time, features]` from left to right, each feature in its own colour.
///
/// # Errors
/// `InvalidInput` without a value.
pub(crate) fn curve(numbers: &[f32], features: usize) -> Result<Image> {
    if features == 0 || numbers.len() < features {
        return Err(Error::invalid_input("the time series is empty; drawing needs at least one time step"));
    }
    let [width, height] = SIZE;
    let mut image = Image::from_rgb8(vec![BACKGROUND; width * height * 3], width, height)?;
    let mut canvas = Canvas::over(&mut image);
    for feature in 0..features.min(MAX_FEATURES) {
        let column: Vec<f32> = numbers.iter().skip(feature).step_by(features).copied().collect();
        draw_feature(&mut canvas, &column, colour_of_index(feature as i64));
    }
    Ok(image)
}

/// Draws one feature from its minimum to its maximum; a column of pixels covers the range of its time steps.
fn draw_feature(canvas: &mut Canvas<'_>, numbers: &[f32], colour: Colour) {
    let [width, height] = [canvas.width(), canvas.height()];
    let (low, high) = range(numbers);
    let place = |number: f32| {
        let share = if high > low { (number - low) / (high - low) } else { 0.5 };
        height as f32 * (0.95 - 0.9 * share)
    };
    for column in 0..width {
        // One time step of the next column is included, so that the curve is continuous.
        let start = numbers.len() * column / width;
        let end = (numbers.len() * (column + 1)).div_ceil(width) + 1;
        let (least, most) = range(&numbers[start..end.min(numbers.len())]);
        if least <= most {
            let x = column as f32;
            canvas.fill([x, place(most) - 0.75, x + 1.0, place(least) + 0.75], colour, 0.8);
        }
    }
}

/// Returns the minimum and maximum of the finite values; the minimum is larger if there are none.
fn range(numbers: &[f32]) -> (f32, f32) {
    let finite = numbers.iter().copied().filter(|number| number.is_finite());
    finite.fold((f32::MAX, f32::MIN), |(low, high), number| (low.min(number), high.max(number)))
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::PixelFormat;

    use super::*;

    #[test]
    fn a_rising_line_rises() {
        let numbers: Vec<f32> = (0..50).flat_map(|time| [time as f32, f32::NAN]).collect();
        let image = curve(&numbers, 2).unwrap();
        let grey = image.hwc_u8(PixelFormat::Grey);
        let top = |column: usize| (0..SIZE[1]).find(|row| grey[row * SIZE[0] + column] > BACKGROUND);
        let tops: Vec<usize> = (0..SIZE[0]).filter_map(top).collect();
        assert_eq!(tops.len(), SIZE[0]);
        assert!(tops.windows(2).all(|pair| pair[1] <= pair[0]) && tops[0] > 210 && tops[SIZE[0] - 1] < 20);
        assert!(curve(&[f32::INFINITY; 3], 1).is_ok() && curve(&[], 1).is_err() && curve(&[1.0], 0).is_err());
    }
}
