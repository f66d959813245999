//! PNG files of class indices: palette indices or grey values, which are not resolved to colours.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Error, Result, ResultExt, Value};
use png::{BitDepth, ColorType, Transformations};

/// Label of ignored pixels.
pub(crate) const IGNORED: u32 = 255;

/// Largest map that is read, in pixels.
const MAX_PIXELS: u64 = 1 << 28;

/// A map of labels, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LabelMap {
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub labels: Vec<u32>,
}

impl LabelMap {
    /// Converts to a target.
    pub fn into_heatmap(self, classes: Classes) -> Result<Heatmap> {
        let [width, height] = self.size.map(|side| side as usize);
        let mut map = Heatmap::from_labels(self.labels, &[height, width])?;
        map.classes = classes;
        Ok(map)
    }

    /// Converts a target of class indices.
    ///
    /// # Errors
    /// `InvalidInput` for other targets, and for indices over 255.
    pub fn from_target(target: Option<&Value>) -> Result<Self> {
        let Some(Value::Heatmap(map)) = target else {
            let other = target.map_or("nothing", |target| target.as_value_ref().value_type().name());
            return Err(Error::invalid_input(format!("label maps are needed, not {other}")));
        };
        let (HeatmapValues::Labels(labels), [height, width]) = (map.values(), map.shape()) else {
            let shape = map.shape();
            return Err(Error::invalid_input(format!(
                "a map of scores of shape {shape:?}; class indices are needed"
            )));
        };
        if let Some(label) = labels.iter().find(|label| **label > 255) {
            return Err(Error::invalid_input(format!("class {label} does not fit into a mask of 8 bits")));
        }
        Ok(Self { size: [*width as u32, *height as u32], labels: labels.to_vec() })
    }

    /// Maps every label by `table`; a label without an entry is an error.
    pub fn mapped(mut self, table: impl Fn(u32) -> Option<u32>) -> Result<Self> {
        for (at, label) in self.labels.iter_mut().enumerate() {
            *label = table(*label).ok_or_else(|| {
                let (x, y) = (at as u32 % self.size[0], at as u32 / self.size[0]);
                Error::format(format!("label {label} at column {x}, row {y} is not a class of the format"))
            })?;
        }
        Ok(self)
    }

    /// Checks that the map has the size of its image.
    pub fn of_size(self, size: [u32; 2]) -> Result<Self> {
        if self.size == size {
            return Ok(self);
        }
        let ([width, height], [image_width, image_height]) = (self.size, size);
        Err(Error::format(format!(
            "the mask has {width}x{height} pixels, its image has {image_width}x{image_height}"
        )))
    }
}

/// Reads a PNG of palette indices or grey values.
///
/// # Errors
/// `NotFound`, `Io`, or `Format` for other files, with the path.
pub(crate) fn open_labels(path: &Path) -> Result<LabelMap> {
    read(path).context(|| format!("opening {}", path.display()))
}

fn read(path: &Path) -> Result<LabelMap> {
    let damaged =
        |error: png::DecodingError| Error::format("the file is not a PNG, or damaged").with_source(error);
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path)?));
    decoder.set_transformations(Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(damaged)?;
    let (width, height) = reader.info().size();
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(Error::format(format!(
            "the header states {width}x{height} pixels; the limit is {MAX_PIXELS} in all"
        )));
    }
    let (colour, depth) = reader.output_color_type();
    if !matches!(colour, ColorType::Indexed | ColorType::Grayscale) {
        return Err(Error::format(format!(
            "an image in colours ({colour:?}); masks need one value per pixel"
        )));
    }
    let size = reader.output_buffer_size().ok_or_else(|| Error::format("the image is too large"))?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(damaged)?;
    let mut labels = Vec::with_capacity(width as usize * height as usize);
    for row in bytes.chunks_exact(frame.line_size.max(1)) {
        match depth {
            BitDepth::Sixteen => {
                labels.extend(row.as_chunks().0.iter().map(|pair| u32::from(u16::from_be_bytes(*pair))));
            }
            depth => {
                let bits = depth as usize;
                let each = |byte: &u8| {
                    let byte = u32::from(*byte);
                    (0..8 / bits).map(move |at| (byte >> (8 - bits * (at + 1))) & ((1 << bits) - 1))
                };
                labels.extend(row.iter().flat_map(each).take(width as usize));
            }
        }
    }
    Ok(LabelMap { size: [width, height], labels })
}

/// Writes labels up to 255 as a PNG with the palette of Pascal VOC, or in grey.
///
/// # Errors
/// `Io`, or `InvalidInput` for a map without pixels.
pub(crate) fn save_labels(map: &LabelMap, path: &Path, in_colours: bool) -> Result<()> {
    let write = || -> Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let failed = |error| Error::io("the PNG cannot be written").with_source(error);
        let [width, height] = map.size;
        let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), width, height);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_color(if in_colours { ColorType::Indexed } else { ColorType::Grayscale });
        if in_colours {
            encoder.set_palette((0..=255u8).flat_map(voc_colour).collect::<Vec<_>>());
        }
        let bytes: Vec<u8> = map.labels.iter().map(|label| *label as u8).collect();
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&bytes).map_err(failed)?;
        writer.finish().map_err(failed)
    };
    write().context(|| format!("writing {}", path.display()))
}

/// Returns the colour of a class in Pascal VOC's masks: its bits, spread over the high bits of red, green and blue.
pub(crate) fn voc_colour(class: u8) -> [u8; 3] {
    let mut colour = [0; 3];
    for bit in 0..8 {
        colour[bit % 3] |= (class >> bit & 1) << (7 - bit / 3);
    }
    colour
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::TemporaryFolder;

    #[test]
    fn colours_are_those_of_the_development_kit() {
        assert_eq!(
            [0, 1, 2, 3, 15, 20, 255].map(voc_colour),
            [
                [0, 0, 0],
                [128, 0, 0],
                [0, 128, 0],
                [128, 128, 0],
                [192, 128, 128],
                [0, 64, 128],
                [224, 224, 192]
            ]
        );
    }

    #[test]
    fn labels_are_read_as_written() {
        let folder = TemporaryFolder::new();
        let path = folder.path().join("a/mask.png");
        let map = LabelMap { size: [3, 2], labels: vec![0, 1, 2, 20, 254, 255] };
        for in_colours in [true, false] {
            save_labels(&map, &path, in_colours).unwrap();
            assert_eq!(open_labels(&path).unwrap(), map);
        }
        let few = [0b0110_0000, 0b1000_0000];
        let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 3, 2);
        encoder.set_depth(BitDepth::One);
        encoder.set_color(ColorType::Grayscale);
        encoder.write_header().unwrap().write_image_data(&few).unwrap();
        assert_eq!(open_labels(&path).unwrap().labels, [0, 1, 1, 1, 0, 0]);
        let coloured = folder.picture("b.png", 3, 2);
        assert!(open_labels(&coloured).unwrap_err().to_string().contains("in colours"));
        std::fs::write(&path, &std::fs::read(&coloured).unwrap()[..60]).unwrap();
        assert!(open_labels(&path).is_err());
    }
}
