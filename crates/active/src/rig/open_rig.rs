//! Rigs by name.

use std::path::Path;

use opendr_engine::data::Image;
use opendr_engine::environment::EnvironmentSource as _;
use opendr_engine::params::ParamMap;
use opendr_engine::rig::ViewRig;
use opendr_engine::{Error, Result};
use opendr_simulation::{RegisteredSource, Registry};

use super::{PanTiltZoom, RecordedViews};
use crate::environment_rig::EnvironmentRig;

/// What a rig needs besides its name. Each option belongs to one kind of rig, and is refused by the others.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RigOptions {
    /// Parameters of the environment, for a rig in an environment.
    pub params: ParamMap,
    /// Seed of the episode, for a rig in an environment; 0 by default.
    pub seed: Option<u64>,
    /// Horizontal field of view of the whole image in rad, for a rig in a large image; 1 by default.
    pub field_of_view: Option<f64>,
}

/// Field of view by default, in rad.
const FIELD_OF_VIEW: f64 = 1.0;
/// Width and height of the images of a camera in a large image, in pixels.
const WINDOW: [usize; 2] = [224, 224];

impl RigOptions {
    /// Opens a rig by its name: an environment (`SphereView-Face-v1`), the index of recorded views (`.json`), or a large image.
    ///
    /// # Errors
    /// `NotFound` for a name that is neither an environment nor a file, `InvalidParam` for an option of another kind of rig; otherwise
    /// as [`EnvironmentRig`], [`RecordedViews::open`] and [`PanTiltZoom::new`].
    pub fn open(&self, rig: &str) -> Result<Box<dyn ViewRig>> {
        if Registry::builtin().get(rig).is_ok() {
            refuse("an environment", &[("field_of_view", self.field_of_view.is_some())])?;
            let source = RegisteredSource::new(rig, &self.params)?;
            let mut rig = EnvironmentRig::new(source.make()?)?;
            rig.begin(self.seed.unwrap_or_default())?;
            return Ok(Box::new(rig));
        }
        let path = Path::new(rig);
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
            self.refuse_of_environments("recorded views")?;
            refuse("recorded views", &[("field_of_view", self.field_of_view.is_some())])?;
            return Ok(Box::new(RecordedViews::open(path)?));
        }
        if !path.exists() {
            return Err(Error::not_found(format!(
                "no rig {rig:?}: neither an environment (see \"opendr sim list\") nor a file; give SphereView-Face-v1, an index of recorded views (.json) or an image"
            )));
        }
        self.in_image(opendr_vision::open(path)?)
    }

    /// Creates a camera that pans, tilts and zooms in a large image.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn in_image(&self, image: Image) -> Result<Box<dyn ViewRig>> {
        self.refuse_of_environments("a large image")?;
        let field = self.field_of_view.unwrap_or(FIELD_OF_VIEW);
        Ok(Box::new(PanTiltZoom::new(image, field, WINDOW)?))
    }

    fn refuse_of_environments(&self, rig: &str) -> Result<()> {
        refuse(rig, &[("seed", self.seed.is_some()), ("env_params", !self.params.is_empty())])
    }
}

fn refuse(rig: &str, options: &[(&str, bool)]) -> Result<()> {
    match options.iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => {
            Err(Error::invalid_param(format!("a rig in {rig} has no {option}; omit the option")))
        }
    }
}
