//! Errors of reader and writer.

/// Reason for which bytes cannot be read, or a message cannot be written.
#[derive(Debug, thiserror::Error)]
pub(super) enum Reason {
    #[error("they end within a field")]
    Short,
    #[error("{0} bytes are left over")]
    Left(usize),
    #[error("a text is not UTF-8")]
    Utf8,
    #[error("a field has more than 2^32 - 1 elements")]
    Long,
    #[error("ROS 1 has no {0}")]
    Unknown(&'static str),
    #[error("{0}")]
    Custom(String),
}

impl serde::ser::Error for Reason {
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        Self::Custom(message.to_string())
    }
}

impl serde::de::Error for Reason {
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        Self::Custom(message.to_string())
    }
}
