//! Detection of a restarted master, and repeated registration.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Result};

use crate::ParameterValue;
use crate::graph::Graph;
use crate::lock::lock;

/// Interval of the checks.
const INTERVAL: Duration = Duration::from_secs(2);

/// Number of checks per query for publishers, since the master announces a change only once.
const CHECKS_PER_QUERY: u32 = 5;

/// Time limit of a response.
const ANSWER_TIME: Duration = Duration::from_secs(2);

/// Starts the thread that checks whether the master knows the node.
pub(crate) fn start(graph: &Arc<Graph>) -> Result<()> {
    let tasks = Arc::clone(&graph.context.tasks);
    let graph = Arc::clone(graph);
    tasks.spawn("master", move |cancel| {
        let mut known = Known::default();
        known.check(&graph).ok();
        while !cancel.wait(INTERVAL) {
            if let Err(error) = known.check(&graph) {
                graph.context.problem(error);
            }
        }
    })?;
    Ok(())
}

/// Last known state of the master.
#[derive(Default)]
struct Known {
    pid: Option<ParameterValue>,
    lost: bool,
    checks: u32,
}

impl Known {
    fn check(&mut self, graph: &Graph) -> Result<()> {
        let pid = match graph.context.master.call_within("getPid", &[], ANSWER_TIME) {
            Ok(pid) => pid,
            Err(_) if self.lost => return Ok(()),
            Err(error) => {
                self.lost = true;
                return Err(error.context("the ROS master is gone; waiting for it to return"));
            }
        };
        let other = self.pid.as_ref().is_some_and(|before| *before != pid);
        let missed = graph.context.unregistered.swap(false, Ordering::AcqRel);
        self.pid = Some(pid);
        if std::mem::take(&mut self.lost) || other || missed || !is_known(graph)? {
            graph.register_all();
        } else if self.checks % CHECKS_PER_QUERY == CHECKS_PER_QUERY - 1 {
            graph.register_subscriptions();
        }
        self.checks = self.checks.wrapping_add(1);
        Ok(())
    }
}

/// Returns whether the master has the registrations of this node; in a container a new master may have the process id of the old
/// one.
fn is_known(graph: &Graph) -> Result<bool> {
    let nothing = lock(&graph.publications).is_empty()
        && lock(&graph.subscriptions).is_empty()
        && lock(&graph.services).is_empty()
        && lock(&graph.watches).is_empty();
    if nothing {
        return Ok(true);
    }
    match graph.context.master.call_within("lookupNode", &[graph.context.names.node().into()], ANSWER_TIME) {
        Ok(uri) if uri.as_str() == Some(&graph.context.api_uri) => Ok(true),
        // The master shuts this node down when another takes its name.
        Ok(uri) => Err(Error::unsupported(format!(
            "another node at {} has the name {}; give each node its own name",
            uri.as_str().unwrap_or("an unknown address"),
            graph.context.names.node()
        ))),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}
