//! Pose of a camera from points of which some are wrong.

use opendr_engine::Random;

use super::camera::PinholeCamera;
use super::p3p::p3p;
use super::pose::Pose;
use super::refine::{Sight, refine_pose};
use super::vector::unit;

/// A pose with the sights that agree.
#[derive(Debug, Default)]
pub(crate) struct Resection {
    pub pose: Pose,
    /// Whether each sight is within the threshold.
    pub agrees: Vec<bool>,
    pub inliers: usize,
}

/// Finds the pose world_from_camera with which most sights agree within `threshold` pixels, by RANSAC over three points (Fischler and
/// Bolles, 1981) and refinement. `guess` is one of the hypotheses. Returns whether a pose was found.
pub(crate) fn resect(
    camera: &PinholeCamera,
    sights: &[Sight],
    guess: Option<&Pose>,
    threshold: f64,
    random: &mut Random,
    found: &mut Resection,
) -> bool {
    const MOST: usize = 300;
    const ENOUGH: usize = 6;
    let agree =
        |pose: &Pose, limit: f64| sights.iter().filter(|sight| is_near(camera, pose, sight, limit)).count();
    let (mut best, mut most) = (None, 0);
    // A guess is a prediction, which may be some pixels off.
    if let Some(refined) = guess.and_then(|guess| {
        refine_pose(camera, *guess, sights.iter().copied(), 8.0 * threshold)
            .and_then(|pose| refine_pose(camera, pose, sights.iter().copied(), threshold))
    }) {
        (best, most) = (Some(refined), agree(&refined, threshold));
    }
    let mut poses = [Pose::IDENTITY; 4];
    let mut trial = 0;
    while trial < trials_for(most, sights.len()).min(MOST) && sights.len() >= ENOUGH {
        trial += 1;
        let chosen = [(); 3].map(|()| sights[random.below(sights.len())]);
        let rays = chosen.map(|sight| unit(camera.ray(sight.pixel)));
        let count = p3p(&chosen.map(|sight| sight.point), &rays, &mut poses);
        for pose in &poses[..count] {
            let inliers = agree(pose, threshold);
            if inliers > most {
                (best, most) = (Some(*pose), inliers);
            }
        }
    }
    let Some(mut pose) = best else { return false };
    for _ in 0..2 {
        let near = sights.iter().copied().filter(|sight| is_near(camera, &pose, sight, 2.0 * threshold));
        match refine_pose(camera, pose, near, threshold) {
            Some(refined) => pose = refined,
            None => break,
        }
    }
    found.pose = pose;
    found.agrees.clear();
    found.agrees.extend(sights.iter().map(|sight| is_near(camera, &pose, sight, threshold)));
    found.inliers = found.agrees.iter().filter(|agrees| **agrees).count();
    found.inliers >= ENOUGH
}

fn is_near(camera: &PinholeCamera, pose: &Pose, sight: &Sight, limit: f64) -> bool {
    camera.project(pose.point_in_frame(sight.point)).is_some_and(|pixel| {
        let [x, y] = [pixel[0] - sight.pixel[0], pixel[1] - sight.pixel[1]];
        x * x + y * y < limit * limit
    })
}

/// Returns how many triples are drawn until one has only right points, with a probability of 99 %.
pub(super) fn trials_for(inliers: usize, count: usize) -> usize {
    let share = inliers as f64 / count.max(1) as f64;
    let all_right = share.powi(3);
    if all_right < 1e-3 {
        return usize::MAX;
    }
    if all_right > 0.999 {
        return 1;
    }
    (0.01_f64.ln() / (1.0 - all_right).ln()).ceil() as usize
}
