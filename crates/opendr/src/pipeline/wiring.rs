//! Which answer goes into which port.

use opendr_engine::learner::{Output, Port};

use super::adapter::{Make, adapter};

/// Where a port's value comes from.
#[derive(Debug, Clone)]
pub(super) enum Wire {
    /// An answer of an earlier stage.
    Answer { stage: usize, output: &'static str },
    /// What is made of such an answer.
    Adapted { stage: usize, output: &'static str, make: Make },
    /// The pipeline's own input of the port's name.
    Input,
}

/// The wires of a learner's ports behind stages that answer `answered`; what nobody answers becomes an input of the
/// pipeline.
pub(super) fn wires(ports: &[Port], answered: &[Vec<Output>], inputs: &mut Vec<Port>) -> Vec<Wire> {
    let wire = |port: &Port| {
        // What begins a stream is the user's to give.
        let newest_first = || answered.iter().enumerate().rev().filter(|_| !port.init);
        let newest = newest_first().find_map(|(stage, outputs)| {
            let output = outputs.iter().find(|output| output.value_type == port.value_type)?;
            Some(Wire::Answer { stage, output: output.name })
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
    fn the_newest_answer_of_a_type_is_taken() {
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
        assert!(matches!(boxes, Wire::Answer { stage: 1, output: "kept" }), "{boxes:?}");
        assert!(matches!(skeletons, Wire::Adapted { stage: 1, output: "poses", .. }), "{skeletons:?}");
        let names: Vec<_> = inputs.iter().map(|input| input.name).collect();
        assert_eq!(names, ["image", "first", "depth"]);
    }
}
