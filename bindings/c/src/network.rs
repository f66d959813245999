//! Networks without their learners: tensors in, tensors out.

use std::ffi::{CString, c_char};
use std::fs;
use std::path::Path;

use opendr::inference::{ElementType, Session, TensorInfo, TensorView};
use opendr::{Device, Error, Model, Result, ResultExt};

use crate::handle::{self, Held, Out};
use crate::learner::{Loaded, opendr_learner};
use crate::pointer::{optional_text, path, place, slice};
use crate::status::{guard, guard_value, opendr_status};
use crate::string::{Text, opendr_string};
use crate::tensors::{Tensors, opendr_tensor, opendr_tensors};

/// A network; runs from several threads are serialised.
pub struct opendr_network(());

/// The declaration of an input or output of a network; valid as long as the network.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_tensor_info {
    /// Name within the network.
    pub name: *const c_char,
    /// Length of each axis; 0 for a dynamic axis.
    pub shape: *const usize,
    /// Number of axes; 0 for a single number, and where the network does not declare them.
    pub axes: usize,
}

struct Network {
    session: Session,
    inputs: Vec<Declared>,
    outputs: Vec<Declared>,
    manifest: String,
}

impl Held for Network {
    const NAME: &'static str = "opendr_network";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRnetwk");
}

/// A [`TensorInfo`] in the form of C.
struct Declared {
    name: CString,
    shape: Vec<usize>,
}

impl From<&TensorInfo> for Declared {
    fn from(info: &TensorInfo) -> Self {
        Self {
            name: CString::new(info.name.replace('\0', "\u{fffd}")).unwrap_or_default(),
            shape: info.dims.iter().map(|size| size.unwrap_or(0)).collect(),
        }
    }
}

impl Network {
    /// Opens an ONNX file, or one of a container.
    fn of_path(path: &Path, file: Option<&str>, device: Device) -> Result<Self> {
        let is_onnx = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("onnx"));
        if !is_onnx {
            return Self::of_model(&Model::open(path)?, file, device);
        }
        if let Some(file) = file {
            return Err(Error::invalid_input(format!(
                "{} is an ONNX file and has no file {file:?}; give NULL for it",
                path.display()
            )));
        }
        let network = fs::read(path).context(|| path.display().to_string())?;
        Self::of_bytes(&network, "{}".to_owned(), device).context(|| path.display().to_string())
    }

    fn of_model(model: &Model, file: Option<&str>, device: Device) -> Result<Self> {
        let network = match file {
            Some(file) => model.file(file)?,
            None => opendr::network(model)?,
        };
        let manifest = String::from_utf8_lossy(&model.manifest().to_json()?).into_owned();
        Self::of_bytes(&network, manifest, device)
    }

    fn of_bytes(network: &[u8], manifest: String, device: Device) -> Result<Self> {
        let session = Session::open(network, device)?;
        if let Some(other) = session.inputs().iter().find(|input| input.element_type != ElementType::F32) {
            return Err(Error::unsupported(format!(
                "the network takes {other}, and opendr_network_run() supports only floats; use its learner"
            )));
        }
        let declared = |infos: &[TensorInfo]| infos.iter().map(Declared::from).collect();
        let (inputs, outputs) = (declared(session.inputs()), declared(session.outputs()));
        Ok(Self { session, inputs, outputs, manifest })
    }

    /// # Safety
    /// The same as for [`handle::held`].
    unsafe fn of<'a>(network: *const opendr_network) -> Result<&'a Self> {
        // SAFETY: the caller's promise.
        unsafe { handle::held(network, "network") }
    }

    /// # Safety
    /// The pointers of the tensors are valid.
    unsafe fn run(&self, given: &[opendr_tensor]) -> Result<Tensors> {
        let infos = self.session.inputs();
        let mut views: Vec<Option<TensorView<'_>>> = vec![None; infos.len()];
        for (index, tensor) in given.iter().enumerate() {
            // SAFETY: the caller's promise.
            let (name, view) =
                unsafe { (optional_text(tensor.name, "the name of an input")?, tensor.view()?) };
            let at = match name {
                Some(name) => infos.iter().position(|info| info.name == name),
                None => Some(index),
            };
            let view_of_input = at.and_then(|at| views.get_mut(at)).ok_or_else(|| {
                let name = name.map_or_else(|| format!("number {index}"), |name| format!("{name:?}"));
                let names: Vec<_> = infos.iter().map(ToString::to_string).collect();
                Error::invalid_input(format!(
                    "the network has no input {name}; it takes {}",
                    names.join(", ")
                ))
            })?;
            if view_of_input.replace(view).is_some() {
                return Err(Error::invalid_input(format!(
                    "input {} is given twice; give it once",
                    name.unwrap_or("without a name")
                )));
            }
        }
        let views = views.iter().zip(infos).map(|(view, info)| {
            view.ok_or_else(|| Error::invalid_input(format!("input {info} is missing; give a tensor for it")))
        });
        let views: Vec<_> = views.collect::<Result<_>>()?;
        let mut tensors = Tensors::default();
        self.session.run(&views, |outputs| {
            for (declared, output) in self.outputs.iter().zip(outputs) {
                tensors.add(declared.name.clone(), output)?;
            }
            Ok(())
        })?;
        Ok(tensors)
    }
}

