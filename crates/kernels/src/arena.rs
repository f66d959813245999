//! Memory of the tensors of a run: one block, of which each tensor has a region.

use std::marker::PhantomData;

/// Zeroed memory in which tensors of any element type lie at offsets that are multiples of 64 bytes.
///
/// Memory of large arenas is untouched until it is written: the system provides zeroed pages then.
#[derive(Debug, Default)]
pub struct Arena {
    memory: Memory,
    /// Bytes before the first one of the arena.
    skipped: usize,
    bytes: usize,
}

#[derive(Debug)]
enum Memory {
    /// Zeroed by the allocator, which has such memory for alignments of up to 16 bytes only.
    Zeroed(Vec<u128>),
    /// Aligned to 16 bytes.
    Adopted(Vec<u8>),
}

impl Default for Memory {
    fn default() -> Self {
        Self::Zeroed(Vec::new())
    }
}

/// Alignment of regions, in bytes.
pub const ALIGNMENT: usize = 64;

/// A part of an [`Arena`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Region {
    /// First byte, a multiple of [`ALIGNMENT`].
    pub start: usize,
    /// Number of bytes.
    pub bytes: usize,
}

/// A type for which every pattern of bits is a value.
pub trait Number: Copy + Default + Send + Sync + sealed::Sealed + 'static {}

mod sealed {
    pub trait Sealed {}
}

macro_rules! numbers {
    ($($name:ty)*) => { $(impl sealed::Sealed for $name {} impl Number for $name {})* };
}
numbers!(f32 f64 i64 i32 i16 i8 u64 u32 u16 u8);

impl Arena {
    /// Creates an arena of at least that many bytes.
    pub fn new(bytes: usize) -> Self {
        if bytes == 0 {
            return Self::default();
        }
        let bytes = bytes.next_multiple_of(ALIGNMENT);
        let memory = vec![0_u128; (bytes + ALIGNMENT) / size_of::<u128>() - 1];
        let skipped = memory.as_ptr().cast::<u8>().align_offset(ALIGNMENT);
        Self { memory: Memory::Zeroed(memory), skipped, bytes }
    }

    /// Creates an arena of these bytes, which are copied only where they are not aligned for every type of number. Its first byte is
    /// a multiple of 16, not of [`ALIGNMENT`].
    pub fn from_bytes(bytes: Vec<u8>) -> Self {
        if bytes.is_empty() || !bytes.as_ptr().addr().is_multiple_of(align_of::<u128>()) {
            return Self::from_numbers(&bytes);
        }
        Self { bytes: bytes.len(), memory: Memory::Adopted(bytes), skipped: 0 }
    }

    /// Creates an arena that has the numbers in its first bytes.
    pub fn from_numbers<T: Number>(numbers: &[T]) -> Self {
        let mut arena = Self::new(size_of_val(numbers));
        let region = Region { start: 0, bytes: size_of_val(numbers) };
        arena.split(region).0.numbers::<T>().copy_from_slice(numbers);
        arena
    }

    /// Returns the same memory as numbers of another type of the same or a smaller size.
    ///
    /// # Panics
    /// When the type is larger.
    pub fn view<T: Number, U: Number>(numbers: &[T]) -> &[U] {
        assert!(size_of::<U>() <= size_of::<T>(), "the numbers are not aligned for the type");
        let length = size_of_val(numbers) / size_of::<U>();
        // SAFETY: the size and alignment of numbers are equal, so that the smaller ones are aligned; every pattern of
        // bits is a number.
        unsafe { std::slice::from_raw_parts(numbers.as_ptr().cast(), length) }
    }

    /// Returns the number of bytes.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Returns the first byte.
    pub(crate) fn start(&self) -> *const u8 {
        let memory = match &self.memory {
            _ if self.bytes == 0 => return std::ptr::without_provenance(ALIGNMENT),
            Memory::Zeroed(memory) => memory.as_ptr().cast::<u8>(),
            Memory::Adopted(memory) => memory.as_ptr(),
        };
        memory.wrapping_add(self.skipped)
    }

    fn start_mut(&mut self) -> *mut u8 {
        let memory = match &mut self.memory {
            _ if self.bytes == 0 => return std::ptr::without_provenance_mut(ALIGNMENT),
            Memory::Zeroed(memory) => memory.as_mut_ptr().cast::<u8>(),
            Memory::Adopted(memory) => memory.as_mut_ptr(),
        };
        memory.wrapping_add(self.skipped)
    }

    /// Returns the numbers of a region.
    ///
    /// # Panics
    /// When the region is not within the arena, or not aligned.
    pub fn get<T: Number>(&self, region: Region) -> &[T] {
        self.check(region);
        // SAFETY: the region lies in initialised memory, aligned for any number, and is borrowed with the arena.
        unsafe { numbers(self.start(), region) }
    }

    /// Returns a region to write, and the other ones to read.
    ///
    /// # Panics
    /// As [`Arena::get`].
    pub fn split(&mut self, written: Region) -> (Written<'_>, Rest<'_>) {
        self.check(written);
        let bytes = self.bytes();
        let start = self.start_mut();
        (
            Written { start, region: written, arena: PhantomData },
            Rest { start, bytes, written, arena: PhantomData },
        )
    }

