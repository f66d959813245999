//! PNG files whose pixels are numbers: palette indices or grey values, never resolved to colours.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Error, Result, ResultExt, Value};
use png::{BitDepth, ColorType, Transformations};

/// The number of a place that does not count.
pub(crate) const IGNORED: u32 = 255;

/// The largest map that is read, in pixels.
const MOST_PIXELS: u64 = 1 << 28;

/// Numbers, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LabelMap {
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub labels: Vec<u32>,
}

impl LabelMap {
    /// As the target of a picture.
    pub fn into_heatmap(self, classes: Classes) -> Result<Heatmap> {
        let [width, height] = self.size.map(|side| side as usize);
        let mut map = Heatmap::from_labels(self.labels, &[height, width])?;
        map.classes = classes;
        Ok(map)
    }

    /// From a target of class numbers.
    ///
    /// # Errors
    /// `InvalidInput` for other targets, and for numbers over 255.
    pub fn from_target(target: Option<&Value>) -> Result<Self> {
        let Some(Value::Heatmap(map)) = target else {
            let found = target.map_or("nothing", |target| target.as_value_ref().value_type().name());
            return Err(Error::invalid_input(format!("label maps are written, no {found}")));
        };
        let (HeatmapValues::Labels(labels), [height, width]) = (map.values(), map.shape()) else {
            let shape = map.shape();
            return Err(Error::invalid_input(format!(
                "a map of scores of shape {shape:?}; give class numbers"
            )));
        };
        if let Some(label) = labels.iter().find(|label| **label > 255) {
            return Err(Error::invalid_input(format!("class {label} does not fit a mask of 8 bits")));
        }
        Ok(Self { size: [*width as u32, *height as u32], labels: labels.to_vec() })
    }

    /// Every number through `table`; the first that has no entry is an error.
    pub fn mapped(mut self, table: impl Fn(u32) -> Option<u32>) -> Result<Self> {
        for (at, label) in self.labels.iter_mut().enumerate() {
            *label = table(*label).ok_or_else(|| {
                let (x, y) = (at as u32 % self.size[0], at as u32 / self.size[0]);
                Error::format(format!("label {label} at column {x}, row {y} is none of the format's"))
            })?;
        }
        Ok(self)
    }

    /// Checks that it is of a picture's size.
    pub fn of_size(self, size: [u32; 2]) -> Result<Self> {
        if self.size == size {
            return Ok(self);
        }
        let ([width, height], [wanted, high]) = (self.size, size);
        Err(Error::format(format!("the mask is of {width}x{height} pixels, its picture of {wanted}x{high}")))
    }
}

/// Reads a PNG of palette indices or grey values.
///
/// # Errors
/// `NotFound`, `Io`, or `Format` for other files, naming the path.
pub(crate) fn open_labels(path: &Path) -> Result<LabelMap> {
    read(path).context(|| format!("opening {}", path.display()))
}

fn read(path: &Path) -> Result<LabelMap> {
    let damaged = |error: png::DecodingError| Error::format("no PNG, or a damaged one").with_source(error);
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path)?));
    decoder.set_transformations(Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(damaged)?;
    let (width, height) = reader.info().size();
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(Error::format(format!(
            "the header claims {width}x{height} pixels, over {MOST_PIXELS} in all"
        )));
    }
    let (colour, depth) = reader.output_color_type();
    if !matches!(colour, ColorType::Indexed | ColorType::Grayscale) {
        return Err(Error::format(format!(
            "a picture in colours ({colour:?}); masks hold one number a pixel"
        )));
    }
    let size = reader.output_buffer_size().ok_or_else(|| Error::format("too large a picture"))?;
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

/// Writes numbers up to 255 as a PNG of indices into the colours of Pascal VOC, or as a grey one.
///
/// # Errors
/// `Io`, or `InvalidInput` for a map without pixels.
pub(crate) fn save_labels(map: &LabelMap, path: &Path, in_colours: bool) -> Result<()> {
    let write = || -> Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let refused = |error| Error::io("the PNG cannot be written").with_source(error);
        let [width, height] = map.size;
        let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), width, height);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_color(if in_colours { ColorType::Indexed } else { ColorType::Grayscale });
        if in_colours {
            encoder.set_palette((0..=255u8).flat_map(voc_colour).collect::<Vec<_>>());
        }
        let bytes: Vec<u8> = map.labels.iter().map(|label| *label as u8).collect();
        let mut writer = encoder.write_header().map_err(refused)?;
        writer.write_image_data(&bytes).map_err(refused)?;
        writer.finish().map_err(refused)
    };
    write().context(|| format!("writing {}", path.display()))
}

/// The colour of a class in Pascal VOC's masks: its bits, spread over the high bits of red, green and blue.
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
    fn numbers_come_back() {
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
