//! Notification of parameter changes.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex};

use opendr_engine::{Error, Result};

use crate::ParameterValue;
use crate::graph::Graph;
use crate::lock::lock;
use crate::name::canonical;

type Changed = Box<dyn Fn(&str, &ParameterValue) + Send + Sync>;

/// A watched parameter.
pub(crate) struct Watch {
    pub key: String,
    changed: Changed,
    /// Lock that serialises the calls of `changed`.
    calling: Mutex<()>,
}

impl Watch {
    /// Subscribes to the parameter at the master.
    pub fn register(&self, graph: &Graph) -> Result<ParameterValue> {
        let params = [graph.api_uri.as_str().into(), self.key.as_str().into()];
        let value = graph.register("subscribeParam", &params)?;
        Ok(value.unwrap_or_else(|| ParameterValue::Struct(BTreeMap::new())))
    }
}

/// Notifies every watch of `key` or of a namespace that contains it.
pub(crate) fn notify(graph: &Graph, key: &str, value: &ParameterValue) {
    let key = canonical(key);
    let watches: Vec<_> = lock(&graph.watches).clone();
    for watch in watches {
        let below = key.strip_prefix(&watch.key).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        if below || watch.key == "/" {
            let _calling = lock(&watch.calling);
            graph.guarded("the owner's function for parameters", || (watch.changed)(&key, value));
        }
    }
}

/// Handle of a watched parameter; dropping it ends the watch.
pub struct ParameterWatch {
    graph: Arc<Graph>,
    watch: Arc<Watch>,
}

impl ParameterWatch {
    pub(crate) fn new(graph: &Arc<Graph>, key: &str, changed: Changed) -> Result<(Self, ParameterValue)> {
        let watch = Arc::new(Watch { key: key.to_owned(), changed, calling: Mutex::default() });
        let mut watches = lock(&graph.watches);
        if graph.is_ended() {
            return Err(Error::network("the node was shut down; create a new one"));
        }
        watches.push(Arc::clone(&watch));
        drop(watches);
        let handle = Self { graph: Arc::clone(graph), watch };
        let value = handle.watch.register(graph)?;
        Ok((handle, value))
    }

    /// Returns the parameter's full name.
    pub fn key(&self) -> &str {
        &self.watch.key
    }
}

impl Drop for ParameterWatch {
    fn drop(&mut self) {
        let mut watches = lock(&self.graph.watches);
        watches.retain(|other| !Arc::ptr_eq(other, &self.watch));
        let others = watches.iter().any(|other| other.key == self.watch.key);
        drop(watches);
        if !others {
            self.graph
                .unregister("unsubscribeParam", &[self.graph.api_uri.as_str().into(), self.key().into()]);
        }
    }
}

impl fmt::Debug for ParameterWatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ParameterWatch").field(&self.key()).finish()
    }
}
