//! `fit`: pictures of persons become references, or the network learns from them.

use std::sync::Arc;

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Error, Result, Statistics, Unit, Value};
use opendr_face_detection::face_finder::{FaceInput, largest};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::{TRAINABLE, network_from_base};
use opendr_training::{TrainingParams, begin, fit_network, open_for_training};

use super::gallery::Gallery;
use super::network::Network;
use super::objective::ArcFace;
use super::{FaceRecognition, FaceRecognitionParams};

opendr_engine::choices! {
    /// What a training makes of pictures of persons.
    pub enum FaceRecognitionMode {
        /// References: the persons are known from then on; the network stays as it is.
        Reference = "reference",
        /// A new network, or a better one where it was trained here; its persons are not known from then on.
        Full = "full",
    }
}

/// How references are taken, or the network is trained.
#[derive(Debug, Clone, Params)]
pub struct FaceRecognitionFitParams {
    /// What is made of the pictures.
    pub mode: FaceRecognitionMode,
    /// Whether the model forgets the persons that it knows (`reference`).
    #[param(default = true)]
    pub create_new: bool,
    /// Numbers of an embedding (`full`).
    #[param(default = 256, range = 2..=4096, alias = "embedding_size")]
    pub dimension: usize,
    /// Factor on the network's channels (`full`).
    #[param(default = 0.5, range = 0.05..=2.0)]
    pub width: f64,
    /// Added to the angle between a face and the centre of its person's, radians (`full`).
    #[param(default = 0.5, range = 0.0..=1.5)]
    pub margin: f64,
    /// What cosines are multiplied with (`full`).
    #[param(default = 32.0, range = 1.0..=1000.0)]
    pub scale: f64,
    /// What every training has (`full`).
    #[param(flatten, epochs = 30, batch_size = 64, lr = 0.002, lr_schedule = opendr_training::ScheduleKind::Cosine)]
    pub training: TrainingParams,
}

/// Pictures with the class of the person that each shows. Of several faces in a picture the largest counts; as
/// references, pictures without one are told and left out. Validation data play no part: measure a network by its
/// references.
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
                "a model finds the faces in the pictures: load one first (the pretrained one will do)",
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
    let classes = classes_to_train(dataset, None, "classes")?.len();
    let mut manifest = base.manifest().clone();
    manifest.variant.clear();
    manifest.metrics.clear();
    manifest.classes = Classes::default();
    let of_parts = base.manifest().files.iter().filter(|file| file.name.contains('/'));
    let parts = of_parts.map(|file| Ok((file.name.clone(), base.file(&file.name)?)));
    let finder = FaceRecognition::load(base, params.clone(), job.device)?;
    let FaceRecognitionFitParams { margin, scale, dimension, width, .. } = *fit_params;
    let objective = ArcFace {
        classes,
        margin,
        scale,
        finder: (params.picture == FaceInput::Frame).then(|| Arc::new(finder)),
        manifest,
        parts: parts.collect::<Result<_>>()?,
    };
    let device = begin(job, &fit_params.training)?;
    let network = Network::new(classes, dimension, width, &device);
    // The zoo's network is no such one.
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
    job.progress.begin("taking references", Some(dataset.len() as u64), Unit::Items);
    let taken = take(&learner, dataset, &mut gallery, job);
    job.progress.end();
    let taken = taken?;
    let mut statistics = Statistics::default();
    statistics.set("persons", gallery.names().len() as f64);
    statistics.set("pictures", taken as f64);
    statistics.set("without_face", (dataset.len() - taken) as f64);
    if !job.progress.stopped() {
        write(base, &gallery, job)?;
    }
    Ok(statistics)
}

/// Adds the largest face of each picture; how many had one.
fn take(
    learner: &FaceRecognition,
    dataset: &dyn DatasetIterator,
    gallery: &mut Gallery,
    job: &FitJob<'_>,
) -> Result<usize> {
    let names = dataset.classes();
    let (mut faces, mut embedding, mut taken) = (BoundingBoxList::default(), Vec::new(), 0);
    for index in 0..dataset.len() {
        if job.progress.stopped() {
            break;
        }
        let sample = match dataset.get(index) {
            Err(error) if job.skip_broken => {
                job.progress.note(&format!("{error}: left out"));
                job.progress.advance(1);
                continue;
            }
            sample => sample?,
        };
        let (Some(Value::Image(image)), Some(Value::Category(category))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input(format!(
                "the sample {} is no picture with the class of a person; give a folder of pictures for each person",
                dataset.name(index)
            )));
        };
        learner.faces(image, &mut faces)?;
        let has_face = match largest(&faces) {
            Some(face) => learner.embed(image, face, &mut embedding)?,
            None => false,
        };
        if has_face {
            let numbered = format!("person {}", category.class);
            let name = category.description.as_deref();
            let name = names.name(category.class).map(AsRef::as_ref).or(name).unwrap_or(&numbered);
            if faces.boxes.len() > 1 {
                let (name, count) = (dataset.name(index), faces.boxes.len());
                job.progress.note(&format!("{name} shows {count} faces: the largest is taken"));
            }
            gallery.add(name, &embedding);
            taken += 1;
        } else {
            job.progress.note(&format!("{} shows no face: left out", dataset.name(index)));
        }
        job.progress.advance(1);
    }
    check_persons(&names, gallery, job)?;
    Ok(taken)
}

/// That everybody has a picture, or the user wants to go on without.
fn check_persons(names: &Classes, gallery: &Gallery, job: &FitJob<'_>) -> Result<()> {
    let known = gallery.names();
    let missing: Vec<_> = names.iter().filter(|name| known.index(name).is_none()).collect();
    if job.progress.stopped() || (missing.is_empty() && !known.is_empty()) {
        return Ok(());
    }
    let text = format!("no picture shows a face of {}", missing.join(", "));
    if known.is_empty() || !job.skip_broken {
        return Err(Error::invalid_input(format!("{text}: give others, or leave broken samples out")));
    }
    job.progress.note(&text);
    Ok(())
}

/// The model with another gallery.
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
