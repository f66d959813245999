//! Structures, requests and memory mappings of the kernel interface Video4Linux 2 on 64-bit machines.

use std::fs::File;
use std::io;
use std::os::fd::AsRawFd;
use std::ptr;

pub(super) const CAPTURE: u32 = 1;
pub(super) const MEMORY_MAPPED: u32 = 1;
pub(super) const CAN_CAPTURE: u32 = 0x1;
pub(super) const CAN_STREAM: u32 = 0x0400_0000;
pub(super) const HAS_DEVICE_CAPABILITIES: u32 = 0x8000_0000;
pub(super) const BUFFER_DAMAGED: u32 = 0x40;
pub(super) const STAMP_KIND: u32 = 0xe000;
pub(super) const STAMP_MONOTONIC: u32 = 0x2000;

#[repr(C)]
pub(super) struct Capability {
    pub(super) driver: [u8; 16],
    pub(super) card: [u8; 32],
    pub(super) bus: [u8; 32],
    pub(super) version: u32,
    pub(super) capabilities: u32,
    pub(super) device_capabilities: u32,
    pub(super) reserved: [u32; 3],
}

#[repr(C)]
pub(super) struct FormatDescription {
    pub(super) index: u32,
    pub(super) kind: u32,
    pub(super) flags: u32,
    pub(super) description: [u8; 32],
    pub(super) pixel_format: u32,
    pub(super) bus_code: u32,
    pub(super) reserved: [u32; 3],
}

/// The `v4l2_pix_format` member of the kernel's union, aligned as the largest member.
#[repr(C, align(8))]
#[derive(Clone, Copy)]
pub(super) struct PictureFormat {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) pixel_format: u32,
    pub(super) field: u32,
    pub(super) bytes_a_row: u32,
    pub(super) bytes: u32,
    pub(super) colour_space: u32,
    pub(super) private: u32,
    pub(super) rest: [u32; 42],
}

#[repr(C)]
pub(super) struct Format {
    pub(super) kind: u32,
    pub(super) picture: PictureFormat,
}

#[repr(C)]
pub(super) struct StreamParameters {
    pub(super) kind: u32,
    pub(super) capability: u32,
    pub(super) mode: u32,
    pub(super) frame_time: [u32; 2],
    pub(super) rest: [u32; 46],
}

#[repr(C)]
pub(super) struct BufferRequest {
    pub(super) count: u32,
    pub(super) kind: u32,
    pub(super) memory: u32,
    pub(super) capabilities: u32,
    pub(super) flags: u32,
}

#[repr(C)]
pub(super) struct Buffer {
    pub(super) index: u32,
    pub(super) kind: u32,
    pub(super) bytes_used: u32,
    pub(super) flags: u32,
    pub(super) field: u32,
    pub(super) seconds: i64,
    pub(super) microseconds: i64,
    pub(super) time_code: [u32; 4],
    pub(super) sequence: u32,
    pub(super) memory: u32,
    pub(super) offset: u64,
    pub(super) length: u32,
    pub(super) reserved: [u32; 2],
}

/// A kernel structure that is valid when zeroed.
///
/// # Safety
/// The type is `repr(C)`, consists of integers only, and has the layout of the kernel's structure.
pub(super) unsafe trait Kernel: Sized {
    /// Returns a zeroed structure for a video capture queue.
    fn zeroed() -> Self {
        // SAFETY: the type consists of integers only, for which zeros are valid.
        unsafe { std::mem::zeroed() }
    }
}

// SAFETY: `repr(C)` with integers only; sizes and request numbers are tested.
unsafe impl Kernel for Capability {}
// SAFETY: as above.
unsafe impl Kernel for FormatDescription {}
// SAFETY: as above.
unsafe impl Kernel for Format {}
// SAFETY: as above.
unsafe impl Kernel for StreamParameters {}
// SAFETY: as above.
unsafe impl Kernel for BufferRequest {}
// SAFETY: as above.
unsafe impl Kernel for Buffer {}
// SAFETY: as above.
unsafe impl Kernel for u32 {}

/// Direction in which an `ioctl` transfers its structure.
#[derive(Clone, Copy)]
pub(super) enum Direction {
    Write = 1,
    Read = 2,
    Both = 3,
}

/// Returns the request number of a Video4Linux `ioctl` with a `T`.
pub(super) const fn request<T>(direction: Direction, number: u8) -> u32 {
    (direction as u32) << 30 | (size_of::<T>() as u32) << 16 | (b'V' as u32) << 8 | number as u32
}

