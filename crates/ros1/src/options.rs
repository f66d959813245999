//! Options of a node.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use opendr_engine::Error;

use crate::{Arguments, ParameterValue};

/// Hook for errors in the background.
pub(crate) type ProblemHook = Arc<dyn Fn(Error) + Send + Sync>;

/// Hook for the shutdown of the node, with its reason.
pub(crate) type ShutdownHook = Arc<dyn Fn(&str) + Send + Sync>;

/// Options of a node; unset ones come from ROS's environment variables.
#[derive(Clone)]
pub struct NodeOptions {
    /// Name of the node, without slashes.
    pub name: String,
    /// Whether the process id and the time are appended to the name, so that several instances can run.
    pub anonymous: bool,
    /// Namespace (default: `ROS_NAMESPACE`, else the root).
    pub namespace: Option<String>,
    /// URI of the master (default: `ROS_MASTER_URI`, else `http://localhost:11311`).
    pub master_uri: Option<String>,
    /// Name or address of this machine for other nodes (default: `ROS_HOSTNAME`, `ROS_IP`, else the machine's name).
    pub host: Option<String>,
    /// Remappings of names, `from` and `to`, in any form.
    pub remappings: Vec<(String, String)>,
    /// Parameters to set when the node starts, usually private ones such as `~rate`.
    pub parameters: Vec<(String, ParameterValue)>,
    /// Maximum wait of [`Node::new`](crate::Node::new) for the master.
    pub wait_for_master: Duration,
    /// Maximum size of a received message, in bytes.
    pub max_message_bytes: usize,
    pub(crate) on_problem: ProblemHook,
    pub(crate) on_shutdown: ShutdownHook,
}

impl NodeOptions {
    /// Creates options for a node called `name`, with the defaults of the environment.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            anonymous: false,
            namespace: None,
            master_uri: None,
            host: None,
            remappings: Vec::new(),
            parameters: Vec::new(),
            wait_for_master: Duration::ZERO,
            max_message_bytes: 1 << 30,
            on_problem: Arc::new(|_| {}),
            on_shutdown: Arc::new(|_| {}),
        }
    }

    /// Applies ROS 1's command-line arguments; `arguments.rest` is left to the caller.
    #[must_use]
    pub fn with_arguments(mut self, arguments: &Arguments) -> Self {
        if let Some(name) = &arguments.name {
            (self.name, self.anonymous) = (name.clone(), false);
        }
        self.namespace = arguments.namespace.clone().or(self.namespace);
        self.master_uri = arguments.master_uri.clone().or(self.master_uri);
        self.host = arguments.host.clone().or(self.host);
        self.remappings.extend(arguments.remappings.iter().cloned());
        self.parameters.extend(arguments.parameters.iter().cloned());
        self
    }

    /// Calls `hook` with errors in the background: conflicting types, invalid data of a peer, a lost master. It is called on the
    /// node's threads and should return quickly. Without a hook these errors are dropped.
    #[must_use]
    pub fn on_error(mut self, hook: impl Fn(Error) + Send + Sync + 'static) -> Self {
        self.on_problem = Arc::new(hook);
        self
    }

    /// Calls `hook` once with the reason when the node has been shut down: by `rosnode kill`, another node of the same name, or its
    /// owner.
    #[must_use]
    pub fn on_shutdown(mut self, hook: impl Fn(&str) + Send + Sync + 'static) -> Self {
        self.on_shutdown = Arc::new(hook);
        self
    }
}

impl fmt::Debug for NodeOptions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NodeOptions")
            .field("name", &self.name)
            .field("namespace", &self.namespace)
            .field("master_uri", &self.master_uri)
            .field("host", &self.host)
            .field("remappings", &self.remappings)
            .finish_non_exhaustive()
    }
}
