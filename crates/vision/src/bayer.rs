//! Conversion of Bayer mosaics to RGB.

use opendr_engine::{Error, Result};

/// Bayer pattern, by the colours of the first two pixels of the first two rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum BayerPattern {
    Rggb,
    Bggr,
    Gbrg,
    Grbg,
}

impl BayerPattern {
    /// All patterns.
    pub const ALL: [Self; 4] = [Self::Rggb, Self::Bggr, Self::Gbrg, Self::Grbg];

    /// Returns the name in lower case, e.g. `"rggb"`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rggb => "rggb",
            Self::Bggr => "bggr",
            Self::Gbrg => "gbrg",
            Self::Grbg => "grbg",
        }
    }

    /// Returns column and row of the first red pixel.
    const fn red(self) -> (usize, usize) {
        match self {
            Self::Rggb => (0, 0),
            Self::Bggr => (1, 1),
            Self::Gbrg => (0, 1),
            Self::Grbg => (1, 0),
        }
    }
}

/// Converts a Bayer mosaic `[height, width]` to RGB `[height, width, 3]`. Missing colours are interpolated
/// bilinearly; the image is mirrored at its border.
///
/// # Errors
/// `InvalidInput` when there are not `width * height` samples, or a side is shorter than 2.
pub fn rgb_from_bayer(samples: &[u8], width: usize, height: usize, pattern: BayerPattern) -> Result<Vec<u8>> {
    if width < 2 || height < 2 || width.checked_mul(height) != Some(samples.len()) {
        return Err(Error::invalid_input(format!(
            "{} samples do not form a Bayer mosaic of {width}x{height} pixels; pass one sample per pixel and at least 2x2 pixels",
            samples.len()
        )));
    }
    let (red_x, red_y) = pattern.red();
    let mut rgb = Vec::with_capacity(samples.len() * 3);
    for y in 0..height {
        let above = if y == 0 { 1 } else { y - 1 };
        let below = if y + 1 == height { y - 1 } else { y + 1 };
        let row = |y: usize| samples.get(y * width..(y + 1) * width).unwrap_or_default();
        let (above, here, below) = (row(above), row(y), row(below));
        for x in 0..width {
            let left = if x == 0 { 1 } else { x - 1 };
            let right = if x + 1 == width { x - 1 } else { x + 1 };
            let own = here[x];
            let beside = mean(&[here[left], here[right]]);
            let upright = mean(&[above[x], below[x]]);
            let cross = mean(&[here[left], here[right], above[x], below[x]]);
            let corners = mean(&[above[left], above[right], below[left], below[right]]);
            rgb.extend(match (x % 2 == red_x, y % 2 == red_y) {
                (true, true) => [own, cross, corners],
                (false, true) => [beside, own, upright],
                (true, false) => [upright, own, beside],
                (false, false) => [corners, cross, own],
            });
        }
    }
    Ok(rgb)
}

fn mean<const N: usize>(samples: &[u8; N]) -> u8 {
    let sum: usize = samples.iter().map(|sample| usize::from(*sample)).sum();
    ((sum + N / 2) / N) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_colour_stays_itself() {
        let colour = [200, 90, 30];
        for pattern in BayerPattern::ALL {
            let letters = pattern.name().as_bytes();
            for (width, height) in [(2, 2), (5, 4), (4, 7)] {
                let sample = |at: usize| {
                    let (x, y) = (at % width % 2, at / width % 2);
                    colour[b"rgb".iter().position(|letter| *letter == letters[y * 2 + x]).unwrap()]
                };
                let samples: Vec<u8> = (0..width * height).map(sample).collect();
                let rgb = rgb_from_bayer(&samples, width, height, pattern).unwrap();
                assert!(rgb.chunks(3).all(|pixel| pixel == colour), "{pattern:?} {width}x{height}: {rgb:?}");
            }
        }
    }

    #[test]
    fn sizes_are_checked() {
        assert!(rgb_from_bayer(&[0; 3], 3, 1, BayerPattern::Rggb).is_err());
        assert!(rgb_from_bayer(&[0; 5], 2, 2, BayerPattern::Rggb).is_err());
    }
}
