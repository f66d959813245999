//! The sample types of network inputs.

/// A sample type of network inputs: `f32`, or integers, to which values are rounded (ties to even) and clamped (`i32`
/// at four million).
pub trait InputSample: sealed::Convert {}

impl InputSample for f32 {}
impl InputSample for i32 {}
impl InputSample for i8 {}
impl InputSample for u8 {}

/// Sample types that the kernels write: `f32` or `i32`.
pub trait Written: Copy + Default {
    /// The largest magnitude that is rounded to an integer; `None` for floats.
    const ROUNDED_WITHIN: Option<f32>;

    /// Converts a value to a sample.
    fn from_value(value: f32) -> Self;
}

impl Written for f32 {
    const ROUNDED_WITHIN: Option<f32> = None;

    fn from_value(value: f32) -> Self {
        value
    }
}

impl Written for i32 {
    const ROUNDED_WITHIN: Option<f32> = Some(4e6);

    fn from_value(value: f32) -> Self {
        // Below 2^22, adding 1.5 * 2^23 moves the integer into the low bits: rounding without a function call.
        const SHIFT: f32 = 12_582_912.0;
        let shifted = value.clamp(-4e6, 4e6) + SHIFT;
        (shifted.to_bits() as Self).wrapping_sub(SHIFT.to_bits() as Self)
    }
}

pub(super) mod sealed {
    use super::Written;

    /// Conversion from the kernels' sample type; seals [`super::InputSample`].
    pub trait Convert: Copy + Send {
        /// The type that the kernels write for this sample.
        type Written: Written;

        /// Converts a written value to the sample.
        fn from_written(written: Self::Written) -> Self;

        /// Returns the slice itself where no conversion is needed: kernels then write in place.
        fn in_place(_: &mut [Self]) -> Option<&mut [Self::Written]> {
            None
        }
    }

    impl Convert for f32 {
        type Written = Self;

        fn from_written(written: Self) -> Self {
            written
        }

        fn in_place(samples: &mut [Self]) -> Option<&mut [Self]> {
            Some(samples)
        }
    }

    impl Convert for i32 {
        type Written = Self;

        fn from_written(written: Self) -> Self {
            written
        }

        fn in_place(samples: &mut [Self]) -> Option<&mut [Self]> {
            Some(samples)
        }
    }

    impl Convert for i8 {
        type Written = i32;

        fn from_written(written: i32) -> Self {
            written.clamp(-128, 127) as Self
        }
    }

    impl Convert for u8 {
        type Written = i32;

        fn from_written(written: i32) -> Self {
            written.clamp(0, 255) as Self
        }
    }
}
