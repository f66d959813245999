//! The file of a policy, in the safetensors format: a length, JSON, numbers.

use std::collections::BTreeMap;
use std::path::Path;

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::{Error, Result, ResultExt as _};
use opendr_runlog::write_atomically;
use opendr_simulation::wrappers::RunningMoments;
use serde::{Deserialize, Serialize};

use super::space_record::SpaceRecord;
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
}

#[derive(Serialize, Deserialize, Clone, Copy)]
#[serde(rename_all = "snake_case")]
enum HeadKind {
    Stochastic,
    SquashedGaussian,
    Squashed,
    Greedy,
}

/// JSON header of the format: tensors by name, and metadata.
#[derive(Serialize, Deserialize)]
struct Header {
    #[serde(rename = "__metadata__")]
    metadata: BTreeMap<String, String>,
    #[serde(flatten)]
    tensors: BTreeMap<String, Tensor>,
}

#[derive(Serialize, Deserialize)]
struct Tensor {
    dtype: String,
    shape: Vec<usize>,
    data_offsets: [usize; 2],
}

const VERSION: u32 = 1;
const KEY: &str = "opendr_policy";
const MAX_HEADER_BYTES: usize = 16 << 20;
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
        };
        let (mut tensors, mut data) = (BTreeMap::new(), Vec::new());
        let mut add = |name: &str, dtype: &str, count: usize, bytes: Vec<u8>| {
            let data_offsets = [data.len(), data.len() + bytes.len()];
            let tensor = Tensor { dtype: dtype.to_owned(), shape: vec![count], data_offsets };
            tensors.insert(name.to_owned(), tensor);
            data.extend(bytes);
        };
        // Tensors of eight-byte numbers come first, so that all are aligned.
        if let Some(ObservationNormaliser { moments, .. }) = normaliser {
            for (name, numbers) in
                MOMENTS.into_iter().zip([moments.mean(), moments.variance(), &[moments.count()]])
            {
                add(name, "F64", numbers.len(), numbers.iter().flat_map(|x| x.to_le_bytes()).collect());
            }
        }
        let bytes = self.parameters.iter().flat_map(|x| x.to_le_bytes()).collect();
        add(PARAMETERS, "F32", self.parameters.len(), bytes);
        let unwritable = |error| Error::internal("the policy cannot be written as JSON").with_source(error);
        let metadata =
            BTreeMap::from([(KEY.to_owned(), serde_json::to_string(&record).map_err(unwritable)?)]);
        let mut json = serde_json::to_vec(&Header { metadata, tensors }).map_err(unwritable)?;
        json.resize(json.len().next_multiple_of(8), b' ');
        Ok([&(json.len() as u64).to_le_bytes()[..], &json, &data].concat())
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
    let damaged = || Error::format("the file is not a complete safetensors file; save the policy again");
    let (length, rest) = bytes.split_first_chunk::<8>().ok_or_else(damaged)?;
    let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
    let header = rest.get(..length).filter(|_| length <= MAX_HEADER_BYTES).ok_or_else(damaged)?;
    let data = &rest[length..];
    let wrong = |error| Error::format("the header is not that of a policy").with_source(error);
    let header: Header = serde_json::from_slice(header).map_err(wrong)?;
    let record = header
        .metadata
        .get(KEY)
        .ok_or_else(|| Error::format("the safetensors file contains no policy of OpenDR"))?;
    let record: Record = serde_json::from_str(record).map_err(wrong)?;
    if record.version != VERSION {
        return Err(Error::unsupported(format!(
            "the file has version {}, this OpenDR reads version {VERSION}; update OpenDR",
            record.version
        )));
    }
    let tensor = |name: &str, dtype: &str| {
        let tensor = header.tensors.get(name).filter(|tensor| tensor.dtype == dtype);
        let range = tensor.map(|tensor| tensor.data_offsets[0]..tensor.data_offsets[1]);
        range.and_then(|range| data.get(range)).ok_or_else(damaged)
    };
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
    let parameters = tensor(PARAMETERS, "F32")?.as_chunks::<4>().0;
    if parameters.len() != policy.parameters.len() {
        return Err(Error::format(format!(
            "the file has {} parameters, its networks {}; save the policy again",
            parameters.len(),
            policy.parameters.len()
        )));
    }
    for (to, bytes) in policy.parameters.iter_mut().zip(parameters) {
        *to = f32::from_le_bytes(*bytes);
    }
    if let Some(at) = policy.parameters.iter().position(|parameter| !parameter.is_finite()) {
        let number = policy.parameters[at];
        return Err(Error::format(format!("parameter {at} is {number}; save the policy again")));
    }
    if let Some(normaliser) = &mut policy.encoder.normaliser {
        let numbers = |name| -> Result<Vec<f64>> {
            let chunks = tensor(name, "F64")?.as_chunks::<8>().0.iter();
            Ok(chunks.map(|bytes| f64::from_le_bytes(*bytes)).collect())
        };
        let [mean, variance, count] = MOMENTS.map(numbers);
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
