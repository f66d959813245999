//! From light to the bytes of an image: brightness, white balance, blur, noise.

use opendr_engine::Random;

use crate::raycast::Vector;

/// Settings of a camera that differ between images.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exposure {
    gain: Vector,
    gamma: f32,
    noise: f32,
    /// Radius of the blur, pixels.
    blur: usize,
    /// Share of light lost in the corners.
    vignette: f32,
}

impl Exposure {
    pub fn draw(random: &mut Random) -> Self {
        let level = random.uniform(0.75, 1.35);
        Self {
            gain: [(); 3].map(|()| level * random.uniform(0.92, 1.08)),
            gamma: random.uniform(0.8, 1.25),
            noise: random.uniform(0.0, 9.0),
            blur: [0, 0, 0, 1, 2][random.below(5)],
            vignette: random.uniform(0.0, 0.35),
        }
    }

    /// Returns RGB bytes of colours from 0 to 1, row by row.
    pub fn develop(&self, mut colours: Vec<Vector>, width: usize, random: &mut Random) -> Vec<u8> {
        for _ in 0..self.blur {
            colours = softened(&colours, width);
        }
        let height = colours.len() / width.max(1);
        let centre = [width, height].map(|pixels| 0.5 * pixels as f32);
        let mut bytes = Vec::with_capacity(3 * colours.len());
        for (at, colour) in colours.iter().enumerate() {
            let [x, y] = [(at % width) as f32 / centre[0] - 1.0, (at / width) as f32 / centre[1] - 1.0];
            let light = 1.0 - self.vignette * 0.5 * (x * x + y * y);
            let bits = random.bits();
            for (part, gain) in self.gain.iter().enumerate() {
                let noise = ((bits >> (16 * part)) & 0xffff) as f32 / 32_768.0 - 1.0;
                let level = (light * gain * colour[part]).clamp(0.0, 1.0).powf(self.gamma);
                bytes.push((255.0 * level + self.noise * noise).round().clamp(0.0, 255.0) as u8);
            }
        }
        bytes
    }
}

/// Returns the mean of each pixel with its four neighbours; edges repeat.
fn softened(colours: &[Vector], width: usize) -> Vec<Vector> {
    let height = colours.len() / width.max(1);
    let soften = |at: usize| {
        let (x, y) = (at % width, at / width);
        let left = y * width + x.saturating_sub(1);
        let right = y * width + (x + 1).min(width - 1);
        let above = y.saturating_sub(1) * width + x;
        let below = (y + 1).min(height - 1) * width + x;
        std::array::from_fn(|part| {
            let around: f32 = [left, right, above, below].iter().map(|near| colours[*near][part]).sum();
            (2.0 * colours[at][part] + around) / 6.0
        })
    };
    (0..colours.len()).map(soften).collect()
}
