//! Lidar scans: x, y, z and reflectance of each point as little-endian 32-bit floats.

use std::path::Path;

use opendr_engine::Result;
use opendr_engine::data::PointCloud;

use crate::Problem;
use crate::folder::read_bytes;

/// Largest size of a scan in bytes; over ten times the largest one of KITTI.
const MAX_BYTES: u64 = 256 << 20;
const POINT_BYTES: usize = 16;

/// Reads the scan at `path`: `[points, 4]`, in metres.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read; `Format` with the byte offset if it is truncated or has a value that is
/// not finite.
pub fn open_velodyne(path: impl AsRef<Path>) -> Result<PointCloud> {
    let path = path.as_ref();
    let bytes = read_bytes(path, MAX_BYTES)?;
    if bytes.len() % POINT_BYTES != 0 {
        let message = format!(
            "{} bytes are not a multiple of 16, the size of a point; the file is truncated",
            bytes.len()
        );
        return Err(Problem::at_byte(path, (bytes.len() / POINT_BYTES * POINT_BYTES) as u64, message).into());
    }
    let (words, _) = bytes.as_chunks::<4>();
    let numbers: Vec<f32> = words.iter().map(|word| f32::from_le_bytes(*word)).collect();
    if let Some(wrong) = numbers.iter().position(|number| !number.is_finite()) {
        let message = format!("point {} has a value that is not finite; remove it", wrong / 4);
        return Err(Problem::at_byte(path, 4 * wrong as u64, message).into());
    }
    let shape = [numbers.len() / 4, 4];
    PointCloud::new(numbers, shape)
}

/// Returns the bytes of a scan. An unknown reflectance becomes 0, and further channels are dropped.
pub fn velodyne_from_cloud(cloud: &PointCloud) -> Vec<u8> {
    let point = |point: &[f32]| {
        let channel = |at: usize| point.get(at).copied().unwrap_or(0.0).to_le_bytes();
        [channel(0), channel(1), channel(2), channel(3)]
    };
    cloud.points().flat_map(point).flatten().collect()
}
