//! Colour map of scores: dark violet is low, bright yellow is high.

use crate::draw::palette::{Colour, rgb_from_oklch};

/// Returns 256 colours whose lightness rises evenly (in OKLCH), so that the order also holds in grey.
pub(super) fn heat_colours() -> Vec<Colour> {
    (0..=255u8)
        .map(|step| {
            let part = f32::from(step) / 255.0;
            let chroma = 0.21 * (std::f32::consts::PI * (0.15 + 0.75 * part)).sin();
            rgb_from_oklch(0.22 + 0.73 * part, chroma, 285.0 + 185.0 * part)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_brighter() {
        let colours = heat_colours();
        let grey = |[red, green, blue]: Colour| {
            0.2126 * f32::from(red).powf(2.2)
                + 0.7152 * f32::from(green).powf(2.2)
                + 0.0722 * f32::from(blue).powf(2.2)
        };
        assert_eq!(colours.len(), 256);
        assert!(colours.windows(9).all(|pair| grey(pair[8]) > grey(pair[0])));
    }
}
