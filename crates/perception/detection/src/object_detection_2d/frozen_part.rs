//! Choice of the layers that a detector does not train.

opendr_engine::choices! {
    /// Layers that do not train.
    pub enum FrozenPart {
        /// All layers train.
        None = "none",
        /// The backbone is frozen; no gradient is computed for it.
        Backbone = "backbone",
        /// Backbone and pyramid are frozen; only the heads train, in a third of the time.
        Features = "features",
    }
}
