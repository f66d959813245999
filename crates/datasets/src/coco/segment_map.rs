//! Pixels of panoptic segments and their image, whose colours are ids (red + 256 green + 65536 blue).

use std::collections::HashMap;

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::target::Rle;
use opendr_engine::{Error, Result};

/// Segment of each pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SegmentMap {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Segment index from 0, row by row.
    pub places: Vec<Option<u32>>,
    count: usize,
}

impl SegmentMap {
    /// Reads an image whose colours are `ids` and black.
    ///
    /// # Errors
    /// `Format` for another colour, and for an id without pixels.
    pub fn new(image: &Image, ids: &[u32]) -> Result<Self> {
        let numbers: HashMap<u32, u32> = ids.iter().copied().zip(0..).collect();
        let (rgb, width) = (image.hwc_u8(PixelFormat::Rgb), image.width());
        let mut has_pixels = vec![false; ids.len()];
        let mut places = Vec::with_capacity(rgb.len() / 3);
        let mut latest = (0, None);
        for (at, [red, green, blue]) in rgb.as_chunks().0.iter().copied().enumerate() {
            let id = u32::from_le_bytes([red, green, blue, 0]);
            if id != latest.0 {
                let number = numbers.get(&id).copied();
                if number.is_none() && id != 0 {
                    let (x, y) = (at % width.max(1), at / width.max(1));
                    return Err(Error::format(format!(
                        "segment {id} at column {x}, row {y} is not in segments_info"
                    )));
                }
                latest = (id, number);
            }
            if let Some(number) = latest.1 {
                has_pixels[number as usize] = true;
            }
            places.push(latest.1);
        }
        if let Some(missing) = has_pixels.iter().position(|has_pixels| !has_pixels) {
            return Err(Error::format(format!("segment {} of segments_info has no pixel", ids[missing])));
        }
        Ok(Self { size: [width as u32, image.height() as u32], places, count: ids.len() })
    }

    /// Draws masks over each other, the last on top.
    pub fn from_masks(masks: &[&Rle], [width, height]: [u32; 2]) -> Result<Self> {
        let mut places = vec![None; width as usize * height as usize];
        for (number, rle) in (0..).zip(masks) {
            for (place, inside) in places.iter_mut().zip(rle.mask()?) {
                *place = if inside { Some(number) } else { *place };
            }
        }
        Ok(Self { size: [width, height], places, count: masks.len() })
    }

    /// Returns the mask of each segment.
    pub fn masks(&self) -> Result<Vec<Rle>> {
        let [width, height] = self.size.map(|side| side as usize);
        let mut runs: Vec<(Vec<u32>, u32)> = vec![(Vec::new(), 0); self.count];
        let columnwise = |at: usize| self.places[at % height * width + at / height];
        let (total, mut start) = (width * height, 0);
        while start < total {
            let place = columnwise(start);
            let end = (start + 1..total).find(|at| columnwise(*at) != place).unwrap_or(total);
            if let Some(number) = place {
                let (counts, covered) = &mut runs[number as usize];
                counts.extend([start as u32 - *covered, (end - start) as u32]);
                *covered = end as u32;
            }
            start = end;
        }
        let mask = |(mut counts, covered): (Vec<u32>, u32)| {
            if (covered as usize) < total {
                counts.push(total as u32 - covered);
            }
            Rle::new(self.size[1], self.size[0], counts)
        };
        runs.into_iter().map(mask).collect()
    }

    /// Converts to an image: segment 0 has the colour 1, and so on.
    pub fn image(&self) -> Result<Image> {
        let colour = |place: &Option<u32>| {
            let [red, green, blue, _] = place.map_or(0, |number| number + 1).to_le_bytes();
            [red, green, blue]
        };
        let rgb = self.places.iter().flat_map(colour).collect();
        Image::from_rgb8(rgb, self.size[0] as usize, self.size[1] as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_and_images_agree() {
        let masks = [[true, true, false, false, true, false], [false, false, false, true, false, true]];
        let masks = masks.map(|mask| Rle::from_mask(&mask, 2, 3).unwrap());
        let map = SegmentMap::from_masks(&[&masks[0], &masks[1]], [3, 2]).unwrap();
        assert_eq!(map.masks().unwrap(), masks);
        let image = map.image().unwrap();
        assert_eq!(SegmentMap::new(&image, &[1, 2]).unwrap(), map);
        assert!(
            SegmentMap::new(&image, &[1]).unwrap_err().to_string().contains("segment 2 at column 0, row 1")
        );
        let missing = SegmentMap::new(&image, &[1, 2, 9]).unwrap_err().to_string();
        assert!(missing.contains("segment 9 of segments_info has no pixel"));
    }
}
