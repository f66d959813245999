//! Rasterisation of bodies into depth buffers.

use super::camera::{Camera, DepthBuffer, Patch};
use super::shape::{meet_box, meet_cylinder, meet_half_space, meet_sphere};
use super::{Body, Directions, LANES, Pose, Shape, Vector};

/// Draws a body where it is nearer than the buffer's content. Wider vectors change no bit: no operation is fused.
pub(super) fn paint(
    camera: &Camera,
    pose: &Pose,
    body: &Body,
    number: u32,
    patch: Patch,
    buffer: &mut DepthBuffer,
) {
    let job = Job {
        camera,
        origin: body.point_in_body(pose.position),
        axes: pose.axes.map(|axis| body.direction_in_body(axis)),
        number,
        patch,
    };
    #[cfg(target_arch = "x86_64")]
    {
        if std::is_x86_feature_detected!("avx512f") {
            // SAFETY: the CPU supports the features that the function is compiled for.
            return unsafe { paint_avx512(&job, body.shape(), buffer) };
        }
        if std::is_x86_feature_detected!("avx2") {
            // SAFETY: the CPU supports the features that the function is compiled for.
            return unsafe { paint_avx2(&job, body.shape(), buffer) };
        }
    }
    paint_shape(&job, body.shape(), buffer);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn paint_avx512(job: &Job<'_>, shape: &Shape, buffer: &mut DepthBuffer) {
    paint_shape(job, shape, buffer);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn paint_avx2(job: &Job<'_>, shape: &Shape, buffer: &mut DepthBuffer) {
    paint_shape(job, shape, buffer);
}

/// The rays to test against a body, in the body's frame.
struct Job<'a> {
    camera: &'a Camera,
    origin: Vector,
    /// Axes of the camera: ahead, left and up.
    axes: [Vector; 3],
    number: u32,
    patch: Patch,
}

/// Runs one loop per shape, so that the loop has no branch on the shape.
#[inline(always)]
fn paint_shape(job: &Job<'_>, shape: &Shape, buffer: &mut DepthBuffer) {
    let origin = job.origin;
    match shape {
        Shape::Sphere { radius } => {
            job.run(buffer, |directions, distances| meet_sphere(*radius, origin, directions, distances));
        }
        Shape::Box { half } => {
            job.run(buffer, |directions, distances| meet_box(*half, origin, directions, distances));
        }
        Shape::Cylinder { radius, half_height } => job.run(buffer, |directions, distances| {
            meet_cylinder(*radius, *half_height, origin, directions, distances);
        }),
        Shape::HalfSpace => {
            job.run(buffer, |directions, distances| meet_half_space(origin, directions, distances));
        }
        Shape::HeightField(field) => {
            job.run(buffer, |directions, distances| field.surface().meet(origin, directions, distances));
        }
        Shape::Mesh(mesh) => {
            job.run(buffer, |directions, distances| mesh.meet(origin, directions, distances));
        }
    }
}

impl Job<'_> {
    #[inline(always)]
    fn run(&self, buffer: &mut DepthBuffer, meet: impl Fn(&Directions, &mut [f32; LANES])) {
        let [ahead, left, up] = self.axes;
        let columns = &self.camera.columns[self.patch.packets.clone()];
        for row in self.patch.rows.clone() {
            let upwards = self.camera.rows[row];
            let begin = row * self.camera.columns.len();
            let range = begin + self.patch.packets.start..begin + self.patch.packets.end;
            let packets = buffer.packets[range.clone()].iter_mut().zip(&mut buffer.bodies[range]);
            for ((depths, bodies), leftwards) in packets.zip(columns) {
                let mut directions = [[0.0; LANES]; 3];
                for axis in 0..3 {
                    let base = ahead[axis] + upwards * up[axis];
                    for lane in 0..LANES {
                        directions[axis][lane] = base + leftwards[lane] * left[axis];
                    }
                }
                let mut nearest = *depths;
                meet(&directions, &mut nearest);
                for lane in 0..LANES {
                    let nearer = nearest[lane] < depths[lane];
                    bodies[lane] = if nearer { self.number } else { bodies[lane] };
                }
                *depths = nearest;
            }
        }
    }
}
