//! Search for objects in flats of several rooms with a depth camera: multi-object search without iGibson.
//!
//! A robot maps a generated floor plan and finds six objects, as in OpenDR's `MultiObjectSearchRLLearner` (Schmalstieg, Honerkamp,
//! Welschehold and Valada, Learning long-horizon robot exploration strategies for multi-object search in continuous action
//! spaces, 2022). [`ObjectSearch`] is the robot with speed and turn rate as actions; [`FrontierSearch`] is the same robot, whose
//! actions choose where it drives next among the frontiers of its map and the objects it has seen. Metres, seconds, radians.

mod distances;
mod egocentric;
mod environment;
mod episode;
mod floor_plan;
mod frontier_environment;
mod frontiers;
mod grid;
mod known_map;
mod options;
mod route;
mod sensor;
#[cfg(test)]
mod tests;
mod view;

pub use environment::ObjectSearch;
pub use floor_plan::FloorPlan;
pub use frontier_environment::{FrontierSearch, NearestFrontier, ObjectsNearer};
pub use known_map::{Cell, KnownMap};
pub use options::ObjectSearchParams;

/// Cells of a floor plan in each direction.
pub const SIDE: usize = 100;
/// Side of a cell, metres.
pub const CELL: f64 = 0.1;
/// Seconds of a step.
pub const CONTROL_PERIOD: f64 = 0.25;
/// Largest speed ahead, m/s, and turn rate, rad/s.
pub const SPEED: f64 = 0.5;
/// Largest turn rate, rad/s.
pub const TURN_RATE: f64 = 1.5;
/// Number of objects.
pub const OBJECTS: usize = 6;
/// Distance in metres within which an object that the camera sees is found.
pub const FOUND: f64 = 1.3;
/// Collisions after which an episode terminates.
const MOST_COLLISIONS: u32 = 600;
/// Steps after which an episode is truncated.
const LIMIT: u32 = 3500;
