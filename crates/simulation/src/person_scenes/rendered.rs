//! Rendering of a scene: colours with shadows, depth, normals, instances.

use opendr_engine::data::Image;
use opendr_engine::{Random, Result};

use super::exposure::Exposure;
use super::place::Place;
use super::surface::Surface;
use crate::raycast::{Body, Camera, DepthBuffer, Pose, Scene, Shape, Vector, along, cross, dot, minus, unit};

/// An image with its depth, normals and instances.
#[derive(Debug, Clone)]
pub struct RenderedScene {
    /// The image.
    pub image: Image,
    /// Distance along the optical axis of each pixel, metres, row by row; [`Self::RANGE`] where nothing is hit.
    pub depth: Vec<f32>,
    /// Surface normal of each pixel in the camera's frame (to the right, down, ahead), row by row; zero where nothing is hit.
    pub normals: Vec<Vector>,
    /// Number of the person in each pixel, from 1; 0 for everything else.
    pub instances: Vec<u16>,
    /// Pose of the camera in the world.
    pub pose: Pose,
    /// Focal length, pixels; the optical axis passes through the middle of the image.
    pub focal_length: f32,
}

impl RenderedScene {
    /// Largest depth, metres.
    pub const RANGE: f32 = 60.0;
}

/// Side of the shadow map, pixels.
const SHADOW_SIDE: usize = 768;
/// Distance of the light from the middle of the scene, metres.
const LIGHT_DISTANCE: f32 = 40.0;
/// Depth by which a surface is behind the shadow map before it is in shadow, metres.
const SHADOW_MARGIN: f32 = 0.06;

/// A scene with a camera, ready to be rendered.
pub(super) struct Stage {
    pub place: Place,
    pub persons: Vec<(Body, Surface)>,
    pub camera: Camera,
    pub half_width: f32,
    pub pose: Pose,
}

impl Stage {
    /// Renders the stage; `random` draws noise.
    pub fn render(&self, exposure: &Exposure, random: &mut Random) -> Result<RenderedScene> {
        let (mut scene, mut surfaces) = (Scene::default(), Vec::new());
        for (body, surface) in self.place.bodies.iter().chain(&self.persons) {
            scene.add(body.clone());
            surfaces.push(*surface);
        }
        let mut buffer = DepthBuffer::default();
        self.camera.render_depth(&scene, &self.pose, RenderedScene::RANGE, &mut buffer);
        let depth: Vec<f32> = buffer.depths().collect();
        let bodies: Vec<Option<usize>> = buffer.bodies().collect();
        let geometry = Geometry {
            camera: &self.camera,
            pose: &self.pose,
            scene: &scene,
            depth: &depth,
            bodies: &bodies,
        };
        let shadows = Shadows::cast(&scene, unit(self.place.light), self.place.half)?;
        let (mut colours, mut normals) = (Vec::with_capacity(depth.len()), Vec::with_capacity(depth.len()));
        for (at, body) in bodies.iter().enumerate() {
            let (colour, normal) = match body.and_then(|number| Some((number, scene.bodies().get(number)?))) {
                None => (self.sky(geometry.ray(at)), [0.0; 3]),
                Some((number, body)) => {
                    let (point, normal) = (geometry.point(at), geometry.normal(at, body));
                    let surface = surfaces[number].colour(body.point_in_body(point));
                    let light = self.light(&shadows, point, normal);
                    (surface.map(|part| light * part), normal)
                }
            };
            colours.push(colour);
            normals.push(self.in_camera(normal));
        }
        let label = |body: &Option<usize>| body.and_then(|at| scene.bodies().get(at)).map_or(0, Body::label);
        let (width, height) = (self.camera.width(), self.camera.height());
        Ok(RenderedScene {
            image: Image::from_rgb8(exposure.develop(colours, width, random), width, height)?,
            instances: bodies.iter().map(label).collect(),
            depth,
            normals,
            pose: self.pose,
            focal_length: width as f32 / (2.0 * self.half_width),
        })
    }

    fn light(&self, shadows: &Shadows, point: Vector, normal: Vector) -> f32 {
        let Place { light, ambient, .. } = self.place;
        let facing = dot(normal, unit(light)).max(0.0);
        let direct = if facing > 0.0 && shadows.is_lit(point) { facing } else { 0.0 };
        // Less light from everywhere reaches what faces the floor.
        ambient * (0.75 + 0.25 * normal[2]) + (1.0 - ambient) * direct
    }

