//! Embedded worlds with the meaning of Gymnasium 1.x: nothing needs to be installed.
//!
//! ```
//! use opendr_engine::environment::Environment as _;
//!
//! let mut cart_pole = opendr_simulation::make("CartPole-v1")?;
//! let mut observation = [0.0; 4];
//! cart_pole.reset(Some(42), &Default::default(), &mut observation)?;
//! let step = cart_pole.step(&[1.0], &mut observation)?;
//! assert_eq!(step.reward, 1.0);
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod drawing;
mod film;
mod numpy_random;
mod registered_source;
mod registry;
mod sine_cosine;

pub mod classic_control;
pub mod lidar;
pub mod raycast;
pub mod sphere_view;
pub mod street;
pub mod uav_corridor;
pub mod vector;
pub mod wrappers;

pub use film::Film;
pub use numpy_random::NumpyRandom;
pub use registered_source::RegisteredSource;
pub use registry::{Registered, Registration, Registry, make, make_vec};
