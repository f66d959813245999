//! Training allocates nothing after the first step.

use opendr_kernels::{
    Activation, Adam, AdamOptions, Compute, Conv2d, Dense, Gru, GruTape, Layer, Network, Tape,
    clip_gradient_norm,
};
use opendr_test_allocator::{CountingAllocator, allocations_of_thread};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn steps_after_the_first_allocate_nothing() {
    let picture = Conv2d::new([1, 12, 12], 4, [3, 3], [2, 2], [1, 1], Activation::Relu).unwrap();
    let network = Network::new(vec![
        Layer::Conv2d(picture),
        Layer::Dense(Dense::new(picture.outputs(), 64, Activation::Tanh).unwrap()),
        Layer::Dense(Dense::new(64, 3, Activation::Identity).unwrap()),
    ])
    .unwrap();
    let gru = Gru::new(3, 8).unwrap();
    let compute = Compute::single();
    let (mut tape, mut gru_tape) = (Tape::default(), GruTape::default());
    let (mut parameters, gru_parameters) = (vec![0.01; network.parameters()], vec![0.01; gru.parameters()]);
    let (mut gradients, mut gru_gradients) = (vec![0.0; network.parameters()], vec![0.0; gru.parameters()]);
    let mut adam = Adam::new(network.parameters(), AdamOptions::default());
    let (x, dy) = (vec![0.5; 32 * network.inputs()], vec![0.1; 32 * 3]);
    let (state, starts, dstates) = (vec![0.0; 4 * 8], vec![false; 32], vec![0.1; 32 * 8]);
    let mut step = || {
        let y = network.forward(&compute, &parameters, &x, &mut tape);
        gru.forward(&compute, &gru_parameters, y, &state, &starts, &mut gru_tape);
        gru.backward(
            &compute,
            &gru_parameters,
            &starts,
            &dstates,
            &mut gru_tape,
            &mut gru_gradients,
            None,
            None,
        );
        network.backward(&compute, &parameters, &dy, &mut tape, Some(&mut gradients), true);
        clip_gradient_norm(&mut [&mut gradients], 0.5);
        adam.step(&compute, 1e-3, &mut parameters, &gradients);
    };
    step();
    // One thread computes; the test runner's main thread may allocate meanwhile.
    let before = allocations_of_thread();
    (0..5).for_each(|_| step());
    assert_eq!(allocations_of_thread() - before, 0);
}
