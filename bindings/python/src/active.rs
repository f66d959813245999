//! Active perception of Python: recognisers, rigs and runs, and the training on a data set and in environments at once.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use opendr::active::rig::RigOptions;
use opendr::active::{
    Active as Loop, ActiveContainer, ActiveModel, EpisodeStrip, Outcome, ViewRecogniser, logarithms,
    write_evidence,
};
use opendr::data::Image;
use opendr::model::Model;
use opendr::rig::{Achieved, Limit, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr::target::{Action, ActionBase as _};
use opendr::{Error, Result};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::bar::PythonBar;
use crate::dataset::{GivenDataset, type_of, types_of_ports};
use crate::environment::GivenEnvironments;
use crate::error::{ToPython, error_from_exception};
use crate::handle::{Handle, options_from_json};
use crate::param::params_from_python;
use crate::pixels::{image_from_python, python_from_image};
use crate::report::json_of;
use crate::target::target_from_python;

/// A recogniser with a camera policy. Runs from several threads are serialised.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Active {
    active: Mutex<Loop<Box<dyn ViewRecogniser>>>,
}

#[pymethods]
impl Active {
    /// Makes a recogniser active: a handle, or a function from an image to a target or to class probabilities, with its number of
    /// classes. The camera policy is another handle, the path of a model, or `None` for a handle that has its own.
    #[new]
    fn new(
        py: Python<'_>,
        recogniser: &Bound<'_, PyAny>,
        camera_policy: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let policy = camera_policy.map(camera_policy_from_python).transpose()?;
        let active = match recogniser.cast::<Handle>() {
            Ok(handle) => {
                let handle = handle.get();
                let make = || {
                    handle.with_learner(|learner| Loop::of_learner(learner, handle.entry(), policy.as_ref()))
                };
                py.detach(make).to_python(py)?
            }
            Err(_) => {
                let (function, classes): (Py<PyAny>, usize) = recogniser.extract()?;
                let missing = || {
                    Error::invalid_param(
                        "a function has no camera policy; give one as camera_policy, trained by ActiveObjectRecognitionLearner.fit",
                    )
                };
                let model = policy.ok_or_else(missing).to_python(py)?;
                let recogniser: Box<dyn ViewRecogniser> = Box::new(Function { function, classes });
                Loop::new(recogniser, &model).to_python(py)?
            }
        };
        Ok(Self { active: Mutex::new(active) })
    }

    /// Moves a rig until the class is certain. `rig` is a name, an image or an object; `options` are those of named rigs. Returns the
    /// images of the views, and the run as JSON; with `out`, writes the views side by side into this file, for .gif and .mp4 as a video.
    fn run<'py>(
        &self,
        py: Python<'py>,
        rig: &Bound<'py, PyAny>,
        options: &Bound<'py, PyDict>,
        out: Option<PathBuf>,
    ) -> PyResult<(Bound<'py, PyList>, String)> {
        let rig = GivenRig::from_python(rig, options)?;
        let run = || -> Result<(Outcome, String)> {
            let mut active = self.active.lock().unwrap_or_else(PoisonError::into_inner);
            let outcome = active.run(rig.open()?.as_mut())?;
            if let Some(out) = out {
                EpisodeStrip::of(&outcome)?.save(&out)?;
            }
            let json = json_of(&outcome)?;
            Ok((outcome, json))
        };
        let (outcome, json) = py.detach(run).to_python(py)?;
        let images = outcome.views.into_iter().map(|view| python_from_image(py, view.image));
        Ok((PyList::new(py, images.collect::<PyResult<Vec<_>>>()?)?, json))
    }
}

/// Converts a camera policy: the handle of a learner of active perception, or the path of its model.
fn camera_policy_from_python(policy: &Bound<'_, PyAny>) -> PyResult<ActiveModel> {
    let py = policy.py();
    let container = match policy.cast::<Handle>() {
        Ok(handle) => {
            let handle = handle.get();
            py.detach(|| handle.with_learner(ActiveContainer::of))
        }
        Err(_) => {
            let path: PathBuf = policy.extract()?;
            py.detach(|| ActiveContainer::read(&Model::open(path)?))
        }
    };
    container.map(|container| container.model).to_python(py)
}

/// A recogniser that is a Python function.
struct Function {
    function: Py<PyAny>,
    classes: usize,
}

