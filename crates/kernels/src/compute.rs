use std::sync::Arc;

use crate::isa::Isa;
use crate::pool::WorkerPool;

/// Execution context of the kernels: an instruction set and a thread pool. Clones share the pool.
#[derive(Debug, Clone)]
pub struct Compute {
    isa: Isa,
    pool: Arc<WorkerPool>,
}

impl Compute {
    /// Uses the fastest instruction set, on the calling thread only.
    pub fn single() -> Self {
        Self::with_threads(1)
    }

    /// Uses the fastest instruction set, on `threads` threads, the calling one included; at least one.
    pub fn with_threads(threads: usize) -> Self {
        Self::new(Isa::best(), Arc::new(WorkerPool::new(threads)))
    }

    /// Uses the given instruction set and pool.
    pub fn new(isa: Isa, pool: Arc<WorkerPool>) -> Self {
        Self { isa, pool }
    }

    /// Returns the instruction set.
    pub fn isa(&self) -> Isa {
        self.isa
    }

    /// Returns the thread pool.
    pub fn pool(&self) -> &WorkerPool {
        &self.pool
    }
}
