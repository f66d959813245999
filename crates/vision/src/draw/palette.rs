//! Distinguishable colours: one for every class or track, the same in every image.

use opendr_engine::target::Name;

/// Red, green, blue; sRGB.
pub type Colour = [u8; 3];

/// Number of colours before they repeat.
pub const COLOURS: u64 = 20;

/// Returns the colour of class or track `index`.
///
/// Hues step by the golden angle, so that neighbouring indices differ strongly in hue; lightness alternates.
pub fn colour_of_index(index: i64) -> Colour {
    const GOLDEN_ANGLE_DEG: f32 = 137.507_77;
    const FIRST_HUE_DEG: f32 = 150.0;
    let step = index.rem_euclid(COLOURS as i64) as f32;
    let lightness = [0.78, 0.68, 0.86][step as usize % 3];
    rgb_from_oklch(lightness, 0.19, FIRST_HUE_DEG + step * GOLDEN_ANGLE_DEG)
}

/// Returns the colour of a class by index, or by a hash of its label.
pub fn colour_of_name(name: &Name) -> Colour {
    match name {
        Name::Index(index) => colour_of_index(*index),
        // FNV-1a gives the same hash on every machine.
        Name::Label(label) => colour_of_index(
            (label.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            }) % COLOURS) as i64,
        ),
    }
}

/// Returns black or white, whichever has more contrast on `ground` (relative luminance of WCAG 2).
pub(super) fn ink_on(ground: Colour) -> Colour {
    let [red, green, blue] = ground.map(|sample| (f32::from(sample) / 255.0).powf(2.2));
    if 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.2 { [16; 3] } else { [255; 3] }
}

/// Converts OKLCH to sRGB (B. Ottosson, 2020): lightness 0..=1, chroma, hue in degrees. Chroma is reduced until the
/// colour lies in the sRGB gamut.
pub(super) fn rgb_from_oklch(lightness: f32, chroma: f32, hue_deg: f32) -> Colour {
    let mut chroma = chroma;
    loop {
        let linear = linear_from_oklch(lightness, chroma, hue_deg);
        if chroma <= 0.0 || linear.iter().all(|part| (-0.001..=1.001).contains(part)) {
            return linear.map(|part| (part.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0).round() as u8);
        }
        chroma -= 0.01;
    }
}

fn linear_from_oklch(lightness: f32, chroma: f32, hue_deg: f32) -> [f32; 3] {
    let (sine, cosine) = hue_deg.to_radians().sin_cos();
    let (a, b) = (chroma * cosine, chroma * sine);
    let long = (lightness + 0.396_337_78 * a + 0.215_803_76 * b).powi(3);
    let middle = (lightness - 0.105_561_346 * a - 0.063_854_17 * b).powi(3);
    let short = (lightness - 0.089_484_18 * a - 1.291_485_5 * b).powi(3);
    [
        4.076_741_7 * long - 3.307_711_6 * middle + 0.230_969_94 * short,
        -1.268_438 * long + 2.609_757_4 * middle - 0.341_319_4 * short,
        -0.004_196_086_3 * long - 0.703_418_6 * middle + 1.707_614_7 * short,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_distinguishable() {
        let colours: Vec<Colour> = (0..COLOURS as i64).map(colour_of_index).collect();
        for (index, one) in colours.iter().enumerate() {
            for other in &colours[..index] {
                let distance: u32 =
                    (0..3).map(|part| u32::from(one[part].abs_diff(other[part])).pow(2)).sum();
                assert!(distance > 20 * 20, "{one:?} {other:?}");
            }
        }
    }

    #[test]
    fn colours_are_stable() {
        assert_eq!(colour_of_index(3), colour_of_index(3 + COLOURS as i64));
        assert_eq!(colour_of_index(-1), colour_of_index(COLOURS as i64 - 1));
        assert_eq!(colour_of_index(i64::MIN), colour_of_index(i64::MIN.rem_euclid(COLOURS as i64)));
        assert_eq!(colour_of_name(&"person".into()), colour_of_name(&"person".into()));
        assert_ne!(colour_of_name(&"person".into()), colour_of_name(&"car".into()));
    }

    #[test]
    fn white_is_white() {
        assert_eq!(rgb_from_oklch(1.0, 0.0, 0.0), [255; 3]);
        assert_eq!(rgb_from_oklch(0.0, 0.0, 0.0), [0; 3]);
        assert_eq!((ink_on([255; 3]), ink_on([0, 0, 120])), ([16; 3], [255; 3]));
    }
}
