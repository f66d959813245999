//! Affine quantisation: `real = (integer - zero_point) * scale`.

use opendr_engine::{Error, Result};
use opendr_onnx::{Array, Data, ElementType, GraphTensor, Operator};

use super::element::Element;
use super::flatbuffer::Table;
use crate::tensorflow::{Lowering, Value};

/// Quantisation parameters of a tensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantisation {
    element: Element,
    scales: Vec<f32>,
    zero_points: Vec<i64>,
    /// Axis with one scale per position, for several scales.
    axis: usize,
}

impl Quantisation {
    /// Reads the parameters; `None` for a tensor that is not quantised.
    ///
    /// # Errors
    /// `Format` for inconsistent parameters, `Unsupported` for element types that ONNX cannot quantise.
    pub fn of(table: &Table, element: Element, rank: usize) -> Result<Option<Self>> {
        let scales = table.floats(2)?;
        if scales.is_empty() || matches!(element, Element::Float32 | Element::Float16 | Element::Bool) {
            return Ok(None);
        }
        let mut zero_points = table.longs(3)?;
        if zero_points.is_empty() {
            zero_points.push(0);
        }
        let axis = usize::try_from(table.int(6, 0)?).ok().filter(|&axis| scales.len() == 1 || axis < rank);
        let range = match element {
            Element::Int8 => -128..=127,
            Element::UInt8 => 0..=255,
            Element::Int32 => 0..=0,
            other => {
                return Err(Error::unsupported(format!("a quantised tensor of {other:?} is not supported")));
            }
        };
        let sound = scales.iter().all(|scale| scale.is_finite() && *scale > 0.0)
            && zero_points.iter().all(|zero| range.contains(zero))
            && (zero_points.len() == 1 || zero_points.len() == scales.len());
        match axis.filter(|_| sound) {
            Some(axis) => Ok(Some(Self { element, scales, zero_points, axis })),
            None => Err(Error::format(format!(
                "a quantised tensor has {} scales and {} zero points that do not match",
                scales.len(),
                zero_points.len()
            ))),
        }
    }

    /// Returns scale and zero point as inputs of ONNX's operators; sums have no zero point.
    fn parameters(&self) -> Result<Vec<GraphTensor>> {
        let several = self.scales.len() > 1;
        let dims = if several { vec![self.scales.len()] } else { Vec::new() };
        let zeros = (0..self.scales.len()).map(|i| self.zero_points.get(i).or(self.zero_points.first()));
        let zeros = zeros.map(|zero| zero.copied().unwrap_or(0));
        let zeros = match self.element {
            Element::Int8 => Some(Data::Int8(zeros.map(|zero| zero as i8).collect())),
            Element::UInt8 => Some(Data::UInt8(zeros.map(|zero| zero as u8).collect())),
            _ => None,
        };
        let mut arrays = vec![Array::new(dims.clone(), Data::Float(self.scales.clone()))];
        arrays.extend(zeros.map(|zeros| Array::new(dims, zeros)));
        let wires = arrays.into_iter().map(|array| array.map(GraphTensor::constant));
        wires.collect::<Option<_>>().ok_or_else(|| Error::internal("the scales have the wrong shape"))
    }

    fn operator(&self, name: &'static str, axis: usize) -> Operator {
        let operator = Operator::new(name);
        if self.scales.len() > 1 { operator.int("axis", axis as i64) } else { operator }
    }

    /// Returns the dequantised values of `stored`; its axes are the tensor's in the order `axes`.
    ///
    /// # Errors
    /// `Format` when there is not one scale per position of the axis.
    pub fn dequantised(
        &self,
        ctx: &mut Lowering,
        name: &str,
        stored: &GraphTensor,
        axes: &[usize],
    ) -> Result<GraphTensor> {
        let axis = axes.iter().position(|&axis| axis == self.axis).unwrap_or(0);
        let positions = stored.dims().get(axis).copied().flatten();
        if self.scales.len() > 1 && positions.is_some_and(|count| count != self.scales.len()) {
            return Err(Error::format(format!(
                "{} scales do not match {positions:?} positions",
                self.scales.len()
            )));
        }
        let parameters = self.parameters()?;
        let inputs: Vec<&GraphTensor> = std::iter::once(stored).chain(&parameters).collect();
        let operator = self.operator("DequantizeLinear", axis);
        ctx.graph.add(name, operator, &inputs, ElementType::Float, stored.dims().to_vec())
    }

    /// Rounds `value` to the nearest quantised values.
    ///
    /// # Errors
    /// Those of [`Quantisation::dequantised`].
    pub fn rounded(&self, ctx: &mut Lowering, name: &str, value: &Value) -> Result<Value> {
        if self.element == Element::Int32 {
            return Ok(value.clone());
        }
        if self.scales.len() > 1 && self.axis >= value.rank() {
            return Err(Error::format(format!(
                "scales on axis {} do not match rank {}",
                self.axis,
                value.rank()
            )));
        }
        let parameters = self.parameters()?;
        let inputs: Vec<&GraphTensor> = std::iter::once(&value.wire).chain(&parameters).collect();
        let operator = self.operator("QuantizeLinear", value.order.stored(self.axis));
        let dims = value.wire.dims().to_vec();
        let stored = ctx.graph.add(name, operator, &inputs, ElementType::Int, dims)?;
        let wire = self.dequantised(ctx, name, &stored, value.order.axes())?;
        Ok(Value::new(wire, value.order.clone()))
    }

    /// Returns whether the limits of the integers already have the effect of this activation.
    pub fn includes(&self, activation: &str) -> bool {
        let (low, high) = match self.element {
            Element::Int8 => (-128, 127),
            Element::UInt8 => (0, 255),
            _ => return false,
        };
        let ([scale], [zero]) = (self.scales.as_slice(), self.zero_points.as_slice()) else { return false };
        let starts_at_zero = *zero == low;
        match activation {
            "Relu" => starts_at_zero,
            "Relu6" => starts_at_zero && (6.0 / scale).round() as i64 + zero >= high,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantisation(element: Element, scale: f32, zero: i64) -> Quantisation {
        Quantisation { element, scales: vec![scale], zero_points: vec![zero], axis: 0 }
    }

    #[test]
    fn a_range_that_ends_at_six_includes_the_clipping() {
        let exact = quantisation(Element::UInt8, 6.0 / 255.0, 0);
        assert!(exact.includes("Relu") && exact.includes("Relu6") && !exact.includes("Tanh"));
        let wide = quantisation(Element::Int8, 0.05, -128);
        assert!(wide.includes("Relu") && !wide.includes("Relu6"));
        assert!(!quantisation(Element::Int8, 0.01, 0).includes("Relu"));
    }
}
