//! Simulated environments with the semantics of Gymnasium 1.x, vectorised, and wrappers.
//!
//! - [`make`] and [`make_vec`] create environments by name: classic control, and a drone in a corridor with obstacles
//!   ([`uav_corridor`]).
//! - [`vector`] steps several environments together, [`wrappers`] limits, checks, stacks and normalises them, [`Recording`] records them.
//! - [`raycast`] is a ray caster for depth and colour images, [`lidar`] a spinning lidar, [`street`] synthetic data sets of street
//!   scenes.
//!
//! In classic control, a seed gives the same episode as in Gymnasium. The traits `Environment` and `EnvironmentSource` and the
//! spaces are in `opendr-engine`; algorithms that train policies are in `opendr-rl`.
//!
//! Begin with [`make`]:
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

mod arctangent;
mod drawing;
mod film;
mod multirotor;
mod numpy_random;
mod planar;
mod registered_source;
mod registration;
mod registry;
mod sine_cosine;

pub mod classic_control;
pub mod drive;
pub mod kinematics;
pub mod lidar;
pub mod mobile_manipulation;
pub mod object_search;
pub mod person_scenes;
pub mod planar_grasp;
pub mod planar_peg;
pub mod planar_push;
pub mod quad_track;
pub mod raycast;
pub mod solids;
pub mod sphere_view;
pub mod street;
pub mod uav_corridor;
pub mod vector;
pub mod wrappers;

pub use film::Recording;
pub use numpy_random::NumpyRandom;
pub use registered_source::RegisteredSource;
pub use registration::{RegisteredEnvironment, Registration};
pub use registry::{Registry, make, make_vec};
