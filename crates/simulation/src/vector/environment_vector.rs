//! Environments stepped by a pool of threads.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use opendr_engine::environment::{Environment, EnvironmentSpec, ResetOptions, Snapshot, StateReader};
use opendr_engine::{Error, Result};

use super::chunk::{Chunk, Order};
use super::{Autoreset, Batch, Seeds, VecEnvironment, check_actions, check_count, check_reset};

/// Environments with the same spaces (Gymnasium's `SyncVectorEnv` and `AsyncVectorEnv`). Each has its own random
/// numbers, so results do not depend on the number of threads.
pub struct EnvironmentVector {
    spec: EnvironmentSpec,
    count: usize,
    autoreset: Autoreset,
    own: Chunk,
    workers: Vec<Worker>,
}

impl EnvironmentVector {
    /// Creates a vector of `environments`, stepped by `threads` threads including the calling one.
    ///
    /// # Errors
    /// `InvalidParam` for none or more than 2^20 environments, `InvalidInput` when their spaces differ.
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
                "environment {at}, {}, has actions {} and observations {}, but {} has actions {} and observations {}; use environments of equal spaces",
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

    /// Fills the chunks, runs them in parallel, and gathers their results.
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
            // An automatic reset has no options.
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

/// A thread that receives its chunk, runs it and sends it back: nothing is shared or allocated.
struct Worker {
    chunk: Option<Box<Chunk>>,
    orders: Option<SyncSender<(Order, Box<Chunk>)>>,
    results: Receiver<Box<Chunk>>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    fn new(chunk: Chunk) -> Result<Self> {
        let (orders, ordered) = sync_channel::<(Order, Box<Chunk>)>(1);
        let (result, results) = sync_channel(1);
        let thread = thread::Builder::new().name("environments".to_owned()).spawn(move || {
            for (order, mut chunk) in ordered {
                chunk.run(order);
                if result.send(chunk).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { chunk: Some(Box::new(chunk)), orders: Some(orders), results, thread: Some(thread) })
    }

    fn begin(&mut self, order: Order, fill: &mut impl FnMut(&mut Chunk)) -> Result<()> {
        let mut chunk = self.chunk.take().ok_or_else(thread_ended)?;
        fill(&mut chunk);
        let orders = self.orders.as_ref().ok_or_else(thread_ended)?;
        orders.send((order, chunk)).map_err(|_| thread_ended())
    }

    fn end(&mut self) -> Result<&mut Chunk> {
        let chunk = self.results.recv().map_err(|_| thread_ended())?;
        Ok(self.chunk.insert(chunk))
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // The step that caused a panic has already reported it.
            let _ = thread.join();
        }
    }
}

fn thread_ended() -> Error {
    Error::internal("an environment panicked and ended its thread; create the environments again")
}
