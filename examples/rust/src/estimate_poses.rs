//! Estimates the poses of several persons. Input: people.jpg, a photograph with persons.

use opendr::learner::Handle;
use opendr::pose_estimation::{Movenet, MovenetParams};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut estimator = Handle::<Movenet>::new(MovenetParams::default(), Device::Auto)?;
    estimator.load(opendr::download("movenet/multipose")?)?;
    let mut image = vision::open("people.jpg")?;
    let poses = estimator.infer(&image)?;
    for pose in &poses.poses {
        if let Some(nose) = pose.keypoint("nose") {
            println!("nose at {:.0}, {:.0}, score {:.2}", nose.x, nose.y, pose.confidence);
        }
    }
    draw(&mut image, &poses, &Style::default());
    vision::save(&image, "estimate_poses.png")
}
