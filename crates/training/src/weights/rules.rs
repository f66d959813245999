//! Which weight goes where.

use opendr_engine::Result;

use crate::weights::pattern::Pattern;

/// How the weights of a file find the parameters of a module.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    by_order: bool,
    renames: Vec<Pattern>,
    only: Vec<String>,
    skip: Vec<String>,
    epsilon: f64,
}

impl Rules {
    /// A parameter takes the weight of its own name, as it is in the module: `backbone.conv.weight`. A norm's `gamma`
    /// and `beta` also answer to `weight` and `bias`.
    pub fn by_name() -> Self {
        Self { by_order: false, renames: Vec::new(), only: Vec::new(), skip: Vec::new(), epsilon: 1e-5 }
    }

    /// The layers of the file, in its order, go into the layers of the module, in the order of its fields; each pair
    /// has to agree in shape. A layer is a convolution or a dense layer, with its bias and the norm that follows.
    ///
    /// Norms that were folded into the file's convolutions become identities in the module; norms that the module
    /// lacks are folded into its convolutions. An identity has no statistics of its own: such norms have to be
    /// frozen ([`Module::freeze`](burn::module::Module::freeze)) while the network trains.
    pub fn by_order() -> Self {
        Self { by_order: true, ..Self::by_name() }
    }

    /// The same with weights called `from` named `to`; `*` stands for any text on both sides, and a prefix is taken off
    /// by `rename("module.*", "*")`. Later ones see what earlier ones made.
    #[must_use]
    pub fn rename(mut self, from: &str, to: &str) -> Self {
        self.renames.push(Pattern::new(from, to));
        self
    }

    /// The same for the part of the module called `path` alone; several times, for several parts.
    #[must_use]
    pub fn only(mut self, path: &str) -> Self {
        self.only.push(path.to_owned());
        self
    }

    /// The same without the part of the module called `path`.
    #[must_use]
    pub fn skip(mut self, path: &str) -> Self {
        self.skip.push(path.to_owned());
        self
    }

    /// The same with what is added to a norm's variance; the default is 1e-5.
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

    /// Whether a parameter is to get a weight at all.
    pub(super) fn cover(&self, parameter: &str) -> bool {
        let within = |path: &String| {
            parameter.strip_prefix(path.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        (self.only.is_empty() || self.only.iter().any(within)) && !self.skip.iter().any(within)
    }

    pub(super) fn check(&self) -> Result<()> {
        self.renames.iter().try_for_each(Pattern::check)
    }

    /// What a weight is called after all renamings.
    pub(super) fn renamed(&self, name: &str) -> String {
        self.renames.iter().fold(name.to_owned(), |name, pattern| pattern.renamed(&name).unwrap_or(name))
    }
}
