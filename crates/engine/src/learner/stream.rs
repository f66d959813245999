//! The state of one camera, topic or thread with a shared learner.

use std::sync::{Arc, PoisonError, RwLock};

use crate::learner::{Inputs, Learner, Outputs, Ports, Streaming, Targets};
use crate::{Header, Result};

/// One stream of inputs: a shared learner with a state of its own.
pub struct Stream<L: Learner> {
    learner: Arc<RwLock<L>>,
    state: L::State,
    begun: bool,
    last: Header,
}

impl<L: Learner> Stream<L> {
    pub(crate) fn new(learner: Arc<RwLock<L>>) -> Self {
        Self { learner, state: L::State::default(), begun: false, last: Header::default() }
    }

    pub(crate) fn learner(&self) -> &Arc<RwLock<L>> {
        &self.learner
    }

    /// Writes the prediction for `input` into `target`, with the stamp and frame of the input.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    pub fn infer_into(&mut self, input: L::Input<'_>, target: &mut L::Target) -> Result<()> {
        let learner = self.learner.read().unwrap_or_else(PoisonError::into_inner);
        target.set_header(input.header());
        self.begun = true;
        learner.infer_into(&mut self.state, input, target)
    }

    /// Returns the prediction for `input`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    pub fn infer(&mut self, input: L::Input<'_>) -> Result<L::Target> {
        let mut target = L::Target::default();
        self.infer_into(input, &mut target)?;
        Ok(target)
    }

    /// Returns the predictions for several inputs, in order.
    ///
    /// # Errors
    /// As [`Learner::infer_batch`].
    pub fn infer_batch(&mut self, inputs: Vec<L::Input<'_>>) -> Result<Vec<L::Target>> {
        let learner = self.learner.read().unwrap_or_else(PoisonError::into_inner);
        self.begun |= !inputs.is_empty();
        learner.infer_batch(&mut self.state, inputs)
    }

    /// Writes the prediction for named inputs into `target`.
    ///
    /// # Errors
    /// Returns `InvalidInput` if a port is missing, unknown or of another type; otherwise as [`Learner::infer_into`].
    pub fn infer_ports(&mut self, ports: &Ports<'_>, target: &mut L::Target) -> Result<()> {
        ports.check(<L::Input<'_> as Inputs<'_>>::PORTS, !self.begun)?;
        self.infer_into(L::Input::from_ports(ports)?, target)
    }

    /// Resets the state: the next prediction is that of a new stream.
    pub fn reset(&mut self) {
        self.state = L::State::default();
        self.begun = false;
        self.last = Header::default();
    }
}

impl<L: Streaming> Stream<L> {
    /// Processes the next piece and passes each completed target to `emit`, with the stamp and frame of the piece.
    ///
    /// # Errors
    /// As [`Streaming::push`].
    pub fn push(&mut self, piece: L::Input<'_>, emit: &mut dyn FnMut(L::Target)) -> Result<()> {
        let learner = self.learner.read().unwrap_or_else(PoisonError::into_inner);
        self.begun = true;
        self.last = piece.header().clone();
        let last = &self.last;
        learner.push(&mut self.state, piece, &mut |mut target| {
            target.set_header(last);
            emit(target);
        })
    }

    /// Ends the stream and passes the pending targets to `emit`.
    ///
    /// # Errors
    /// As [`Streaming::flush`].
    pub fn flush(&mut self, emit: &mut dyn FnMut(L::Target)) -> Result<()> {
        let learner = self.learner.read().unwrap_or_else(PoisonError::into_inner);
        let last = &self.last;
        learner.flush(&mut self.state, &mut |mut target| {
            target.set_header(last);
            emit(target);
        })
    }

    pub(crate) fn push_ports(
        &mut self,
        piece: Option<&Ports<'_>>,
        emit: &mut dyn FnMut(Outputs),
    ) -> Result<()> {
        let mut emit = |target: L::Target| emit(Outputs::from_targets(&target));
        match piece {
            Some(ports) => {
                ports.check(<L::Input<'_> as Inputs<'_>>::PORTS, !self.begun)?;
                self.push(L::Input::from_ports(ports)?, &mut emit)
            }
            None => self.flush(&mut emit),
        }
    }
}
