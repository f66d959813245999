//! The sample types of network inputs.

/// A sample type that networks take: `f32`, or integers into which values are rounded and cut.
pub trait InputSample: Copy + Send + sealed::Convert {}

impl InputSample for f32 {}
impl InputSample for i32 {}
impl InputSample for i8 {}
impl InputSample for u8 {}

pub(super) mod sealed {
    /// Keeps [`super::InputSample`] to the types below.
    pub trait Convert: Sized {
        /// The nearest sample, ties upwards.
        fn from_value(value: f32) -> Self;

        /// The slice itself where samples are floats: kernels then write in place.
        fn floats(_: &mut [Self]) -> Option<&mut [f32]> {
            None
        }
    }

    impl Convert for f32 {
        fn from_value(value: f32) -> Self {
            value
        }

        fn floats(samples: &mut [Self]) -> Option<&mut [f32]> {
            Some(samples)
        }
    }

    impl Convert for i32 {
        fn from_value(value: f32) -> Self {
            (value + 0.5).floor() as Self
        }
    }

    impl Convert for i8 {
        fn from_value(value: f32) -> Self {
            (value + 0.5).floor() as Self
        }
    }

    impl Convert for u8 {
        fn from_value(value: f32) -> Self {
            (value + 0.5) as Self
        }
    }
}
