//! The protocol of docs/active_perception.md: several seeds of a camera policy in one world, on the persons or instances of the
//! training, on others, and with another recogniser.
//!
//! `cargo run --release -p opendr-active --example sphere_view -- face [--model runs/face/model] [--seeds 5 | 2..5] [--timesteps 400000]
//! [--episodes 500] [--first-seed 5000000] [--strip OUT.png]`
//!
//! `--model` takes the networks of a model that `opendr fit` trained, and its camera policy as that of seed 0.

mod options;

use std::time::Instant;

use opendr_active::{
    ActiveContainer, ActiveFitParams, ActiveModel, ActiveParams, BestViewEstimator, Comparison,
    EnvironmentScene, EpisodeStrip, FreshViews, ViewClassifier, calibrated, compare, fit_view_classifier,
    fit_view_networks, train_active,
};
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::model::Model;
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result, Silent};
use opendr_kernels::Compute;
use opendr_simulation::RegisteredSource;

use options::Options;

/// Galleries of the training and of the other subjects.
const GALLERIES: [i64; 2] = [0, 1];

fn main() -> Result<()> {
    let options = Options::parse()?;
    let begun = Instant::now();
    let source = |gallery: i64| {
        RegisteredSource::new(
            options.subject.id(),
            &ParamMap::from_iter([("gallery".to_owned(), gallery.into())]),
        )
    };
    let [known, others] = [source(GALLERIES[0])?, source(GALLERIES[1])?];
    let params = ActiveFitParams {
        total_timesteps: options.timesteps,
        view_episodes: options.view_episodes,
        ..ActiveFitParams::default()
    };
    let other = ActiveFitParams { kernels: 12, hidden: 64, epochs: 6, seed: 9, ..params.clone() };
    let (recogniser, best_view, trained) = match &options.model {
        Some(path) => read_model(path, options.subject.id())?,
        None => {
            let (recogniser, best_view) = fit_networks(&known, &params)?;
            (recogniser, Some(best_view), None)
        }
    };
    // Persons of another gallery are other classes, whose recogniser is trained on their views; instances of objects and poses
    // are recognised by the same recogniser.
    let enrolled = match options.subject {
        opendr_simulation::sphere_view::Subject::Face => fit_recogniser(&others, &params)?,
        _ => recogniser.clone(),
    };
    let swapped = fit_recogniser(&known, &other)?;
    for seed in options.seeds.clone() {
        let training = ActiveFitParams { seed, ..params.clone() }.active_training(&ActiveParams::default());
        let part = Instant::now();
        let scene = || EnvironmentScene::new(&known, recogniser.clone());
        let model = match (&trained, seed) {
            (Some(model), 0) => model.clone(),
            _ => train_active(&scene, best_view.clone(), &training, &Silent, &mut |_, _| ())?,
        };
        eprintln!("seed {seed}: {:?} after {:.0} s", model.fusion, part.elapsed().as_secs_f64());
        let run = |name: &str, comparison: Comparison| println!("seed {seed}, {name}\n\n{comparison}");
        let evaluate =
            |scene, model: &_| compare(scene, model, options.first_seed, options.episodes, &Silent);
        run("subjects of the training", evaluate(scene()?, &model)?);
        let scene = || EnvironmentScene::new(&others, enrolled.clone());
        run("other subjects", evaluate(scene()?, &model)?);
        if let (Some(path), 0) = (&options.strip, seed) {
            EpisodeStrip::run(scene()?, &model, options.first_seed, 6)?.save(path.as_ref())?;
        }
        let scene = || EnvironmentScene::new(&known, swapped.clone());
        let model = calibrated(&model, &scene, training.calibration_episodes, &Silent)?;
        run("another recogniser", evaluate(scene()?, &model)?);
    }
    println!("{:.0} s in all", begun.elapsed().as_secs_f64());
    Ok(())
}

/// Recogniser, estimator of the best view and camera policy of a model.
fn read_model(
    path: &str,
    environment: &str,
) -> Result<(ViewClassifier, Option<BestViewEstimator>, Option<ActiveModel>)> {
    let container = ActiveContainer::read(&Model::open(path)?)?;
    if container.environment != environment {
        return Err(Error::invalid_param(format!(
            "{path} was trained in {}; give a model of {environment}",
            container.environment
        )));
    }
    Ok((container.recogniser, container.model.best_view.clone(), Some(container.model)))
}

/// Views that train the networks of a source.
fn views(source: &dyn EnvironmentSource, params: &ActiveFitParams) -> Result<FreshViews> {
    FreshViews::of(source, params.num_workers, params.seed, params.view_episodes)
}

fn fit_recogniser(source: &dyn EnvironmentSource, params: &ActiveFitParams) -> Result<ViewClassifier> {
    let begun = Instant::now();
    let compute = Compute::with_threads(params.num_workers as usize);
    fit_view_classifier(
        &mut views(source, params)?,
        &params.view_training(),
        (&compute, &Silent),
        &mut |epoch, loss| {
            eprintln!("recogniser, epoch {epoch}: loss {loss:.3}, {:.0} s", begun.elapsed().as_secs_f64());
        },
    )
}

fn fit_networks(
    source: &dyn EnvironmentSource,
    params: &ActiveFitParams,
) -> Result<(ViewClassifier, BestViewEstimator)> {
    let begun = Instant::now();
    let compute = Compute::with_threads(params.num_workers as usize);
    fit_view_networks(
        &mut views(source, params)?,
        &params.view_training(),
        (&compute, &Silent),
        &mut |epoch, losses| {
            eprintln!("networks, epoch {epoch}: losses {losses:.3?}, {:.0} s", begun.elapsed().as_secs_f64());
        },
    )
}
