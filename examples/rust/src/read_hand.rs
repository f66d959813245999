//! Estimates the 21 joints of a hand. Input: hand.jpg, a photograph of a hand.

use opendr::hand_pose_estimation::{HandPose, HandPoseParams};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut estimator = Handle::<HandPose>::new(HandPoseParams::default(), Device::Auto)?;
    estimator.load(opendr::download("hand_pose")?)?;
    let mut image = vision::open("hand.jpg")?;
    let hands = estimator.infer(&image)?;
    for hand in &hands.poses {
        let (wrist, tip) = (hand.keypoints[0], hand.keypoints[8]);
        print!("wrist at {:.0}, {:.0}, ", wrist.x, wrist.y);
        println!("tip of the index finger at {:.0}, {:.0}", tip.x, tip.y);
    }
    draw(&mut image, &hands, &Style::default());
    vision::save(&image, "read_hand.png")
}
