//! Points from two views.

use super::pose::Pose;
use super::vector::{Vector, along, dot, length, minus, plus, scaled, unit};

/// Returns the point nearest to both rays, in the world, with the cosine of the angle between them: the middle of their shortest
/// connection. `None` for parallel rays and for a point behind a camera.
pub(crate) fn triangulate(views: [(&Pose, Vector); 2]) -> Option<(Vector, f64)> {
    let [(first, a), (second, b)] = views;
    let rotated = |pose: &Pose, ray: Vector| unit(minus(pose.point(ray), pose.position));
    let (a, b) = (rotated(first, a), rotated(second, b));
    let aside = minus(second.position, first.position);
    let cosine = dot(a, b);
    let below = 1.0 - cosine * cosine;
    if below < 1e-10 {
        return None;
    }
    let (along_a, along_b) = (dot(aside, a), dot(aside, b));
    let far_a = (along_a - cosine * along_b) / below;
    let far_b = (cosine * along_a - along_b) / below;
    if far_a <= 0.0 || far_b <= 0.0 {
        return None;
    }
    let [one, other] = [along(first.position, a, far_a), along(second.position, b, far_b)];
    let point = scaled(plus(one, other), 0.5);
    length(point).is_finite().then_some((point, cosine))
}
