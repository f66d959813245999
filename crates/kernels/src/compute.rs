use std::sync::Arc;

use crate::isa::Isa;
use crate::pool::WorkerPool;

/// Where kernels run: an instruction set and a pool of threads. Clones share the pool.
#[derive(Debug, Clone)]
pub struct Compute {
    isa: Isa,
    pool: Arc<WorkerPool>,
}

impl Compute {
    /// The fastest instructions, on the calling thread alone.
    pub fn single() -> Self {
        Self::with_threads(1)
    }

    /// The fastest instructions, on this many threads, the caller among them; at least one.
    pub fn with_threads(threads: usize) -> Self {
        Self::new(Isa::best(), Arc::new(WorkerPool::new(threads)))
    }

    /// These instructions, on this pool.
    pub fn new(isa: Isa, pool: Arc<WorkerPool>) -> Self {
        Self { isa, pool }
    }

    /// The instruction set.
    pub fn isa(&self) -> Isa {
        self.isa
    }

    /// The threads.
    pub fn pool(&self) -> &WorkerPool {
        &self.pool
    }
}
