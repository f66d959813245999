//! Lowering of TensorFlow operators, one file per family; each function writes one operator into the ONNX graph.

mod activation;
mod conv;
mod elementwise;
mod gather;
mod join;
mod matmul;
mod pad;
mod pool;
mod reduce;
mod reshape;
mod resize;
mod search;
mod shape;
mod slice;
mod window;

use opendr_engine::Result;

use super::call::Call;
use super::lowering::Lowering;
use super::value::Value;

/// A function that writes one operator and returns the values of its outputs.
pub type Lower = fn(&mut Lowering, &Call) -> Result<Vec<Value>>;

/// Returns the lowering of a TensorFlow operator; `None` for an unknown one.
pub fn lowering(op: &str) -> Option<Lower> {
    Some(match op {
        "Identity" | "StopGradient" | "Snapshot" | "PreventGradient" => {
            |_, call| Ok(vec![call.input(0)?.clone()])
        }

        "Add" | "AddV2" | "Sub" | "Mul" | "RealDiv" | "Div" | "Pow" | "Maximum" | "Minimum" | "Equal"
        | "Less" | "LessEqual" | "Greater" | "GreaterEqual" | "LogicalAnd" | "LogicalOr" => {
            elementwise::binary
        }
        "NotEqual" => elementwise::not_equal,
        "FloorDiv" => elementwise::floor_div,
        "FloorMod" => elementwise::floor_mod,
        "SquaredDifference" => elementwise::squared_difference,
        "Atan2" => elementwise::atan2,
        "AddN" => elementwise::add_n,
        "BiasAdd" => elementwise::bias_add,
        "Abs" | "Neg" | "Exp" | "Log" | "Sqrt" | "Sin" | "Cos" | "Atan" | "Floor" | "Ceil" | "Round"
        | "Erf" | "Sign" | "Reciprocal" | "LogicalNot" => elementwise::unary,
        "Square" => elementwise::square,
        "Rsqrt" => elementwise::rsqrt,
        "Cast" => elementwise::cast,
        "ClipByValue" => elementwise::clip,
        "Select" | "SelectV2" => elementwise::select,

        "Relu" | "Relu6" | "ReluN1To1" | "Relu0To1" | "HardSwish" | "Elu" | "Selu" | "Sigmoid" | "Tanh"
        | "LeakyRelu" | "Prelu" | "Softplus" | "Softmax" | "LogSoftmax" => activation::activation,

        "Conv2D" | "_FusedConv2D" => conv::conv,
        "DepthwiseConv2dNative" | "FusedDepthwiseConv2dNative" => conv::depthwise,
        "Conv2DBackpropInput" => conv::transposed,
        "MaxPool" | "AvgPool" => pool::pool,
        "MatMul" | "_FusedMatMul" => matmul::matmul,
        "BatchMatMul" | "BatchMatMulV2" => matmul::batch_matmul,
        "FusedBatchNorm" | "FusedBatchNormV2" | "FusedBatchNormV3" => conv::batch_norm,

        "Mean" | "Sum" | "Prod" | "Max" | "Min" => reduce::reduce,
        "ResizeBilinear" | "ResizeNearestNeighbor" => resize::resize,
        "DepthToSpace" => resize::depth_to_space,
        "Pad" | "PadV2" | "MirrorPad" => pad::pad,

        "Reshape" => reshape::reshape,
        "Squeeze" => reshape::squeeze,
        "ExpandDims" => reshape::expand_dims,
        "Transpose" => reshape::transpose,
        "ConcatV2" => join::concat,
        "Pack" => join::pack,
        "Tile" => join::tile,
        "StridedSlice" => slice::strided_slice,
        "Slice" => slice::slice,
        "Split" => slice::split,
        "SplitV" => slice::split_v,
        "Unpack" => slice::unpack,

        "GatherV2" => gather::gather,
        "GatherNd" => gather::gather_nd,
        "ScatterNd" => gather::scatter_nd,
        "SparseToDense" => gather::sparse_to_dense,
        "TopKV2" => search::top_k,
        "ArgMax" | "ArgMin" => search::arg,
        "Where" => search::where_true,
        "NonMaxSuppressionV3" | "NonMaxSuppressionV5" => search::non_max_suppression,

        "Shape" => shape::shape,
        "Size" => shape::size,
        "Rank" => shape::rank,
        "Fill" => shape::fill,
        "Range" => shape::range,
        "ZerosLike" | "OnesLike" => shape::filled_like,
        "BroadcastTo" => shape::broadcast_to,
        _ => return None,
    })
}
