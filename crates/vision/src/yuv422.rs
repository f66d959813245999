//! Conversion of 4:2:2, the usual uncompressed format of cameras, to RGB. Two pixels share a pair of chroma samples.

use opendr_engine::{Error, Result};

/// Order of luma and chroma in the four bytes of two pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Yuv422 {
    /// Luma first (YUY2).
    Yuyv,
    /// Chroma first.
    Uyvy,
}

/// Converts 4:2:2 (BT.601, luma 16..=235) to RGB.
///
/// `data` holds `height` rows, `stride` bytes from one to the next; the result is `[height, width, 3]`.
///
/// # Errors
/// `Format` when `data` has fewer bytes than that.
pub fn rgb_from_yuv422(
    data: &[u8],
    stride: usize,
    width: usize,
    height: usize,
    order: Yuv422,
) -> Result<Vec<u8>> {
    let row_bytes = width.div_ceil(2) * 4;
    let needed = height.saturating_sub(1).saturating_mul(stride).saturating_add(row_bytes);
    if stride < row_bytes || data.len() < needed || width == 0 || height == 0 {
        return Err(Error::format(format!(
            "a 4:2:2 frame of {width}x{height} pixels needs {needed} bytes in rows of {row_bytes}, but has {} in rows of \
             {stride}; check the cable and the driver",
            data.len()
        )));
    }
    let mut rgb = Vec::with_capacity(width * height * 3);
    for row in data.chunks(stride).take(height) {
        let end = rgb.len() + width * 3;
        for pair in row[..row_bytes].chunks_exact(4) {
            let ([first, second], [u, v]) = match order {
                Yuv422::Yuyv => ([pair[0], pair[2]], [pair[1], pair[3]]),
                Yuv422::Uyvy => ([pair[1], pair[3]], [pair[0], pair[2]]),
            };
            let [red, green, blue] = colour_parts(u, v);
            for luma in [first, second] {
                let luma = 76_309 * (i32::from(luma) - 16) + 0x8000;
                rgb.extend([red, green, blue].map(|part| ((luma + part) >> 16).clamp(0, 255) as u8));
            }
        }
        rgb.truncate(end);
    }
    Ok(rgb)
}

/// Returns the contributions of the chroma samples to red, green and blue, in 1/65536.
fn colour_parts(u: u8, v: u8) -> [i32; 3] {
    let (u, v) = (i32::from(u) - 128, i32::from(v) - 128);
    [104_597 * v, -25_675 * u - 53_279 * v, 132_201 * u]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colours() {
        // Black, white, and BT.601's pure red, green and blue.
        let cases = [
            ([16, 128, 128], [0, 0, 0]),
            ([235, 128, 128], [255, 255, 255]),
            ([81, 90, 240], [254, 0, 0]),
            ([145, 54, 34], [0, 255, 1]),
            ([41, 240, 110], [0, 0, 255]),
        ];
        for ([y, u, v], wanted) in cases {
            let rgb = rgb_from_yuv422(&[y, u, y, v], 4, 2, 1, Yuv422::Yuyv).unwrap();
            assert_eq!(rgb_from_yuv422(&[u, y, v, y], 4, 2, 1, Yuv422::Uyvy).unwrap(), rgb);
            for (found, wanted) in rgb.iter().zip([wanted, wanted].as_flattened()) {
                assert!(found.abs_diff(*wanted) <= 2, "{rgb:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn padded_rows_and_odd_widths() {
        let row = [16, 128, 235, 128, 235, 128, 99, 128, 7, 7];
        let data = [row, row].concat();
        let rgb = rgb_from_yuv422(&data, 10, 3, 2, Yuv422::Yuyv).unwrap();
        assert_eq!(rgb, [[0; 3], [255; 3], [255; 3], [0; 3], [255; 3], [255; 3]].as_flattened());
        // The last row needs no padding.
        assert!(rgb_from_yuv422(&data[..18], 10, 3, 2, Yuv422::Yuyv).is_ok());
        assert!(rgb_from_yuv422(&data[..17], 10, 3, 2, Yuv422::Yuyv).is_err());
        assert!(rgb_from_yuv422(&data, 7, 3, 2, Yuv422::Yuyv).is_err());
        assert!(rgb_from_yuv422(&[], 0, 0, 0, Yuv422::Yuyv).is_err());
    }
}
