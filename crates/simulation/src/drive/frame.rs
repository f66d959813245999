//! Rendering of the frames of a drive.

use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_engine::{Error, Header, Random, Result};

use super::DriveOptions;
use super::course::Road;
use super::ride::{CameraPose, Ride, raycast_pose};
use super::sensor::{Sensor, nearly_normal};
use super::town::Town;
use crate::raycast::{Camera, DepthBuffer, Pose, Vector, along, dot, length, unit};
use crate::sine_cosine::sine_cosine;

/// A drive through a town, rendered frame by frame.
#[derive(Debug, Clone)]
pub struct Drive {
    options: DriveOptions,
    camera: Camera,
    ride: Ride,
    town: Town,
}

/// What the cameras image at one time.
#[derive(Debug, Clone)]
pub struct DriveFrame {
    /// RGB image of the left camera, which is also the camera of a monocular or depth drive.
    pub left: Image,
    /// RGB image of the right camera.
    pub right: Image,
    /// Depth of each pixel of the left image along the optical axis, in metres, `f32`; 0 where nothing is in range.
    pub depth: Image,
}

/// Farthest surface that is rendered, in metres.
const RANGE: f32 = 300.0;
const SUN: Vector = [-0.35, 0.45, 0.82];
const AMBIENT: f32 = 0.55;

impl Drive {
    /// Creates the drive of these options.
    ///
    /// # Errors
    /// `InvalidParam` for an option out of its range.
    pub fn new(options: &DriveOptions) -> Result<Self> {
        options.check()?;
        let [width, height] = options.size;
        let camera = Camera::new(width, height, options.half_width)?;
        let road = Road::new(options, &mut Random::from_key([options.seed, 0]));
        let town = Town::new(&road, options, &mut Random::from_key([options.seed, 1]))?;
        let ride = Ride::new(road, options, &mut Random::from_key([options.seed, 2]));
        Ok(Self { options: options.clone(), camera, ride, town })
    }

    /// Returns the number of frames.
    pub fn frames(&self) -> usize {
        self.ride.frames()
    }

    /// Returns the exact pose of the left camera: the rows of world_from_camera, with x right, y down and z ahead in the camera, z up
    /// in the world, in metres.
    pub fn pose(&self, frame: usize) -> [[f64; 4]; 3] {
        self.ride.pose(frame)
    }

    /// Returns the time of a frame, in seconds.
    pub fn time(&self, frame: usize) -> f64 {
        frame as f64 / self.options.rate
    }

    /// Returns focal length and principal point, in pixels, where the centre of the first pixel is at 0.
    pub fn intrinsics(&self) -> (f64, [f64; 2]) {
        let [width, height] = self.options.size.map(|side| side as f64);
        (width / (2.0 * f64::from(self.options.half_width)), [(width - 1.0) / 2.0, (height - 1.0) / 2.0])
    }

    /// Returns the options.
    pub fn options(&self) -> &DriveOptions {
        &self.options
    }

    /// Renders left image, right image and depth of a frame.
    ///
    /// # Errors
    /// `NotFound` when the drive has no such frame.
    pub fn render(&self, frame: usize) -> Result<DriveFrame> {
        if frame >= self.frames() {
            return Err(Error::not_found(format!(
                "no frame {frame}; the drive has {} frames",
                self.frames()
            )));
        }
        let pose: CameraPose = self.pose(frame);
        let header = || Header::new((self.time(frame) * 1e9) as i64, "camera");
        let [width, height] = self.options.size;
        let mut random = Random::from_key([self.options.seed, 3, frame as u64]);
        let (left, depths) = self.look(&raycast_pose(&pose, 0.0), frame, &mut random)?;
        let (right, _) =
            self.look(&raycast_pose(&pose, f64::from(self.options.baseline)), frame, &mut random)?;
        let depths: Vec<f32> = depths.into_iter().map(|depth| self.measured(depth, &mut random)).collect();
        let depth = Image::new(depths, width, height, PixelFormat::Grey, Layout::Hwc)?;
        let [left, right, depth] = [left, right, depth].map(|image| image.with_header(header()));
        Ok(DriveFrame { left, right, depth })
    }

    /// Renders an image; returns it with its depths.
    fn look(&self, pose: &Pose, frame: usize, random: &mut Random) -> Result<(Image, Vec<f32>)> {
        let mut buffer = DepthBuffer::default();
        self.camera.render_depth(&self.town.scene, pose, RANGE, &mut buffer);
        let width = self.camera.width();
        let depths: Vec<f32> = buffer.depths().collect();
        let mut light = Vec::with_capacity(depths.len());
        for (at, (depth, body)) in depths.iter().zip(buffer.bodies()).enumerate() {
            let direction = pose.to_world(self.camera.direction(at % width, at / width));
            light.push(match body {
                Some(number) => self.surface(number, pose, direction, *depth),
                None => sky(direction),
            });
        }
        let swing = sine_cosine(0.9 * self.time(frame)).0 as f32;
        let gain = 1.0 + self.options.exposure_swing * swing;
        let bytes = Sensor { gain, noise: self.options.noise }.develop(&light, width, random);
        Ok((Image::from_rgb8(bytes, width, self.camera.height())?, depths))
    }

    fn surface(&self, number: usize, pose: &Pose, direction: Vector, depth: f32) -> Vector {
        let body = &self.town.scene.bodies()[number];
        let point = along(pose.position, direction, depth);
        let normal = body.normal(point);
        let facing = (-dot(normal, direction) / length(direction)).max(0.04);
        let (focal_length, _) = self.intrinsics();
        let pixel = depth / (focal_length as f32 * facing);
        let own = [body.point_in_body(point), body.direction_in_body(normal)];
        let colour = self.town.finishes[number].at(own[0], own[1], pixel);
        let lit = AMBIENT + (1.0 - AMBIENT) * dot(normal, unit(SUN)).max(0.0);
        colour.map(|part| lit * part)
    }

    /// Returns the depth that a depth camera measures.
    fn measured(&self, depth: f32, random: &mut Random) -> f32 {
        if depth > self.options.depth_range {
            return 0.0;
        }
        let (focal_length, _) = self.intrinsics();
        let product = focal_length as f32 * self.options.baseline;
        product / (product / depth + self.options.depth_noise * nearly_normal(random.bits())).max(0.1)
    }
}

fn sky(direction: Vector) -> Vector {
    let high = unit(direction)[2].clamp(0.0, 1.0).sqrt();
    std::array::from_fn(|part| [0.86, 0.9, 0.94][part] + high * [-0.36, -0.2, -0.06][part])
}
