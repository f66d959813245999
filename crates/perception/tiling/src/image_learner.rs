use opendr_engine::data::Image;
use opendr_engine::learner::Learner;
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::target::Classes;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{default_threads, with_threads};

/// A learner of one image with predictions `T` and without state, as a trait object.
pub trait ImageLearner<T>: Send + Sync {
    /// Writes the prediction for `image` into `target`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn predict_into(&self, image: &Image, target: &mut T) -> Result<()>;

    /// Returns the names of the classes.
    fn classes(&self) -> Classes;
}

impl<T, L> ImageLearner<T> for L
where
    L: for<'a> Learner<Input<'a> = &'a Image, Target = T, State = ()>,
{
    fn predict_into(&self, image: &Image, target: &mut T) -> Result<()> {
        self.infer_into(&mut (), image, target)
    }

    fn classes(&self) -> Classes {
        Learner::classes(self)
    }
}

/// Function that opens a learner of a container. It sets those of the given parameters that the learner has; the others are
/// the container's.
pub type Open<T> = fn(&Model, &ParamMap, Device) -> Result<Box<dyn ImageLearner<T>>>;

/// Opens a container as the learner `L`; an [`Open`] function.
///
/// # Errors
/// As [`Learner::load`], and `InvalidParam` when the container or `overrides` has an invalid parameter.
pub fn open_as<T: 'static, L>(
    model: &Model,
    overrides: &ParamMap,
    device: Device,
) -> Result<Box<dyn ImageLearner<T>>>
where
    L: for<'a> Learner<Input<'a> = &'a Image, Target = T, State = ()>,
{
    let has = |name: &str| L::Params::FIELDS.iter().any(|field| field.name == name);
    let mut params = L::Params::from_map(model.params())?;
    for (name, value) in overrides.iter().filter(|(name, _)| has(name)) {
        params.set(name, value.clone())?;
    }
    Ok(Box::new(L::load(model, params, device)?))
}

/// Opens a container with the learner of `known` that its manifest names.
///
/// # Errors
/// `Unsupported` when it belongs to another learner; else as [`Learner::load`].
pub fn open_image_learner<T>(
    model: &Model,
    known: &[(&str, Open<T>)],
    overrides: &ParamMap,
    device: Device,
) -> Result<Box<dyn ImageLearner<T>>> {
    let learner = model.manifest().learner.as_str();
    let open = known.iter().find(|(known, _)| *known == learner).map(|(_, open)| open).ok_or_else(|| {
        let known: Vec<_> = known.iter().map(|(name, _)| *name).collect();
        Error::unsupported(format!(
            "{} is a model of {learner:?}, which is not supported here; give a model of one of {}",
            model.path().display(),
            known.join(", ")
        ))
    })?;
    open(model, overrides, device)
}

/// Maximum number of copies by default; more cost memory without gain.
const MOST_COPIES: usize = 4;

/// Opens the part `name` of a container with the learner of `known` that its manifest names, `copies` times (0: the number
/// of cores, at most four). The copies share the cores.
///
/// # Errors
/// `Unsupported` when the part belongs to another learner; else as [`Model::part`] and [`Learner::load`].
pub fn open_copies<T>(
    model: &Model,
    name: &str,
    known: &[(&str, Open<T>)],
    copies: usize,
    overrides: &ParamMap,
    device: Device,
) -> Result<Vec<Box<dyn ImageLearner<T>>>> {
    let part = model.part(name)?;
    let threads = default_threads()?;
    let copies = if copies == 0 { threads.clamp(1, MOST_COPIES) } else { copies };
    (0..copies)
        .map(|_| {
            with_threads((threads / copies).max(1), || open_image_learner(&part, known, overrides, device))
        })
        .collect()
}
