//! `fit` of face recognition: images of persons become references, or train the network.

use std::sync::Arc;

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Error, Result, Statistics, Unit, Value};
use opendr_face_detection::face_detector::{FaceInput, largest_face};
use opendr_perception_common::embedding_network::EmbeddingInputParams;
use opendr_perception_common::exported_network::{InputColour, InputLevels};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::{TRAINABLE, network_from_base};
use opendr_training::{TrainingParams, fit_network, open_for_training, seeded_device};
use serde_json::json;

use super::gallery::Gallery;
use super::network::Network;
use super::objective::ArcFace;
use super::{FaceRecognition, FaceRecognitionParams};

opendr_engine::choices! {
    /// Use of the images of persons in `fit`.
    pub enum FaceRecognitionMode {
        /// References: `fit` stores the persons in the model and does not change the network.
        Reference = "reference",
        /// Training of a new network, or of one from a previous training; the model then contains no persons.
        Full = "full",
    }
}

/// Training parameters of [`FaceRecognition`].
#[derive(Debug, Clone, Params)]
pub struct FaceRecognitionFitParams {
    /// Use of the images.
    pub mode: FaceRecognitionMode,
    /// Whether the persons of the model are removed before (`reference`).
    #[param(default = true)]
    pub create_new: bool,
    /// Length of an embedding (`full`).
    #[param(default = 256, range = 2..=4096, alias = "embedding_size")]
    pub dimension: usize,
    /// Factor of the network's channels (`full`).
    #[param(default = 0.5, range = 0.05..=2.0)]
    pub width: f64,
    /// Margin, added to the angle between a face and its person's centre, in radians (`full`).
    #[param(default = 0.5, range = 0.0..=1.5)]
    pub margin: f64,
    /// Scale of the cosines (`full`).
    #[param(default = 32.0, range = 1.0..=1000.0)]
    pub scale: f64,
    /// Parameters of every training (`full`).
    #[param(flatten, epochs = 30, batch_size = 64, lr = 0.002, lr_schedule = opendr_training::ScheduleKind::Cosine)]
    pub training: TrainingParams,
}

/// Samples are images with the class of the person. Of several faces in an image the largest counts. With `reference`,
/// images without a face are reported and skipped. Validation data are not used: evaluate a network by its references.
impl Fit for FaceRecognition {
    type FitParams = FaceRecognitionFitParams;

    fn fit(
        base: Option<&Model>,
        params: &FaceRecognitionParams,
        fit_params: &FaceRecognitionFitParams,
        dataset: DatasetRef<'_>,
        _val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let base = base.ok_or_else(|| {
            Error::invalid_input(
                "fit needs a model to detect the faces; load one first, such as the pretrained one",
            )
        })?;
        let dataset = open_for_training::<Self>(dataset, job)?;
        match fit_params.mode {
            FaceRecognitionMode::Reference => references(base, params, fit_params, &*dataset, job),
            FaceRecognitionMode::Full => train(base, params, fit_params, &*dataset, job),
        }
    }
}

fn train(
    base: &Model,
    params: &FaceRecognitionParams,
    fit_params: &FaceRecognitionFitParams,
    dataset: &dyn DatasetIterator,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let EmbeddingInputParams { colour, levels } = params.input;
    if (colour, levels) != (InputColour::Auto, InputLevels::Auto) {
        return Err(Error::unsupported(
            "mode full trains another network than the loaded one, with an input of its own: leave out colour and levels, and begin \
             with the pretrained model",
        ));
    }
    let classes = classes_to_train(dataset, None, "classes")?.len();
    let mut manifest = base.manifest().clone();
    manifest.variant.clear();
    manifest.metrics.clear();
    manifest.classes = Classes::default();
    let input = json!({"image": {"colour": "rgb", "mean": [0, 0, 0], "std": [1, 1, 1]}});
    manifest.write_inputs(&input)?;
    let of_parts = base.manifest().files.iter().filter(|file| file.name.contains('/'));
    let parts = of_parts.map(|file| Ok((file.name.clone(), base.file(&file.name)?)));
    let finder = FaceRecognition::load(base, params.clone(), job.device)?;
    let FaceRecognitionFitParams { margin, scale, dimension, width, .. } = *fit_params;
    let objective = ArcFace {
        classes,
        margin,
        scale,
        finder: (params.input_kind == FaceInput::Frame).then(|| Arc::new(finder)),
        manifest,
        parts: parts.collect::<Result<_>>()?,
    };
    let device = seeded_device(job, &fit_params.training)?;
    let network = Network::new(classes, dimension, width, &device);
    // A network that was not trained by `fit`, such as the zoo's, is not a base.
    let own = Some(base).filter(|base| base.manifest().files.iter().any(|file| file.name == TRAINABLE));
    fit_network(&objective, network_from_base(network, own)?, &fit_params.training, dataset, None, job)
}

