//! The registry of environments by name.

use std::sync::LazyLock;

use opendr_engine::environment::Environment;
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};

use crate::classic_control::{Acrobot, CartPole, MountainCar, MountainCarContinuous, Pendulum};
use crate::object_search::{FrontierSearch, ObjectSearch};
use crate::planar_grasp::PlanarGrasp;
use crate::planar_peg::PlanarPeg;
use crate::planar_push::PlanarPush;
use crate::quad_track::QuadTrack;
use crate::registration::Registration;
use crate::vector::{VecEnvironment, VectorOptions};
use crate::{mobile_manipulation, sphere_view, uav_corridor};

/// Environments by name and version.
#[derive(Clone)]
pub struct Registry {
    entries: Vec<Registration>,
}

static BUILTIN: LazyLock<Registry> = LazyLock::new(|| {
    let classic = [
        Registration::of::<Acrobot>(),
        Registration::of::<CartPole>(),
        Registration::of::<MountainCar>(),
        Registration::of::<MountainCarContinuous>(),
        Registration::of::<ObjectSearch>(),
        Registration::of::<FrontierSearch>(),
        Registration::of::<Pendulum>(),
        Registration::of::<PlanarGrasp>(),
        Registration::of::<PlanarPeg>(),
        Registration::of::<PlanarPush>(),
        Registration::of::<QuadTrack>(),
    ];
    let further = uav_corridor::registrations().into_iter().chain(sphere_view::registrations());
    let further = further.chain(mobile_manipulation::registrations());
    Registry { entries: classic.into_iter().chain(further).collect() }
});

impl Registry {
    /// Returns the environments of this crate. A clone can be extended.
    pub fn builtin() -> &'static Self {
        &BUILTIN
    }

    /// Adds an entry.
    ///
    /// # Errors
    /// `InvalidParam` when the name does not end in a version such as `-v1`, or is taken.
    pub fn add(&mut self, registration: Registration) -> Result<()> {
        let id = &registration.id;
        if version_of(id).is_none() {
            return Err(Error::invalid_param(format!("the name {id:?} has no version; use {id}-v0")));
        }
        if self.entries.iter().any(|entry| entry.id == *id) {
            return Err(Error::invalid_param(format!("{id} is already registered; use a higher version")));
        }
        self.entries.push(registration);
        Ok(())
    }

    /// Returns the names of all entries.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(Registration::id)
    }

    /// Returns the entry `id`; without a version, the newest.
    ///
    /// # Errors
    /// `NotFound`, with similar names, or with the newest version if only the version is unknown.
    pub fn get(&self, id: &str) -> Result<&Registration> {
        if let Some(entry) = self.entries.iter().find(|entry| entry.id == id) {
            return Ok(entry);
        }
        match version_of(id) {
            None => self.newest(id).ok_or_else(|| self.unknown(id, id)),
            Some((name, _)) => Err(match self.newest(name) {
                Some(newest) => Error::not_found(format!("no version {id:?}; the newest is {:?}", newest.id)),
                None => self.unknown(id, name),
            }),
        }
    }

    fn newest(&self, name: &str) -> Option<&Registration> {
        let versions = self.entries.iter().filter_map(|entry| match version_of(&entry.id) {
            Some((own, version)) if own == name => Some((version, entry)),
            _ => None,
        });
        versions.max_by_key(|(version, _)| *version).map(|(_, entry)| entry)
    }

    fn unknown(&self, id: &str, name: &str) -> Error {
        let distance = |entry: &&Registration| {
            let own = version_of(&entry.id).map_or(entry.id(), |(own, _)| own);
            edits(&own.to_lowercase(), &name.to_lowercase())
        };
        let mut near: Vec<_> = self.entries.iter().filter(|entry| distance(entry) <= 3).collect();
        near.sort_by_key(distance);
        let near = if near.is_empty() { self.entries.iter().collect() } else { near };
        let names: Vec<_> = near.into_iter().map(Registration::id).collect();
        Error::not_found(format!("no environment {id:?}; available: {}", names.join(", ")))
    }
}

