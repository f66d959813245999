//! Native module of the Python package `opendr`.
//!
//! The module `opendr._opendr` exports the registry, learners, values, data sets, sources, environments, studies, the zoo and
//! the command; the Python files of the package build their classes on it. It depends on data and target types, never on single
//! learners. Data are Python objects that own NumPy arrays; their memory is read through raw pointers in one pass, since other
//! threads may write to it. Targets are passed as the JSON objects of `docs/json.md`, the schema of every surface. The GIL is
//! released in every long call.
//!
//! Begin with `Handle` in `handle.rs`, a learner, and with `datum.rs` and `target.rs`, the conversions of values.

mod active;
mod array;
mod bar;
mod command;
mod convert;
mod dataset;
mod datum;
mod environment;
mod error;
mod evaluate;
mod generation;
mod group;
mod handle;
mod header;
mod mask;
mod metric;
mod online;
mod param;
mod pixels;
mod plugin;
mod prior;
mod registry;
mod report;
#[cfg(feature = "ros")]
mod ros_bridge;
mod source;
mod study;
mod target;
mod zoo;

use pyo3::prelude::*;

// The module does not depend on the GIL: state shared by threads is frozen or behind a mutex.
#[pymodule(gil_used = false)]
fn _opendr(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let prefix = module.py().import("sys")?.getattr("prefix")?;
    opendr::inference::prefer_python(prefix.extract()?);
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<handle::Handle>()?;
    module.add_class::<handle::Stream>()?;
    module.add_class::<dataset::Dataset>()?;
    module.add_class::<metric::Metric>()?;
    module.add_class::<pixels::Pixels>()?;
    module.add_class::<array::NativeArray>()?;
    module.add_class::<source::Source>()?;
    module.add_class::<environment::Environment>()?;
    module.add_class::<environment::VectorEnvironment>()?;
    module.add_class::<environment::SharedArray>()?;
    module.add_class::<active::Active>()?;
    module.add_class::<online::OnlineAdapter>()?;
    module.add_class::<study::Study>()?;
    #[cfg(feature = "ros")]
    for function in [
        wrap_pyfunction!(ros_bridge::ros_message_types, module)?,
        wrap_pyfunction!(ros_bridge::value_from_ros, module)?,
        wrap_pyfunction!(ros_bridge::ros_from_value, module)?,
    ] {
        module.add_function(function)?;
    }
    for function in [
        wrap_pyfunction!(registry::entries, module)?,
        wrap_pyfunction!(environment::environments, module)?,
        wrap_pyfunction!(dataset::formats, module)?,
        wrap_pyfunction!(dataset::shuffled, module)?,
        wrap_pyfunction!(dataset::split, module)?,
        wrap_pyfunction!(evaluate::evaluate, module)?,
        wrap_pyfunction!(generation::render, module)?,
        wrap_pyfunction!(metric::metrics, module)?,
        wrap_pyfunction!(metric::metric_of, module)?,
        wrap_pyfunction!(plugin::register, module)?,
        wrap_pyfunction!(prior::priors, module)?,
        wrap_pyfunction!(prior::register_prior, module)?,
        wrap_pyfunction!(prior::register_pid, module)?,
        wrap_pyfunction!(prior::register_lqr, module)?,
        wrap_pyfunction!(active::fit_active, module)?,
        wrap_pyfunction!(plugin::check_learner, module)?,
        wrap_pyfunction!(command::main, module)?,
        wrap_pyfunction!(convert::json, module)?,
        wrap_pyfunction!(convert::value_from_json_text, module)?,
        wrap_pyfunction!(convert::readable_text, module)?,
        wrap_pyfunction!(convert::text, module)?,
        wrap_pyfunction!(convert::mot, module)?,
        wrap_pyfunction!(convert::coco, module)?,
        wrap_pyfunction!(convert::kitti, module)?,
        wrap_pyfunction!(convert::from_coco, module)?,
        wrap_pyfunction!(convert::from_mot, module)?,
        wrap_pyfunction!(convert::from_kitti, module)?,
        wrap_pyfunction!(datum::open_value, module)?,
        wrap_pyfunction!(mask::masks, module)?,
        wrap_pyfunction!(pixels::save_image, module)?,
        wrap_pyfunction!(pixels::png, module)?,
        wrap_pyfunction!(pixels::draw, module)?,
        wrap_pyfunction!(zoo::download, module)?,
        wrap_pyfunction!(zoo::sample, module)?,
        wrap_pyfunction!(zoo::models, module)?,
        wrap_pyfunction!(zoo::list_models, module)?,
        wrap_pyfunction!(zoo::runtime, module)?,
    ] {
        module.add_function(function)?;
    }
    Ok(())
}
