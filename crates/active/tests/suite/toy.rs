//! A scene without rendering: four classes that can be distinguished from one side only, and images that show which side
//! that is.

use opendr_active::{ActiveScene, ViewRecogniser};
use opendr_engine::data::Image;
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr_engine::target::Action;
use opendr_engine::{Random, Result};

pub const CLASSES: usize = 4;
const SIDE: usize = 12;

/// A rig whose images are bright to the left where the front is to the left.
pub struct ToyRig {
    sphere: ViewSphere,
    front: f64,
    class: usize,
}

impl ToyRig {
    pub fn new(front: f64, class: usize) -> Self {
        let axes = vec![ViewAxis::turning("azimuth", 0.6)];
        let sphere = ViewSphere::new(axes, ViewPose { distance: 1.0, ..ViewPose::default() }).unwrap();
        Self { sphere, front, class }
    }

    fn off(&self) -> f64 {
        let turn = std::f64::consts::TAU;
        let off = self.front - self.sphere.pose().azimuth;
        off - turn * (off / turn).round()
    }
}

impl ViewRig for ToyRig {
    fn axes(&self) -> &[ViewAxis] {
        self.sphere.axes()
    }

    fn pose(&self) -> ViewPose {
        self.sphere.pose()
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        self.sphere.apply(action)
    }

    fn capture(&mut self) -> Result<Image> {
        let off = self.off();
        let level = |left: bool| if left == (off > 0.0) { (40.0 + 60.0 * off.abs()) as u8 } else { 0 };
        // Two pixels have the class and whether it is visible, for the recogniser below.
        let mut pixels: Vec<u8> = (0..SIDE * SIDE).flat_map(|at| [level(at % SIDE < SIDE / 2); 3]).collect();
        pixels[0] = self.class as u8;
        pixels[1] = if off.abs() < 0.5 { 200 } else { 100 };
        Image::from_rgb8(pixels, SIDE, SIDE)
    }
}

/// Reads the two pixels: certain from the front, even from elsewhere.
#[derive(Clone, Copy)]
pub struct ToyRecogniser;

impl ViewRecogniser for ToyRecogniser {
    fn classes(&self) -> usize {
        CLASSES
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        let opendr_engine::data::Pixels::U8(pixels) = image.pixels() else { return Ok(()) };
        evidence.fill(0.0);
        if pixels[1] == 200 {
            evidence[usize::from(pixels[0])] = 4.0;
        }
        Ok(())
    }
}

pub struct ToyScene {
    rig: ToyRig,
    image: Image,
}

impl ToyScene {
    pub fn new() -> Self {
        let mut rig = ToyRig::new(0.0, 0);
        Self { image: rig.capture().unwrap(), rig }
    }
}

impl ActiveScene for ToyScene {
    fn classes(&self) -> usize {
        CLASSES
    }

    fn begin(&mut self, random: &mut Random) -> Result<usize> {
        let class = random.below(CLASSES);
        self.rig = ToyRig::new(f64::from(random.uniform(-2.4, 2.4)), class);
        Ok(class)
    }

    fn rig(&mut self) -> &mut dyn ViewRig {
        &mut self.rig
    }

    fn view(&mut self, evidence: &mut [f32]) -> Result<&Image> {
        self.image = self.rig.capture()?;
        ToyRecogniser.recognise(&self.image, evidence)?;
        Ok(&self.image)
    }

    fn best_pose(&self) -> Option<ViewPose> {
        Some(ViewPose { azimuth: self.rig.front, distance: 1.0, ..ViewPose::default() })
    }
}
