//! Noticing that the master was restarted, and registering everything again.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Result};

use crate::ParameterValue;
use crate::graph::Graph;
use crate::lock::lock;

/// How often the master is asked.
const INTERVAL: Duration = Duration::from_secs(2);

/// Looks between two questions for the publishers: the master tells of a change once, and never again where that
/// was lost.
const LOOKS: u32 = 5;

/// How long it may take to answer.
const ANSWER_TIME: Duration = Duration::from_secs(2);

/// Asks the master from time to time whether it knows the node.
pub(crate) fn start(graph: &Arc<Graph>) -> Result<()> {
    let tasks = Arc::clone(&graph.tasks);
    let graph = Arc::clone(graph);
    tasks.spawn("master", move |cancel| {
        let mut known = Known::default();
        known.look(&graph).ok();
        while !cancel.wait(INTERVAL) {
            if let Err(error) = known.look(&graph) {
                graph.problem(error);
            }
        }
    })?;
    Ok(())
}

/// What was known of the master.
#[derive(Default)]
struct Known {
    pid: Option<ParameterValue>,
    lost: bool,
    looks: u32,
}

impl Known {
    fn look(&mut self, graph: &Graph) -> Result<()> {
        let pid = match graph.master.call_within("getPid", &[], ANSWER_TIME) {
            Ok(pid) => pid,
            Err(_) if self.lost => return Ok(()),
            Err(error) => {
                self.lost = true;
                return Err(error.context("the ROS master is gone; waiting for it to come back"));
            }
        };
        let other = self.pid.as_ref().is_some_and(|before| *before != pid);
        let missed = graph.unregistered.swap(false, Ordering::AcqRel);
        self.pid = Some(pid);
        if std::mem::take(&mut self.lost) || other || missed || !is_known(graph)? {
            graph.register_all();
        } else if self.looks % LOOKS == LOOKS - 1 {
            graph.register_subscriptions();
        }
        self.looks = self.looks.wrapping_add(1);
        Ok(())
    }
}

/// Whether the master has what we registered; in a container a new master may have the process id of the old
/// one.
fn is_known(graph: &Graph) -> Result<bool> {
    let nothing = lock(&graph.publications).is_empty()
        && lock(&graph.subscriptions).is_empty()
        && lock(&graph.services).is_empty()
        && lock(&graph.watches).is_empty();
    if nothing {
        return Ok(true);
    }
    match graph.master.call_within("lookupNode", &[graph.names.node().into()], ANSWER_TIME) {
        Ok(uri) if uri.as_str() == Some(&graph.api_uri) => Ok(true),
        // The master tells this node to end when another takes its name.
        Ok(uri) => Err(Error::unsupported(format!(
            "another node at {} has the name {}; give each a name of its own",
            uri.as_str().unwrap_or("an unknown address"),
            graph.names.node()
        ))),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}
