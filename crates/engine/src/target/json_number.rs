//! Numbers without a JSON form: NaN and infinities are written as `null`, and `null` is read as NaN.

use serde::{Deserialize, Deserializer};
use smallvec::SmallVec;

/// Numbers, or arrays and lists of them, that may be `null`.
pub(super) trait Nullable: Sized {
    type Json<'de>: Deserialize<'de>;

    fn from_json(json: Self::Json<'_>) -> Self;
}

impl Nullable for f32 {
    type Json<'de> = Option<f32>;

    fn from_json(json: Option<f32>) -> Self {
        json.unwrap_or(f32::NAN)
    }
}

macro_rules! arrays {
    ($($length:literal)*) => {$(
        impl<T: Nullable> Nullable for [T; $length] {
            type Json<'de> = [T::Json<'de>; $length];

            fn from_json(json: Self::Json<'_>) -> Self {
                json.map(T::from_json)
            }
        }
    )*};
}

arrays!(2 3 4);

impl<T: Nullable> Nullable for Option<T> {
    type Json<'de> = Option<T::Json<'de>>;

    fn from_json(json: Self::Json<'_>) -> Self {
        json.map(T::from_json)
    }
}

impl<T: Nullable> Nullable for Vec<T> {
    type Json<'de> = Vec<T::Json<'de>>;

    fn from_json(json: Self::Json<'_>) -> Self {
        json.into_iter().map(T::from_json).collect()
    }
}

impl Nullable for SmallVec<[[f32; 2]; 5]> {
    type Json<'de> = Vec<[Option<f32>; 2]>;

    fn from_json(json: Self::Json<'_>) -> Self {
        json.into_iter().map(<[f32; 2]>::from_json).collect()
    }
}

/// Deserialises numbers and reads `null` as NaN, for `#[serde(deserialize_with)]`.
pub(super) fn null_as_nan<'de, T: Nullable, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    T::Json::deserialize(deserializer).map(T::from_json)
}
