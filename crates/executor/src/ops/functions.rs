//! Functions of one number that networks need rarely: compiled loops without kernels of their own.

use opendr_engine::Result;
use opendr_kernels::Number;
use opendr_onnx::proto::NodeProto;

use super::inputs::required;
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Planner};
use crate::tensor::Kind;

/// Numbers per piece of work.
const PIECE: usize = 1 << 13;

struct FunctionStep<F, T>(F, std::marker::PhantomData<fn() -> T>);

impl<T: Number + Send, F: Fn(f32) -> T + Send + Sync> Kernel for FunctionStep<F, T> {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<T>());
        io.compute.pool().run_on_pieces(y, PIECE, |index, y| {
            let x = &x[index * PIECE..][..y.len()];
            y.iter_mut().zip(x).for_each(|(y, &x)| *y = self.0(x));
        });
        Ok(())
    }
}

/// Applies a node of one input of floats to each element.
pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let number = |key: &str, default: f32| node.float(key, default);
    macro_rules! emit {
        ($function:expr) => {
            emit(planner, node, x, Kind::F32, $function)
        };
    }
    let y = match node.op_type.as_str() {
        "Acos" => emit!(f32::acos),
        "Acosh" => emit!(f32::acosh),
        "Asin" => emit!(f32::asin),
        "Asinh" => emit!(f32::asinh),
        "Atan" => emit!(f32::atan),
        "Atanh" => emit!(f32::atanh),
        "Ceil" => emit!(f32::ceil),
        "Celu" => {
            let alpha = number("alpha", 1.0);
            emit!(move |x| if x > 0.0 { x } else { alpha * (x / alpha).exp_m1() })
        }
        "Cos" => emit!(f32::cos),
        "Cosh" => emit!(f32::cosh),
        "Elu" => {
            let alpha = number("alpha", 1.0);
            emit!(move |x| if x >= 0.0 { x } else { alpha * x.exp_m1() })
        }
        "Floor" => emit!(f32::floor),
        "IsInf" => {
            let [low, high] = ["detect_negative", "detect_positive"].map(|key| node.int_or(key, 1) != 0);
            let is = move |x: f32| u8::from(x.is_infinite() && if x > 0.0 { high } else { low });
            emit(planner, node, x, Kind::Bool, is)
        }
        "IsNaN" => emit(planner, node, x, Kind::Bool, |x| u8::from(x.is_nan())),
        "Log" => emit!(f32::ln),
        "Mish" => emit!(|x| x * softplus(x).tanh()),
        "Round" => emit!(f32::round_ties_even),
        "Selu" => {
            let (alpha, gamma) = (number("alpha", 1.673_263_2), number("gamma", 1.050_701));
            emit!(move |x| gamma * if x > 0.0 { x } else { alpha * x.exp_m1() })
        }
        "Shrink" => {
            let (limit, bias) = (number("lambd", 0.5), number("bias", 0.0));
            emit!(move |x| match () {
                () if x < -limit => x + bias,
                () if x > limit => x - bias,
                () => 0.0,
            })
        }
        "Sign" => emit!(|x| if x.is_nan() || x == 0.0 { x } else { x.signum() }),
        "Sin" => emit!(f32::sin),
        "Sinh" => emit!(f32::sinh),
        "Softplus" => emit!(softplus),
        "Softsign" => emit!(|x| x / (1.0 + x.abs())),
        "Swish" => {
            let alpha = number("alpha", 1.0);
            emit!(move |x| x / (1.0 + (-alpha * x).exp()))
        }
        "Tan" => emit!(f32::tan),
        "ThresholdedRelu" => {
            let alpha = number("alpha", 1.0);
            emit!(move |x| if x > alpha { x } else { 0.0 })
        }
        _ => return Err(node.refused("it is not known")),
    }?;
    Ok(vec![y])
}

/// Adds the tanh approximation of GELU.
pub(crate) fn gelu_by_tanh(planner: &mut Planner<'_>, node: &NodeProto, x: Id) -> Result<Id> {
    let factor = std::f32::consts::FRAC_2_SQRT_PI * std::f32::consts::FRAC_1_SQRT_2;
    emit(planner, node, x, Kind::F32, move |x: f32| {
        0.5 * x * (1.0 + (factor * (x + 0.044_715 * x * x * x)).tanh())
    })
}

fn emit<T: Number + Send>(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    x: Id,
    kind: Kind,
    function: impl Fn(f32) -> T + Send + Sync + 'static,
) -> Result<Id> {
    let value = planner.value(x).clone();
    if value.kind != Kind::F32 {
        return Err(node.refused(&format!("elements of type {:?}", value.kind)));
    }
    let step = FunctionStep(function, std::marker::PhantomData);
    planner.emit_one(step, &[x], kind, value.shape, value.layout)
}

/// `ln(1 + exp(x))`, without overflow.
fn softplus(x: f32) -> f32 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}
