//! Pre-processing allocates nothing after the first frames, on any thread.
//!
//! A separate test binary: allocations of other threads count, so no other test may run beside it.

use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_test_allocator::{CountingAllocator, allocations};
use opendr_vision::{LetterboxAlign, Preprocess};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn a_stream_of_frames_allocates_nothing() {
    let camera = Image::from_rgb8(vec![9; 640 * 480 * 3], 640, 480).unwrap();
    let planes = Image::new(vec![9u8; 64 * 48 * 3], 64, 48, PixelFormat::Bgr, Layout::Chw).unwrap();
    let stretched = Preprocess::new(320, 320);
    let letterboxed = Preprocess::new(192, 192).letterbox(LetterboxAlign::Centre, 0.0).layout(Layout::Hwc);
    let mut floats = vec![0f32; stretched.len()];
    let mut bytes = vec![0u8; letterboxed.len()];
    let mut frame = |number: usize| {
        let crop = camera.view().crop(number % 300, number % 200, 340 - number % 50, 280).unwrap();
        for view in [camera.view(), planes.view(), crop] {
            stretched.run_into(view, &mut floats).unwrap();
            stretched.with_size(96, 128).run_into(view, &mut floats[..96 * 128 * 3]).unwrap();
            letterboxed.run_into(view, &mut bytes).unwrap();
        }
    };
    (0..50).for_each(&mut frame);
    // The minimum over five streams, since the test runner's main thread may allocate meanwhile.
    let streams = (0..5).map(|_| {
        let before = allocations();
        (50..100).for_each(&mut frame);
        allocations() - before
    });
    assert_eq!(streams.min(), Some(0));
}
