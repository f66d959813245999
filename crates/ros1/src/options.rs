//! How a node is set up.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use opendr_engine::Error;

use crate::{Arguments, ParameterValue};

/// Called with what goes wrong in the background.
pub(crate) type ProblemHook = Arc<dyn Fn(Error) + Send + Sync>;

/// Called once with the reason when the node is shut down.
pub(crate) type ShutdownHook = Arc<dyn Fn(&str) + Send + Sync>;

/// How a node is set up; what is not set comes from ROS's environment variables.
#[derive(Clone)]
pub struct NodeOptions {
    /// The node's name, without slashes.
    pub name: String,
    /// Whether the process id and the time are added to the name, so that several may run.
    pub anonymous: bool,
    /// The namespace; `ROS_NAMESPACE` else the root.
    pub namespace: Option<String>,
    /// The master's address; `ROS_MASTER_URI` else `http://localhost:11311`.
    pub master_uri: Option<String>,
    /// How others reach this machine; `ROS_HOSTNAME`, `ROS_IP` else the machine's name.
    pub host: Option<String>,
    /// Names that stand for others, `from` and `to`, in any form.
    pub remappings: Vec<(String, String)>,
    /// Parameters to set once the node is there, mostly private ones such as `~rate`.
    pub parameters: Vec<(String, ParameterValue)>,
    /// How long [`Node::new`](crate::Node::new) waits for a master that does not answer yet.
    pub wait_for_master: Duration,
    /// The longest message that is taken, in bytes.
    pub max_message_bytes: usize,
    pub(crate) on_problem: ProblemHook,
    pub(crate) on_shutdown: ShutdownHook,
}

impl NodeOptions {
    /// A node of the name `name`, the rest as the environment has it.
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

    /// Takes over what ROS 1's command line says; `arguments.rest` is the caller's.
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

    /// Calls `hook` with what goes wrong in the background: a clash of types, a peer that talks nonsense, a
    /// master that is gone. It is called from the node's threads and should return soon. Without it nothing
    /// is told.
    #[must_use]
    pub fn on_problem(mut self, hook: impl Fn(Error) + Send + Sync + 'static) -> Self {
        self.on_problem = Arc::new(hook);
        self
    }

    /// Calls `hook` once with the reason when the node has been shut down: by `rosnode kill`, by another node
    /// of the same name, or by its owner.
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