    fn check(&self, region: Region) {
        let end = region.start.checked_add(region.bytes);
        assert!(end.is_some_and(|end| end <= self.bytes()), "the region lies outside the arena");
        assert!(region.start.is_multiple_of(ALIGNMENT), "the region is not aligned");
    }
}

/// Returns the same memory as integers.
pub(crate) fn integers(numbers: &mut [f32]) -> &mut [i32] {
    // SAFETY: size and alignment are equal, and every pattern of bits is a number of both types.
    unsafe { std::slice::from_raw_parts_mut(numbers.as_mut_ptr().cast(), numbers.len()) }
}

/// # Safety
/// `region` lies in initialised memory at `start`, which is aligned to [`ALIGNMENT`].
unsafe fn numbers<'a, T: Number>(start: *const u8, region: Region) -> &'a [T] {
    // SAFETY: the caller's promise.
    unsafe { std::slice::from_raw_parts(start.add(region.start).cast(), region.bytes / size_of::<T>()) }
}

/// The region that is written.
#[derive(Debug)]
pub struct Written<'a> {
    start: *mut u8,
    region: Region,
    arena: PhantomData<&'a mut Arena>,
}

impl<'a> Written<'a> {
    /// Returns the numbers of the region.
    pub fn numbers<T: Number>(self) -> &'a mut [T] {
        let Region { start, bytes } = self.region;
        // SAFETY: the region lies in the arena, of which nothing else borrows it: `Rest` excludes it.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(start).cast(), bytes / size_of::<T>()) }
    }

    /// Divides the region after `bytes`, rounded up to the alignment.
    ///
    /// # Panics
    /// When the region is smaller.
    #[must_use]
    pub fn split(self, bytes: usize) -> (Self, Self) {
        let Region { start, bytes: all } = self.region;
        let first = bytes.next_multiple_of(ALIGNMENT);
        assert!(first <= all, "the region is too small");
        let part =
            |start, bytes| Written { start: self.start, region: Region { start, bytes }, arena: PhantomData };
        (part(start, bytes), part(start + first, all - first))
    }
}

/// All regions but the one that is written.
#[derive(Debug, Clone, Copy)]
pub struct Rest<'a> {
    start: *const u8,
    bytes: usize,
    written: Region,
    arena: PhantomData<&'a Arena>,
}

impl<'a> Rest<'a> {
    /// Returns the numbers of a region.
    ///
    /// # Panics
    /// When the region overlaps the one that is written, lies outside the arena, or is not aligned.
    pub fn get<T: Number>(&self, region: Region) -> &'a [T] {
        let end = region.start.checked_add(region.bytes);
        let written_end = self.written.start + self.written.bytes;
        assert!(end.is_some_and(|end| end <= self.bytes), "the region lies outside the arena");
        assert!(region.start.is_multiple_of(ALIGNMENT), "the region is not aligned");
        let apart = region.bytes == 0
            || self.written.bytes == 0
            || region.start >= written_end
            || region.start + region.bytes <= self.written.start;
        assert!(apart, "a tensor is read and written at the same time");
        // SAFETY: as in `Arena::get`; nothing writes the region, which does not overlap the written one.
        unsafe { numbers(self.start, region) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_arenas_are_aligned_zeros() {
        for bytes in [0, 1, 64, 65, 4097, 1 << 20] {
            let arena = Arena::new(bytes);
            assert_eq!(arena.bytes(), bytes.next_multiple_of(ALIGNMENT));
            let all = arena.get::<u8>(Region { start: 0, bytes: arena.bytes() });
            assert!(all.as_ptr().addr().is_multiple_of(ALIGNMENT) && all.iter().all(|&byte| byte == 0));
        }
    }

    #[test]
    fn bytes_are_adopted() {
        for length in [0, 1, 16, 100] {
            let bytes: Vec<u8> = (0..length).collect();
            let mut arena = Arena::from_bytes(bytes.clone());
            let region = Region { start: 0, bytes: bytes.len() };
            assert_eq!(arena.get::<u8>(region), bytes);
            let numbers = arena.split(region).0.numbers::<i64>();
            numbers.fill(-1);
            assert_eq!(
                arena.get::<i32>(region).iter().filter(|&&number| number != -1).count(),
                bytes.len() / 4 % 2
            );
        }
    }

    #[test]
    fn parts_are_separate() {
        let mut arena = Arena::new(256);
        let (written, rest) = arena.split(Region { start: 64, bytes: 128 });
        let (first, second) = written.split(12);
        first.numbers::<f32>().fill(1.0);
        second.numbers::<i64>().fill(2);
        assert_eq!(rest.get::<u8>(Region { start: 192, bytes: 64 }), [0; 64]);
        let caught = std::panic::catch_unwind(|| rest.get::<u8>(Region { start: 128, bytes: 64 }).len());
        assert!(caught.is_err());
        assert_eq!(arena.get::<f32>(Region { start: 64, bytes: 12 }), [1.0; 3]);
        assert_eq!(arena.get::<i64>(Region { start: 128, bytes: 64 }), [2; 8]);
    }
}