pub(super) const QUERY_CAPABILITY: (Direction, u8) = (Direction::Read, 0);
pub(super) const ENUMERATE_FORMATS: (Direction, u8) = (Direction::Both, 2);
pub(super) const GET_FORMAT: (Direction, u8) = (Direction::Both, 4);
pub(super) const SET_FORMAT: (Direction, u8) = (Direction::Both, 5);
pub(super) const REQUEST_BUFFERS: (Direction, u8) = (Direction::Both, 8);
pub(super) const QUERY_BUFFER: (Direction, u8) = (Direction::Both, 9);
pub(super) const ENQUEUE: (Direction, u8) = (Direction::Both, 15);
pub(super) const DEQUEUE: (Direction, u8) = (Direction::Both, 17);
pub(super) const STREAM_ON: (Direction, u8) = (Direction::Write, 18);
pub(super) const STREAM_OFF: (Direction, u8) = (Direction::Write, 19);
pub(super) const GET_PARAMETERS: (Direction, u8) = (Direction::Both, 21);

pub(super) fn ioctl<T: Kernel>(
    file: &File,
    (direction, number): (Direction, u8),
    value: &mut T,
) -> io::Result<()> {
    loop {
        let request = request::<T>(direction, number);
        // SAFETY: the descriptor is open, the request number encodes the size of `T`, and `T` has the layout of the
        // kernel's structure.
        let status = unsafe { libc::ioctl(file.as_raw_fd(), request as _, ptr::from_mut(value)) };
        if status >= 0 {
            return Ok(());
        }
        let error = io::Error::last_os_error();
        if error.kind() != io::ErrorKind::Interrupted {
            return Err(error);
        }
    }
}

/// A buffer of the driver, mapped into this process.
#[derive(Debug)]
pub(super) struct Mapping {
    start: *mut libc::c_void,
    pub(super) length: usize,
}

// SAFETY: the mapping owns its memory.
unsafe impl Send for Mapping {}

impl Mapping {
    pub(super) fn new(file: &File, buffer: &Buffer) -> io::Result<Self> {
        let (length, offset) = (buffer.length as usize, buffer.offset as u32);
        // SAFETY: a new mapping at an address that the kernel chooses; no existing memory is affected.
        let start = unsafe {
            libc::mmap(
                ptr::null_mut(),
                length,
                libc::PROT_READ,
                libc::MAP_SHARED,
                file.as_raw_fd(),
                offset.into(),
            )
        };
        if start == libc::MAP_FAILED { Err(io::Error::last_os_error()) } else { Ok(Self { start, length }) }
    }

    /// Returns the first `used` bytes. The driver writes only to enqueued buffers; the caller has dequeued this one.
    pub(super) fn bytes(&self, used: usize) -> &[u8] {
        // SAFETY: mapped readable for `length` bytes until drop, and not written to while dequeued.
        unsafe { std::slice::from_raw_parts(self.start.cast(), used.min(self.length)) }
    }
}

impl Drop for Mapping {
    fn drop(&mut self) {
        // SAFETY: `new` mapped this length, and no slice of it outlives `self`.
        unsafe { libc::munmap(self.start, self.length) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_the_kernels() {
        // The values of VIDIOC_* in linux/videodev2.h on 64-bit machines.
        fn number<T>((direction, number): (Direction, u8)) -> u32 {
            request::<T>(direction, number)
        }
        assert_eq!(number::<Capability>(QUERY_CAPABILITY), 0x8068_5600);
        assert_eq!(number::<FormatDescription>(ENUMERATE_FORMATS), 0xc040_5602);
        assert_eq!(number::<Format>(GET_FORMAT), 0xc0d0_5604);
        assert_eq!(number::<Format>(SET_FORMAT), 0xc0d0_5605);
        assert_eq!(number::<BufferRequest>(REQUEST_BUFFERS), 0xc014_5608);
        assert_eq!(number::<Buffer>(QUERY_BUFFER), 0xc058_5609);
        assert_eq!(number::<Buffer>(ENQUEUE), 0xc058_560f);
        assert_eq!(number::<Buffer>(DEQUEUE), 0xc058_5611);
        assert_eq!(number::<u32>(STREAM_ON), 0x4004_5612);
        assert_eq!(number::<u32>(STREAM_OFF), 0x4004_5613);
        assert_eq!(number::<StreamParameters>(GET_PARAMETERS), 0xc0cc_5615);
        assert_eq!(std::mem::offset_of!(Format, picture), 8);
        assert_eq!(std::mem::offset_of!(Buffer, seconds), 24);
        assert_eq!(std::mem::offset_of!(Buffer, offset), 64);
        assert_eq!(std::mem::offset_of!(StreamParameters, frame_time), 12);
    }
}
