//! Parts of graphs.

use super::dead_nodes::remove_unneeded;
use crate::proto::GraphProto;

/// Reduces a graph to what computes the outputs named `outputs`. Values named `values`, which are outputs of the graph, become inputs
/// after the graph's own; inputs that nothing reads are removed. Names that the graph lacks have no effect.
///
/// ```
/// use opendr_onnx::{Builder, ElementType, Operator, passes::reduce_to_outputs};
///
/// let mut graph = Builder::default();
/// let [a, b] = ["a", "b"].map(|name| graph.input(name, ElementType::Float, vec![Some(1)], &[]));
/// let half = graph.add("half", Operator::new("Relu"), &[&a], ElementType::Float, vec![Some(1)])?;
/// let sum = graph.add("sum", Operator::new("Add"), &[&half, &b], ElementType::Float, vec![Some(1)])?;
/// graph.output("half", &half, "", &[])?;
/// graph.output("sum", &sum, "", &[])?;
/// let mut graph = graph.finish("example");
/// reduce_to_outputs(&mut graph, &[], &["half"]);
/// assert_eq!([graph.input.len(), graph.output.len()], [1, 1]);
/// # Ok::<(), opendr_engine::Error>(())
/// ```
pub fn reduce_to_outputs(graph: &mut GraphProto, values: &[&str], outputs: &[&str]) {
    let cut: Vec<_> =
        graph.output.iter().filter(|info| values.contains(&info.name.as_str())).cloned().collect();
    for node in &mut graph.node {
        // An output without a name is one that nothing reads.
        node.output.iter_mut().filter(|name| values.contains(&name.as_str())).for_each(String::clear);
    }
    graph.input.extend(cut);
    graph.output.retain(|info| outputs.contains(&info.name.as_str()));
    let needed = remove_unneeded(graph);
    graph.input.retain(|info| needed.contains(&info.name));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proto::{NodeProto, ValueInfoProto};

    fn node(kind: &str, inputs: &[&str], output: &str) -> NodeProto {
        let input = inputs.iter().map(|name| (*name).to_owned()).collect();
        NodeProto { op_type: kind.to_owned(), input, output: vec![output.to_owned()], ..NodeProto::default() }
    }

    #[test]
    fn values_become_inputs() {
        let infos = |names: &[&str]| {
            let info = |name: &&str| ValueInfoProto { name: (*name).to_owned(), ..ValueInfoProto::default() };
            names.iter().map(info).collect::<Vec<_>>()
        };
        let graph = GraphProto {
            node: vec![node("Relu", &["a"], "l"), node("Abs", &["b"], "r"), node("Add", &["l", "r"], "s")],
            input: infos(&["a", "b"]),
            output: infos(&["l", "r", "s"]),
            ..GraphProto::default()
        };
        let names = |graph: &GraphProto| {
            let inputs: Vec<_> = graph.input.iter().map(|info| info.name.clone()).collect();
            let kinds: Vec<_> = graph.node.iter().map(|node| node.op_type.clone()).collect();
            (inputs.join(" "), kinds.join(" "))
        };
        let reduced = |values: &[&str], outputs: &[&str]| {
            let mut graph = graph.clone();
            reduce_to_outputs(&mut graph, values, outputs);
            names(&graph)
        };
        assert_eq!(reduced(&[], &["l"]), ("a".into(), "Relu".into()));
        assert_eq!(reduced(&["l"], &["s"]), ("b l".into(), "Abs Add".into()));
        assert_eq!(reduced(&["l", "r"], &["s"]), ("l r".into(), "Add".into()));
        assert_eq!(reduced(&["none"], &["other"]), (String::new(), String::new()));
    }
}