/// Opens a network without its learner. path is an ONNX file (*.onnx) or a model container: a folder, its JSON (OpenDR's
/// too) or a zip.
///
/// file is the ONNX file within a container, e.g. "encoder.onnx" or "detector/model.onnx"; NULL selects the only one. device
/// is "cpu", "cuda:0", ...; NULL selects the best available. Returns OPENDR_UNSUPPORTED for a network with inputs of other
/// types than float.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_open(
    path: *const c_char,
    file: *const c_char,
    device: *const c_char,
    network: *mut *mut opendr_network,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, path, file, device) = unsafe {
            (
                Out::new(network, "network")?,
                self::path(path, "path")?,
                optional_text(file, "file")?,
                optional_text(device, "device")?.unwrap_or("auto"),
            )
        };
        out.set(Network::of_path(path, file, device.parse()?)?);
        Ok(())
    })
}

/// Opens the network of a loaded learner again, on the learner's device, to run it without the learner's pre- and
/// post-processing. file is the same as for opendr_network_open(); the learner may be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_learner_network(
    learner: *const opendr_learner,
    file: *const c_char,
    network: *mut *mut opendr_network,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, loaded, file) =
            unsafe { (Out::new(network, "network")?, Loaded::of(learner)?, optional_text(file, "file")?) };
        let learner = loaded.lock();
        let model = learner.model().ok_or_else(|| {
            Error::not_found(format!("{} has no model; load or train one", loaded.entry.spec.class))
        })?;
        out.set(Network::of_model(model, file, learner.device())?);
        Ok(())
    })
}

/// Runs a network. Each input is given once, by its name or, where that is NULL, by its position. tensors receives the outputs
/// in the network's order, which must be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_run(
    network: *const opendr_network,
    inputs: *const opendr_tensor,
    input_count: usize,
    tensors: *mut *mut opendr_tensors,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, network, inputs) = unsafe {
            (Out::new(tensors, "tensors")?, Network::of(network)?, slice(inputs, input_count, "inputs")?)
        };
        // SAFETY: the rules at the top of opendr.h.
        out.set(unsafe { network.run(inputs) }?);
        Ok(())
    })
}

/// Returns the number of the network's inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_input_count(network: *const opendr_network) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || Ok(unsafe { Network::of(network) }?.inputs.len()))
}

/// Returns the number of the network's outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_output_count(network: *const opendr_network) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || Ok(unsafe { Network::of(network) }?.outputs.len()))
}

/// Writes the declaration of the network's input index into info.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_input(
    network: *const opendr_network,
    index: usize,
    info: *mut opendr_tensor_info,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { declared(&Network::of(network)?.inputs, index, info) })
}

/// Writes the declaration of the network's output index into info.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_output(
    network: *const opendr_network,
    index: usize,
    info: *mut opendr_tensor_info,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { declared(&Network::of(network)?.outputs, index, info) })
}

/// # Safety
/// `info` is null or may be written to.
unsafe fn declared(all: &[Declared], index: usize, info: *mut opendr_tensor_info) -> Result<()> {
    let place = place(info, "info")?;
    let Declared { name, shape } = all.get(index).ok_or_else(|| {
        Error::invalid_input(format!("tensor {index} is out of range; there are {} tensors", all.len()))
    })?;
    let info = opendr_tensor_info { name: name.as_ptr(), shape: shape.as_ptr(), axes: shape.len() };
    // SAFETY: the caller's promise.
    unsafe { place.write(info) };
    Ok(())
}

/// Writes the model.json of the network's container as JSON ("learner", "params", "classes", "inputs", ...), which must be
/// freed; "{}" for an ONNX file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_manifest(
    network: *const opendr_network,
    json: *mut *mut opendr_string,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, network) = unsafe { (Out::new(json, "json")?, Network::of(network)?) };
        out.set(Text::new(network.manifest.as_str()));
        Ok(())
    })
}

/// Frees the network and sets the variable to NULL; does nothing if it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_network_free(network: *mut *mut opendr_network) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Network, _>(network, "network") })
}
