//! Census transform: a bit pattern of each pixel's neighbourhood.
//!
//! R. Zabih, J. Woodfill, "Non-parametric local transforms for computing visual correspondence", ECCV 1994: a bit for
//! each neighbour states whether it is darker, so the brightness of the two cameras may differ.

/// Extent of the window to each side, in pixels: 9 x 7.
const REACH: [usize; 2] = [4, 3];
/// Bits of a window without its centre.
pub(super) const BITS: u8 = 62;
/// Bytes that contain these bits.
const BYTES: usize = 8;

/// The census transform of an image; its memory is reused.
#[derive(Debug, Default)]
pub(super) struct Census {
    /// The image with replicated edges.
    padded: Vec<u8>,
    planes: Vec<u8>,
    /// One word per pixel, row by row.
    pub words: Vec<u64>,
}

impl Census {
    /// Transforms an image of grey levels. With `is_mirrored`, each row of words is written in reverse.
    pub fn fill(&mut self, grey: &[u8], [width, height]: [usize; 2], is_mirrored: bool) {
        let Self { padded, planes, words } = self;
        let [across, down] = REACH;
        let stride = width + 2 * across;
        padded.clear();
        for y in 0..height + 2 * down {
            let y = y.saturating_sub(down).min(height - 1);
            let row = &grey[y * width..][..width];
            padded.extend((0..across).map(|_| row[0]));
            padded.extend(row);
            padded.extend((0..across).map(|_| row[width - 1]));
        }
        words.clear();
        words.resize(width * height, 0);
        planes.resize(BYTES * width, 0);
        for (y, row) in words.chunks_exact_mut(width).enumerate() {
            planes.fill(0);
            let middles = &padded[(y + down) * stride + across..][..width];
            let places = (0..=2 * down).flat_map(|dy| (0..=2 * across).map(move |dx| [dx, dy]));
            for (number, [dx, dy]) in places.filter(|place| *place != REACH).enumerate() {
                let bit = 1_u8 << (number % 8);
                let neighbours = &padded[(y + dy) * stride + dx..][..width];
                let plane = &mut planes[number / 8 * width..][..width];
                for ((bits, neighbour), middle) in plane.iter_mut().zip(neighbours).zip(middles) {
                    *bits |= if neighbour < middle { bit } else { 0 };
                }
            }
            for (x, word) in row.iter_mut().enumerate() {
                *word = u64::from_le_bytes(std::array::from_fn(|byte| planes[byte * width + x]));
            }
            if is_mirrored {
                row.reverse();
            }
        }
    }
}
