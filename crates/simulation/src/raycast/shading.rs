//! Colours of what a camera sees.

use opendr_engine::Result;
use opendr_engine::data::Image;

use super::{Camera, DepthBuffer, Pose, Scene, Shape, Vector, along, dot, unit};

/// Light and colours: Lambert's law under a sun and a sky, a chequered ground.
#[derive(Debug, Clone, PartialEq)]
pub struct Shading {
    /// Colours by label, from the first again after the last.
    pub colours: Vec<[u8; 3]>,
    /// Where the sun stands.
    pub sun: Vector,
    /// The share of light that comes from everywhere.
    pub ambient: f32,
    /// The sky at the horizon and overhead.
    pub sky: [[u8; 3]; 2],
    /// Side of the ground's squares in metres.
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
    /// An RGB picture of what `camera` sees of `scene` from `pose`, at most `range` metres ahead.
    ///
    /// # Errors
    /// None that a [`Camera`] allows.
    pub fn picture(&self, camera: &Camera, scene: &Scene, pose: &Pose, range: f32) -> Result<Image> {
        let mut seen = DepthBuffer::default();
        camera.look(scene, pose, range, &mut seen);
        let mut pixels = Vec::with_capacity(3 * camera.width() * camera.height());
        for (at, (depth, body)) in seen.depths().zip(seen.bodies()).enumerate() {
            let direction = pose.turned(camera.direction(at % camera.width(), at / camera.width()));
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
        // A surface is seen from the side from which it is looked at.
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
