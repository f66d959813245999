//! Compression and decompression of chunks.

use std::io::{Read, Write};

use bytes::Bytes;
use opendr_engine::{Error, Result};

/// Compression of chunks in a recording that is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// No compression, the default of `rosbag record` and `ros2 bag record`.
    #[default]
    None,
    /// LZ4 frames, which are fast to decompress; for rosbag 1 and MCAP.
    Lz4,
}

/// Largest size of a chunk or message: 2 GiB.
pub(crate) const MAX_BYTES: u64 = 1 << 31;

/// Decompressed size above which a compression ratio over 1000 is rejected, in bytes.
const RATIO_CHECK_BYTES: u64 = 1 << 28;

/// Decompresses `bytes` to `size` bytes by the method `name` (rosbag 1: `none`, `bz2`, `lz4`; MCAP: empty, `lz4`,
/// `zstd`).
pub(crate) fn decompress(name: &[u8], bytes: Bytes, size: u64) -> Result<Bytes> {
    if size > MAX_BYTES {
        return Err(Error::format(format!("a chunk of {size} bytes: the limit is {MAX_BYTES}")));
    }
    if size > RATIO_CHECK_BYTES && bytes.len() as u64 * 1000 < size {
        return Err(Error::format(format!(
            "a chunk states {size} bytes, but has only {} compressed",
            bytes.len()
        )));
    }
    match name {
        b"" | b"none" => exact(bytes, size),
        b"lz4" => read(lz4_flex::frame::FrameDecoder::new(&bytes[..]), bytes.len(), size),
        b"bz2" => read(bzip2::read::MultiBzDecoder::new(&bytes[..]), bytes.len(), size),
        b"zstd" => zstd(&bytes, Some(size)),
        other => Err(Error::unsupported(format!(
            "chunks are compressed with {:?}: lz4, bz2 and zstd are supported; rewrite the recording with one of them",
            String::from_utf8_lossy(other)
        ))),
    }
}

/// Decompresses a Zstandard frame, whose decompressed size may be unknown.
pub(crate) fn zstd(bytes: &[u8], size: Option<u64>) -> Result<Bytes> {
    let broken = |error| Error::format("compressed bytes are damaged").with_source(error);
    let decoder = ruzstd::decoding::StreamingDecoder::new(bytes).map_err(broken)?;
    match size {
        Some(size) => read(decoder, bytes.len(), size),
        None => {
            let limit = RATIO_CHECK_BYTES.max(bytes.len() as u64 * 1000).min(MAX_BYTES);
            let mut out = Vec::new();
            decoder.take(limit + 1).read_to_end(&mut out).map_err(damaged)?;
            if out.len() as u64 > limit {
                return Err(Error::format(format!(
                    "{} compressed bytes expand to more than {limit}",
                    bytes.len()
                )));
            }
            Ok(out.into())
        }
    }
}

/// Compresses a chunk; `None` without compression.
pub(crate) fn compress(compression: Compression, bytes: &[u8]) -> Result<Option<Vec<u8>>> {
    match compression {
        Compression::None => Ok(None),
        Compression::Lz4 => {
            let mut frame = lz4_flex::frame::FrameInfo::new();
            // The reader of ROS 1 accepts only independent blocks and a checksum of the content.
            frame.block_mode = lz4_flex::frame::BlockMode::Independent;
            frame.content_checksum = true;
            let mut encoder = lz4_flex::frame::FrameEncoder::with_frame_info(frame, Vec::new());
            encoder.write_all(bytes)?;
            let out = encoder.finish().map_err(|error| Error::internal("lz4").with_source(error))?;
            Ok(Some(out))
        }
    }
}

fn read(decoder: impl Read, compressed: usize, size: u64) -> Result<Bytes> {
    // A wrong size costs no memory: at first, only 16 times the compressed size is allocated.
    let mut out = Vec::with_capacity(size.min((compressed as u64).saturating_mul(16)) as usize);
    decoder.take(size + 1).read_to_end(&mut out).map_err(damaged)?;
    exact(out.into(), size)
}

fn damaged(error: std::io::Error) -> Error {
    Error::format("compressed bytes are damaged").with_source(error)
}

fn exact(bytes: Bytes, size: u64) -> Result<Bytes> {
    if bytes.len() as u64 == size {
        return Ok(bytes);
    }
    let more = if bytes.len() as u64 > size { "more" } else { "fewer" };
    Err(Error::format(format!("a chunk that states {size} bytes has {more}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lz4_comes_back() {
        let plain: Vec<u8> = (0..200_000_u32).map(|number| (number / 7) as u8).collect();
        let packed = Bytes::from(compress(Compression::Lz4, &plain).unwrap().unwrap());
        assert!(packed.len() < plain.len());
        assert_eq!(decompress(b"lz4", packed.clone(), 200_000).unwrap(), plain);
        for wrong in [0, 199_999, 200_001, u64::MAX] {
            assert!(decompress(b"lz4", packed.clone(), wrong).is_err());
        }
        for end in 0..packed.len().min(64) {
            assert!(decompress(b"lz4", packed.slice(..end), 200_000).is_err());
        }
    }

    #[test]
    fn a_bomb_is_refused_before_it_is_opened() {
        for name in [&b"lz4"[..], b"bz2", b"zstd"] {
            for size in [1 << 29, MAX_BYTES + 1, u64::MAX] {
                let error = decompress(name, Bytes::from_static(&[0; 1000]), size).unwrap_err();
                assert!(error.message().contains("bytes"), "{error}");
            }
        }
    }

    #[test]
    fn what_is_no_compressed_data_is_refused() {
        for name in [&b"lz4"[..], b"bz2", b"zstd", b"lzma"] {
            assert!(decompress(name, Bytes::from_static(b"neither of them"), 10).is_err());
        }
    }
}
