//! Map from pixels to objects, and its boxes with masks.

use opendr_engine::target::{BoundingBox, Name, Rle, Segment, Segmentation};
use opendr_engine::{Error, Result};

/// Index of the object of each pixel, 0 for none; buffers are reused.
#[derive(Debug, Clone, Default)]
pub struct OwnerMap {
    size: [usize; 2],
    owners: Vec<u8>,
    extents: Vec<Extent>,
}

/// Extent of the pixels of an object.
#[derive(Debug, Clone, Copy)]
struct Extent {
    left: usize,
    top: usize,
    right: usize,
    bottom: usize,
    pixels: u64,
}

impl OwnerMap {
    /// Resets the map to `[width, height]` pixels; `fill_row` fills a row of zeros, given its index.
    pub fn fill(&mut self, size @ [width, height]: [usize; 2], mut fill_row: impl FnMut(usize, &mut [u8])) {
        self.size = size;
        let nothing = Extent { left: width, top: height, right: 0, bottom: 0, pixels: 0 };
        self.extents.clear();
        self.extents.resize(usize::from(u8::MAX) + 1, nothing);
        self.owners.clear();
        self.owners.resize(width * height, 0);
        for (y, row) in self.owners.chunks_exact_mut(width.max(1)).enumerate() {
            fill_row(y, row);
            let mut x = 0;
            for run in row.chunk_by(|one, next| one == next) {
                if let Some(object) = run.first().filter(|object| **object > 0) {
                    let extent = &mut self.extents[usize::from(*object)];
                    (extent.left, extent.top) = (extent.left.min(x), extent.top.min(y));
                    (extent.right, extent.bottom) = (extent.right.max(x + run.len() - 1), y);
                    extent.pixels += run.len() as u64;
                }
                x += run.len();
            }
        }
    }

    /// Returns the object indices, row by row.
    pub fn owners(&self) -> &[u8] {
        &self.owners
    }

    /// Returns `[left, top, right, bottom]` of the pixels of an object; `None` when it has no pixel.
    pub fn corners(&self, object: u8) -> Option<[f32; 4]> {
        let extent = self.extents.get(usize::from(object)).filter(|extent| extent.pixels > 0)?;
        let Extent { left, top, right, bottom, .. } = *extent;
        Some([left, top, right + 1, bottom + 1].map(|edge| edge as f32))
    }

    /// Returns the bounding box of an object with its mask; `None` when it has no pixel.
    ///
    /// # Errors
    /// `InvalidInput` for an image with a side above 2^32 pixels.
    pub fn bounding_box(&self, object: u8, name: Name, confidence: f32) -> Result<Option<BoundingBox>> {
        let (Some(corners), Some(extent)) = (self.corners(object), self.extents.get(usize::from(object)))
        else {
            return Ok(None);
        };
        let mut found = BoundingBox::from_corners(name, corners, confidence);
        let segmentation = Segmentation::Rle(self.mask(object, extent)?);
        found.segment = Some(Box::new(Segment { segmentation, area: extent.pixels as f32, iscrowd: false }));
        Ok(Some(found))
    }

    fn mask(&self, object: u8, extent: &Extent) -> Result<Rle> {
        let [width, height] = self.size;
        let (mut counts, mut inside, mut begun) = (Vec::new(), false, 0);
        for x in extent.left..=extent.right {
            for y in extent.top..=extent.bottom + 1 {
                let is_object = y <= extent.bottom && self.owners[y * width + x] == object;
                if is_object != inside {
                    // Pixels are counted column by column.
                    let at = x * height + y;
                    inside = is_object;
                    match counts.pop_if(|_| is_object && at == begun) {
                        // The run continues from the bottom of a column to the top of the next.
                        Some(run) => begun -= run as usize,
                        None => {
                            counts.push((at - begun) as u32);
                            begun = at;
                        }
                    }
                }
            }
        }
        if begun < width * height {
            counts.push((width * height - begun) as u32);
        }
        let side = |side: usize| {
            u32::try_from(side).map_err(|_| {
                Error::invalid_input("the image is too large; its sides must be below 2^32 pixels")
            })
        };
        Rle::new(side(height)?, side(width)?, counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_contain_the_pixels_of_their_object() {
        let picture = ["..11", "2.11", "2..1", "2..."];
        let pixels: Vec<u8> =
            picture.concat().bytes().map(|byte| if byte == b'.' { 0 } else { byte - b'0' }).collect();
        let mut map = OwnerMap::default();
        for _ in 0..2 {
            map.fill([4, 4], |y, row| row.copy_from_slice(&pixels[y * 4..][..4]));
            for object in [1, 2] {
                let found = map.bounding_box(object, Name::Index(0), 0.5).unwrap().unwrap();
                let Segmentation::Rle(rle) = &found.segment.as_ref().unwrap().segmentation else { panic!() };
                let wanted: Vec<_> = pixels.iter().map(|pixel| *pixel == object).collect();
                assert_eq!(rle, &Rle::from_mask(&wanted, 4, 4).unwrap());
                assert_eq!(found.segment.as_ref().unwrap().area, rle.area() as f32);
            }
        }
        let corner = map.bounding_box(1, Name::Index(0), 0.5).unwrap().unwrap();
        assert_eq!(corner.corners(), [2.0, 0.0, 4.0, 3.0]);
        assert!(map.bounding_box(3, Name::Index(0), 0.5).unwrap().is_none());
        map.fill([2, 3], |_, row| row.fill(9));
        let whole = map.bounding_box(9, Name::Index(0), 0.5).unwrap().unwrap();
        let Segmentation::Rle(rle) = &whole.segment.as_ref().unwrap().segmentation else { panic!() };
        assert_eq!(rle.counts(), [0, 6]);
        map.fill([4, 4], |_, _| ());
        assert!(map.bounding_box(1, Name::Index(0), 0.5).unwrap().is_none());
    }
}
