//! Subscribed topics.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, Weak};

use opendr_engine::{Error, Result};

use super::inbox::Inbox;
use super::link::Link;
use crate::graph::Graph;
use crate::lock::lock;
use crate::{ParameterValue, TopicType};

/// Maximum number of publishers of one topic; a longer list is an error or an attack.
const MOST_PUBLISHERS: usize = 256;

/// A subscribed topic with a link to each of its publishers.
pub(crate) struct Subscribed {
    pub topic: String,
    pub kind: TopicType,
    pub tcp_nodelay: bool,
    pub inbox: Arc<Inbox>,
    graph: Weak<Graph>,
    /// Lock held while publishers change, so that an older list never replaces a newer one.
    changing: Mutex<()>,
    links: Mutex<BTreeMap<String, Arc<Link>>>,
}

impl Subscribed {
    pub fn new(graph: &Arc<Graph>, topic: &str, kind: TopicType, tcp_nodelay: bool, inbox: Inbox) -> Self {
        Self {
            topic: topic.to_owned(),
            kind,
            tcp_nodelay,
            inbox: Arc::new(inbox),
            graph: Arc::downgrade(graph),
            changing: Mutex::default(),
            links: Mutex::default(),
        }
    }

    /// Registers the subscription with the master and connects to the publishers that it returns. With `again`, the master may have
    /// been restarted; since many nodes never register twice, working connections are kept.
    pub fn register(self: &Arc<Self>, again: bool) -> Result<()> {
        let Some(graph) = self.graph.upgrade() else { return Ok(()) };
        let params =
            [self.topic.as_str().into(), self.kind.name.as_str().into(), graph.api_uri.as_str().into()];
        let _changing = lock(&self.changing);
        if let Some(publishers) = graph.register("registerSubscriber", &params)? {
            self.set_publishers(&graph, &uris(&publishers)?, again);
        }
        Ok(())
    }

    /// Applies the master's list of current publishers.
    pub fn update(self: &Arc<Self>, publishers: &[String]) {
        let _changing = lock(&self.changing);
        if let Some(graph) = self.graph.upgrade() {
            self.set_publishers(&graph, publishers, false);
        }
    }

    fn set_publishers(self: &Arc<Self>, graph: &Arc<Graph>, uris: &[String], again: bool) {
        if uris.len() > MOST_PUBLISHERS {
            graph.problem(Error::unsupported(format!(
                "{} has {} publishers; only {MOST_PUBLISHERS} are connected",
                self.topic,
                uris.len()
            )));
        }
        let wanted = uris.iter().take(MOST_PUBLISHERS).collect::<BTreeSet<_>>();
        let mut links = lock(&self.links);
        links.retain(|uri, link| {
            let known = wanted.contains(uri);
            let connected = link.connected.load(Ordering::Relaxed);
            let orphaned = !known && connected && (again || link.orphaned.load(Ordering::Relaxed));
            link.orphaned.store(orphaned, Ordering::Relaxed);
            let finished = link.finished.load(Ordering::Relaxed);
            let stays = (known || orphaned) && !finished && !self.inbox.is_closed();
            if !stays {
                link.cancel();
            }
            stays
        });
        for uri in wanted {
            if !links.contains_key(uri) && !self.inbox.is_closed() {
                match Link::start(graph, self, uri) {
                    Ok(link) => drop(links.insert(uri.clone(), link)),
                    Err(error) => graph.problem(error.context(format!("subscribing to {}", self.topic))),
                }
            }
        }
    }

    /// Returns the current links.
    pub fn links(&self) -> Vec<Arc<Link>> {
        lock(&self.links).values().cloned().collect()
    }

    /// Ends every link, and closes the queue.
    pub fn close(&self) {
        self.inbox.close();
        for link in std::mem::take(&mut *lock(&self.links)).values() {
            link.cancel();
        }
    }
}

/// Returns the URIs in a list.
pub(crate) fn uris(value: &ParameterValue) -> Result<Vec<String>> {
    let texts =
        value.as_list().and_then(|list| list.iter().map(|uri| uri.as_str().map(str::to_owned)).collect());
    texts.ok_or_else(|| Error::format("the list of publishers contains a value that is not an address"))
}
