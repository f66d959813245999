//! Recognises the action of a moving skeleton and draws its path. Input: skeleton.npy, [frames, 20 joints of Kinect, 3].

use opendr::data::Image;
use opendr::learner::Handle;
use opendr::skeleton_based_action_recognition::{SpatioTemporalGcn, SpatioTemporalGcnParams};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, Value, ValueType, datasets, vision};

pub fn main() -> opendr::Result<()> {
    let params = SpatioTemporalGcnParams::default();
    let mut recogniser = Handle::<SpatioTemporalGcn>::new(params, Device::Auto)?;
    recogniser.load(opendr::download("spatio_temporal_gcn/utd_mhad")?)?;
    let value = datasets::open_value(ValueType::SkeletonSequence, "skeleton.npy")?;
    let Value::SkeletonSequence(skeleton) = value else { return Ok(()) };
    let action = recogniser.infer(&skeleton)?;
    let name = action.description.as_deref().unwrap_or_default();
    println!("{name} {:.2}", action.confidence.unwrap_or_default());

    let [_, _, frames, joints, _] = skeleton.shape();
    let (x, y) = skeleton.as_slice().split_at(frames * joints);
    let mut pixels = vec![255; 400 * 400 * 3];
    for (at, (x, y)) in x.iter().zip(y).enumerate() {
        let shade = 230 - (230 * (at / joints) / frames) as u8;
        // Metres, y upwards; a pixel is 5 mm.
        let (column, row) = (200.0 + 200.0 * f64::from(*x), 200.0 - 200.0 * f64::from(*y));
        for pixel in 0..9 {
            let (column, row) = (column as i64 + pixel % 3 - 1, row as i64 + pixel / 3 - 1);
            if (0..400).contains(&column) && (0..400).contains(&row) {
                let at = (row * 400 + column) as usize * 3;
                pixels[at..at + 3].copy_from_slice(&[shade, shade, 255]);
            }
        }
    }
    let mut picture = Image::from_rgb8(pixels, 400, 400)?;
    draw(&mut picture, &action, &Style::default());
    vision::save(&picture, "recognise_action.png")
}
