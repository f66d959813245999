//! One camera, topic or thread in front of a shared learner.

use std::sync::{Arc, PoisonError, RwLock};

use crate::learner::{Inputs, Learner, Outputs, Ports, Streaming, Targets};
use crate::{Header, Result};

/// One stream through a learner: its own state, the learner shared with others.
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

    /// Answers `target` to `input`, with the input's stamp and frame.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    pub fn infer_into(&mut self, input: L::Input<'_>, target: &mut L::Target) -> Result<()> {
        let learner = self.learner.read().unwrap_or_else(PoisonError::into_inner);
        target.set_header(input.header());
        self.begun = true;
        learner.infer_into(&mut self.state, input, target)
    }

    /// Answers `input`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    pub fn infer(&mut self, input: L::Input<'_>) -> Result<L::Target> {
        let mut target = L::Target::default();
        self.infer_into(input, &mut target)?;
        Ok(target)
    }

    /// Answers several inputs in order.
    ///
    /// # Errors
    /// As [`Learner::infer_batch`].
    pub fn infer_batch(&mut self, inputs: Vec<L::Input<'_>>) -> Result<Vec<L::Target>> {
        let learner = self.learner.read().unwrap_or_else(PoisonError::into_inner);
        self.begun |= !inputs.is_empty();
        learner.infer_batch(&mut self.state, inputs)
    }

    /// Answers named ports.
    ///
    /// # Errors
    /// `InvalidInput` when a port is missing, unknown or of another type; else as [`Learner::infer_into`].
    pub fn infer_ports(&mut self, ports: &Ports<'_>, target: &mut L::Target) -> Result<()> {
        ports.check(<L::Input<'_> as Inputs<'_>>::PORTS, !self.begun)?;
        self.infer_into(L::Input::from_ports(ports)?, target)
    }

    /// Forgets everything: the next answer is that of a fresh stream.
    pub fn reset(&mut self) {
        self.state = L::State::default();
        self.begun = false;
        self.last = Header::default();
    }
}

impl<L: Streaming> Stream<L> {
    /// Takes the next piece and hands on each target that it completes, with the piece's stamp and frame.
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

    /// The stream is over: hands on what is still pending.
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
