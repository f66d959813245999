//! Computes the depth of a stereo pair, in metres. Inputs: left.png and right.png, rectified images of two cameras.

use opendr::learner::Handle;
use opendr::stereo_matching::{SemiGlobalMatching, SemiGlobalMatchingInputs, SemiGlobalMatchingParams};
use opendr::target::HeatmapValues;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    // Focal length in pixels, and the distance of the cameras in metres.
    let params = SemiGlobalMatchingParams { focal_length: 994.978, baseline: 0.193001, ..Default::default() };
    let mut matcher = Handle::<SemiGlobalMatching>::new(params, Device::Auto)?;
    matcher.load(opendr::download("semi_global_matching")?)?;
    let (mut left, right) = (vision::open("left.png")?, vision::open("right.png")?);
    let found = matcher.infer(SemiGlobalMatchingInputs { left: &left, right: &right })?;
    if let HeatmapValues::Scores(depths) = found.depth.values() {
        let metres: Vec<_> =
            depths.iter().copied().filter(|depth| depth.is_finite() && *depth > 0.0).collect();
        let (low, high) =
            metres.iter().fold((f32::MAX, 0f32), |(low, high), one| (low.min(*one), high.max(*one)));
        let share = 100.0 * metres.len() as f64 / depths.len() as f64;
        println!("{share:.0} % of the pixels have a depth, {low:.2} to {high:.2} m");
    }
    draw(&mut left, &found.disparity, &Style::default());
    vision::save(&left, "stereo_depth.png")
}
