//! Rules that assign weights to parameters.

use opendr_engine::Result;

use crate::weights::pattern::Pattern;

/// Rules that assign the weights of a file to the parameters of a module.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    by_order: bool,
    renames: Vec<Pattern>,
    only: Vec<String>,
    skip: Vec<String>,
    epsilon: f64,
}

impl Rules {
    /// Creates rules by name: a parameter takes the weight of its own path in the module, such as `backbone.conv.weight`. The
    /// `gamma` and `beta` of a normalisation also match `weight` and `bias`.
    pub fn by_name() -> Self {
        Self { by_order: false, renames: Vec::new(), only: Vec::new(), skip: Vec::new(), epsilon: 1e-5 }
    }

    /// Creates rules by order: the layers of the file, in its order, are assigned to the layers of the module, in the order of
    /// its fields; each pair must agree in shape. A layer is a convolution or a linear layer, with its bias and the
    /// normalisation after it.
    ///
    /// Normalisations that were folded into the file's convolutions become identities in the module; normalisations that the
    /// module lacks are folded into its convolutions. An identity has no statistics: such normalisations must be frozen
    /// ([`Module::freeze`](burn::module::Module::freeze)) while the network trains.
    pub fn by_order() -> Self {
        Self { by_order: true, ..Self::by_name() }
    }

    /// Renames weights from `from` to `to`; `*` matches any text on both sides, so `rename("module.*", "*")` removes a prefix.
    /// Later renames apply to the results of earlier ones.
    #[must_use]
    pub fn rename(mut self, from: &str, to: &str) -> Self {
        self.renames.push(Pattern::new(from, to));
        self
    }

    /// Restricts the rules to the part `path` of the module; may be repeated for several parts.
    #[must_use]
    pub fn only(mut self, path: &str) -> Self {
        self.only.push(path.to_owned());
        self
    }

    /// Excludes the part `path` of the module.
    #[must_use]
    pub fn skip(mut self, path: &str) -> Self {
        self.skip.push(path.to_owned());
        self
    }

    /// Sets the epsilon of the normalisations' variance; the default is 1e-5.
    #[must_use]
    pub fn norm_epsilon(self, epsilon: f64) -> Self {
        Self { epsilon, ..self }
    }

    pub(super) fn is_by_order(&self) -> bool {
        self.by_order
    }

    pub(super) fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// Whether a parameter gets a weight.
    pub(super) fn cover(&self, parameter: &str) -> bool {
        let within = |path: &String| {
            parameter.strip_prefix(path.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        (self.only.is_empty() || self.only.iter().any(within)) && !self.skip.iter().any(within)
    }

    pub(super) fn check(&self) -> Result<()> {
        self.renames.iter().try_for_each(Pattern::check)
    }

    /// Returns the name of a weight after all renames.
    pub(super) fn renamed(&self, name: &str) -> String {
        self.renames.iter().fold(name.to_owned(), |name, pattern| pattern.renamed(&name).unwrap_or(name))
    }
}
