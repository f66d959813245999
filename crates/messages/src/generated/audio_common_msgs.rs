//! `audio_common_msgs`.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `audio_common_msgs/AudioData`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AudioData {
    #[serde(with = "serde_bytes")]
    pub data: Vec<u8>,
}

/// `audio_common_msgs/AudioDataStamped`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AudioDataStamped {
    pub header: crate::std_msgs::Header,
    pub audio: AudioData,
}

/// `audio_common_msgs/AudioInfo`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AudioInfo {
    pub channels: u8,
    pub sample_rate: u32,
    pub sample_format: String,
    pub bitrate: u32,
    pub coding_format: String,
}