impl ViewRecogniser for Function {
    fn classes(&self) -> usize {
        self.classes
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        Python::attach(|py| {
            let mut call = || -> PyResult<()> {
                let returned = self.function.bind(py).call1((python_from_image(py, image.clone())?,))?;
                if type_of(&returned).is_ok() {
                    let target = target_from_python(&returned)?;
                    let written = write_evidence(&target, evidence);
                    let kind = target.as_value_ref().value_type().name();
                    let refused = || {
                        Error::invalid_input(format!(
                            "the recogniser returns {kind}, which has no classes; return a Category or class probabilities"
                        ))
                    };
                    return written.then_some(()).ok_or_else(refused).to_python(py);
                }
                let probabilities: Vec<f32> =
                    returned.try_iter()?.map(|number| number?.extract()).collect::<PyResult<_>>()?;
                probabilities_to_evidence(&probabilities, evidence).to_python(py)
            };
            call().map_err(|raised| error_from_exception(py, raised))
        })
    }
}

/// Largest difference of a sum of probabilities from 1: that of half-precision numbers.
const TOLERANCE: f32 = 0.01;

/// Writes the logarithms of class probabilities.
fn probabilities_to_evidence(probabilities: &[f32], evidence: &mut [f32]) -> Result<()> {
    let sum: f32 = probabilities.iter().sum();
    let in_range = probabilities.iter().all(|probability| (0.0..=1.0 + TOLERANCE).contains(probability));
    if probabilities.len() != evidence.len() || !in_range || (sum - 1.0).abs() > TOLERANCE {
        return Err(Error::invalid_input(format!(
            "the recogniser returns {} numbers with the sum {sum}; return the probabilities of all {} classes, whose sum is 1",
            probabilities.len(),
            evidence.len()
        )));
    }
    evidence.copy_from_slice(probabilities);
    logarithms(evidence);
    Ok(())
}

/// The rig argument of a run.
enum GivenRig {
    Named(String, RigOptions),
    InImage(Image, RigOptions),
    Object(Box<PythonRig>),
}

impl GivenRig {
    /// Accepts a name (an environment, an index of recorded views, or an image file), an `Image`, or an object with `axes`, `move` and
    /// `capture`. Options of named rigs are `env_params`, `seed` and `field_of_view`, each absent or `None` by default.
    fn from_python(rig: &Bound<'_, PyAny>, options: &Bound<'_, PyDict>) -> PyResult<Self> {
        let option = |name: &str| options.get_item(name).map(|value| value.filter(|value| !value.is_none()));
        let params = match option("env_params")? {
            Some(params) => params_from_python(params.cast::<PyDict>()?)?,
            None => Default::default(),
        };
        let seed = option("seed")?.map(|seed| seed.extract()).transpose()?;
        let field_of_view = option("field_of_view")?.map(|field| field.extract()).transpose()?;
        let options = RigOptions { params, seed, field_of_view };
        if let Ok(name) = rig.extract::<String>() {
            return Ok(Self::Named(name, options));
        }
        if rig.hasattr("_pixels")? {
            return image_from_python(rig, Vec::new()).map(|image| Self::InImage(image, options));
        }
        if options != RigOptions::default() {
            let refused = Err(Error::invalid_param(
                "env_params, seed and field_of_view are for rigs that are given by name; omit them for a rig of your own",
            ));
            return refused.to_python(rig.py());
        }
        PythonRig::new(rig).map(|rig| Self::Object(Box::new(rig)))
    }

    fn open(self) -> Result<Box<dyn ViewRig>> {
        match self {
            Self::Named(name, options) => options.open(&name),
            Self::InImage(image, options) => options.in_image(image),
            Self::Object(rig) => Ok(rig),
        }
    }
}

/// A rig that is a Python object.
struct PythonRig {
    rig: Py<PyAny>,
    /// Whether the object states its pose; else that of the motions counts.
    states_pose: bool,
    sphere: ViewSphere,
}

impl PythonRig {
    /// Reads axes and pose of the object.
    fn new(rig: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = rig.py();
        let rows: Vec<(String, f64, f64, f64, bool)> = rig.getattr("axes")?.extract()?;
        let axes: Vec<_> = rows
            .into_iter()
            .map(|(name, step, low, high, wraps)| ViewAxis { name, step, low, high, wraps })
            .collect();
        let states_pose = rig.hasattr("pose")?;
        let begin = match states_pose {
            true => pose_of(rig)?,
            // As of a stream without poses: the middle of the distances.
            false => ViewPose {
                distance: axes.get(2).map_or(1.0, |axis| 0.5 * (axis.low + axis.high)),
                ..ViewPose::default()
            },
        };
        let sphere = ViewSphere::new(axes, begin).to_python(py)?;
        Ok(Self { rig: rig.clone().unbind(), states_pose, sphere })
    }

