//! Bodies that move and touch.

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, StateReader};

use super::body::Body;
use super::contact::{Contact, find};
use super::drive_impulse::DriveImpulse;

/// Passes of Gauss-Seidel in a step.
const PASSES: usize = 16;
/// Room for this many contacts: a step then allocates nothing.
const CONTACTS: usize = 128;

/// Bodies on a table.
#[derive(Debug)]
pub(crate) struct World {
    pub bodies: Vec<Body>,
    contacts: Vec<Contact>,
    drives: Vec<DriveImpulse>,
}

impl Clone for World {
    fn clone(&self) -> Self {
        Self::new(self.bodies.clone())
    }
}

impl World {
    pub fn new(bodies: Vec<Body>) -> Self {
        let drives = vec![DriveImpulse::default(); bodies.len()];
        Self { bodies, contacts: Vec::with_capacity(CONTACTS), drives }
    }

    /// Advances by one step of the physics.
    pub fn advance(&mut self, seconds: f64) {
        let Self { bodies, contacts, drives } = self;
        contacts.clear();
        for first in 0..bodies.len() {
            for second in first + 1..bodies.len() {
                if bodies[first].mass.is_finite() || bodies[second].mass.is_finite() {
                    find(bodies, [first, second], contacts);
                }
            }
        }
        drives.iter_mut().for_each(|impulse| *impulse = DriveImpulse::default());
        for _ in 0..PASSES {
            drives.iter_mut().zip(&mut *bodies).for_each(|(impulse, body)| impulse.solve(body, seconds));
            contacts.iter_mut().for_each(|contact| contact.solve(bodies, seconds));
        }
        bodies.iter_mut().for_each(|body| body.advance(seconds));
    }

    /// Returns the impulse with which two bodies were pressed together in the last step, N s.
    pub fn pressed(&self, pair: [usize; 2]) -> f64 {
        let between = self.contacts.iter().filter(|contact| contact.bodies == pair);
        between.map(Contact::pressed).sum()
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        self.bodies.iter().for_each(|body| body.save(snapshot));
    }

    pub fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.bodies.iter_mut().try_for_each(|body| body.load(state))
    }
}
