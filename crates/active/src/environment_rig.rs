//! An environment of active perception as a rig.

use opendr_engine::data::Image;
use opendr_engine::environment::{Environment, ResetOptions, Space};
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr_engine::target::{Action, ActionBase as _};
use opendr_engine::{Error, Result};

/// A rig that moves in an environment.
///
/// The environment's observation is a dictionary with `image` (height, width, 3; levels of 0 to 255) and `pose` (azimuth,
/// elevation, distance, then the number of motions). Its action is a deflection of each axis followed by a score of each class,
/// and full deflection moves by the steps of [`ViewSphere::camera`]. The info of a reset has `class` and, for
/// [`OracleBaseline`](crate::OracleBaseline), `best_azimuth` and `best_elevation`. `SphereView-Face-v1` is one.
pub struct EnvironmentRig {
    environment: Box<dyn Environment>,
    layout: Layout,
    sphere: ViewSphere,
    observation: Vec<f32>,
    action: Vec<f32>,
    image: Image,
    best: Option<ViewPose>,
}

/// Positions of the parts in an observation.
#[derive(Debug, Clone, Copy)]
struct Layout {
    image: usize,
    side: [usize; 2],
    pose: usize,
}

/// Number of axes.
const AXES: usize = 3;

impl EnvironmentRig {
    /// Creates the rig of an environment.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an environment with other spaces.
    pub fn new(environment: Box<dyn Environment>) -> Result<Self> {
        let spec = environment.spec();
        let refused = || {
            Error::invalid_input(format!(
                "{} is no environment of active perception: its observation needs \"image\" (height, width, 3) and \"pose\" (4 numbers), its action 3 axes and at least 2 scores; use SphereView-Face-v1",
                spec.id
            ))
        };
        let (layout, limits) = layout(&spec.observation).ok_or_else(refused)?;
        if spec.action.len() < AXES + 2 {
            return Err(refused());
        }
        let [height, width] = layout.side;
        let mut axes = ViewSphere::camera(ViewPose { distance: 3.0, ..ViewPose::default() })?.axes().to_vec();
        for (axis, (low, high)) in axes.iter_mut().zip(limits).skip(1) {
            (axis.low, axis.high) = (low, high);
        }
        let (observation, action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
        Ok(Self {
            sphere: ViewSphere::new(axes, ViewPose { distance: 3.0, ..ViewPose::default() })?,
            image: Image::from_rgb8(vec![0; 3 * width * height], width, height)?,
            environment,
            layout,
            observation,
            action,
            best: None,
        })
    }

    /// Starts the episode of a seed and returns the class of its subject.
    ///
    /// # Errors
    /// Returns errors of the environment, and `InvalidInput` if it does not report the class.
    pub fn begin(&mut self, seed: u64) -> Result<usize> {
        let info = self.environment.reset(Some(seed), &ResetOptions::new(), &mut self.observation)?;
        self.receive()?;
        let class = info.get("class").filter(|class| (0.0..self.classes() as f64).contains(class));
        let nearest = self.sphere.axes().get(2).map_or(0.0, |axis| axis.low);
        let best = info.get("best_azimuth").zip(info.get("best_elevation"));
        self.best =
            best.map(|(azimuth, elevation)| ViewPose { azimuth, elevation, distance: nearest, fourth: 0.0 });
        class.map(|class| class as usize).ok_or_else(|| {
            Error::invalid_input(format!(
                "{} does not report the \"class\" of an episode in the info of its reset",
                self.environment.spec().id
            ))
        })
    }

    /// Returns the number of classes.
    pub fn classes(&self) -> usize {
        self.action.len() - AXES
    }

    /// Returns width and height of an image in pixels; of images that are not square the smaller one.
    pub fn side(&self) -> usize {
        self.layout.side[0].min(self.layout.side[1])
    }

    /// Returns the pose from which the subject is visible best, if the environment states it.
    pub fn best_pose(&self) -> Option<ViewPose> {
        self.best
    }

    /// Returns the last image.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Returns the pixels of the last image.
    pub(crate) fn pixels(&mut self) -> Result<&[u8]> {
        self.image.bytes_mut().map(|pixels| &*pixels).ok_or_else(not_bytes)
    }

    /// Takes image and pose from the observation.
    fn receive(&mut self) -> Result<()> {
        let Self { layout, sphere, observation, image, .. } = self;
        let pixels = image.bytes_mut().ok_or_else(not_bytes)?;
        let levels = &observation[layout.image..layout.image + pixels.len()];
        pixels.iter_mut().zip(levels).for_each(|(pixel, level)| *pixel = *level as u8);
        let pose: [f64; AXES] = std::array::from_fn(|axis| f64::from(observation[layout.pose + axis]));
        let [azimuth, elevation, distance] = pose;
        sphere.place(ViewPose { azimuth, elevation, distance, fourth: 0.0 })
    }
}

#[cold]
fn not_bytes() -> Error {
    Error::internal("the image of a rig is not of bytes")
}

/// Returns the positions of image and pose, and the limits of the axes.
fn layout(space: &Space) -> Option<(Layout, Vec<(f64, f64)>)> {
    let Space::Dict(parts) = space else { return None };
    let (mut at, mut image, mut pose) = (0, None, None);
    for (name, part) in parts {
        match (name.as_str(), part) {
            ("image", Space::Box { shape, .. }) => {
                let [height, width, 3] = shape[..] else { return None };
                image = Some((at, [height, width]));
            }
            ("pose", Space::Box { low, high, .. }) if low.len() == AXES + 1 => {
                let limits = low.iter().zip(high).map(|(low, high)| (f64::from(*low), f64::from(*high)));
                pose = Some((at, limits.take(AXES).collect()));
            }
            _ => {}
        }
        at += part.len();
    }
    let ((image, side), (pose, limits)) = (image?, pose?);
    Some((Layout { image, side, pose }, limits))
}

impl ViewRig for EnvironmentRig {
    fn axes(&self) -> &[ViewAxis] {
        self.sphere.axes()
    }

    fn pose(&self) -> ViewPose {
        self.sphere.pose()
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        let achieved = self.sphere.apply(action)?;
        self.action[..AXES].copy_from_slice(action.axes());
        self.environment.step(&self.action, &mut self.observation)?;
        self.receive()?;
        Ok(Achieved { pose: self.sphere.pose(), ..achieved })
    }

    fn capture(&mut self) -> Result<Image> {
        Ok(self.image.clone())
    }
}