    fn sky(&self, direction: Vector) -> Vector {
        let high = unit(direction)[2].clamp(0.0, 1.0).sqrt();
        let [horizon, zenith] = self.place.sky;
        std::array::from_fn(|part| horizon[part] + high * (zenith[part] - horizon[part]))
    }

    fn in_camera(&self, normal: Vector) -> Vector {
        let [ahead, left, up] = self.pose.axes.map(|axis| dot(axis, normal));
        [-left, -up, ahead]
    }
}

/// Depths and bodies of an image, to compute points and normals.
struct Geometry<'a> {
    camera: &'a Camera,
    pose: &'a Pose,
    scene: &'a Scene,
    depth: &'a [f32],
    bodies: &'a [Option<usize>],
}

impl Geometry<'_> {
    /// Returns the direction of a pixel in the world, one metre ahead.
    fn ray(&self, at: usize) -> Vector {
        let width = self.camera.width();
        self.pose.to_world(self.camera.direction(at % width, at / width))
    }

    fn point(&self, at: usize) -> Vector {
        along(self.pose.position, self.ray(at), self.depth[at])
    }

    /// Returns the normal of a pixel towards the camera: exact for simple shapes, from differences of depth for meshes.
    fn normal(&self, at: usize, body: &Body) -> Vector {
        let normal = match body.shape() {
            Shape::Mesh(_) => self.normal_of_differences(at),
            _ => body.normal(self.point(at)),
        };
        if dot(normal, self.ray(at)) > 0.0 { normal.map(|part| -part) } else { normal }
    }

    fn normal_of_differences(&self, at: usize) -> Vector {
        let (width, x) = (self.camera.width(), at % self.camera.width());
        let label =
            |at: usize| self.bodies[at].and_then(|number| self.scene.bodies().get(number)).map(Body::label);
        let own = label(at);
        let same = |near: Option<usize>| near.filter(|near| *near < self.depth.len() && label(*near) == own);
        let difference = |before: Option<usize>, after: Option<usize>| {
            let (before, after) = (same(before).unwrap_or(at), same(after).unwrap_or(at));
            (before != after).then(|| minus(self.point(after), self.point(before)))
        };
        let across = difference((x > 0).then(|| at - 1), (x + 1 < width).then_some(at + 1));
        let down = difference(at.checked_sub(width), Some(at + width));
        match (across, down) {
            (Some(across), Some(down)) => unit(cross(down, across)),
            _ => unit(self.ray(at).map(|part| -part)),
        }
    }
}

/// What the light sees.
struct Shadows {
    camera: Camera,
    pose: Pose,
    depth: Vec<f32>,
}

impl Shadows {
    fn cast(scene: &Scene, light: Vector, half: f32) -> Result<Self> {
        let camera = Camera::new(SHADOW_SIDE, SHADOW_SIDE, (half + 3.0) / LIGHT_DISTANCE)?;
        let pose = Pose::looking_at(light.map(|part| LIGHT_DISTANCE * part), [0.0; 3]);
        // Walls and ceilings of rooms do not shade; what is lower than persons does.
        let mut shading = Scene::default();
        let is_low = |body: &&Body| !matches!(body.shape(), Shape::HalfSpace) && body.position()[2] < 1.2;
        scene.bodies().iter().filter(is_low).for_each(|body| shading.add(body.clone()));
        let mut buffer = DepthBuffer::default();
        camera.render_depth(&shading, &pose, 2.0 * LIGHT_DISTANCE, &mut buffer);
        Ok(Self { camera, pose, depth: buffer.depths().collect() })
    }

    fn is_lit(&self, point: Vector) -> bool {
        let Some([x, y]) = self.camera.project(&self.pose, point) else { return true };
        if x < 0.0 || y < 0.0 || x >= SHADOW_SIDE as f32 || y >= SHADOW_SIDE as f32 {
            return true;
        }
        let depth = dot(minus(point, self.pose.position), self.pose.axes[0]);
        depth < self.depth[y as usize * SHADOW_SIDE + x as usize] + SHADOW_MARGIN
    }
}
