//! Finds abnormal heart beats and draws all. Input: heart.txt, beats of the data set ECG5000 (UCR archive).

use opendr::data::Image;
use opendr::dataset::ExternalDataset;
use opendr::datasets::{OpenOptions, Problems};
use opendr::heart_anomaly_detection::GatedRecurrentUnit;
use opendr::learner::Handle;
use opendr::{Device, Value, datasets, vision};

pub fn main() -> opendr::Result<()> {
    let mut recogniser = Handle::<GatedRecurrentUnit>::new(Default::default(), Device::Auto)?;
    recogniser.load(opendr::download("gated_recurrent_unit")?)?;
    let set = ExternalDataset::new("heart.txt", "ucr");
    let beats = datasets::open(&set, &OpenOptions::default(), &Problems::strict())?;
    let (mut pixels, mut abnormal, mut right) = (vec![255; 240 * 560 * 3], 0, 0);
    for index in (0..beats.len()).step_by(10) {
        let sample = beats.get(index)?;
        let [Value::Timeseries(beat)] = &sample.data[..] else { continue };
        let Some(Value::Category(annotation)) = &sample.target else { continue };
        let found = recogniser.infer(beat)?.class;
        abnormal += found;
        // The first class of the data set is the normal beat.
        right += i64::from((found == 1) == (annotation.class > 0));
        let colour = if found == 1 { [200, 40, 40] } else { [40, 120, 160] };
        for (time, value) in beat.as_slice().iter().enumerate() {
            let row = ((120.0 - 22.0 * f64::from(*value)) as i64).clamp(0, 239) as usize;
            let at = (row * 560 + 4 * time) * 3;
            pixels[at..at + 12].copy_from_slice(&[colour; 4].concat());
        }
    }
    println!("{abnormal} of 50 beats are abnormal, {right} as annotated");
    vision::save(&Image::from_rgb8(pixels, 560, 240)?, "heart_beats.png")
}
