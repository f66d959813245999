//! Rigid bodies in the plane of a table, with contacts, Coulomb friction and the friction of the table.
//!
//! Bodies are unions of rounded convex polygons. A step solves contacts, drives and the friction of the table together at the level of
//! velocities by projected Gauss-Seidel (Catto, Iterative dynamics with temporal coherence, 2005), without warm starts: pose and
//! velocity are the whole state, so that an episode continues bit for bit from a snapshot. The friction between a body and the table
//! is bounded by the ellipsoidal limit surface (Lee and Cutkosky, Fixture planning with friction, 1991): a pushed body comes to rest
//! within a few centimetres, and within millimetres at the speeds of manipulation (Lynch and Mason, Stable pushing, 1996).

mod body;
mod contact;
mod drive;
mod drive_impulse;
mod episode_key;
mod shape;
#[cfg(test)]
mod tests;
pub(crate) mod vector;
mod way;
mod world;

pub(crate) use body::{Body, Part, Pose};
pub(crate) use drive::Drive;
pub(crate) use episode_key::EpisodeKey;
pub(crate) use shape::Convex;
pub(crate) use way::Ring;
pub(crate) use world::World;
