//! Rendering of a flight: colour camera, depth camera, and a map of the path.

use opendr_engine::Result;
use opendr_engine::data::{Image, PixelFormat};
use opendr_vision::draw::{Canvas, Point};

use super::{CAMERA_HEIGHT, FINISH, HALF_WIDTH, RANGE, SIDE, START};
use crate::raycast::{Camera, DepthBuffer, Pose, Scene, Shading, Vector, along};

const WIDTH: usize = 600;
const HALF_HEIGHT: usize = 200;
/// Pixels of the colour image and, square, of the depth image.
const COLOUR: usize = 400;
const DEPTH: usize = WIDTH - COLOUR;
/// Height of the map's camera, large enough that objects are hardly visible from the side.
const ABOVE: f32 = 120.0;
/// Half width of the map, in metres.
const HALF_MAP: f32 = 17.0;
const FAR: f32 = 60.0;

/// Renders the world, the drone's pose and the path so far in 600 x 400 pixels.
pub(super) fn picture(scene: &Scene, pose: Pose, path: &[Vector]) -> Result<Image> {
    let eye = Pose { position: along(pose.position, pose.axes[2], CAMERA_HEIGHT), ..pose };
    let shading = Shading::default();
    let wide = Camera::new(COLOUR, HALF_HEIGHT, HALF_WIDTH * COLOUR as f32 / HALF_HEIGHT as f32)?;
    let ahead = shading.render(&wide, scene, &eye, FAR)?;
    let mut canvas = vec![255; 3 * WIDTH * 2 * HALF_HEIGHT];
    paste(&mut canvas, &ahead, [0, 0]);
    paste(&mut canvas, &depth_picture(scene, &eye)?, [COLOUR, 0]);
    paste(&mut canvas, &map(scene, path, &shading)?, [0, HALF_HEIGHT]);
    Image::from_rgb8(canvas, WIDTH, 2 * HALF_HEIGHT)
}

/// Renders the depth image in grey, dark for near, at the drone's resolution.
fn depth_picture(scene: &Scene, eye: &Pose) -> Result<Image> {
    let mut buffer = DepthBuffer::default();
    Camera::new(SIDE, SIDE, HALF_WIDTH)?.render_depth(scene, eye, RANGE, &mut buffer);
    let depths: Vec<_> = buffer.depths().map(|depth| (255.0 * depth / RANGE) as u8).collect();
    let at = |pixel: usize| pixel * SIDE / DEPTH;
    let pixels =
        (0..DEPTH * DEPTH).flat_map(|pixel| [depths[at(pixel / DEPTH) * SIDE + at(pixel % DEPTH)]; 3]);
    Image::from_rgb8(pixels.collect(), DEPTH, DEPTH)
}

fn map(scene: &Scene, path: &[Vector], shading: &Shading) -> Result<Image> {
    let camera = Camera::new(WIDTH, HALF_HEIGHT, HALF_MAP / ABOVE)?;
    // Seen from above, with the corridor from left to right.
    let axes = [[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let pose = Pose { position: [(START + FINISH) / 2.0, 0.0, ABOVE], axes };
    let mut image = shading.render(&camera, scene, &pose, 2.0 * ABOVE)?;
    let points: Vec<Point> = path.iter().filter_map(|point| camera.project(&pose, *point)).collect();
    let mut canvas = Canvas::over(&mut image);
    for ends in points.windows(2) {
        canvas.line(ends[0], ends[1], 2.0, [220, 40, 40], 1.0);
    }
    if let Some(point) = points.last() {
        canvas.disc(*point, 4.0, [220, 40, 40], 1.0);
    }
    Ok(image)
}

/// Copies an RGB image onto the canvas.
fn paste(canvas: &mut [u8], image: &Image, [left, top]: [usize; 2]) {
    let size = 3 * image.width();
    for (row, pixels) in image.hwc_u8(PixelFormat::Rgb).chunks(size).enumerate() {
        let begin = 3 * ((top + row) * WIDTH + left);
        canvas[begin..begin + size].copy_from_slice(pixels);
    }
}
