//! A camera that pans, tilts and zooms over a large image.

use opendr_engine::data::{Image, Pixels};
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr_engine::target::Action;
use opendr_engine::{Error, Result};
use opendr_vision::resize;

use crate::rgb_image::rgb_image;

/// A window of a large image, as a camera in its middle sees it.
///
/// Axes: azimuth (to the left positive), elevation (up positive), distance. The whole width of the image is one field of view,
/// in rad; a distance of 1 shows it whole, and of 0.5 half of its width. Windows stay within the image.
pub struct PanTiltZoom {
    image: Image,
    sphere: ViewSphere,
    field: f64,
    side: [usize; 2],
}

impl PanTiltZoom {
    /// Creates a camera over an image of bytes whose width is `field` rad; its images are RGB, of `width` x `height` pixels. It begins
    /// with the whole image.
    ///
    /// # Errors
    /// `InvalidInput` for an image of other samples, `InvalidParam` for a field that is not in 0..=pi.
    pub fn new(image: Image, field: f64, [width, height]: [usize; 2]) -> Result<Self> {
        let image = rgb_image(&image)?.into_owned();
        if !(field > 0.0 && field <= std::f64::consts::PI) {
            return Err(Error::invalid_param(format!("a field of view of {field} rad; give one in 0..=pi")));
        }
        let high = field * image.height() as f64 / image.width() as f64;
        let axes = vec![
            ViewAxis::limited("azimuth", field / 5.0, -field / 2.0, field / 2.0),
            ViewAxis::limited("elevation", high / 5.0, -high / 2.0, high / 2.0),
            ViewAxis::limited("distance", -0.2, 0.2, 1.0),
        ];
        let sphere = ViewSphere::new(axes, ViewPose { distance: 1.0, ..ViewPose::default() })?;
        Ok(Self { image, sphere, field, side: [width.max(1), height.max(1)] })
    }

    /// Returns the left, top, width and height of the window, in pixels.
    pub fn window(&self) -> [usize; 4] {
        let pose = self.sphere.pose();
        let (width, height) = (self.image.width() as f64, self.image.height() as f64);
        let [wide, high] = [width, height].map(|side| (side * pose.distance).round().clamp(1.0, side));
        let per_rad = width / self.field;
        let begin = |middle: f64, size: f64, side: f64| (middle - size / 2.0).round().clamp(0.0, side - size);
        let left = begin(width / 2.0 - pose.azimuth * per_rad, wide, width);
        let top = begin(height / 2.0 - pose.elevation * per_rad, high, height);
        [left, top, wide, high].map(|pixels| pixels as usize)
    }
}

impl ViewRig for PanTiltZoom {
    fn axes(&self) -> &[ViewAxis] {
        self.sphere.axes()
    }

    fn pose(&self) -> ViewPose {
        self.sphere.pose()
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        self.sphere.apply(action)
    }

    fn capture(&mut self) -> Result<Image> {
        let [left, top, width, height] = self.window();
        let Pixels::U8(pixels) = self.image.pixels() else {
            return Err(Error::internal("an image that changed its samples"));
        };
        let row = |line: usize| {
            let begin = 3 * ((top + line) * self.image.width() + left);
            &pixels[begin..begin + 3 * width]
        };
        let window = Image::from_rgb8((0..height).flat_map(row).copied().collect(), width, height)?;
        resize(&window, self.side[0], self.side[1])
    }
}
