//! Time and size of each frame from the log of `ffmpeg`.

/// Time and size of one frame, from a line of the filter `showinfo`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FrameLine {
    /// Seconds since the start of the video, where the file states it.
    pub time_s: Option<f64>,
    /// Width in pixels, turned upright.
    pub width: usize,
    /// Height in pixels, turned upright.
    pub height: usize,
}

impl FrameLine {
    /// Parses `[Parsed_showinfo_0 @ 0x5] [info] n: 0 pts: 0 pts_time:0.04 ... s:320x240 ...`.
    pub(super) fn of_text(line: &str) -> Option<Self> {
        let rest = line.strip_prefix("[Parsed_showinfo")?;
        let value = |key: &str| {
            let (_, after) = rest.split_once(key)?;
            after.split_whitespace().next()
        };
        let time_s = value(" pts_time:")?;
        let (width, height) = value(" s:")?.split_once('x')?;
        Some(Self {
            time_s: time_s.parse().ok().filter(|time: &f64| time.is_finite()),
            width: width.parse().ok()?,
            height: height.parse().ok()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read() {
        let line = "[Parsed_showinfo_0 @ 0x55] [info] n:   3 pts:   3072 pts_time:0.3     pos: 1 fmt:yuv420p sar:1/1 s:320x240 i:P";
        assert_eq!(FrameLine::of_text(line), Some(FrameLine { time_s: Some(0.3), width: 320, height: 240 }));
        let untimed = line.replace("0.3 ", "NOPTS ");
        assert_eq!(FrameLine::of_text(&untimed).unwrap().time_s, None);
        for other in ["[info] title: pts_time:1 s:9x9", "[Parsed_showinfo_0 @ 0x55] [info] config in", ""] {
            assert_eq!(FrameLine::of_text(other), None);
        }
    }
}
