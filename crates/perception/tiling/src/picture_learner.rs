use opendr_engine::data::Image;
use opendr_engine::learner::Learner;
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::target::Classes;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{default_threads, with_threads};

/// A learner that answers a `T` to one picture and remembers nothing, whichever it is.
pub trait PictureLearner<T>: Send + Sync {
    /// Answers `target` to `image`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn answer(&self, image: &Image, target: &mut T) -> Result<()>;

    /// What class numbers mean.
    fn classes(&self) -> Classes;
}

impl<T, L> PictureLearner<T> for L
where
    L: for<'a> Learner<Input<'a> = &'a Image, Target = T, State = ()>,
{
    fn answer(&self, image: &Image, target: &mut T) -> Result<()> {
        self.infer_into(&mut (), image, target)
    }

    fn classes(&self) -> Classes {
        Learner::classes(self)
    }
}

/// Opens a learner of a container; of the parameters it takes those that it has, and is told the rest by the container.
pub type Open<T> = fn(&Model, &ParamMap, Device) -> Result<Box<dyn PictureLearner<T>>>;

/// Opens a container as the learner `L`, as [`Open`] says.
///
/// # Errors
/// As [`Learner::load`], and `InvalidParam` where the container or `wishes` has a parameter that does not fit.
pub fn open_as<T: 'static, L>(
    model: &Model,
    wishes: &ParamMap,
    device: Device,
) -> Result<Box<dyn PictureLearner<T>>>
where
    L: for<'a> Learner<Input<'a> = &'a Image, Target = T, State = ()>,
{
    let has = |name: &str| L::Params::FIELDS.iter().any(|field| field.name == name);
    let mut params = L::Params::from_map(model.params())?;
    for (name, value) in wishes.iter().filter(|(name, _)| has(name)) {
        params.set(name, value.clone())?;
    }
    Ok(Box::new(L::load(model, params, device)?))
}

/// Opens a container with whichever of the learners `known` it is made for.
///
/// # Errors
/// `Unsupported` when it is made for another learner; else as [`Learner::load`].
pub fn open_picture_learner<T>(
    model: &Model,
    known: &[(&str, Open<T>)],
    wishes: &ParamMap,
    device: Device,
) -> Result<Box<dyn PictureLearner<T>>> {
    let learner = model.manifest().learner.as_str();
    let open = known.iter().find(|(known, _)| *known == learner).map(|(_, open)| open).ok_or_else(|| {
        let known: Vec<_> = known.iter().map(|(name, _)| *name).collect();
        Error::unsupported(format!(
            "{} is a model of {learner:?}, which cannot be used here; these can: {}",
            model.path().display(),
            known.join(", ")
        ))
    })?;
    open(model, wishes, device)
}

/// More copies of a network than this cost memory and bring nothing.
const MOST_COPIES: usize = 4;

/// Opens the part `name` of a container with whichever of the learners `known` it is made for, `copies` times (0: as often as there
/// are cores, at most four times); the copies share the cores.
///
/// # Errors
/// `Unsupported` when the part is made for another learner; else as [`Model::part`] and [`Learner::load`].
pub fn open_copies<T>(
    model: &Model,
    name: &str,
    known: &[(&str, Open<T>)],
    copies: usize,
    wishes: &ParamMap,
    device: Device,
) -> Result<Vec<Box<dyn PictureLearner<T>>>> {
    let part = model.part(name)?;
    let threads = default_threads()?;
    let copies = if copies == 0 { threads.clamp(1, MOST_COPIES) } else { copies };
    (0..copies)
        .map(|_| {
            with_threads((threads / copies).max(1), || open_picture_learner(&part, known, wishes, device))
        })
        .collect()
}
