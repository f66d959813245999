//! Recognition of emotions and gestures from two modalities.

mod audiovisual_emotion;
mod rgbd_hand_gesture;

#[cfg(feature = "training")]
pub use audiovisual_emotion::AudiovisualEmotionFitParams;
pub use audiovisual_emotion::{
    AudiovisualEmotion, AudiovisualEmotionParams, AudiovisualFusion, AudiovisualInputs, ModalityDrop,
};
#[cfg(feature = "training")]
pub use rgbd_hand_gesture::RgbdHandGestureFitParams;
pub use rgbd_hand_gesture::{RgbdArchitecture, RgbdHandGesture, RgbdHandGestureParams, RgbdInputs};