fn references(
    base: &Model,
    params: &FaceRecognitionParams,
    fit_params: &FaceRecognitionFitParams,
    dataset: &dyn DatasetIterator,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let learner = FaceRecognition::load(base, params.clone(), job.device)?;
    let mut gallery = match fit_params.create_new {
        true => Gallery::new(learner.gallery.dimension()),
        false => learner.gallery.clone(),
    };
    job.progress.begin("storing references", Some(dataset.len() as u64), Unit::Items);
    let with_face = take(&learner, dataset, &mut gallery, job);
    job.progress.end();
    let with_face = with_face?;
    let mut statistics = Statistics::default();
    statistics.set("persons", gallery.names().len() as f64);
    statistics.set("images", with_face as f64);
    statistics.set("without_face", (dataset.len() - with_face) as f64);
    if !job.progress.stopped() {
        write(base, &gallery, job)?;
    }
    Ok(statistics)
}

/// Adds the largest face of each image and returns the number of images with a face.
fn take(
    learner: &FaceRecognition,
    dataset: &dyn DatasetIterator,
    gallery: &mut Gallery,
    job: &FitJob<'_>,
) -> Result<usize> {
    let names = dataset.classes();
    let (mut faces, mut embedding, mut with_face) = (BoundingBoxList::default(), Vec::new(), 0);
    for index in 0..dataset.len() {
        if job.progress.stopped() {
            break;
        }
        let sample = match dataset.get(index) {
            Err(error) if job.skip_broken => {
                job.progress.note(&format!("{error}; skipped"));
                job.progress.advance(1);
                continue;
            }
            sample => sample?,
        };
        let (Some(Value::Image(image)), Some(Value::Category(category))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input(format!(
                "the sample {} is not an image with the class of a person; give a folder of images for each person",
                dataset.name(index)
            )));
        };
        learner.faces(image, &mut faces)?;
        let has_face = match largest_face(&faces) {
            Some(face) => learner.embed(image, face, &mut embedding)?,
            None => false,
        };
        if has_face {
            let numbered = format!("person {}", category.class);
            let name = category.description.as_deref();
            let name = names.name(category.class).map(AsRef::as_ref).or(name).unwrap_or(&numbered);
            if faces.boxes.len() > 1 {
                let (name, count) = (dataset.name(index), faces.boxes.len());
                job.progress.note(&format!("{name} has {count} faces; the largest is used"));
            }
            gallery.add(name, &embedding);
            with_face += 1;
        } else {
            job.progress.note(&format!("{} has no face; skipped", dataset.name(index)));
        }
        job.progress.advance(1);
    }
    check_persons(&names, gallery, job)?;
    Ok(with_face)
}

/// Checks that every person has an image with a face, unless broken samples are skipped.
fn check_persons(names: &Classes, gallery: &Gallery, job: &FitJob<'_>) -> Result<()> {
    let known = gallery.names();
    let missing: Vec<_> = names.iter().filter(|name| known.index(name).is_none()).collect();
    if job.progress.stopped() || (missing.is_empty() && !known.is_empty()) {
        return Ok(());
    }
    let text = format!("no image has a face of {}", missing.join(", "));
    if known.is_empty() || !job.skip_broken {
        return Err(Error::invalid_input(format!("{text}; give other images, or skip broken samples")));
    }
    job.progress.note(&text);
    Ok(())
}

/// Writes the model with another gallery.
fn write(base: &Model, gallery: &Gallery, job: &FitJob<'_>) -> Result<()> {
    let mut manifest = base.manifest().clone();
    manifest.classes = gallery.names();
    let mut writer = ModelWriter::new(job.model(), manifest)?;
    for file in base.manifest().files.iter().filter(|file| !Gallery::is_file(&file.name)) {
        writer.add(&file.name, &base.file(&file.name)?)?;
    }
    for (name, bytes) in gallery.to_files()? {
        writer.add(name, &bytes)?;
    }
    writer.finish().map(drop)
}
