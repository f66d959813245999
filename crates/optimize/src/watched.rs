//! Sessions with inner tensors as outputs.

use opendr_engine::{Device, Result};
use opendr_inference::recording::Recording;
use opendr_inference::{Session, TensorView};
use opendr_onnx::bytes_from_model;
use opendr_onnx::proto::{
    DataType, GraphProto, ModelProto, TensorType, TypeProto, TypeValue, ValueInfoProto,
};

/// A session with inner tensors as outputs.
pub struct Watched {
    session: Session,
    /// Index of each observed tensor among the outputs.
    places: Vec<usize>,
}

impl Watched {
    /// Opens `model` with its graph replaced by `graph` and with the float tensors `names` as outputs.
    ///
    /// # Errors
    /// Those of [`Session::open`].
    pub fn open(model: &ModelProto, graph: &GraphProto, names: &[String], device: Device) -> Result<Self> {
        let mut graph = graph.clone();
        for name in names {
            if !graph.output.iter().any(|output| output.name == *name) {
                let tensor = TensorType { elem_type: DataType::Float as i32, shape: None };
                let value = Some(TypeValue::Tensor(tensor));
                graph.output.push(ValueInfoProto {
                    name: name.clone(),
                    r#type: Some(TypeProto { value, ..TypeProto::default() }),
                    ..ValueInfoProto::default()
                });
            }
        }
        let model = ModelProto { graph: Some(graph), ..model.clone() };
        let session = Session::open(&bytes_from_model(&model), device)?;
        let places = names.iter().map(|name| session.output_index(name)).collect::<Result<_>>()?;
        Ok(Self { session, places })
    }

    /// Runs on a recording; `see` receives the index of each tensor in `names`, and its elements.
    ///
    /// # Errors
    /// Those of [`Session::run`].
    pub fn run(&self, recording: &Recording, mut see: impl FnMut(usize, &[f32])) -> Result<()> {
        let inputs =
            recording.tensors.iter().map(|tensor| tensor.view()).collect::<Result<Vec<TensorView<'_>>>>()?;
        self.session.run(&inputs, |outputs| {
            for (at, place) in self.places.iter().enumerate() {
                if let Some(output) = outputs.get(*place) {
                    see(at, output.values()?);
                }
            }
            Ok(())
        })
    }
}
