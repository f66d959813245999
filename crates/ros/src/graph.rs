//! What a node needs of a ROS, whichever it is.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use opendr_engine::Result;
use opendr_messages::{Message, MessageType, std_srvs};

use crate::ParameterTable;

/// Quality of service, as far as a node chooses it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Qos {
    /// Whether lost messages are sent again. A subscription that does not ask for it takes from both kinds of publishers.
    pub reliable: bool,
    /// Whether who comes late gets the last message (ROS 1: latched, ROS 2: transient local).
    pub latched: bool,
    /// How many messages are kept for a slow peer.
    pub depth: usize,
}

impl Qos {
    /// For what sensors send.
    pub const SENSOR: Self = Self { reliable: false, latched: false, depth: 5 };
    /// For results.
    pub const RESULT: Self = Self { reliable: true, latched: false, depth: 10 };
    /// For what is told once.
    pub const LATCHED: Self = Self { reliable: true, latched: true, depth: 1 };
}

/// Takes messages as they come; an error stands for bytes that are no message of the type.
pub type Deliver = Box<dyn FnMut(Result<Message>) + Send>;

/// Answers a `std_srvs/Trigger`: what was done, or why it was not.
pub type Trigger = Box<dyn FnMut() -> Result<String> + Send>;

/// The answer to who pulled a trigger.
pub(crate) fn answer_to(trigger: &mut Trigger) -> std_srvs::TriggerResponse {
    let (success, message) = match trigger() {
        Ok(message) => (true, message),
        Err(error) => (false, error.to_string()),
    };
    std_srvs::TriggerResponse { success, message }
}

/// Serves `~/reset`: what it sets when somebody asks, who then is told `done`.
pub(crate) fn serve_reset(graph: &mut dyn Graph, done: &'static str) -> Result<Arc<AtomicBool>> {
    let reset = Arc::new(AtomicBool::new(false));
    let asked = reset.clone();
    let trigger = move || {
        asked.store(true, Ordering::Relaxed);
        Ok(done.to_owned())
    };
    graph.serve("~/reset", Box::new(trigger))?;
    Ok(reset)
}

/// Nanoseconds since the epoch, or of the simulation.
pub type Clock = Arc<dyn Fn() -> i64 + Send + Sync>;

/// Writes a line to the terminal and to the ROS.
pub type Log = Arc<dyn Fn(Severity, &str) + Send + Sync>;

/// How much a log line matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Severity {
    Info,
    Warn,
    Error,
}

impl Severity {
    /// As ROS's log lines have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Info => "INFO",
            Self::Warn => "WARN",
            Self::Error => "ERROR",
        }
    }
}

/// One node in a ROS.
pub trait Graph: Send {
    /// The node's name with its namespace, e.g. `/opendr/nanodet`.
    fn name(&self) -> &str;

    /// The absolute name of a topic or service as the user's remappings have it.
    ///
    /// # Errors
    /// `InvalidInput` for what is no name.
    fn resolve(&self, name: &str) -> Result<String>;

    /// A topic to publish to.
    ///
    /// # Errors
    /// `InvalidInput` for what is no name; `Io` when the network cannot be used.
    fn advertise(&mut self, topic: &str, message_type: MessageType, qos: Qos) -> Result<Arc<dyn Publisher>>;

    /// Hands the messages of a topic on, from a thread of its own.
    ///
    /// # Errors
    /// As [`Graph::advertise`].
    fn subscribe(&mut self, topic: &str, message_type: MessageType, qos: Qos, deliver: Deliver)
    -> Result<()>;

    /// Serves a `std_srvs/Trigger`.
    ///
    /// # Errors
    /// As [`Graph::advertise`].
    fn serve(&mut self, service: &str, trigger: Trigger) -> Result<()>;

    /// Shows the parameters and lets others set them.
    ///
    /// # Errors
    /// As [`Graph::advertise`].
    fn declare(&mut self, parameters: Arc<ParameterTable>) -> Result<()>;

    /// Whether somebody else has ended the node (`rosnode kill`).
    fn is_over(&self) -> bool {
        false
    }

    /// The clock of the ROS.
    fn clock(&self) -> Clock;

    /// Logs to the terminal and to the ROS.
    fn log(&self) -> Log;
}

/// One topic that a node publishes to.
pub trait Publisher: Send + Sync {
    /// Sends a message; a peer that is slow or gone never holds it up for long.
    ///
    /// # Errors
    /// `Io` when the network cannot be used; `Unsupported` for a message that this ROS does not have.
    fn publish(&self, message: Message) -> Result<()>;

    /// How many listen.
    fn subscribers(&self) -> usize;
}
