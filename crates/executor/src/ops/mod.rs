//! The operators: each builds the steps of a node whose input shapes are known.

mod attention;
mod broadcast;
mod bytes;
mod cast;
mod concat;
mod conv;
mod conv_integer;
mod conv_transpose;
mod dynamic_quantize;
mod einsum;
mod elementwise;
mod functions;
mod fusion;
mod gemm;
mod grid_sample;
mod groups;
mod index;
mod inputs;
mod lines;
mod matmul;
mod matmul_integer;
mod movement;
mod non_zero;
mod normalise;
mod pool;
mod quantize;
mod recurrent;
mod reduce;
mod resize;
mod reverse_sequence;
mod rotary;
mod scatter;
mod shape;
mod suppression;
mod top_k;

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::planner::{Id, Planner};

pub(crate) type Build = fn(&mut Planner<'_>, &NodeProto, &[Option<Id>]) -> Result<Vec<Id>>;

/// Computes the outputs of a node from its inputs.
pub(crate) type Host = fn(&NodeProto, &[Option<&Constant>]) -> Result<Vec<Constant>>;

/// How an operator runs.
pub(crate) enum Operator {
    /// As steps of a plan.
    Steps(Build),
    /// On tensors: the shapes of its outputs depend on their elements.
    Host(Host),
    If,
    Loop,
}

/// Operators that run on tensors, by name.
const HOSTS: &[(&str, Host)] =
    &[("NonMaxSuppression", suppression::non_max_suppression), ("NonZero", non_zero::non_zero)];

/// Operators with graphs.
const CONTROL: &[&str] = &["If", "Loop"];

/// Operators and what builds their steps, by name.
const OPERATORS: &[(&str, Build)] = &[
    ("Abs", elementwise::unary),
    ("Acos", functions::build),
    ("Acosh", functions::build),
    ("Add", elementwise::binary),
    ("And", elementwise::binary),
    ("ArgMax", reduce::arg),
    ("ArgMin", reduce::arg),
    ("Asin", functions::build),
    ("Asinh", functions::build),
    ("Atan", functions::build),
    ("Atanh", functions::build),
    ("Attention", attention::build),
    ("AveragePool", pool::pool),
    ("BatchNormalization", normalise::batch),
    ("Cast", cast::cast),
    ("CastLike", cast::cast_like),
    ("Ceil", functions::build),
    ("Celu", functions::build),
    ("Clip", elementwise::clip),
    ("Concat", concat::concat),
    ("Constant", shape::constant),
    ("ConstantOfShape", shape::constant_of_shape),
    ("Conv", conv::conv),
    ("ConvInteger", conv_integer::build),
    ("ConvTranspose", conv_transpose::build),
    ("Cos", functions::build),
    ("Cosh", functions::build),
    ("CumSum", lines::cumulative_sum),
    ("DepthToSpace", movement::depth_to_space),
    ("DequantizeLinear", quantize::dequantize),
    ("Div", elementwise::binary),
    ("Dropout", shape::identity),
    ("DynamicQuantizeLinear", dynamic_quantize::build),
    ("Einsum", einsum::build),
    ("Elu", functions::build),
    ("Equal", elementwise::binary),
    ("Erf", elementwise::unary),
    ("Exp", elementwise::unary),
    ("Expand", movement::expand),
    ("EyeLike", lines::eye_like),
    ("Flatten", shape::flatten),
    ("Floor", functions::build),
    ("GRU", recurrent::gru),
    ("Gather", index::gather),
    ("GatherElements", index::gather_elements),
    ("GatherND", index::gather_nd),
    ("Gelu", elementwise::unary),
    ("Gemm", gemm::build),
    ("GlobalAveragePool", pool::global),
    ("GlobalMaxPool", pool::global),
    ("Greater", elementwise::binary),
    ("GreaterOrEqual", elementwise::binary),
    ("GridSample", grid_sample::build),
    ("GroupNormalization", groups::group),
    ("HardSigmoid", elementwise::unary),
    ("HardSwish", elementwise::unary),
    ("Identity", shape::identity),
    ("InstanceNormalization", groups::group),
    ("IsInf", functions::build),
    ("IsNaN", functions::build),
    ("LSTM", recurrent::lstm),
    ("LayerNormalization", normalise::layer),
    ("LeakyRelu", elementwise::unary),
    ("Less", elementwise::binary),
    ("LessOrEqual", elementwise::binary),
    ("Log", functions::build),
    ("LogSoftmax", normalise::softmax),
    ("LpNormalization", groups::lp),
    ("MatMul", matmul::matmul),
    ("MatMulInteger", matmul_integer::build),
    ("Max", elementwise::variadic),
    ("MaxPool", pool::pool),
    ("Mean", elementwise::variadic),
    ("Min", elementwise::variadic),
    ("Mish", functions::build),
    ("Mod", elementwise::binary),
    ("Mul", elementwise::binary),
    ("Neg", elementwise::unary),
    ("Not", elementwise::not),
    ("OneHot", lines::one_hot),
    ("Or", elementwise::binary),
    ("PRelu", elementwise::prelu),
    ("Pad", movement::pad),
    ("Pow", elementwise::binary),
    ("QuantizeLinear", quantize::quantize),
    ("RMSNormalization", groups::root_mean_square),
    ("Range", shape::range),
    ("Reciprocal", elementwise::unary),
    ("ReduceL1", reduce::reduce),
    ("ReduceL2", reduce::reduce),
    ("ReduceLogSum", reduce::reduce),
    ("ReduceLogSumExp", reduce::reduce),
    ("ReduceMax", reduce::reduce),
    ("ReduceMean", reduce::reduce),
    ("ReduceMin", reduce::reduce),
    ("ReduceProd", reduce::reduce),
    ("ReduceSum", reduce::reduce),
    ("ReduceSumSquare", reduce::reduce),
    ("Relu", elementwise::unary),
    ("Reshape", shape::reshape),
    ("Resize", resize::resize),
    ("ReverseSequence", reverse_sequence::build),
    ("RotaryEmbedding", rotary::build),
    ("Round", functions::build),
    ("Scatter", scatter::elements),
    ("ScatterElements", scatter::elements),
    ("ScatterND", scatter::nd),
    ("Selu", functions::build),
    ("Shape", shape::shape),
    ("Shrink", functions::build),
    ("Sigmoid", elementwise::unary),
    ("Sign", functions::build),
    ("Sin", functions::build),
    ("Sinh", functions::build),
    ("Size", shape::size),
    ("Slice", movement::slice),
    ("Softmax", normalise::softmax),
    ("Softplus", functions::build),
    ("Softsign", functions::build),
    ("SpaceToDepth", movement::depth_to_space),
    ("Split", movement::split),
    ("Sqrt", elementwise::unary),
    ("Squeeze", shape::squeeze),
    ("Sub", elementwise::binary),
    ("Sum", elementwise::variadic),
    ("Swish", functions::build),
    ("Tan", functions::build),
    ("Tanh", elementwise::unary),
    ("ThresholdedRelu", functions::build),
    ("Tile", movement::tile),
    ("TopK", top_k::top_k),
    ("Transpose", movement::transpose),
    ("Trilu", lines::triangle),
    ("Unsqueeze", shape::unsqueeze),
    ("Upsample", resize::resize),
    ("Where", elementwise::select),
    ("Xor", elementwise::binary),
];

/// Returns the names of the operators that the executor runs, in alphabetical order.
pub fn supported_operators() -> impl Iterator<Item = &'static str> {
    let hosts = HOSTS.iter().map(|(name, _)| *name);
    let mut names: Vec<&str> = OPERATORS.iter().map(|(name, _)| *name).chain(hosts).collect();
    names.extend(CONTROL);
    names.sort_unstable();
    names.into_iter()
}

