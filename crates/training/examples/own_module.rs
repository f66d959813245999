//! Trains a custom module with the loop of every learner: an autoencoder of the images in a folder.
//! `cargo run --release -p opendr-training --example own_module -- pictures runs/autoencoder`

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::tensor::{Device, Tensor, TensorData, activation::relu};
use opendr_datasets::UnlabelledImages;
use opendr_datasets::loader::{ImageBatch, ImageBatches};
use opendr_engine::{Result, learner::FitJob, model::Manifest};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective, TrainingParams, fit_network, seeded_device};
use opendr_vision::Preprocess;

const SIDE: usize = 64;
#[derive(Module, Debug)]
struct Autoencoder {
    encoder: Conv2d,
    decoder: ConvTranspose2d,
}
impl Autoencoder {
    fn forward(&self, images: Tensor<4>) -> Tensor<4> {
        self.decoder.forward(relu(self.encoder.forward(images)))
    }
}

struct Rebuild;
impl Objective for Rebuild {
    type Network = Autoencoder;
    type Collate = ImageBatches;
    fn collate(&self) -> Result<ImageBatches> {
        Ok(ImageBatches::new(Preprocess::new(SIDE, SIDE).normalise([127.5; 3], [127.5; 3])))
    }
    fn loss(&self, network: &Autoencoder, batch: &ImageBatch, device: &Device) -> Result<Loss> {
        let images = Tensor::from_data(TensorData::new(batch.values().to_vec(), batch.shape()), device);
        Ok((network.forward(images.clone()) - images).square().mean().into())
    }
    fn container(&self, network: &Autoencoder) -> Result<Container> {
        let input = Input::new("image", [1, 3, SIDE, SIDE]).open(0);
        let model = export::onnx(network, input, &["image_again"], Autoencoder::forward)?;
        Ok(Container {
            manifest: Manifest::new("autoencoder", ""),
            files: vec![("model.onnx".into(), model)],
        })
    }
}

fn main() -> Result<()> {
    let [pictures, output] = [1, 2].map(|at| std::env::args().nth(at).unwrap_or_default());
    let pictures = UnlabelledImages::open(pictures.as_ref())?;
    let log = format!("{output}/log");
    let job = FitJob { logging_path: Some(log.as_ref()), ..FitJob::new(output.as_ref()) };
    let params = TrainingParams { epochs: 20, lr: 0.01, ..TrainingParams::default() };
    let device = seeded_device(&job, &params)?;
    let encoder = Conv2dConfig::new([3, 32], [4, 4]).with_stride([4, 4]).init(&device);
    let decoder = ConvTranspose2dConfig::new([32, 3], [4, 4]).with_stride([4, 4]).init(&device);
    let network = Autoencoder { encoder, decoder };
    println!("{}", fit_network(&Rebuild, network, &params, &pictures, None, &job)?);
    Ok(())
}