/// Splits `name-v1` into name and version.
fn version_of(id: &str) -> Option<(&str, u32)> {
    let (name, version) = id.rsplit_once("-v")?;
    Some((name, version.parse().ok()?)).filter(|(name, _)| !name.is_empty())
}

/// Returns the edit distance (Levenshtein); names longer than 64 letters are far from all others.
fn edits(a: &str, b: &str) -> usize {
    if a.len().max(b.len()) > 64 {
        return usize::MAX;
    }
    let b: Vec<_> = b.chars().collect();
    let mut row: Vec<_> = (0..=b.len()).collect();
    for (above, letter) in a.chars().enumerate() {
        let mut corner = above;
        row[0] = above + 1;
        for at in 0..b.len() {
            let changed = corner + usize::from(letter != b[at]);
            corner = row[at + 1];
            row[at + 1] = changed.min(corner + 1).min(row[at] + 1);
        }
    }
    row[b.len()]
}

/// Creates an environment of this crate with its defaults, its time limit and checks.
///
/// # Errors
/// `NotFound` for an unknown name.
pub fn make(id: &str) -> Result<Box<dyn Environment>> {
    Registry::builtin().get(id)?.make(&ParamMap::new())
}

/// Creates `options.count` environments with their defaults, stepped together.
///
/// # Errors
/// `NotFound` for an unknown name, `InvalidParam` for a count of 0 or too many.
pub fn make_vec(id: &str, options: VectorOptions) -> Result<Box<dyn VecEnvironment>> {
    Registry::builtin().get(id)?.make_vec(&ParamMap::new(), options)
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;
    use opendr_engine::params::ParamValue;

    use super::*;

    #[test]
    fn unknown_names_give_similar_ones() {
        assert_eq!(make("CartPole-v1").unwrap().spec().max_episode_steps, Some(500));
        assert_eq!(make("CartPole").unwrap().spec().id, "CartPole-v1");
        let message = |id: &str| {
            let error = make(id).err().unwrap();
            assert_eq!(error.kind(), ErrorKind::NotFound);
            error.to_string()
        };
        assert!(message("CartPole-v7").ends_with("the newest is \"CartPole-v1\""));
        assert!(message("cartpol-v1").ends_with("available: CartPole-v1"));
        assert!(message("Walker").contains("Pendulum-v1"));
        assert!(message(&"x".repeat(1000)).contains("Pendulum-v1"));
    }

    #[test]
    fn parameters_are_typed() {
        let pendulum = Registry::builtin().get("Pendulum-v1").unwrap();
        assert_eq!(pendulum.fields()[0].name, "g");
        let with = |value: ParamValue| pendulum.make(&ParamMap::from([("g".to_owned(), value)]));
        assert!(with(ParamValue::Float(9.81)).is_ok());
        assert!(with(ParamValue::Float(-1.0)).is_err());
        assert!(with(ParamValue::Text("heavy".to_owned())).is_err());
        let side_by_side = |id: &str, name: &str, value: ParamValue| {
            let params = ParamMap::from([(name.to_owned(), value)]);
            Registry::builtin().get(id).unwrap().make_vec(&params, VectorOptions::new(2))
        };
        assert!(side_by_side("CartPole-v1", "semi_implicit", ParamValue::Bool(true)).is_ok());
        assert!(side_by_side("CartPole-v1", "g", ParamValue::Float(9.81)).is_err());
        assert!(side_by_side("Pendulum-v1", "g", ParamValue::Float(9.81)).is_ok());
        assert!(pendulum.make(&ParamMap::from([("gg".to_owned(), ParamValue::Int(1))])).is_err());
    }

    #[test]
    fn entries_can_be_added_once() {
        let mut registry = Registry::builtin().clone();
        let mine = |id: &str| Registration::new(id, &[], |_| make("CartPole-v1"));
        registry.add(mine("mine/CartPole-v2")).unwrap();
        registry.add(mine("mine/CartPole-v10")).unwrap();
        assert_eq!(registry.get("mine/CartPole").unwrap().id(), "mine/CartPole-v10");
        assert!(registry.add(mine("mine/CartPole-v2")).is_err());
        assert!(registry.add(mine("CartPole")).is_err());
    }
}
