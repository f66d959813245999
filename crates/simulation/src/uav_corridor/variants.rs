//! Variants of the corridor with other defaults.

use opendr_engine::Result;
use opendr_engine::params::{ParamMap, Params};

use super::{CompactCorridor, CorridorForm, CorridorOptions, UavDepthCorridor, UavDepthCorridorParams};
use crate::Registration;
use crate::registration::checked;

/// `UavDepthCorridor-discrete-v1`: seven discrete actions.
#[derive(Debug, Clone, Params)]
pub struct Discrete {
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten)]
    pub options: CorridorOptions,
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten, discrete = true)]
    pub form: CorridorForm,
}

/// `UavDepthCorridor-dyn-v1`: a quadrotor in wind.
#[derive(Debug, Clone, Params)]
pub struct Dynamic {
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten)]
    pub options: CorridorOptions,
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten, dynamics = true)]
    pub form: CorridorForm,
}

/// `UavDepthCorridor-dense-v1`: 8 to 10 obstacles.
#[derive(Debug, Clone, Params)]
pub struct Dense {
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten, min_obstacles = 8, max_obstacles = 10)]
    pub options: CorridorOptions,
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten)]
    pub form: CorridorForm,
}

/// `UavDepthCorridor-noisy-v1`: range noise of 2 %, 5 % of the pixels dropped.
#[derive(Debug, Clone, Params)]
pub struct Noisy {
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten, range_noise = 0.02, dropped_pixels = 0.05)]
    pub options: CorridorOptions,
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten)]
    pub form: CorridorForm,
}

/// `UavDepthCorridor-compact-v1`: 26 numbers instead of the depth image.
#[derive(Debug, Clone, Params)]
pub struct Compact {
    /// As in `UavDepthCorridor-v1`.
    #[param(flatten)]
    pub options: CorridorOptions,
    /// Rewards arrival at the finish by 1 and everything else by 0.
    #[param(default = false)]
    pub sparse_reward: bool,
}

const COMPACT: &str = "UavDepthCorridor-compact-v1";

/// Parameters of a corridor with other defaults.
trait Variant: Params {
    const ID: &'static str;

    fn corridor(self) -> UavDepthCorridorParams;
}

macro_rules! variants {
    ($($name:ident = $id:literal),*) => {
        $(impl Variant for $name {
            const ID: &'static str = $id;

            fn corridor(self) -> UavDepthCorridorParams {
                UavDepthCorridorParams { options: self.options, form: self.form }
            }
        })*
    };
}

variants! {
    Discrete = "UavDepthCorridor-discrete-v1",
    Dynamic = "UavDepthCorridor-dyn-v1",
    Dense = "UavDepthCorridor-dense-v1",
    Noisy = "UavDepthCorridor-noisy-v1"
}

/// Returns the entries of all variants and of the plain corridor.
pub(crate) fn registrations() -> [Registration; 6] {
    [
        Registration::of::<UavDepthCorridor>(),
        registration::<Discrete>(),
        registration::<Dynamic>(),
        registration::<Dense>(),
        registration::<Noisy>(),
        compact(),
    ]
}

fn registration<V: Variant>() -> Registration {
    let make = |params: &ParamMap| -> Result<_> {
        checked(UavDepthCorridor::called(V::ID, &V::from_map(params)?.corridor())?)
    };
    Registration::new(V::ID, V::FIELDS, make)
}

fn compact() -> Registration {
    let make = |params: &ParamMap| -> Result<_> {
        let Compact { options, sparse_reward } = Compact::from_map(params)?;
        let params = UavDepthCorridorParams { options, ..Default::default() };
        let corridor = CompactCorridor::new(UavDepthCorridor::called(COMPACT, &params)?)?;
        checked(if sparse_reward { corridor.with_sparse_reward() } else { corridor })
    };
    Registration::new(COMPACT, Compact::FIELDS, make)
}
