//! Time between the frames of a stream.

use opendr_engine::Header;

/// Seconds between frames without time stamps.
const FRAME: f32 = 1.0 / 30.0;
/// Minimum seconds between frames: stamps may be wrong.
const SHORTEST_FRAME: f32 = 1e-3;

/// Stores the stamp of the last frame.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FrameClock {
    stamp_ns: Option<i64>,
}

impl FrameClock {
    /// Returns the seconds since the last frame.
    pub fn seconds_to(&mut self, header: &Header) -> f32 {
        let before = std::mem::replace(&mut self.stamp_ns, header.stamp_ns);
        let passed =
            before.zip(header.stamp_ns).map(|(before, now)| now.saturating_sub(before) as f32 * 1e-9);
        passed.map_or(FRAME, |passed| passed.max(SHORTEST_FRAME))
    }
}