    /// Calls `work` with the object.
    fn with<T>(&self, work: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<T>) -> Result<T> {
        Python::attach(|py| work(self.rig.bind(py)).map_err(|raised| error_from_exception(py, raised)))
    }
}

/// Reads the attribute `pose`: azimuth, elevation, distance and, for rigs of four axes, the fourth.
fn pose_of(rig: &Bound<'_, PyAny>) -> PyResult<ViewPose> {
    let numbers: Vec<f64> =
        rig.getattr("pose")?.try_iter()?.map(|number| number?.extract()).collect::<PyResult<_>>()?;
    let (pose, rest) = match numbers[..] {
        [azimuth, elevation, distance] => ([azimuth, elevation, distance], 0.0),
        [azimuth, elevation, distance, fourth] => ([azimuth, elevation, distance], fourth),
        _ => {
            let refused = Err(Error::invalid_input(format!(
                "the rig's pose has {} numbers; give azimuth (rad), elevation (rad), distance and, for rigs of four axes, the fourth",
                numbers.len()
            )));
            return refused.to_python(rig.py());
        }
    };
    let [azimuth, elevation, distance] = pose;
    Ok(ViewPose { azimuth, elevation, distance, fourth: rest })
}

impl ViewRig for PythonRig {
    fn axes(&self) -> &[ViewAxis] {
        self.sphere.axes()
    }

    fn pose(&self) -> ViewPose {
        self.sphere.pose()
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        let before = self.sphere.pose();
        let mut achieved = self.sphere.apply(action)?;
        let carried = self.with(|rig| {
            let returned = rig.call_method1("move", (action.axes().to_vec(),))?;
            if returned.is_none() {
                return Ok(None);
            }
            returned.try_iter()?.map(|axis| axis?.extract()).collect::<PyResult<Vec<f32>>>().map(Some)
        })?;
        if let Some(carried) = carried {
            let carried = carried_out(&carried, &achieved.action)?;
            for (at, (own, possible)) in carried.axes().iter().zip(achieved.action.axes()).enumerate() {
                if own != possible {
                    achieved.limits[at].get_or_insert(Limit::Blocked);
                }
            }
            achieved.action = carried;
            self.sphere.place(before)?;
            self.sphere.apply(&carried)?;
        }
        if self.states_pose {
            let pose = self.with(pose_of)?;
            self.sphere.place(pose)?;
        }
        Ok(Achieved { pose: self.sphere.pose(), ..achieved })
    }

    fn capture(&mut self) -> Result<Image> {
        self.with(|rig| {
            let captured = rig.call_method0("capture")?;
            let convert = rig.py().import("opendr._input_value")?.getattr("input_value")?;
            image_from_python(&convert.call1((captured, "the image of capture()", "Image"))?, Vec::new())
        })
    }
}

/// Returns the motion that a rig carried out.
fn carried_out(axes: &[f32], possible: &Action) -> Result<Action> {
    match Action::new(axes) {
        Ok(action) if axes.len() == possible.axes().len() => Ok(action),
        _ => Err(Error::invalid_input(format!(
            "move() returns {axes:?}; return the deflections that were carried out, {} in [-1, 1], or None for all",
            possible.axes().len()
        ))),
    }
}

/// Trains a learner of active perception: the recogniser on a data set, the camera policy in environments. `options` are JSON. Returns
/// the report as JSON and as text.
#[pyfunction]
pub fn fit_active(
    py: Python<'_>,
    learner: &Bound<'_, Handle>,
    dataset: &Bound<'_, PyAny>,
    env: &Bound<'_, PyAny>,
    options: &str,
    silent: bool,
) -> PyResult<(String, String)> {
    let handle = learner.get();
    let mut options = options_from_json(options).to_python(py)?;
    opendr::check_fit(handle.entry(), &options.params).to_python(py)?;
    let ports: Vec<_> = handle.entry().ports.iter().filter(|port| !port.optional).copied().collect();
    let dataset = GivenDataset::from_python(dataset, &types_of_ports(&ports))?;
    options.name = Some(dataset.name());
    let env = GivenEnvironments::from_python(env)?;
    PythonBar::new(silent).run(py, |bar| {
        let fitted = handle.with_learner_mut(|learner| {
            opendr::fit_active(learner, handle.entry(), dataset.as_ref(), &env, &options, bar)
        })?;
        Ok((json_of(&fitted)?, fitted.to_string()))
    })
}
