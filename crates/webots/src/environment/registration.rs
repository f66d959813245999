//! The environment by name.

use std::time::Duration;

use opendr_engine::environment::Environment as _;
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};
use opendr_simulation::Registration;
use opendr_simulation::wrappers::{Checked, TimeLimit};

use super::options::{ID, LinkKind, WebotsParams};
use super::robot_environment::WebotsEnvironment;
use crate::link::WebotsLink;
use crate::native::NativeLink;
use crate::url::ControllerUrl;
use crate::version::Version;

/// Returns the entry of the registry: it connects to Webots when it creates an environment.
pub fn registration() -> Registration {
    Registration::new(ID, WebotsParams::FIELDS, |params| {
        let params = WebotsParams::from_map(params)?;
        let environment = WebotsEnvironment::new(connect(&params)?, &params)?;
        match environment.spec().max_episode_steps {
            Some(limit) => Ok(Box::new(Checked::new(TimeLimit::new(environment, limit)?))),
            None => Ok(Box::new(Checked::new(environment))),
        }
    })
}

fn connect(params: &WebotsParams) -> Result<Box<dyn WebotsLink>> {
    let set = std::env::var("WEBOTS_CONTROLLER_URL").unwrap_or_default();
    if params.link == LinkKind::Library {
        return library(params, &set);
    }
    let url = if params.url.is_empty() { &set } else { &params.url };
    if url.is_empty() {
        return Err(Error::invalid_param(
            "no address of a robot; set url, such as url=tcp://localhost:1234/ROBOT, or WEBOTS_CONTROLLER_URL",
        ));
    }
    let url = ControllerUrl::parse(url)?;
    let version = Some(params.version.as_str()).filter(|version| !version.is_empty());
    let timeout = (params.timeout > 0.0).then(|| Duration::from_secs_f64(params.timeout));
    Ok(Box::new(NativeLink::connect(&url, version.map(Version::parse).transpose()?, timeout)?))
}

#[cfg(feature = "webots-library")]
fn library(params: &WebotsParams, set: &str) -> Result<Box<dyn WebotsLink>> {
    if !params.url.is_empty() && params.url != set {
        return Err(Error::invalid_param(format!(
            "libController takes the address from WEBOTS_CONTROLLER_URL ({set:?}); set that to {:?}, and no url",
            params.url
        )));
    }
    let library = crate::library::LibraryLink::installed()?;
    Ok(Box::new(crate::library::LibraryLink::connect(&library)?))
}

#[cfg(not(feature = "webots-library"))]
fn library(_: &WebotsParams, _: &str) -> Result<Box<dyn WebotsLink>> {
    Err(Error::unsupported(
        "this build has no link by libController; build it with the feature webots-library",
    ))
}
