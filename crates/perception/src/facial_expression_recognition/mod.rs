//! What a face expresses.

mod facial_emotion;

pub use facial_emotion::{FacialEmotion, FacialEmotionParams};
