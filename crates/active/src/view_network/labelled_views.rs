//! Views with their classes, to train a classifier on.

use opendr_engine::data::Pixels;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::rig::ViewRig as _;
use opendr_engine::target::Action;
use opendr_engine::{Error, Progress, Random, Result, ResultExt as _, Value, map_in_order};
use opendr_vision::resize;

use crate::best_view::in_camera_frame;
use crate::camera_policy::{CameraContext, CameraPolicy as _, OracleBaseline};
use crate::environment_rig::EnvironmentRig;
use crate::rgb_image::rgb_image;

/// Views with their class indices.
#[derive(Debug, Clone, Default)]
pub struct LabelledViews {
    /// Width and height of a view in pixels.
    pub side: usize,
    /// `[views, height, width, 3]` RGB bytes.
    pub pixels: Vec<u8>,
    /// Class index of each view.
    pub labels: Vec<usize>,
    /// Direction from the subject to the best camera pose in the camera's frame, of each view; empty where the environment does not
    /// state it.
    pub best: Vec<[f32; 3]>,
    /// Number of classes.
    pub classes: usize,
}

/// Motions of an episode that provides views.
const MOTIONS: usize = 6;
/// Share of the episodes whose motions are random throughout; the others move to the best pose, if the environment states it.
const RANDOM: f32 = 0.25;
/// Largest random part of a motion to the best pose.
const DEVIATION: f32 = 0.7;

impl LabelledViews {
    /// Collects the views of episodes in environments, one thread per environment, until `progress` is stopped. Seeds start at `first`.
    ///
    /// # Errors
    /// Returns errors of the environments, and `InvalidInput` for an environment that does not report the class.
    pub fn collect(
        rigs: &mut [EnvironmentRig],
        first: u64,
        episodes: u64,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let Some(rig) = rigs.first() else { return Ok(Self::default()) };
        let mut views = Self { side: rig.side(), classes: rig.classes(), ..Self::default() };
        let collect = |rig: &mut EnvironmentRig, seed: u64| -> Result<(usize, Vec<u8>, Vec<[f32; 3]>)> {
            let class = rig.begin(seed)?;
            let mut random = Random::from_key([seed, 0x71e3]);
            let explores = random.chance(RANDOM);
            let axes = rig.axes().to_vec();
            let mut pixels = rig.pixels()?.to_vec();
            let direction = |rig: &EnvironmentRig| {
                rig.best_pose()
                    .map(|best| in_camera_frame(&rig.pose(), best.direction().map(|part| part as f32)))
            };
            let mut best: Vec<_> = direction(rig).into_iter().collect();
            let mut action = vec![0.0; axes.len()];
            for _ in 0..MOTIONS {
                if let (Some(best), false) = (rig.best_pose(), explores) {
                    let context =
                        CameraContext { observation: &[], pose: rig.pose(), axes: &axes, best: Some(best) };
                    OracleBaseline.choose(&context, &mut action)?;
                    let mut moved = |axis: &mut f32| {
                        *axis = (*axis + DEVIATION * random.uniform(-1.0, 1.0)).clamp(-1.0, 1.0)
                    };
                    action.iter_mut().for_each(&mut moved);
                } else {
                    action.iter_mut().for_each(|axis| *axis = random.uniform(-1.0, 1.0));
                }
                rig.apply(&Action::new(&action)?)?;
                pixels.extend_from_slice(rig.pixels()?);
                best.extend(direction(rig));
            }
            Ok((class, pixels, best))
        };
        let seeds = (first..first + episodes).take_while(|_| !progress.stopped());
        map_in_order(rigs, seeds, collect, |collected| {
            let (class, pixels, best) = collected?;
            views.pixels.extend(pixels);
            views.best.extend(best);
            views.labels.extend([class; MOTIONS + 1]);
            Ok::<_, Error>(())
        })?;
        Ok(views)
    }

    /// Reads the images of a data set whose targets are categories, resized to `side` x `side` pixels.
    ///
    /// # Errors
    /// Returns errors of the data set, and `InvalidInput` for samples without an image or a category.
    pub fn from_dataset(dataset: &dyn DatasetIterator, side: usize, classes: usize) -> Result<Self> {
        let mut views = Self { side, classes, ..Self::default() };
        for index in 0..dataset.len() {
            let sample = dataset.get(index)?;
            let refused = |what: &str| {
                Error::invalid_input(format!(
                    "{}: {what}; give images with class indices below {classes}",
                    dataset.name(index)
                ))
            };
            let image = sample.data.iter().find_map(|value| match value {
                Value::Image(image) => Some(image),
                _ => None,
            });
            let label = match &sample.target {
                Some(Value::Category(category)) => usize::try_from(category.class).ok(),
                _ => None,
            };
            let label = label
                .filter(|label| *label < classes)
                .ok_or_else(|| refused("no class of the environment"))?;
            let image =
                rgb_image(image.ok_or_else(|| refused("no image"))?).context(|| dataset.name(index))?;
            let Pixels::U8(pixels) = resize(&image, side, side)?.into_pixels() else {
                return Err(Error::internal("an image of bytes that was resized to other samples"));
            };
            views.pixels.extend_from_slice(&pixels);
            views.labels.push(label);
        }
        Ok(views)
    }

    /// Returns the number of views.
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Returns whether the direction to the best camera pose is known.
    pub fn has_best(&self) -> bool {
        !self.is_empty() && self.best.len() == self.len()
    }

    /// Returns whether there are no views.
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    pub(crate) fn view(&self, at: usize) -> &[u8] {
        let size = 3 * self.side * self.side;
        &self.pixels[at * size..(at + 1) * size]
    }
}
