//! Names, addresses, threads and master of a node, which its topics, services and watches share.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Result};

use crate::ParameterValue;
use crate::http::host_in_uri;
use crate::master::Master;
use crate::name::Names;
use crate::options::ProblemHook;
use crate::tasks::Tasks;

/// What the parts of a node share.
pub(crate) struct Context {
    pub names: Names,
    pub master: Master,
    /// Name or address of this machine for other nodes.
    pub host: String,
    /// URI of the node's XML-RPC server.
    pub api_uri: String,
    pub tcp_port: u16,
    pub max_message_bytes: usize,
    pub tasks: Arc<Tasks>,
    /// Whether the master may lack a registration of this node.
    pub unregistered: AtomicBool,
    pub on_problem: ProblemHook,
    pub next_id: AtomicU32,
    pub ending: AtomicBool,
}

impl Context {
    /// Reports an error to the owner's hook.
    pub fn problem(&self, error: Error) {
        // A panic of the hook must not end the calling thread.
        catch_unwind(AssertUnwindSafe(|| (self.on_problem)(error))).ok();
    }

    /// Runs the owner's code; a panic in it is reported and does not end the thread.
    pub fn guarded<T>(&self, what: &str, code: impl FnOnce() -> T) -> Option<T> {
        let done = catch_unwind(AssertUnwindSafe(code));
        if done.is_err() {
            self.problem(Error::internal(format!("{what} panicked; its message is on standard error")));
        }
        done.ok()
    }

    /// Returns a new id of a connection.
    pub fn connection_id(&self) -> u32 {
        self.next_id.fetch_add(1, Ordering::Relaxed)
    }

    /// Registers with the master. If the master does not respond, the error is reported and the registration repeated later.
    ///
    /// # Errors
    /// The error of a master that refuses.
    pub fn register(&self, method: &str, params: &[ParameterValue]) -> Result<Option<ParameterValue>> {
        match self.master.call(method, params) {
            Ok(value) => Ok(Some(value)),
            Err(error) if error.kind() == ErrorKind::Network => {
                self.unregistered.store(true, Ordering::Release);
                self.problem(error);
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Unregisters with the master; errors of a master that is gone are ignored.
    pub fn unregister(&self, method: &str, params: &[ParameterValue]) {
        if !self.is_ended() {
            self.master.call_within(method, params, Duration::from_secs(2)).ok();
        }
    }

    /// Returns whether the node is shutting down or has ended.
    pub fn is_ended(&self) -> bool {
        self.ending.load(Ordering::Acquire)
    }

    /// Checks that the node is not shutting down.
    ///
    /// # Errors
    /// `Network` during the shutdown of the node and after it.
    pub fn check_running(&self) -> Result<()> {
        if self.is_ended() {
            return Err(Error::network("the node was shut down; create a new one"));
        }
        Ok(())
    }

    /// Returns the URI of the node's services.
    pub fn service_uri(&self) -> String {
        format!("rosrpc://{}:{}", host_in_uri(&self.host), self.tcp_port)
    }
}
