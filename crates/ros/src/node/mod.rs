//! Learners as nodes.

mod annotated;
mod diagnostics;
mod feeds;
mod frame;
mod inbox;
mod labels;
mod outputs;
mod params;
mod path;
mod topics;
mod worker;

pub use feeds::SharedSubscriptions;
pub use params::NodeParams;
pub use topics::{NodeOptions, TopicOptions, default_topics};
pub use worker::NodeObserver;

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::learner::{AnyLearner, Entry};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};

use crate::graph::serve_reset;
use crate::{Graph, ParameterTable};
use inbox::Inbox;
use worker::Worker;

/// A learner as a node: it subscribes to its inputs and publishes its outputs.
pub struct LearnerNode {
    worker: Worker,
}

impl LearnerNode {
    /// Declares topics, parameters and services of a loaded learner on `graph`, which starts afterwards. Nodes of one process share
    /// `feeds`, so that each image is received and decoded once.
    ///
    /// # Errors
    /// `InvalidInput` for an invalid topic name or a message type that does not match; `NotFound` for a learner without a model;
    /// `Io` when the network cannot be used.
    pub fn new(
        graph: &mut dyn Graph,
        entry: &'static Entry,
        learner: Box<dyn AnyLearner>,
        options: NodeOptions,
        feeds: &mut SharedSubscriptions,
    ) -> Result<Self> {
        options.check(entry)?;
        let inbox = Arc::new(Inbox::new(entry));
        let params = Arc::new(Mutex::new(options.params.clone()));
        let stream = learner.stream()?;
        let classes = learner.classes();
        declare_parameters(graph, entry, learner, &params)?;
        let reset = serve_reset(graph, "the next input begins a new stream")?;
        let worker = Worker::new(graph, entry, stream, &classes, inbox.clone(), params, reset, &options)?;
        for (index, port) in entry.ports.iter().enumerate() {
            let Some(topic) = options.inputs.iter().find(|topic| topic.name == port.name) else { continue };
            feeds.subscribe(graph, topic, port.value_type, &inbox, index)?;
        }
        Ok(Self { worker })
    }

    /// Calls `observer` after each inference, on the thread of the node.
    pub fn observe(&mut self, observer: NodeObserver) {
        self.worker.observe(observer);
    }

    /// Returns the flag of the active node; while it is false, inputs are skipped and nothing is published.
    pub fn active(&self) -> Arc<AtomicBool> {
        self.worker.active()
    }

    /// Runs until `stop` returns true.
    pub fn run(self, stop: &dyn Fn() -> bool) {
        self.worker.run(stop);
    }
}

/// Declares the parameters of the learner and of the node in one table.
fn declare_parameters(
    graph: &mut dyn Graph,
    entry: &'static Entry,
    learner: Box<dyn AnyLearner>,
    params: &Arc<Mutex<NodeParams>>,
) -> Result<()> {
    let of_learner = learner.params();
    let mut rows = Vec::new();
    for field in entry.params {
        let value = of_learner.get(field.name).cloned().unwrap_or_else(|| field.default.value());
        rows.push((field, value));
    }
    let own = params.lock().unwrap_or_else(PoisonError::into_inner).clone();
    for (index, field) in NodeParams::FIELDS.iter().enumerate() {
        if entry.params.iter().any(|other| other.name == field.name) {
            return Err(Error::internal(format!(
                "{} has a parameter {}, which is reserved for nodes",
                entry.spec.name, field.name
            )));
        }
        rows.push((field, own.get_at(index)));
    }
    let (learner, params) = (Mutex::new(learner), params.clone());
    let table = ParameterTable::new(rows, move |name, value| {
        if NodeParams::FIELDS.iter().any(|field| field.name == name) {
            params.lock().unwrap_or_else(PoisonError::into_inner).set(name, value.clone())
        } else {
            learner.lock().unwrap_or_else(PoisonError::into_inner).set(name, value.clone())
        }
    });
    graph.declare(Arc::new(table))
}
