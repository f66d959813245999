//! Run-length encoded masks, as in COCO.

mod outline;
mod overlap;

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// A mask as lengths of runs, column by column: first a run of background, then one of the object, and so on (COCO's
/// RLE).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "RleJson", into = "RleJson")]
pub struct Rle {
    height: u32,
    width: u32,
    counts: Vec<u32>,
}

/// The JSON form. COCO writes the runs as numbers (crowds) or packed into text.
#[derive(Serialize, Deserialize)]
struct RleJson {
    size: [u32; 2],
    counts: Counts,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Counts {
    Packed(String),
    Plain(Vec<u32>),
}

impl Rle {
    /// Creates a mask of `height` x `width` pixels from its runs.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the sum of the runs is not the number of pixels.
    pub fn new(height: u32, width: u32, counts: Vec<u32>) -> Result<Self> {
        let (area, filled) =
            (u64::from(height) * u64::from(width), counts.iter().copied().map(u64::from).sum::<u64>());
        if filled != area {
            return Err(Error::invalid_input(format!(
                "the runs of a {height}x{width} mask fill {filled} pixels instead of {area}; give the size of the mask"
            )));
        }
        Ok(Self { height, width, counts })
    }

    /// Encodes a mask in row-major order (`[height, width]`).
    ///
    /// # Errors
    /// Returns `InvalidInput` if there are not `height * width` pixels.
    pub fn from_mask(mask: &[bool], height: u32, width: u32) -> Result<Self> {
        let (rows, columns) = (height as usize, width as usize);
        let (mut counts, mut inside, mut run) = (Vec::new(), false, 0u32);
        if mask.len() as u64 == u64::from(height) * u64::from(width) {
            for at in (0..columns).flat_map(|x| (0..rows).map(move |y| y * columns + x)) {
                if mask[at] != inside {
                    counts.push(std::mem::take(&mut run));
                    inside = !inside;
                }
                run += 1;
            }
        }
        counts.push(run);
        Self::new(height, width, counts)
    }

    /// Returns `[height, width]` in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.height, self.width]
    }

    /// Returns the lengths of the runs, background first.
    pub fn counts(&self) -> &[u32] {
        &self.counts
    }

    /// Returns the number of pixels of the object.
    pub fn area(&self) -> u64 {
        self.counts.iter().skip(1).step_by(2).map(|run| u64::from(*run)).sum()
    }

    /// Decodes the mask in row-major order (`[height, width]`).
    ///
    /// # Errors
    /// Returns `InvalidInput` for a mask of more than 2^28 pixels.
    pub fn mask(&self) -> Result<Vec<bool>> {
        let (rows, columns) = (self.height as usize, self.width as usize);
        if u64::from(self.height) * u64::from(self.width) > 1 << 28 {
            return Err(Error::invalid_input(format!(
                "a mask of {rows}x{columns} pixels is too large to decode; scale the image down"
            )));
        }
        let mut mask = vec![false; rows * columns];
        let runs = self.counts.iter().enumerate();
        let columnwise = runs.flat_map(|(index, run)| std::iter::repeat_n(index % 2 == 1, *run as usize));
        for (at, inside) in columnwise.enumerate() {
            mask[at % rows * columns + at / rows] = inside;
        }
        Ok(mask)
    }

    /// Returns COCO's packed text: differences to the run before the last, five bits per character.
    pub fn packed(&self) -> String {
        let mut text = String::new();
        for (index, run) in self.counts.iter().enumerate() {
            let before = if index > 2 { i64::from(self.counts[index - 2]) } else { 0 };
            let mut rest = i64::from(*run) - before;
            loop {
                let bits = (rest & 0x1f) as u8;
                rest >>= 5;
                let more = rest != if bits & 0x10 == 0 { 0 } else { -1 };
                text.push(char::from(48 + bits + if more { 0x20 } else { 0 }));
                if !more {
                    break;
                }
            }
        }
        text
    }

    /// Parses COCO's packed text.
    ///
    /// # Errors
    /// Returns `Format` for invalid text, `InvalidInput` if the sum of the runs is not the number of pixels.
    pub fn from_packed(height: u32, width: u32, text: &str) -> Result<Self> {
        let invalid =
            || Error::format(format!("{text:.40?} is not a packed COCO mask; write the mask again"));
        let (mut counts, mut value, mut shift) = (Vec::<u32>::new(), 0i64, 0u32);
        for byte in text.bytes() {
            let bits = byte.checked_sub(48).filter(|bits| *bits < 64 && shift <= 35).ok_or_else(invalid)?;
            value |= i64::from(bits & 0x1f) << shift;
            shift += 5;
            if bits & 0x20 == 0 {
                if bits & 0x10 != 0 {
                    value |= -1 << shift;
                }
                let before = if counts.len() > 2 { counts[counts.len() - 2] } else { 0 };
                counts.push(u32::try_from(value + i64::from(before)).map_err(|_| invalid())?);
                (value, shift) = (0, 0);
            }
        }
        if shift != 0 {
            return Err(invalid());
        }
        Self::new(height, width, counts)
    }
}

impl TryFrom<RleJson> for Rle {
    type Error = Error;

    fn try_from(RleJson { size: [height, width], counts }: RleJson) -> Result<Self> {
        match counts {
            Counts::Packed(text) => Self::from_packed(height, width, &text),
            Counts::Plain(counts) => Self::new(height, width, counts),
        }
    }
}

impl From<Rle> for RleJson {
    fn from(rle: Rle) -> Self {
        Self { size: rle.size(), counts: Counts::Packed(rle.packed()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texts are those of pycocotools 2.0.
    #[test]
    fn packed_text_is_that_of_pycocotools() {
        let mask: Vec<bool> = (0..6 * 9).map(|at| (at / 9 * 7 + at % 9 * 3) % 5 < 2).collect();
        let rle = Rle::from_mask(&mask, 6, 9).unwrap();
        assert_eq!(rle.packed(), "0120O00010O00010O00030M00010O00010O00010O0001");
        assert_eq!(Rle::from_packed(6, 9, &rle.packed()).unwrap(), rle);
        assert_eq!((rle.mask().unwrap(), rle.area()), (mask, 22));
        let big = Rle::new(1000, 1000, vec![5, 100, 999_800, 40, 55]).unwrap();
        assert_eq!(big.packed(), "5T3h[`n0TNoe_QO");
    }

    #[test]
    fn wrong_masks_are_rejected() {
        assert!(Rle::new(2, 2, vec![1, 2]).is_err());
        assert!(Rle::from_mask(&[true; 3], 2, 2).is_err());
        assert!(Rle::new(u32::MAX, u32::MAX, vec![u32::MAX; 3]).is_err());
        for text in ["", "o", "ooooooooooooooooo0", "\u{7f}", "é", "04o0"] {
            assert!(Rle::from_packed(2, 2, text).is_err(), "{text}");
        }
    }
}
