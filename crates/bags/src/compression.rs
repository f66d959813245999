//! Chunks out of and into their compressed form.

use std::io::{Read, Write};

use bytes::Bytes;
use opendr_engine::{Error, Result};

/// How chunks are compressed when a recording is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// Not at all, as `rosbag record` and `ros2 bag record` do unless told otherwise.
    #[default]
    None,
    /// LZ4 frames: fast; rosbag 1 and MCAP.
    Lz4,
}

/// No chunk and no message may be larger: 2 GiB.
pub(crate) const LARGEST: u64 = 1 << 31;

/// A compressed chunk larger than this has to hold a thousandth of its size.
const PLAUSIBLE: u64 = 1 << 28;

/// What `name` (rosbag 1's `none`, `bz2`, `lz4`; MCAP's empty one, `lz4`, `zstd`) made of `size` bytes.
pub(crate) fn decompress(name: &[u8], bytes: Bytes, size: u64) -> Result<Bytes> {
    if size > LARGEST {
        return Err(Error::format(format!("a chunk of {size} bytes: more than {LARGEST} are never read")));
    }
    if size > PLAUSIBLE && bytes.len() as u64 * 1000 < size {
        return Err(Error::format(format!("{size} bytes are told to be in {} compressed ones", bytes.len())));
    }
    match name {
        b"" | b"none" => exact(bytes, size),
        b"lz4" => read(lz4_flex::frame::FrameDecoder::new(&bytes[..]), bytes.len(), size),
        b"bz2" => read(bzip2::read::MultiBzDecoder::new(&bytes[..]), bytes.len(), size),
        b"zstd" => zstd(&bytes, Some(size)),
        other => Err(Error::unsupported(format!(
            "chunks compressed with {:?}: lz4, bz2 and zstd are read; rewrite the recording with one of them",
            String::from_utf8_lossy(other)
        ))),
    }
}

/// One Zstandard frame of a size that may only be found at its end.
pub(crate) fn zstd(bytes: &[u8], size: Option<u64>) -> Result<Bytes> {
    let broken = |error| Error::format("compressed bytes are damaged").with_source(error);
    let decoder = ruzstd::decoding::StreamingDecoder::new(bytes).map_err(broken)?;
    match size {
        Some(size) => read(decoder, bytes.len(), size),
        None => {
            let limit = PLAUSIBLE.max(bytes.len() as u64 * 1000).min(LARGEST);
            let mut out = Vec::new();
            decoder.take(limit + 1).read_to_end(&mut out).map_err(damaged)?;
            if out.len() as u64 > limit {
                return Err(Error::format(format!(
                    "{} compressed bytes hold more than {limit}",
                    bytes.len()
                )));
            }
            Ok(out.into())
        }
    }
}

/// The compressed form of a chunk.
pub(crate) fn compress(compression: Compression, bytes: &[u8]) -> Result<Option<Vec<u8>>> {
    match compression {
        Compression::None => Ok(None),
        Compression::Lz4 => {
            let mut frame = lz4_flex::frame::FrameInfo::new();
            // The reader of ROS 1 takes only blocks that do not depend on each other, and a checksum of all.
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
    // A lie about the size costs no memory: what is believed at once is what plain data compresses to.
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
    Err(Error::format(format!("a chunk of {size} bytes has {more} than it tells of")))
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
            for size in [1 << 29, LARGEST + 1, u64::MAX] {
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
