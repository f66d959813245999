//! Transposed convolutions beside their definition: each input pixel adds its multiple of the kernel.

use opendr_executor::{Data, Executor, Tensor};
use opendr_kernels::Compute;
use opendr_onnx::{Array, Builder, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph};

struct Case {
    batch: usize,
    groups: usize,
    inputs: usize,
    outputs: usize,
    input: [usize; 2],
    kernel: [usize; 2],
    strides: [usize; 2],
    dilations: [usize; 2],
    pads: [usize; 4],
    extra: [usize; 2],
}

impl Case {
    fn output(&self, axis: usize) -> Option<usize> {
        let whole = (self.input[axis] - 1) * self.strides[axis]
            + (self.kernel[axis] - 1) * self.dilations[axis]
            + 1
            + self.extra[axis];
        whole.checked_sub(self.pads[axis] + self.pads[axis + 2]).filter(|&size| size > 0)
    }

    fn by_definition(
        &self,
        x: &[f32],
        weights: &[f32],
        bias: &[f32],
        [height, width]: [usize; 2],
    ) -> Vec<f32> {
        let (channels, all) = (self.groups * self.inputs, self.groups * self.outputs);
        let mut y = vec![0.0; self.batch * all * height * width];
        for image in 0..self.batch {
            for (output, &bias) in bias.iter().enumerate() {
                let plane = (image * all + output) * height * width;
                y[plane..plane + height * width].fill(bias);
                let group = output / self.outputs;
                for input in group * self.inputs..(group + 1) * self.inputs {
                    for iy in 0..self.input[0] {
                        for ix in 0..self.input[1] {
                            let x = x[((image * channels + input) * self.input[0] + iy) * self.input[1] + ix];
                            for ky in 0..self.kernel[0] {
                                for kx in 0..self.kernel[1] {
                                    let oy = iy * self.strides[0] + ky * self.dilations[0];
                                    let ox = ix * self.strides[1] + kx * self.dilations[1];
                                    let (Some(oy), Some(ox)) =
                                        (oy.checked_sub(self.pads[0]), ox.checked_sub(self.pads[1]))
                                    else {
                                        continue;
                                    };
                                    if oy < height && ox < width {
                                        let weight = (input * self.outputs + output % self.outputs)
                                            * self.kernel[0]
                                            * self.kernel[1]
                                            + ky * self.kernel[1]
                                            + kx;
                                        y[plane + oy * width + ox] += x * weights[weight];
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
        y
    }

    /// Builds `relu(conv_transpose(x) + r)`.
    fn model(&self, weights: &[f32], bias: &[f32], size: [usize; 2]) -> Vec<u8> {
        let dims = |channels: usize, [height, width]: [usize; 2]| {
            vec![Some(self.batch), Some(channels), Some(height), Some(width)]
        };
        let constant = |shape: Vec<usize>, data: &[f32]| {
            GraphTensor::constant(Array::new(shape, opendr_onnx::Data::Float(data.to_vec())).unwrap())
        };
        let mut graph = Builder::default();
        let (channels, all) = (self.groups * self.inputs, self.groups * self.outputs);
        let x = graph.input("x", ElementType::Float, dims(channels, self.input), &[]);
        let r = graph.input("r", ElementType::Float, dims(all, size), &[]);
        let weights = constant(vec![channels, self.outputs, self.kernel[0], self.kernel[1]], weights);
        let ints = |values: &[usize]| values.iter().map(|&value| value as i64).collect::<Vec<_>>();
        let operator = Operator::new("ConvTranspose")
            .int("group", self.groups as i64)
            .ints("strides", ints(&self.strides))
            .ints("dilations", ints(&self.dilations))
            .ints("pads", ints(&self.pads))
            .ints("output_padding", ints(&self.extra));
        let bias = constant(vec![all], bias);
        let y =
            graph.add("y", operator, &[&x, &weights, &bias], ElementType::Float, dims(all, size)).unwrap();
        let sum =
            graph.add("s", Operator::new("Add"), &[&y, &r], ElementType::Float, dims(all, size)).unwrap();
        let relu =
            graph.add("a", Operator::new("Relu"), &[&sum], ElementType::Float, dims(all, size)).unwrap();
        graph.output("out", &relu, "", &[]).unwrap();
        bytes_from_model(&model_from_graph(graph.finish("transposed")))
    }
}

#[test]
fn transposed_convolutions_equal_their_definition() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut below = |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit
    };
    let mut compared = 0;
    for _ in 0..400 {
        let strides = [below(3) + 1, below(3) + 1];
        let case = Case {
            batch: below(2) + 1,
            groups: [1, 1, 2, 3][below(4)],
            inputs: below(9) + 1,
            outputs: [1, 3, 8, 16, 21][below(5)],
            input: [below(6) + 1, below(7) + 1],
            kernel: [below(5) + 1, below(5) + 1],
            strides,
            dilations: [below(3) + 1, below(2) + 1],
            pads: [below(4), below(4), below(4), below(4)],
            extra: [below(strides[0]), below(strides[1])],
        };
        let (Some(height), Some(width)) = (case.output(0), case.output(1)) else { continue };
        let mut numbers =
            |count: usize| (0..count).map(|_| below(2001) as f32 / 1000.0 - 1.0).collect::<Vec<_>>();
        let (channels, all) = (case.groups * case.inputs, case.groups * case.outputs);
        let x = numbers(case.batch * channels * case.input[0] * case.input[1]);
        let weights = numbers(channels * case.outputs * case.kernel[0] * case.kernel[1]);
        let (bias, r) = (numbers(all), numbers(case.batch * all * height * width));
        let mut wanted = case.by_definition(&x, &weights, &bias, [height, width]);
        wanted.iter_mut().zip(&r).for_each(|(y, r)| *y = (*y + r).max(0.0));
        for threads in [1, 2] {
            let compute = Compute::with_threads(threads);
            let model = case.model(&weights, &bias, [height, width]);
            let mut executor = Executor::open(&model, compute).unwrap();
            let inputs = [
                Tensor { shape: &[case.batch, channels, case.input[0], case.input[1]], data: Data::F32(&x) },
                Tensor { shape: &[case.batch, all, height, width], data: Data::F32(&r) },
            ];
            let run = executor.run(&inputs, &mut |outputs| {
                let Data::F32(y) = outputs[0].data else { panic!("{outputs:?}") };
                assert_eq!(y.len(), wanted.len());
                let error = y.iter().zip(&wanted).map(|(y, wanted)| (y - wanted).abs()).fold(0.0, f32::max);
                assert!(
                    error < 2e-4,
                    "{error}: strides {:?}, dilations {:?}, kernel {:?}, pads {:?}, input {:?}",
                    case.strides,
                    case.dilations,
                    case.kernel,
                    case.pads,
                    case.input
                );
                Ok(())
            });
            run.unwrap();
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}
