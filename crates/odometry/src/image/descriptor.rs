//! Binary descriptors of corners.

use opendr_engine::Random;

use super::pyramid::Level;

/// 256 comparisons of luminances around a corner (M. Calonder et al., BRIEF, 2010).
pub(crate) type Descriptor = [u64; 4];

/// The pairs of places that are compared.
#[derive(Debug, Clone)]
pub(crate) struct Sampling {
    pairs: Vec<[[i32; 2]; 2]>,
}

/// Half side of the described window, in pixels of its level.
const HALF: f64 = 11.0;

impl Sampling {
    /// Draws the pairs, normally distributed around the corner; always the same.
    pub fn new() -> Self {
        let mut random = Random::new(0x0b21_ef00);
        let mut place = || [(); 2].map(|()| (random.normal() * HALF / 2.0).round().clamp(-HALF, HALF) as i32);
        Self { pairs: (0..256).map(|_| [place(), place()]).collect() }
    }

    /// Describes the corner at a place of the image, on the level of half the size; `None` near the border.
    ///
    /// The level's means of 2x2 pixels, of which two rows and columns are added, suppress noise.
    pub fn describe(&self, level: &Level, corner: [f32; 2]) -> Option<Descriptor> {
        let [x, y] = corner.map(|at| ((at + 0.5) / 2.0 - 0.5).round() as i64);
        let margin = HALF as i64 + 1;
        let fits = x >= margin
            && y >= margin
            && x + margin + 1 < level.width as i64
            && y + margin + 1 < level.height as i64;
        if !fits {
            return None;
        }
        let middle = y as usize * level.width + x as usize;
        let mean = |[dx, dy]: [i32; 2]| {
            let at = middle.wrapping_add_signed(dy as isize * level.width as isize + dx as isize);
            level.luminance[at]
                + level.luminance[at + 1]
                + level.luminance[at + level.width]
                + level.luminance[at + level.width + 1]
        };
        let mut bits = Descriptor::default();
        for (number, [one, other]) in self.pairs.iter().enumerate() {
            bits[number / 64] |= u64::from(mean(*one) < mean(*other)) << (number % 64);
        }
        Some(bits)
    }
}

/// Returns the number of bits that differ.
pub(crate) fn distance(a: &Descriptor, b: &Descriptor) -> u32 {
    a.iter().zip(b).map(|(a, b)| (a ^ b).count_ones()).sum()
}
