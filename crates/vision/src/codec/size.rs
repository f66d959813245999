//! The size of an image file, from its header.

use std::io::Cursor;
use std::path::Path;

use image::metadata::Orientation;
use image::{ImageDecoder, ImageFormat, ImageReader};
use opendr_engine::{Result, ResultExt};

use crate::codec::decode::Decoder;
use crate::codec::{finding, jpeg};

impl Decoder {
    /// Returns width and height in pixels of the image at `path`, as [`Decoder::open`] returns it: turned upright. No
    /// pixel is decoded.
    ///
    /// # Errors
    /// Those of [`Decoder::open`]; damage after the header is not detected.
    pub fn size(&self, path: impl AsRef<Path>) -> Result<[u32; 2]> {
        let path = path.as_ref();
        let size = self.read(path).and_then(|bytes| self.size_in(&bytes));
        size.context(|| format!("opening {}", path.display()))
    }

    fn size_in(&self, bytes: &[u8]) -> Result<[u32; 2]> {
        let ([width, height], orientation) = match finding::format_of(bytes)? {
            ImageFormat::Jpeg => jpeg::size(bytes)?,
            format => {
                let damaged = |error| finding::damaged(format, error);
                let reader = ImageReader::with_format(Cursor::new(bytes), format);
                let mut decoder = reader.into_decoder().map_err(damaged)?;
                let (width, height) = decoder.dimensions();
                ([width, height], decoder.orientation().unwrap_or(Orientation::NoTransforms))
            }
        };
        let lies = matches!(
            orientation,
            Orientation::Rotate90
                | Orientation::Rotate270
                | Orientation::Rotate90FlipH
                | Orientation::Rotate270FlipH
        );
        Ok(if lies { [height, width] } else { [width, height] })
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;

    use super::*;

    #[test]
    fn sizes_are_read_from_headers() {
        let folder = std::env::temp_dir().join(format!("opendr-size-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let image = Image::from_rgb8(vec![90; 31 * 17 * 3], 31, 17).unwrap();
        for extension in ["jpg", "png", "bmp", "webp"] {
            let path = folder.join(format!("picture.{extension}"));
            crate::save(&image, &path).unwrap();
            assert_eq!(Decoder::default().size(&path).unwrap(), [31, 17], "{extension}");
        }
        assert!(Decoder::default().size(folder.join("none.jpg")).is_err());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
