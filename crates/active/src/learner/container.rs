//! The files of a model of active perception.

use std::path::Path;

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::learner::AnyLearner;
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::params::Params as _;
use opendr_engine::rig::{ViewAxis, ViewPose, ViewSphere};
use opendr_engine::{Error, Result, ResultExt as _};
use opendr_rl::{POLICY_FILE, Policy};
use serde::{Deserialize, Serialize};

use super::{ActiveKind, ActiveParams};
use crate::best_view::BestViewEstimator;
use crate::fusion::{Belief, Fusion};
use crate::gain::GainNetwork;
use crate::model::ActiveModel;
use crate::observation::Observer;
use crate::stop::StopRule;
use crate::view_classifier::{ViewClassifier, ViewClassifierConfig};
use crate::view_network::ViewNetworkConfig;

const RECOGNISER_FILE: &str = "recogniser.bin";
const BEST_VIEW_FILE: &str = "best_view.bin";
const GAIN_FILE: &str = "gain.bin";

/// Contents of `inputs` in the manifest.
#[derive(Debug, Serialize, Deserialize)]
struct Layout {
    /// Id of the environment of the training.
    environment: String,
    axes: Vec<ViewAxis>,
    fusion: Fusion,
    stop: StopRule,
    recogniser: ViewClassifierConfig,
    best_view: Option<ViewNetworkConfig>,
}

/// A camera policy and the recogniser that it was trained with.
#[derive(Debug, Clone)]
pub struct ActiveContainer {
    /// The camera policy, with fusion, expected gain and stop rule.
    pub model: ActiveModel,
    /// The recogniser.
    pub recogniser: ViewClassifier,
    /// Id of the environment of the training.
    pub environment: String,
}

impl ActiveContainer {
    /// Reads the container of a loaded learner of active perception, with the learner's parameters as stop rule.
    ///
    /// # Errors
    /// Returns `NotFound` if no model is loaded, `InvalidParam` for another learner; otherwise as [`Self::read`].
    pub fn of(learner: &dyn AnyLearner) -> Result<Self> {
        let missing = || Error::not_found("no model is loaded; train one with fit, or load one");
        let mut container = Self::read(learner.model().ok_or_else(missing)?)?;
        container.model.stop = ActiveParams::from_map(&learner.params())?.stop();
        Ok(container)
    }

    /// Reads a container.
    ///
    /// # Errors
    /// Returns `Format` for the container of another learner or damaged files, `Integrity` for files with other checksums.
    pub fn read(model: &Model) -> Result<Self> {
        let layout: Layout = model.manifest().read_inputs("a camera policy")?;
        let axes = layout.axes.len();
        // Both check the ranges of what a file contains.
        ViewSphere::new(layout.axes.clone(), ViewPose { distance: 1.0, ..ViewPose::default() })?;
        Belief::new(layout.recogniser.classes, layout.fusion)?;
        layout.stop.check()?;
        let policy = Policy::from_bytes(&model.file(POLICY_FILE)?)?;
        if policy.action().len() != axes || policy.observation().len() != Observer::LEN {
            return Err(Error::format(format!(
                "{}: a policy from {} numbers to {} axes; {} and {axes} are needed, train the model again",
                model.path().display(),
                policy.observation().len(),
                policy.action().len(),
                Observer::LEN
            )));
        }
        let gain = GainNetwork::from_bytes(axes, &model.file(GAIN_FILE)?)?;
        let recogniser = ViewClassifier::from_bytes(layout.recogniser, &model.file(RECOGNISER_FILE)?)
            .context(|| model.path().display().to_string())?;
        let best_view = layout.best_view.map(|config| {
            BestViewEstimator::from_bytes(config, &model.file(BEST_VIEW_FILE)?)
                .context(|| model.path().display().to_string())
        });
        let model = ActiveModel {
            policy,
            best_view: best_view.transpose()?,
            fusion: layout.fusion,
            gain,
            stop: layout.stop,
            axes: layout.axes,
        };
        Ok(Self { model, recogniser, environment: layout.environment })
    }
}

/// Writes the container of a learner of kind `K`.
///
/// # Errors
/// Returns `Io` if writing fails.
pub fn write_active_model<K: ActiveKind>(
    path: &Path,
    container: &ActiveContainer,
    params: &ActiveParams,
    spec: &EnvironmentSpec,
) -> Result<()> {
    let ActiveContainer { model, recogniser, .. } = container;
    let mut manifest = Manifest::new(K::SPEC.name, spec.id.to_lowercase());
    manifest.task = Some(K::SPEC.task);
    manifest.params = params.to_map();
    manifest.write_inputs(&Layout {
        environment: spec.id.clone(),
        axes: model.axes.clone(),
        fusion: model.fusion,
        stop: model.stop,
        recogniser: recogniser.config().clone(),
        best_view: model.best_view.as_ref().map(|best_view| best_view.config().clone()),
    })?;
    manifest.lineage.source = format!("trained in {}", spec.id);
    let mut writer = ModelWriter::new(path, manifest)?;
    writer.add(POLICY_FILE, &model.policy.to_bytes()?)?;
    writer.add(RECOGNISER_FILE, &recogniser.to_bytes())?;
    if let Some(best_view) = &model.best_view {
        writer.add(BEST_VIEW_FILE, &best_view.to_bytes())?;
    }
    writer.add(GAIN_FILE, &model.gain.to_bytes())?;
    writer.finish().map(drop)
}
