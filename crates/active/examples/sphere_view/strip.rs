//! A picture strip of episodes: the views of each from left to right, with the probability of the best class below.

use opendr_active::ActiveScene as _;
use opendr_active::sphere::SphereScene;
use opendr_active::{ActiveModel, Look, Mover as _, Observer, PolicyMover, Situation};
use opendr_engine::data::{Image, Pixels};
use opendr_engine::target::Action;
use opendr_engine::{Random, Result};
use opendr_vision::resize;

/// Pixels of a view, of the bar below it, and of the edge around both.
const VIEW: usize = 128;
const BAR: usize = 14;
const EDGE: usize = 4;
const GREEN: [u8; 3] = [60, 170, 80];
const RED: [u8; 3] = [205, 70, 60];

/// Writes episodes, one a row, as a PNG. The bar below a view is as long as the best class is probable, green where that is the true
/// class.
pub fn write(scene: &SphereScene, model: &ActiveModel, first: u64, rows: usize, path: &str) -> Result<()> {
    let columns = model.stop.moves + 1;
    let [width, height] = [columns * (VIEW + EDGE) + EDGE, rows * (VIEW + BAR + EDGE) + EDGE];
    let mut sheet = vec![245; 3 * width * height];
    let mut look = Look::new(scene.clone(), model.fusion, model.stop.moves)?;
    let mut mover = PolicyMover::new(model.policy.clone());
    let axes = look.scene().rig().axes().to_vec();
    let (mut observation, mut action) = (vec![0.0; Observer::LEN], vec![0.0; axes.len()]);
    for row in 0..rows {
        look.begin(&mut Random::from_key([first + row as u64, 0xe415]))?;
        mover.begin(first);
        for column in 0..columns {
            let (class, confidence) = look.belief().best();
            let at = [EDGE + column * (VIEW + EDGE), EDGE + row * (VIEW + BAR + EDGE)];
            paste(&mut sheet, width, &resize(look.scene().image(), VIEW, VIEW)?, at);
            let colour = if class == look.class() { GREEN } else { RED };
            let long = (confidence * VIEW as f32) as usize;
            fill(&mut sheet, width, [at[0], at[1] + VIEW + 2], [long, BAR - 4], colour);
            if model.stop.reason(column, confidence, None).is_some() {
                break;
            }
            look.observe(&mut observation);
            let situation =
                Situation { observation: &observation, pose: look.pose(), axes: &axes, best: None };
            mover.choose(&situation, &mut action)?;
            look.step(&Action::new(&action)?)?;
        }
    }
    opendr_vision::save(&Image::from_rgb8(sheet, width, height)?, path)
}

fn paste(sheet: &mut [u8], width: usize, image: &Image, [left, top]: [usize; 2]) {
    let Pixels::U8(pixels) = image.pixels() else { return };
    for (line, row) in pixels.chunks_exact(3 * image.width()).enumerate() {
        let to = 3 * ((top + line) * width + left);
        sheet[to..to + row.len()].copy_from_slice(row);
    }
}

fn fill(sheet: &mut [u8], width: usize, [left, top]: [usize; 2], [wide, high]: [usize; 2], colour: [u8; 3]) {
    for line in top..top + high {
        for column in left..left + wide {
            let to = 3 * (line * width + column);
            sheet[to..to + 3].copy_from_slice(&colour);
        }
    }
}
