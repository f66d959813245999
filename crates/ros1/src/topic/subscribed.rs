//! Subscribed topics.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use opendr_engine::{Error, Result};

use super::link::{Link, Wanted};
use crate::ParameterValue;
use crate::context::Context;
use crate::lock::lock;

/// Maximum number of publishers of one topic; a longer list is an error or an attack.
const MOST_PUBLISHERS: usize = 256;

/// A subscribed topic with a link to each of its publishers.
pub(crate) struct Subscribed {
    pub wanted: Arc<Wanted>,
    context: Arc<Context>,
    /// Lock held while publishers change, so that an older list never replaces a newer one.
    changing: Mutex<()>,
    links: Mutex<BTreeMap<String, Arc<Link>>>,
}

impl Subscribed {
    pub fn new(context: &Arc<Context>, wanted: Wanted) -> Self {
        Self {
            wanted: Arc::new(wanted),
            context: Arc::clone(context),
            changing: Mutex::default(),
            links: Mutex::default(),
        }
    }

    /// Registers the subscription with the master and connects to the publishers that it returns. With `again`, the master may have
    /// been restarted; since many nodes never register twice, working connections are kept.
    pub fn register(&self, again: bool) -> Result<()> {
        let Wanted { topic, kind, .. } = &*self.wanted;
        let params = [topic.as_str().into(), kind.name.as_str().into(), self.context.api_uri.as_str().into()];
        let _changing = lock(&self.changing);
        if let Some(publishers) = self.context.register("registerSubscriber", &params)? {
            self.set_publishers(&uris(&publishers)?, again);
        }
        Ok(())
    }

    /// Applies the master's list of current publishers.
    pub fn update(&self, publishers: &[String]) {
        let _changing = lock(&self.changing);
        self.set_publishers(publishers, false);
    }

    fn set_publishers(&self, uris: &[String], again: bool) {
        if uris.len() > MOST_PUBLISHERS {
            self.context.problem(Error::unsupported(format!(
                "{} has {} publishers; only {MOST_PUBLISHERS} are connected",
                self.wanted.topic,
                uris.len()
            )));
        }
        let current = uris.iter().take(MOST_PUBLISHERS).collect::<BTreeSet<_>>();
        let mut links = lock(&self.links);
        links.retain(|uri, link| {
            let known = current.contains(uri);
            let connected = link.connected.load(Ordering::Relaxed);
            let orphaned = !known && connected && (again || link.orphaned.load(Ordering::Relaxed));
            link.orphaned.store(orphaned, Ordering::Relaxed);
            let finished = link.finished.load(Ordering::Relaxed);
            let stays = (known || orphaned) && !finished && !self.wanted.inbox.is_closed();
            if !stays {
                link.cancel();
            }
            stays
        });
        for uri in current {
            if !links.contains_key(uri) && !self.wanted.inbox.is_closed() {
                match Link::start(&self.context, &self.wanted, uri) {
                    Ok(link) => drop(links.insert(uri.clone(), link)),
                    Err(error) => {
                        let error = error.context(format!("subscribing to {}", self.wanted.topic));
                        self.context.problem(error);
                    }
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
        self.wanted.inbox.close();
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
