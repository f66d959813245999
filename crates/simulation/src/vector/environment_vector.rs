//! Any environments side by side, on threads that stay.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use opendr_engine::environment::{Environment, EnvironmentSpec, ResetOptions, Snapshot, StateReader};
use opendr_engine::{Error, Result};

use super::chunk::{Chunk, Order};
use super::{Autoreset, Batch, Seeds, VecEnvironment, check_actions, check_count, check_reset};

/// Environments of one kind (Gymnasium's `SyncVectorEnv` and `AsyncVectorEnv`). Every environment has its own stream of
/// random numbers, so the answers are the same for any number of threads.
pub struct EnvironmentVector {
    spec: EnvironmentSpec,
    count: usize,
    autoreset: Autoreset,
    own: Chunk,
    workers: Vec<Worker>,
}

impl EnvironmentVector {
    /// `environments`, stepped by `threads` threads, the calling one among them.
    ///
    /// # Errors
    /// `InvalidParam` when there is none or a million, `InvalidInput` when their spaces differ.
    pub fn new(
        mut environments: Vec<Box<dyn Environment>>,
        autoreset: Autoreset,
        threads: usize,
    ) -> Result<Self> {
        let count = check_count(environments.len())?;
        let spec = environments[0].spec().clone();
        let differs = |other: &EnvironmentSpec| {
            (&other.observation, &other.action) != (&spec.observation, &spec.action)
        };
        if let Some(at) = environments.iter().position(|other| differs(other.spec())) {
            let other = environments[at].spec();
            return Err(Error::invalid_input(format!(
                "environment {at}, {}, acts by {} and sees {}, but {} acts by {} and sees {}; take one kind",
                other.id, other.action, other.observation, spec.id, spec.action, spec.observation
            )));
        }
        let size = count.div_ceil(threads.clamp(1, count));
        let (mut own, mut workers) = (None, Vec::new());
        for first in (0..count).step_by(size) {
            let behind = environments.split_off(size.min(environments.len()));
            let chunk = Chunk::new(std::mem::replace(&mut environments, behind), first, autoreset, &spec);
            match own {
                None => own = Some(chunk),
                Some(_) => workers.push(Worker::new(chunk)?),
            }
        }
        let own = own.ok_or_else(|| Error::internal("no environment for the calling thread"))?;
        Ok(Self { spec, count, autoreset, own, workers })
    }

    /// Fills the chunks, lets all of them work, and gathers what they answer.
    fn run(&mut self, order: Order, batch: &mut Batch, mut fill: impl FnMut(&mut Chunk)) -> Result<()> {
        for worker in &mut self.workers {
            worker.begin(order, &mut fill)?;
        }
        fill(&mut self.own);
        self.own.run(order);
        batch.copy_from(&self.own.batch, 0);
        let mut outcome = std::mem::replace(&mut self.own.outcome, Ok(()));
        for worker in &mut self.workers {
            let chunk = worker.end()?;
            batch.copy_from(&chunk.batch, chunk.range().start);
            outcome = outcome.and(std::mem::replace(&mut chunk.outcome, Ok(())));
        }
        outcome
    }
}

impl VecEnvironment for EnvironmentVector {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn count(&self) -> usize {
        self.count
    }

    fn autoreset(&self) -> Autoreset {
        self.autoreset
    }

    fn reset(
        &mut self,
        seeds: Seeds<'_>,
        options: &ResetOptions,
        mask: Option<&[bool]>,
        batch: &mut Batch,
    ) -> Result<()> {
        check_reset(&seeds, mask, self.count)?;
        batch.check(&self.spec, self.count)?;
        self.run(Order::Reset, batch, |chunk| {
            for (place, index) in chunk.range().enumerate() {
                chunk.seeds[place] = seeds.at(index);
                chunk.mask[place] = mask.is_none_or(|mask| mask[index]);
            }
            chunk.options.clone_from(options);
        })
    }

    fn step(&mut self, actions: &[f32], batch: &mut Batch) -> Result<()> {
        check_actions(actions, &self.spec, self.count)?;
        batch.check(&self.spec, self.count)?;
        let size = self.spec.action.len();
        self.run(Order::Step, batch, |chunk| {
            let range = chunk.range();
            chunk.actions.copy_from_slice(&actions[range.start * size..range.end * size]);
            // Episodes that begin by themselves begin as by a plain reset.
            chunk.options.clear();
        })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.own.save_state(snapshot)?;
        for worker in &self.workers {
            worker.chunk.as_ref().ok_or_else(thread_ended)?.save_state(snapshot)?;
        }
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.own.load_state(state)?;
        for worker in &mut self.workers {
            worker.chunk.as_mut().ok_or_else(thread_ended)?.load_state(state)?;
        }
        Ok(())
    }
}

/// A thread that waits for its chunk, works on it and gives it back: nothing is shared, nothing is allocated.
struct Worker {
    chunk: Option<Box<Chunk>>,
    orders: Option<SyncSender<(Order, Box<Chunk>)>>,
    answers: Receiver<Box<Chunk>>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    fn new(chunk: Chunk) -> Result<Self> {
        let (orders, ordered) = sync_channel::<(Order, Box<Chunk>)>(1);
        let (answer, answers) = sync_channel(1);
        let thread = thread::Builder::new().name("environments".to_owned()).spawn(move || {
            for (order, mut chunk) in ordered {
                chunk.run(order);
                if answer.send(chunk).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { chunk: Some(Box::new(chunk)), orders: Some(orders), answers, thread: Some(thread) })
    }

    fn begin(&mut self, order: Order, fill: &mut impl FnMut(&mut Chunk)) -> Result<()> {
        let mut chunk = self.chunk.take().ok_or_else(thread_ended)?;
        fill(&mut chunk);
        let orders = self.orders.as_ref().ok_or_else(thread_ended)?;
        orders.send((order, chunk)).map_err(|_| thread_ended())
    }

    fn end(&mut self) -> Result<&mut Chunk> {
        let chunk = self.answers.recv().map_err(|_| thread_ended())?;
        Ok(self.chunk.insert(chunk))
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // A panic was told by the step that met it.
            let _ = thread.join();
        }
    }
}

fn thread_ended() -> Error {
    Error::internal("an environment panicked and ended its thread; make the environments anew")
}
