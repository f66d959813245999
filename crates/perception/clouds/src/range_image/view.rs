//! Field of view of a range image.

use std::f32::consts::{FRAC_PI_2, PI};

use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// Size and field of view of a range image; rows and columns are equal angles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RangeView {
    /// Number of rows, from top to bottom.
    pub rows: usize,
    /// Number of columns, from left to right.
    pub columns: usize,
    /// Angle of the upper edge above the horizon in radians.
    pub top: f32,
    /// Angle of the lower edge in radians, negative below the horizon.
    pub bottom: f32,
    /// Angle from ahead to either edge in radians; pi is a full turn.
    pub half_view: f32,
}

/// Maximum number of pixels.
const MOST_PIXELS: usize = 1 << 22;

impl RangeView {
    /// Returns the pixel of a point `distance` metres away, `row * columns + column`; `None` outside of the view, at the lidar
    /// itself, and where a value is not finite.
    #[inline]
    pub fn pixel(&self, [x, y, z]: [f32; 3], distance: f32) -> Option<usize> {
        if !(distance > 0.0 && distance < f32::INFINITY) {
            return None;
        }
        let down = (self.top - (z / distance).asin()) / (self.top - self.bottom);
        let right = (self.half_view - y.atan2(x)) / (2.0 * self.half_view);
        // Comparisons with NaN are false.
        if !((0.0..1.0).contains(&down) && (0.0..=1.0).contains(&right)) {
            return None;
        }
        let row = ((down * self.rows as f32) as usize).min(self.rows - 1);
        let column = ((right * self.columns as f32) as usize).min(self.columns - 1);
        Some(row * self.columns + column)
    }

    /// Checks the view of a container or a user.
    ///
    /// # Errors
    /// `Format` for invalid angles, and for no pixel or more than four million.
    pub fn check(&self) -> Result<()> {
        let Self { rows, columns, top, bottom, half_view } = *self;
        let angles = -FRAC_PI_2 <= bottom && bottom < top && top <= FRAC_PI_2;
        let pixels = rows.checked_mul(columns).is_some_and(|pixels| (1..=MOST_PIXELS).contains(&pixels));
        if angles && pixels && half_view > 0.0 && half_view <= PI + 1e-3 {
            return Ok(());
        }
        Err(Error::format(format!(
            "a range image needs an upper edge above its lower edge, at most pi to either side, and 1 to {MOST_PIXELS} \
             pixels; this one is {self:?}"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: RangeView = RangeView { rows: 64, columns: 1024, top: 0.05, bottom: -0.45, half_view: PI };

    #[test]
    fn rings_are_rows_and_turns_are_columns() {
        VIEW.check().unwrap();
        let pixel = |azimuth: f32, elevation: f32| {
            let level = 10.0 * elevation.cos();
            VIEW.pixel([level * azimuth.cos(), level * azimuth.sin(), 10.0 * elevation.sin()], 10.0)
        };
        assert_eq!(pixel(0.0, 0.049), Some(512));
        assert_eq!(pixel(PI - 1e-3, -0.449), Some(63 * 1024));
        assert_eq!(pixel(1e-3 - PI, -0.449), Some(64 * 1024 - 1));
        assert_eq!((pixel(0.0, 0.06), pixel(0.0, -0.46)), (None, None));
        for strange in [f32::NAN, f32::INFINITY] {
            assert_eq!(VIEW.pixel([strange, 1.0, 1.0], strange), None);
        }
    }

    #[test]
    fn invalid_views_are_refused() {
        let wrong = [
            RangeView { rows: 0, ..VIEW },
            RangeView { columns: usize::MAX, ..VIEW },
            RangeView { top: -0.45, ..VIEW },
            RangeView { bottom: f32::NAN, ..VIEW },
            RangeView { half_view: 4.0, ..VIEW },
        ];
        assert!(wrong.iter().all(|view| view.check().is_err()));
    }
}
