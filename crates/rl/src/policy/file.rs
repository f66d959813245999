//! The file of a policy.

use std::path::Path;

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::{Error, Result, ResultExt as _};
use opendr_runlog::write_atomically;
use opendr_simulation::wrappers::RunningMoments;
use serde::{Deserialize, Serialize};

use super::space_record::SpaceRecord;
use super::tensor_file::TensorFile;
use super::{Bounds, Head, NetworkConfig, ObservationNormaliser, Policy};

/// JSON in the metadata of the file.
#[derive(Serialize, Deserialize)]
struct Record {
    version: u32,
    observation: SpaceRecord,
    action: SpaceRecord,
    head: HeadKind,
    network: ParamMap,
    /// Clipping bound of normalised observations; none if they are not normalised.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    clip_obs: Option<f32>,
    /// Features of each choice; none if the network does not score choices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    choice_features: Option<usize>,
}

#[derive(Serialize, Deserialize, Clone, Copy)]
#[serde(rename_all = "snake_case")]
enum HeadKind {
    Stochastic,
    SquashedGaussian,
    Squashed,
    Greedy,
}

const VERSION: u32 = 1;
const KEY: &str = "opendr_policy";
/// Maximum number of hidden layers.
const MAX_LAYERS: usize = 64;
const PARAMETERS: &str = "parameters";
const MOMENTS: [&str; 3] = ["observation_mean", "observation_variance", "observation_count"];

impl Policy {
    /// Returns the bytes of the file: safetensors, with spaces and networks in the metadata.
    ///
    /// # Errors
    /// `Unsupported` for a space that cannot be stored.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let normaliser = self.encoder.normaliser.as_ref();
        let record = Record {
            version: VERSION,
            observation: SpaceRecord::of(self.observation())?,
            action: SpaceRecord::of(&self.action)?,
            head: HeadKind::of(&self.head),
            network: self.config.to_map(),
            clip_obs: normaliser.map(|normaliser| normaliser.clip),
            choice_features: self.trunk.choices().map(|choices| choices.own),
        };
        let unwritable = |error| Error::internal("the policy cannot be written as JSON").with_source(error);
        let mut file = TensorFile::default();
        file.set_metadata(KEY, serde_json::to_string(&record).map_err(unwritable)?);
        if let Some(ObservationNormaliser { moments, .. }) = normaliser {
            for (name, numbers) in
                MOMENTS.into_iter().zip([moments.mean(), moments.variance(), &[moments.count()]])
            {
                file.add_f64(name, numbers);
            }
        }
        file.add_f32(PARAMETERS, &self.parameters);
        file.to_bytes()
    }

    /// Reads the policy from the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// `Format` for a damaged or other file, `Unsupported` for a newer version.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        read(bytes).context(|| "reading a policy")
    }

    /// Writes the file of a policy; an existing file is replaced atomically.
    ///
    /// # Errors
    /// As [`Self::to_bytes`], and `Io`.
    pub fn save(&self, path: &Path) -> Result<()> {
        write_atomically(path, &self.to_bytes()?)
    }

    /// Reads the file of a policy.
    ///
    /// # Errors
    /// As [`Self::from_bytes`], `NotFound` and `Io`.
    pub fn load(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).context(|| path.display().to_string())?;
        Self::from_bytes(&bytes).context(|| path.display().to_string())
    }
}

