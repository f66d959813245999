//! Learns to grasp each object of `PlanarGrasp-v1` from one demonstration, and measures the grasps in physics.
//!
//! ```console
//! $ cargo run --release -p opendr-manipulation --example single_demo_grasp -- [poses] [steps] [objects]
//! ```

use std::time::Instant;

use opendr_engine::Result;
use opendr_engine::learner::Learner as _;
use opendr_engine::target::PoseList;
use opendr_manipulation::{
    GraspExample, GraspTolerance, GraspTraining, SingleDemoGrasp, SingleDemoGraspParams, grasp_success,
    train_from_demonstration,
};
use opendr_simulation::planar_grasp::{GraspDemonstration, GraspObject, PlanarGraspParams};

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse().unwrap_or(0));
    let (poses, steps) = (arguments.next().unwrap_or(500), arguments.next().unwrap_or(2000));
    let objects = arguments.next().unwrap_or(5);
    let training = GraspTraining { rate: 1e-3, steps: steps as usize, batch: 16, threads: 2, seed: 0 };
    for object in GraspObject::ALL.into_iter().take(objects as usize) {
        let shown = GraspDemonstration::record(object, &PlanarGraspParams::default())?;
        let example = GraspExample::new(&shown.image, shown.jaws)?;
        let begun = Instant::now();
        let network = train_from_demonstration(&example, &training, &mut |step, loss| {
            if step % 100 == 0 {
                eprintln!("{object:?}: step {step}, loss {loss:.3}");
            }
            false
        })?;
        let (trained, bytes) = (begun.elapsed().as_secs_f64(), network.to_bytes().len());
        let learner = SingleDemoGrasp::new(network, SingleDemoGraspParams { threshold: 0.0 });
        let params = PlanarGraspParams { object: Some(object), ..PlanarGraspParams::default() };
        let mut seconds = 0.0;
        let counts = grasp_success(&params, poses, &GraspTolerance::default(), &mut |view| {
            let begun = Instant::now();
            let mut grasps = PoseList::default();
            learner.infer_into(&mut (), view.image, &mut grasps)?;
            seconds += begun.elapsed().as_secs_f64();
            Ok(grasps)
        })?;
        println!(
            "{object:?}: trained {trained:.0} s, {bytes} bytes, {:.1} ms an image; {} of {poses} succeed (within the tolerance {}, held {}), off by {:.1} mm and {:.1} degrees",
            1e3 * seconds / poses.max(1) as f64,
            counts.successes,
            counts.near,
            counts.held,
            1e3 * counts.mean_distance,
            counts.mean_angle.to_degrees()
        );
    }
    Ok(())
}
