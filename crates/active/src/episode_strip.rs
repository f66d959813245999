//! A strip of images of episodes: the views of an episode from left to right, with the confidence below each.

use opendr_engine::data::{Image, Pixels};
use opendr_engine::target::Action;
use opendr_engine::{Random, Result};
use opendr_vision::resize;

use crate::active::Outcome;
use crate::camera_policy::{CameraContext, CameraPolicy as _, TrainedPolicy};
use crate::episode::EPISODE_KEY;
use crate::model::ActiveModel;
use crate::observation::Observer;
use crate::scene::ActiveScene;
use crate::view_loop::ViewLoop;

/// Width and height of a view in pixels, height of the bar below it, and space around both.
const VIEW: usize = 96;
const BAR: usize = 12;
const EDGE: usize = 4;
const GREEN: [u8; 3] = [60, 170, 80];
const RED: [u8; 3] = [205, 70, 60];
const GREY: [u8; 3] = [110, 110, 110];

/// Draws the episodes with seeds from `first_seed` on, one per row. The length of the bar below a view is the probability of
/// the most likely class; it is green if that is the true class.
///
/// # Errors
/// Returns errors of the scene.
pub fn episode_strip<S: ActiveScene>(
    scene: S,
    model: &ActiveModel,
    first_seed: u64,
    rows: usize,
) -> Result<Image> {
    let columns = model.stop.moves + 1;
    let [width, height] = [columns * (VIEW + EDGE) + EDGE, rows * (VIEW + BAR + EDGE) + EDGE];
    let mut strip = vec![245; 3 * width * height];
    let mut view_loop = ViewLoop::new(scene, model.fusion, model.stop.moves, model.best_view.clone())?;
    let mut policy = TrainedPolicy::new(model.policy.clone());
    let axes = view_loop.scene().rig().axes().to_vec();
    let (mut observation, mut action) = (vec![0.0; Observer::LEN], vec![0.0; axes.len()]);
    for row in 0..rows {
        let seed = first_seed + row as u64;
        view_loop.begin(&mut Random::from_key([seed, EPISODE_KEY]))?;
        policy.begin(seed);
        for column in 0..columns {
            let (class, confidence) = view_loop.belief().best();
            let at = [EDGE + column * (VIEW + EDGE), EDGE + row * (VIEW + BAR + EDGE)];
            paste(&mut strip, width, &resize(&view_loop.scene().rig().capture()?, VIEW, VIEW)?, at);
            let colour = if class == view_loop.class() { GREEN } else { RED };
            let length = (confidence * VIEW as f32) as usize;
            fill(&mut strip, width, [at[0], at[1] + VIEW + 2], [length, BAR - 4], colour);
            if model.stop.reason(column, confidence, None).is_some() {
                break;
            }
            view_loop.observe(&mut observation);
            let pose = view_loop.pose();
            let context = CameraContext { observation: &observation, pose, axes: &axes, best: None };
            policy.choose(&context, &mut action)?;
            view_loop.step(&Action::new(&action)?)?;
        }
    }
    Image::from_rgb8(strip, width, height)
}

/// Draws the views of a run from left to right; the bars below them are grey, since the true class is unknown.
///
/// # Errors
/// Returns `InvalidInput` for images that cannot be resized.
pub fn strip_of_views(outcome: &Outcome) -> Result<Image> {
    let [width, height] = [outcome.views.len() * (VIEW + EDGE) + EDGE, VIEW + BAR + 2 * EDGE];
    let mut strip = vec![245; 3 * width * height];
    for (column, view) in outcome.views.iter().enumerate() {
        let at = [EDGE + column * (VIEW + EDGE), EDGE];
        paste(&mut strip, width, &resize(&view.image, VIEW, VIEW)?, at);
        let length = (view.confidence * VIEW as f32) as usize;
        fill(&mut strip, width, [at[0], at[1] + VIEW + 2], [length, BAR - 4], GREY);
    }
    Image::from_rgb8(strip, width, height)
}

fn paste(strip: &mut [u8], width: usize, image: &Image, [left, top]: [usize; 2]) {
    let Pixels::U8(pixels) = image.pixels() else { return };
    for (line, row) in pixels.chunks_exact(3 * image.width()).enumerate() {
        let to = 3 * ((top + line) * width + left);
        strip[to..to + row.len()].copy_from_slice(row);
    }
}

fn fill(strip: &mut [u8], width: usize, [left, top]: [usize; 2], [wide, high]: [usize; 2], colour: [u8; 3]) {
    for line in top..top + high {
        for column in left..left + wide {
            let to = 3 * (line * width + column);
            strip[to..to + 3].copy_from_slice(&colour);
        }
    }
}
