//! Lidar scans: x, y, z and reflectance of each point as little-endian 32-bit floats.

use std::path::Path;

use opendr_engine::Result;
use opendr_engine::data::PointCloud;

use crate::Problem;
use crate::folder::read_bytes;

/// Over ten times the largest scan of KITTI.
const MAX_BYTES: u64 = 256 << 20;
const POINT_BYTES: usize = 16;

/// Reads the scan at `path`: `[points, 4]`, metres.
///
/// # Errors
/// `NotFound` or `Io` when it cannot be read; `Format` with the byte when it is cut off or has a number that is none.
pub fn open_velodyne(path: impl AsRef<Path>) -> Result<PointCloud> {
    let path = path.as_ref();
    let bytes = read_bytes(path, MAX_BYTES)?;
    if bytes.len() % POINT_BYTES != 0 {
        let message =
            format!("{} bytes are no whole number of 16-byte points; the file is cut off", bytes.len());
        return Err(Problem::at_byte(path, (bytes.len() / POINT_BYTES * POINT_BYTES) as u64, message).into());
    }
    let (words, _) = bytes.as_chunks::<4>();
    let numbers: Vec<f32> = words.iter().map(|word| f32::from_le_bytes(*word)).collect();
    if let Some(wrong) = numbers.iter().position(|number| !number.is_finite()) {
        let message = format!("point {} has a coordinate that is no finite number; drop it", wrong / 4);
        return Err(Problem::at_byte(path, 4 * wrong as u64, message).into());
    }
    let shape = [numbers.len() / 4, 4];
    PointCloud::new(numbers, shape)
}

/// The bytes of a scan; a reflectance that is not known becomes 0, further channels are left out.
pub fn velodyne_from_cloud(cloud: &PointCloud) -> Vec<u8> {
    let point = |point: &[f32]| {
        let channel = |at: usize| point.get(at).copied().unwrap_or(0.0).to_le_bytes();
        [channel(0), channel(1), channel(2), channel(3)]
    };
    cloud.points().flat_map(point).flatten().collect()
}