fn read(bytes: &[u8]) -> Result<Policy> {
    let file = TensorFile::from_bytes(bytes)?;
    let wrong = |error| Error::format("the header is not that of a policy").with_source(error);
    let record = file
        .metadata(KEY)
        .ok_or_else(|| Error::format("the safetensors file contains no policy of OpenDR"))?;
    let record: Record = serde_json::from_str(record).map_err(wrong)?;
    if record.version != VERSION {
        return Err(Error::unsupported(format!(
            "the file has version {}, this OpenDR reads version {VERSION}; update OpenDR",
            record.version
        )));
    }
    let config = NetworkConfig::from_map(&record.network)?;
    if config.net_arch.len() > MAX_LAYERS {
        return Err(Error::format(format!(
            "the policy has {} hidden layers, more than {MAX_LAYERS}",
            config.net_arch.len()
        )));
    }
    let (observation, action) = (record.observation.space()?, record.action.space()?);
    let head = record.head.of_space(&action)?;
    let spec = EnvironmentSpec::new("policy", observation, action);
    let mut policy = Policy::new(&spec, head, &config, record.clip_obs)?;
    record.choice_features.map_or(Ok(()), |features| policy.score_choices(features))?;
    let parameters = file.f32(PARAMETERS)?;
    if parameters.len() != policy.parameters.len() {
        return Err(Error::format(format!(
            "the file has {} parameters, its networks {}; save the policy again",
            parameters.len(),
            policy.parameters.len()
        )));
    }
    policy.parameters = parameters;
    if let Some(normaliser) = &mut policy.encoder.normaliser {
        let [mean, variance, count] = MOMENTS.map(|name| file.f64(name));
        let damaged = || Error::format("the statistics of observations are damaged; save the policy again");
        let count = count?.first().copied().ok_or_else(damaged)?;
        let moments = RunningMoments::from_parts(mean?, variance?, count)?;
        if moments.mean().len() != normaliser.moments.mean().len() {
            return Err(damaged());
        }
        normaliser.moments = moments;
    }
    Ok(policy)
}

impl HeadKind {
    fn of(head: &Head) -> Self {
        match head {
            Head::Categorical { .. } | Head::Binary(_) | Head::Gaussian(_) => Self::Stochastic,
            Head::SquashedGaussian(_) => Self::SquashedGaussian,
            Head::Squashed(_) => Self::Squashed,
            Head::Greedy { .. } => Self::Greedy,
        }
    }

    fn of_space(self, space: &opendr_engine::environment::Space) -> Result<Head> {
        use opendr_engine::environment::Space;
        match (self, space) {
            (Self::Stochastic, space) => Head::stochastic(space),
            (Self::SquashedGaussian, space) => Bounds::of(space, true).map(Head::SquashedGaussian),
            (Self::Squashed, space) => Bounds::of(space, true).map(Head::Squashed),
            (Self::Greedy, Space::Discrete { n, start }) => Ok(Head::Greedy { count: *n, start: *start }),
            (Self::Greedy, space) => Err(Error::format(format!(
                "a Q-network for the action space {space}; it needs discrete actions"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use opendr_engine::Random;
    use opendr_engine::environment::Space;

    use super::*;
    use crate::policy::ParameterInit;

    fn policy() -> Policy {
        let parts = BTreeMap::from([
            ("depth".to_owned(), Space::uniform(0.0, 15.0, &[36, 36]).unwrap()),
            ("gear".to_owned(), Space::Discrete { n: 3, start: -1 }),
            ("speed".to_owned(), Space::symmetric(&[f32::INFINITY, 0.1])),
        ]);
        let spec = EnvironmentSpec::new("test", Space::Dict(parts), Space::symmetric(&[0.5, 2.0]));
        let head = Head::stochastic(&spec.action).unwrap();
        let mut policy = Policy::new(&spec, head, &NetworkConfig::default(), Some(10.0)).unwrap();
        policy.initialise(ParameterInit::Orthogonal(0.01), -0.5, &mut Random::new(1));
        let mut observation = vec![1.0; 36 * 36 + 3];
        observation[36 * 36] = 0.0;
        policy.encoder.learn(&observation);
        policy
    }

    #[test]
    fn is_restored_from_its_bytes() {
        let policy = policy();
        let bytes = policy.to_bytes().unwrap();
        assert!(Policy::from_bytes(&bytes).unwrap() == policy);
        assert!(bytes.len() < 4 * policy.parameters.len() + 2000, "bounds of images are written once");
    }

    #[test]
    fn damage_is_detected() {
        let bytes = policy().to_bytes().unwrap();
        for cut in (0..900).chain([bytes.len() - 1]) {
            assert!(Policy::from_bytes(&bytes[..cut]).is_err(), "{cut}");
        }
        for at in 0..900 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x15;
            drop(Policy::from_bytes(&damaged));
        }
    }
}
