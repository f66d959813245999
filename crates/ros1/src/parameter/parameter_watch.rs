//! Handles of watched parameters.

use std::fmt;
use std::sync::Arc;

use opendr_engine::Result;

use super::watch::{Changed, Watch};
use crate::ParameterValue;
use crate::graph::Graph;
use crate::lock::lock;
use crate::name::canonical;

/// Notifies every watch of `key` or of a namespace that contains it.
pub(crate) fn notify(graph: &Graph, key: &str, value: &ParameterValue) {
    let key = canonical(key);
    let watches: Vec<_> = lock(&graph.watches).clone();
    for watch in watches.iter().filter(|watch| watch.contains(&key)) {
        watch.notify(&graph.context, &key, value);
    }
}

/// Handle of a watched parameter; dropping it ends the watch.
pub struct ParameterWatch {
    graph: Arc<Graph>,
    watch: Arc<Watch>,
}

impl ParameterWatch {
    pub(crate) fn new(graph: &Arc<Graph>, key: &str, changed: Changed) -> Result<(Self, ParameterValue)> {
        let watch = Arc::new(Watch::new(key, changed));
        let mut watches = lock(&graph.watches);
        graph.context.check_running()?;
        watches.push(Arc::clone(&watch));
        drop(watches);
        let handle = Self { graph: Arc::clone(graph), watch };
        let value = handle.watch.register(&graph.context)?;
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
            let context = &self.graph.context;
            context.unregister("unsubscribeParam", &[context.api_uri.as_str().into(), self.key().into()]);
        }
    }
}

impl fmt::Debug for ParameterWatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ParameterWatch").field(&self.key()).finish()
    }
}