/// Returns how an operator runs; `None` where the executor lacks it.
pub(crate) fn operator(name: &str) -> Option<Operator> {
    if let Some((_, build)) = OPERATORS.iter().find(|(operator, _)| *operator == name) {
        return Some(Operator::Steps(*build));
    }
    if let Some((_, host)) = HOSTS.iter().find(|(operator, _)| *operator == name) {
        return Some(Operator::Host(*host));
    }
    match name {
        "If" => Some(Operator::If),
        "Loop" => Some(Operator::Loop),
        _ => None,
    }
}

pub(crate) fn is_supported(name: &str) -> bool {
    operator(name).is_some()
}

/// Builds the steps of a node of quantised values, which computes with their bytes; `None` where it does not.
pub(crate) fn build_on_bytes(planner: &mut Planner<'_>, node: &NodeProto) -> Result<Option<Vec<Id>>> {
    let is_quantised = node.input.iter().any(|name| planner.deferred(name).is_some());
    if !is_quantised || node.output.len() != 1 {
        return Ok(None);
    }
    match node.op_type.as_str() {
        "Add" => bytes::sum::build(planner, node),
        "ArgMax" | "ArgMin" => bytes::labels(planner, node),
        "AveragePool" | "GlobalAveragePool" => bytes::pool::build(planner, node),
        "Conv" => bytes::conv::build(planner, node),
        "QuantizeLinear" => bytes::table::build(planner, node),
        "Resize" => bytes::resize::build(planner, node),
        _ => Ok(None),
    }
}

/// Builds the steps of a node and returns its outputs.
pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let Some(Operator::Steps(build)) = operator(&node.op_type) else {
        return Err(node.refused("it is not known"));
    };
    let used = node.output.iter().rposition(|name| !name.is_empty()).map_or(0, |last| last + 1);
    let outputs = build(planner, node, inputs)?;
    if outputs.len() < used {
        return Err(node.refused("one of its outputs"));
    }
    Ok(outputs)
}
