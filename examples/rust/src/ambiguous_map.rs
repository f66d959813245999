//! Measures whether the best place on a map is ambiguous, for instance where to push an object. The map is computed here.

use opendr::ambiguity_measure::{AmbiguityMeasure, AmbiguityMeasureParams};
use opendr::data::Image;
use opendr::learner::Handle;
use opendr::target::{Heatmap, HeatmapValues};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let params = AmbiguityMeasureParams { threshold: 0.4, ..AmbiguityMeasureParams::default() };
    let mut measure = Handle::<AmbiguityMeasure>::new(params, Device::Auto)?;
    measure.load(opendr::download("ambiguity_measure")?)?;
    let mut picture = Image::from_rgb8(vec![0; 120 * 160 * 3], 160, 120)?;
    for height in [4f32, 8.9] {
        // A peak of 9 at the left, and a second one at the right.
        let value = |at: i32| {
            let (row, column) = ((at / 160) as f32, (at % 160) as f32);
            let left = 9.0 / (1.0 + ((column - 40.0).powi(2) + (row - 60.0).powi(2)) / 200.0);
            left + height / (1.0 + ((column - 120.0).powi(2) + (row - 50.0).powi(2)) / 200.0)
        };
        let places = Heatmap::from_scores((0..120 * 160).map(value).collect(), &[120, 160])?;
        let found = measure.infer(&places)?;
        let name = found.category.description.as_deref().unwrap_or_default();
        // The last of four columns: row, column, height, probability.
        if let HeatmapValues::Scores(peaks) = found.peaks.values() {
            println!("second peak {height:.1}: {name}, best peak with probability {:.2}", peaks[3]);
        }
        picture = Image::from_rgb8(vec![0; 120 * 160 * 3], 160, 120)?;
        draw(&mut picture, &places, &Style::default());
    }
    vision::save(&picture, "ambiguous_map.png")
}
