//! Wiring of predictions to ports.

use opendr_engine::learner::{Output, Port};

use super::adapter::Make;
use super::adapters::adapter;

/// Source of a port's value.
#[derive(Debug, Clone)]
pub(super) enum Wire {
    /// A prediction of an earlier stage.
    Prediction { stage: usize, output: &'static str },
    /// A converted prediction of an earlier stage.
    Adapted { stage: usize, output: &'static str, make: Make },
    /// The input of the pipeline with the name of the port.
    Input,
}

/// Returns the sources of a learner's ports after stages with the outputs `predicted`. A port without a prediction is added to the
/// `inputs` of the pipeline.
pub(super) fn wires(ports: &[Port], predicted: &[Vec<Output>], inputs: &mut Vec<Port>) -> Vec<Wire> {
    let wire = |port: &Port| {
        // Init ports are always inputs of the pipeline.
        let newest_first = || predicted.iter().enumerate().rev().filter(|_| !port.init);
        let newest = newest_first().find_map(|(stage, outputs)| {
            let output = outputs.iter().find(|output| output.value_type == port.value_type)?;
            Some(Wire::Prediction { stage, output: output.name })
        });
        let made = || {
            newest_first().find_map(|(stage, outputs)| {
                let of = |output: &Output| Some((output.name, adapter(output.value_type, port.value_type)?));
                let (output, make) = outputs.iter().find_map(of)?;
                Some(Wire::Adapted { stage, output, make })
            })
        };
        newest.or_else(made).unwrap_or_else(|| {
            if !inputs.iter().any(|input| input.name == port.name) {
                inputs.push(*port);
            }
            Wire::Input
        })
    };
    ports.iter().map(wire).collect()
}

#[cfg(test)]
#[cfg(feature = "actions")]
mod tests {
    use opendr_engine::ValueType;

    use super::*;

    const fn port(name: &'static str, value_type: ValueType, init: bool) -> Port {
        Port { name, doc: "", value_type, optional: false, init }
    }

    const fn output(name: &'static str, value_type: ValueType) -> Output {
        Output { name, doc: "", value_type }
    }

    #[test]
    fn the_newest_prediction_of_a_type_is_used() {
        let detector = vec![output("detections", ValueType::BoundingBoxList)];
        let filter = vec![output("poses", ValueType::PoseList), output("kept", ValueType::BoundingBoxList)];
        let mut inputs = vec![port("image", ValueType::Image, false)];
        let ports = [
            port("image", ValueType::Image, false),
            port("boxes", ValueType::BoundingBoxList, false),
            port("first", ValueType::BoundingBoxList, true),
            port("depth", ValueType::Heatmap, false),
            port("skeletons", ValueType::SkeletonSequence, false),
        ];
        let found = wires(&ports, &[detector, filter], &mut inputs);
        let [Wire::Input, boxes, Wire::Input, Wire::Input, skeletons] = &found[..] else {
            panic!("{found:?}")
        };
        assert!(matches!(boxes, Wire::Prediction { stage: 1, output: "kept" }), "{boxes:?}");
        assert!(matches!(skeletons, Wire::Adapted { stage: 1, output: "poses", .. }), "{skeletons:?}");
        let names: Vec<_> = inputs.iter().map(|input| input.name).collect();
        assert_eq!(names, ["image", "first", "depth"]);
    }
}
