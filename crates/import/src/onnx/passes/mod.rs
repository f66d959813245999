//! Rewrites of finished graphs. Each leaves the results as they were, up to rounding.

mod dead_nodes;
mod identity;
mod links;

pub use dead_nodes::remove_dead_nodes;
pub use identity::remove_identities;
pub use links::Links;

use super::proto::GraphProto;

/// All rewrites, in an order in which one prepares the next.
pub fn simplify(graph: &mut GraphProto) {
    remove_identities(graph);
    remove_dead_nodes(graph);
}
