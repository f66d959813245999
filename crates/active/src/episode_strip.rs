//! A strip of images of episodes: the views of an episode from left to right, with the confidence below each.

use std::path::Path;

use opendr_engine::data::{Image, Pixels};
use opendr_engine::target::Action;
use opendr_engine::{Random, Result};
use opendr_simulation::Recording;
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
/// Views per second of a video, and for how many views its end is shown.
const RATE: f64 = 1.5;
const END: usize = 3;

/// The views of episodes, one episode per row.
///
/// The length of the bar below a view is the probability of the most likely class. The bar is green if that is the true class, red if it
/// is not, and grey where the true class is unknown.
#[derive(Debug, Clone)]
pub struct EpisodeStrip {
    rows: Vec<Vec<Cell>>,
}

/// A view with its bar.
#[derive(Debug, Clone)]
struct Cell {
    image: Image,
    confidence: f32,
    colour: [u8; 3],
}

impl EpisodeStrip {
    /// Runs the episodes with seeds from `first_seed` on.
    ///
    /// # Errors
    /// Returns errors of the scene.
    pub fn run<S: ActiveScene>(scene: S, model: &ActiveModel, first_seed: u64, rows: usize) -> Result<Self> {
        let mut view_loop = ViewLoop::new(scene, model.fusion, model.stop.moves, model.best_view.clone())?;
        let mut policy = TrainedPolicy::new(model.policy.clone());
        let axes = view_loop.scene().rig().axes().to_vec();
        let (mut observation, mut action) = (vec![0.0; Observer::LEN], vec![0.0; axes.len()]);
        let mut episode = |row: usize| -> Result<Vec<Cell>> {
            let seed = first_seed + row as u64;
            view_loop.begin(&mut Random::from_key([seed, EPISODE_KEY]))?;
            policy.begin(seed);
            let mut cells = Vec::new();
            loop {
                let (class, confidence) = view_loop.belief().best();
                let image = resize(&view_loop.scene().rig().capture()?, VIEW, VIEW)?;
                let colour = if class == view_loop.class() { GREEN } else { RED };
                cells.push(Cell { image, confidence, colour });
                if model.stop.reason(cells.len() - 1, confidence, None).is_some() {
                    return Ok(cells);
                }
                view_loop.observe(&mut observation);
                let pose = view_loop.pose();
                let context = CameraContext { observation: &observation, pose, axes: &axes, best: None };
                policy.choose(&context, &mut action)?;
                view_loop.step(&Action::new(&action)?)?;
            }
        };
        Ok(Self { rows: (0..rows).map(&mut episode).collect::<Result<_>>()? })
    }

    /// Creates the strip of a run.
    ///
    /// # Errors
    /// Returns `InvalidInput` for images that cannot be resized.
    pub fn of(outcome: &Outcome) -> Result<Self> {
        let cell = |view: &crate::active::View| {
            let image = resize(&view.image, VIEW, VIEW)?;
            Ok(Cell { image, confidence: view.confidence, colour: GREY })
        };
        Ok(Self { rows: vec![outcome.views.iter().map(cell).collect::<Result<_>>()?] })
    }

    /// Draws all views.
    ///
    /// # Errors
    /// Returns `InvalidInput` without a row.
    pub fn image(&self) -> Result<Image> {
        self.first_views(usize::MAX)
    }

    /// Saves a video that shows view after view for `.gif`, `.mp4`, `.mov` and `.mkv`, else an image of all views.
    ///
    /// # Errors
    /// Returns errors of [`Recording`] and of [`opendr_vision::save`].
    pub fn save(&self, path: &Path) -> Result<()> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if !["gif", "mp4", "mov", "mkv"].contains(&extension.to_ascii_lowercase().as_str()) {
            return opendr_vision::save(&self.image()?, path);
        }
        let mut video = Recording::create(path, RATE)?;
        let views = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        for shown in 1..views + END {
            video.write(&self.first_views(shown)?)?;
        }
        video.finish()
    }

    /// Draws the first `count` views of each episode.
    fn first_views(&self, count: usize) -> Result<Image> {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let row_height = VIEW + BAR + EDGE;
        let [width, height] = [columns * (VIEW + EDGE) + EDGE, self.rows.len() * row_height + EDGE];
        let mut strip = vec![245; 3 * width * height];
        for (row, cells) in self.rows.iter().enumerate() {
            for (column, Cell { image, confidence, colour }) in cells.iter().take(count).enumerate() {
                let at = [EDGE + column * (VIEW + EDGE), EDGE + row * row_height];
                paste(&mut strip, width, image, at);
                let length = (confidence * VIEW as f32) as usize;
                fill(&mut strip, width, [at[0], at[1] + VIEW + 2], [length, BAR - 4], *colour);
            }
        }
        Image::from_rgb8(strip, width, height)
    }
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
