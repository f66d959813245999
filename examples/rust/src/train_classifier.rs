//! Trains an image classifier on folders of images, here of drawn shapes, and draws its learning curve. Feature: `training`.

use opendr::data::{Image, Layout, PixelFormat};
use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::params::ParamMap;
use opendr::{Device, FitOptions, Silent, vision};

pub fn main() -> opendr::Result<()> {
    // A folder for each class; the last 60 of 240 images are not trained on.
    for number in 0..240 {
        let (kind, folder) = (["disc", "square"][number % 2], if number < 180 { "train" } else { "val" });
        let (size, grey) = (5 + number / 2 % 5, (80 + number * 13 % 170) as u8);
        let pixel = |at: usize| {
            let [y, x] = [(at / 32, 5), (at % 32, 7)].map(|(at, by)| at.abs_diff(10 + number * by % 12));
            let inside = if kind == "disc" { x * x + y * y < size * size } else { x.max(y) < size };
            if inside { grey } else { 20 }
        };
        std::fs::create_dir_all(format!("train_classifier/{folder}/{kind}"))?;
        let pixels: Vec<u8> = (0..32 * 32).map(pixel).collect();
        let image = Image::new(pixels, 32, 32, PixelFormat::Grey, Layout::Chw)?;
        vision::save(&image, format!("train_classifier/{folder}/{kind}/{number}.png"))?;
    }

    let entry = opendr::registry().find("image_classifier")?;
    let mut learner = entry.make(&ParamMap::new(), Device::Auto)?;
    let params = [("epochs", 12), ("batch_size", 16), ("side", 32), ("width", 16)];
    let params = params.map(|(name, value)| (name.to_owned(), i64::into(value))).into();
    let out = Some("train_classifier/run".into());
    let options = FitOptions { params, out, val_split: Some("val".to_owned()), ..FitOptions::default() };
    let set = ExternalDataset::new("train_classifier", "imagenet");
    let fitted = opendr::fit(learner.as_mut(), entry, DatasetRef::External(&set).into(), &options, &Silent)?;
    let accuracies = &fitted.statistics.curves["val_accuracy"];
    accuracies.iter().for_each(|accuracy| println!("accuracy {accuracy:.2}"));
    let width = 40 * accuracies.len();
    let pixels = (0..200 * width).flat_map(|at| match (at / width, at % width, at % width % 40) {
        (row, column, 5..35) if row >= 200 - (accuracies[column / 40] * 199.0) as usize => [40, 120, 160],
        _ => [255; 3],
    });
    vision::save(&Image::from_rgb8(pixels.collect(), width, 200)?, "train_classifier.png")
}
