//! Detection of file formats, with descriptions for error messages.

use image::{ImageError, ImageFormat};
use opendr_engine::{Error, ErrorKind, Result};

const READ: &str = "supported are JPEG, PNG, BMP and WebP";

/// Detects the image format of `bytes`.
///
/// # Errors
/// `InvalidInput` when they are not an image, `Unsupported` when the format cannot be decoded.
pub(super) fn format_of(bytes: &[u8]) -> Result<ImageFormat> {
    match image::guess_format(bytes) {
        Ok(format) if format == ImageFormat::Jpeg || format.reading_enabled() => Ok(format),
        Ok(format) => {
            Err(Error::unsupported(format!("found a {} file; {READ}: convert it first", name(format))))
        }
        Err(_) => Err(Error::invalid_input(format!("found {}, not an image; {READ}", content(bytes)))),
    }
}

/// Returns the error for an image that its decoder rejected.
pub(super) fn damaged(format: ImageFormat, error: ImageError) -> Error {
    let kind = match &error {
        ImageError::Unsupported(_) => ErrorKind::Unsupported,
        _ => ErrorKind::InvalidInput,
    };
    let what = match &error {
        ImageError::Unsupported(_) => "an unsupported variant; save it again with another program",
        ImageError::Limits(_) => "larger than `Decoder::max_samples` allows",
        _ => "damaged or truncated; copy or download it again",
    };
    Error::new(kind, format!("found a {} file, {what}", name(format))).with_source(error)
}

/// Returns the usual name of the format.
pub(super) fn name(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Jpeg => "JPEG",
        ImageFormat::Png => "PNG",
        ImageFormat::Bmp => "BMP",
        ImageFormat::WebP => "WebP",
        other => other.extensions_str().first().copied().unwrap_or("image"),
    }
}

fn content(bytes: &[u8]) -> String {
    let head = &bytes[..bytes.len().min(24)];
    let text = String::from_utf8_lossy(head);
    if bytes.is_empty() {
        "an empty file".to_owned()
    } else if !text
        .chars()
        .any(|letter| letter.is_control() && !letter.is_whitespace() || letter == '\u{fffd}')
    {
        format!("text ({:?}...)", text.trim())
    } else {
        let hex: Vec<String> = head.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        format!("unknown bytes ({})", hex.join(" "))
    }
}
