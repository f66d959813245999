//! Rules by name that decide which actions a shield replaces.

use std::sync::{Arc, PoisonError, RwLock};

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};
use opendr_simulation::uav_corridor::CorridorClearance;

use super::shield::Predicate;

type Make = dyn Fn(&Space) -> Result<Predicate> + Send + Sync;

/// A rule that decides whether an action is unsafe, under the name by which the parameter `shield` of a policy selects it.
#[derive(Clone)]
pub struct SafetyRule {
    name: String,
    about: String,
    make: Arc<Make>,
}

static REGISTERED: RwLock<Vec<SafetyRule>> = RwLock::new(Vec::new());

impl SafetyRule {
    /// Creates a rule; `make` creates its predicate for observations of a space.
    pub fn new(
        name: impl Into<String>,
        about: impl Into<String>,
        make: impl Fn(&Space) -> Result<Predicate> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), about: about.into(), make: Arc::new(make) }
    }

    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns what the rule forbids and where.
    pub fn description(&self) -> &str {
        &self.about
    }

    /// Creates the predicate for observations of `space`.
    ///
    /// # Errors
    /// `Unsupported` for a space that the rule does not read.
    pub fn predicate(&self, space: &Space) -> Result<Predicate> {
        (self.make)(space)
    }

    /// Makes the rule known to this process.
    ///
    /// # Errors
    /// `InvalidInput` when the name is taken.
    pub fn register(self) -> Result<()> {
        if Self::all().iter().any(|rule| rule.name == self.name) {
            return Err(Error::invalid_input(format!(
                "the safety rule {} is registered already; use another name",
                self.name
            )));
        }
        REGISTERED.write().unwrap_or_else(PoisonError::into_inner).push(self);
        Ok(())
    }

    /// Returns all rules of this process.
    pub fn all() -> Vec<Self> {
        let registered = REGISTERED.read().unwrap_or_else(PoisonError::into_inner);
        std::iter::once(corridor_clearance()).chain(registered.iter().cloned()).collect()
    }

    /// Returns the rule of a name.
    ///
    /// # Errors
    /// `NotFound` for an unknown name; the message lists the known ones.
    pub fn find(name: &str) -> Result<Self> {
        let all = Self::all();
        all.iter().find(|rule| rule.name == name).cloned().ok_or_else(|| {
            let names: Vec<_> = all.iter().map(|rule| rule.name.as_str()).collect();
            Error::not_found(format!("no safety rule {name:?}, only {}", names.join(", ")))
        })
    }
}

fn corridor_clearance() -> SafetyRule {
    let about = "forbids headings with something nearer than 1.3 m and 0.35 m aside, in UavDepthCorridor";
    SafetyRule::new("corridor-clearance", about, |space| {
        let mut clearance = CorridorClearance::new(space)?;
        Ok(Box::new(move |observation, action| clearance.is_violated(observation, action)))
    })
}
