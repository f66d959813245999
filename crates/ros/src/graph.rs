//! Interface of nodes to ROS 1 and ROS 2.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use opendr_engine::Result;
use opendr_messages::{Message, MessageType, std_srvs};

use crate::ParameterTable;

/// Quality of service of a topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Qos {
    /// Whether lost messages are sent again. A best-effort subscription accepts both kinds of publishers.
    pub reliable: bool,
    /// Whether late subscribers get the last message (ROS 1: latched, ROS 2: transient local).
    pub latched: bool,
    /// Number of messages kept for a slow peer.
    pub depth: usize,
}

impl Qos {
    /// Quality of service of sensor data.
    pub const SENSOR: Self = Self { reliable: false, latched: false, depth: 5 };
    /// Quality of service of predictions.
    pub const RESULT: Self = Self { reliable: true, latched: false, depth: 10 };
    /// Quality of service of messages that are sent once.
    pub const LATCHED: Self = Self { reliable: true, latched: true, depth: 1 };
}

/// Callback for received messages; an error stands for bytes that cannot be read as the type.
pub type MessageCallback = Box<dyn FnMut(Result<Message>) + Send>;

/// Handler of a `std_srvs/Trigger`; returns the message of the response.
pub type TriggerHandler = Box<dyn FnMut() -> Result<String> + Send>;

/// Returns the response of a trigger.
pub(crate) fn answer_to(trigger: &mut TriggerHandler) -> std_srvs::TriggerResponse {
    let (success, message) = match trigger() {
        Ok(message) => (true, message),
        Err(error) => (false, error.to_string()),
    };
    std_srvs::TriggerResponse { success, message }
}

/// Serves `~/reset` and returns the flag that a request sets; the response is `done`.
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

/// Returns nanoseconds since 1970, or of the simulation.
pub type Clock = Arc<dyn Fn() -> i64 + Send + Sync>;

/// Logs a line to the terminal and to ROS.
pub type Log = Arc<dyn Fn(Severity, &str) + Send + Sync>;

/// Severity of a log line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Severity {
    Info,
    Warn,
    Error,
}

impl Severity {
    /// Returns the name in ROS's log format.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Info => "INFO",
            Self::Warn => "WARN",
            Self::Error => "ERROR",
        }
    }
}

/// Connection of one node to ROS.
pub trait Graph: Send {
    /// Returns the node's name with its namespace, such as `/opendr/nanodet`.
    fn name(&self) -> &str;

    /// Returns the absolute name of a topic or service after the user's remappings.
    ///
    /// # Errors
    /// `InvalidInput` for an invalid name.
    fn resolve(&self, name: &str) -> Result<String>;

    /// Advertises a topic.
    ///
    /// # Errors
    /// `InvalidInput` for an invalid name; `Io` when the network cannot be used.
    fn advertise(&mut self, topic: &str, message_type: MessageType, qos: Qos) -> Result<Arc<dyn Publisher>>;

    /// Subscribes to a topic; `deliver` receives the messages on a thread of its own.
    ///
    /// # Errors
    /// As [`Graph::advertise`].
    fn subscribe(
        &mut self,
        topic: &str,
        message_type: MessageType,
        qos: Qos,
        deliver: MessageCallback,
    ) -> Result<()>;

    /// Serves a `std_srvs/Trigger`.
    ///
    /// # Errors
    /// As [`Graph::advertise`].
    fn serve(&mut self, service: &str, trigger: TriggerHandler) -> Result<()>;

    /// Declares the parameters, which other nodes can then read and set.
    ///
    /// # Errors
    /// As [`Graph::advertise`].
    fn declare(&mut self, parameters: Arc<ParameterTable>) -> Result<()>;

    /// Returns whether the node was ended from outside (`rosnode kill`).
    fn is_over(&self) -> bool {
        false
    }

    /// Returns the clock of ROS.
    fn clock(&self) -> Clock;

    /// Returns the logger of the node.
    fn log(&self) -> Log;
}

/// Publisher of one topic.
pub trait Publisher: Send + Sync {
    /// Sends a message; a slow or ended peer does not block for long.
    ///
    /// # Errors
    /// `Io` when the network cannot be used; `Unsupported` for a message that this version of ROS does not have.
    fn publish(&self, message: Message) -> Result<()>;

    /// Returns the number of subscribers.
    fn subscribers(&self) -> usize;
}
