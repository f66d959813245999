//! Conversion of `Constant` nodes to initializers.

use crate::proto::GraphProto;

/// Converts each `Constant` with a tensor to an initializer of the same name.
pub fn constants_to_initializers(graph: &mut GraphProto) {
    let initializers = &mut graph.initializer;
    graph.node.retain_mut(|node| {
        let [output] = node.output.as_slice() else { return true };
        if node.op_type != "Constant" || !node.domain.is_empty() {
            return true;
        }
        let tensor = node.attribute.iter_mut().find(|attribute| attribute.name == "value");
        let Some(mut tensor) = tensor.and_then(|attribute| attribute.t.take()) else { return true };
        tensor.name.clone_from(output);
        initializers.push(tensor);
        false
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Array;
    use crate::proto::{AttributeProto, NodeProto};

    #[test]
    fn only_tensors_are_moved() {
        let constant = |name: &str, t| NodeProto {
            op_type: "Constant".to_owned(),
            output: vec![name.to_owned()],
            attribute: vec![AttributeProto { name: "value".to_owned(), t, ..AttributeProto::default() }],
            ..NodeProto::default()
        };
        let node = vec![constant("a", Array::scalar(2.0).to_tensor("x").ok()), constant("b", None)];
        let mut graph = GraphProto { node, ..GraphProto::default() };
        constants_to_initializers(&mut graph);
        assert_eq!((graph.node.len(), graph.node[0].output[0].as_str()), (1, "b"));
        assert_eq!((graph.initializer.len(), graph.initializer[0].name.as_str()), (1, "a"));
    }
}
