//! Shading of rendered images.

use opendr_engine::Result;
use opendr_engine::data::Image;

use super::{Camera, DepthBuffer, Pose, Scene, Shape, Vector, along, dot, unit};

/// Colours and lights: Lambertian shading with sun and sky, chequered ground.
#[derive(Debug, Clone, PartialEq)]
pub struct Shading {
    /// Colours by label; labels beyond the list wrap around.
    pub colours: Vec<[u8; 3]>,
    /// Direction of the sun.
    pub sun: Vector,
    /// Fraction of ambient light.
    pub ambient: f32,
    /// Colours of the sky at the horizon and at the zenith.
    pub sky: [[u8; 3]; 2],
    /// Side of the ground's squares, in metres.
    pub square: f32,
}

impl Default for Shading {
    fn default() -> Self {
        Self {
            colours: vec![[200, 200, 190], [214, 164, 92], [92, 142, 196], [196, 96, 84], [122, 172, 104]],
            sun: [-0.4, 0.5, 0.9],
            ambient: 0.35,
            sky: [[222, 232, 240], [112, 160, 212]],
            square: 1.0,
        }
    }
}

impl Shading {
    /// Renders an RGB image of `scene` from `pose`, up to `range` metres ahead.
    ///
    /// # Errors
    /// None for a valid [`Camera`].
    pub fn render(&self, camera: &Camera, scene: &Scene, pose: &Pose, range: f32) -> Result<Image> {
        let mut buffer = DepthBuffer::default();
        camera.render_depth(scene, pose, range, &mut buffer);
        let mut pixels = Vec::with_capacity(3 * camera.width() * camera.height());
        for (at, (depth, body)) in buffer.depths().zip(buffer.bodies()).enumerate() {
            let direction = pose.to_world(camera.direction(at % camera.width(), at / camera.width()));
            let point = along(pose.position, direction, depth);
            let colour = match body {
                None => self.sky(unit(direction)),
                Some(number) => self.surface(scene, number, point, direction),
            };
            pixels.extend(colour.map(|part| part.clamp(0.0, 255.0) as u8));
        }
        Image::from_rgb8(pixels, camera.width(), camera.height())
    }

    fn sky(&self, direction: Vector) -> [f32; 3] {
        let high = direction[2].clamp(0.0, 1.0).sqrt();
        let [horizon, zenith] = self.sky.map(|colour| colour.map(f32::from));
        std::array::from_fn(|part| horizon[part] + high * (zenith[part] - horizon[part]))
    }

    fn surface(&self, scene: &Scene, number: usize, point: Vector, direction: Vector) -> [f32; 3] {
        let Some(body) = scene.bodies().get(number) else { return [0.0; 3] };
        let normal = body.normal(point);
        // The normal points to the side that the camera looks at.
        let normal = if dot(normal, direction) > 0.0 { normal.map(|part| -part) } else { normal };
        let sunlight = dot(normal, unit(self.sun)).max(0.0);
        let light = self.ambient + (1.0 - self.ambient) * sunlight;
        let is_ground = matches!(body.shape(), Shape::HalfSpace);
        let squares = (point[0] / self.square).floor() + (point[1] / self.square).floor();
        let light = if is_ground && squares.rem_euclid(2.0) >= 1.0 { 0.8 * light } else { light };
        let colours = self.colours.len().max(1);
        let colour = self.colours.get(usize::from(body.label()) % colours).copied().unwrap_or([200; 3]);
        colour.map(|part| light * f32::from(part))
    }
}
