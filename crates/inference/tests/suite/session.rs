//! Checks, sharing between threads, timing, and the absence of allocations in a session.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use opendr_engine::{Error, ErrorKind, Result};
use opendr_inference::{Element, ElementType, Engine, Session, Sink, TensorInfo, TensorView, timing};
use opendr_test_allocator::allocations_of_thread;

/// An engine that adds one to each element, in two outputs.
struct AddOne {
    infos: [TensorInfo; 3],
    sum: Vec<f32>,
}

static RUNNING: AtomicUsize = AtomicUsize::new(0);

impl AddOne {
    fn session() -> Session {
        let info = |name: &str, dims: &[Option<usize>]| TensorInfo {
            name: name.into(),
            element_type: ElementType::F32,
            dims: dims.to_vec(),
        };
        let infos = [info("x", &[Some(1), None]), info("y", &[Some(1), None]), info("z", &[Some(1), None])];
        Session::from_engine(Box::new(Self { infos, sum: Vec::with_capacity(1000) }))
    }
}

impl Engine for AddOne {
    fn inputs(&self) -> &[TensorInfo] {
        &self.infos[..1]
    }

    fn outputs(&self) -> &[TensorInfo] {
        &self.infos[1..]
    }

    fn run(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<()> {
        let input = inputs[0].values::<f32>()?;
        self.sum.clear();
        self.sum.extend(input.iter().map(|value| value + 1.0));
        let output = TensorView::new(inputs[0].shape(), &self.sum)?;
        sink(&[output, output])
    }
}

fn view<T: Element>(elements: &[T]) -> TensorView<'_> {
    TensorView::new(&[1, elements.len()], elements).unwrap()
}

#[test]
fn a_run_allocates_nothing_of_its_own() {
    let (session, data) = (AddOne::session(), [1.0_f32; 100]);
    let mut last = 0.0;
    let before = allocations_of_thread();
    for _ in 0..10 {
        timing::start();
        session
            .run(&[view(&data)], |outputs| {
                last = outputs[1].values::<f32>()?[99];
                Ok(())
            })
            .unwrap();
        assert_eq!(timing::take().unwrap().runs, 1);
    }
    assert_eq!(allocations_of_thread() - before, 0);
    assert_eq!(last, 2.0);
}

#[test]
fn mismatched_inputs_are_errors() {
    let session = AddOne::session();
    let run = |inputs: &[TensorView<'_>]| session.run(inputs, |_| Ok(())).unwrap_err();
    for (inputs, says) in [
        (&[][..], "the model has 1 inputs, but received 0"),
        (&[view(&[1_u8])], "model input x: f32[1, ?] received u8[1, 1]"),
        (&[TensorView::new(&[2, 1], &[1.0_f32; 2]).unwrap()], "received f32[2, 1]"),
        (&[TensorView::new(&[1], &[1.0_f32]).unwrap()], "received f32[1]"),
    ] {
        let error = run(inputs);
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        assert!(error.to_string().contains(says), "{error}");
    }
    assert_eq!(session.output_index("z").unwrap(), 1);
    assert!(
        session.output_index("w").unwrap_err().to_string().contains("no output \"w\"; its outputs are y, z")
    );
}

#[test]
fn errors_of_the_sink_are_returned_and_panics_leave_the_session_usable() {
    let session = AddOne::session();
    let error = session.run(&[view(&[1.0_f32])], |_| Err(Error::not_found("the sink"))).unwrap_err();
    assert_eq!((error.kind(), error.message()), (ErrorKind::NotFound, "the sink"));
    let panicked =
        catch_unwind(AssertUnwindSafe(|| session.run(&[view(&[1.0_f32])], |_| panic!("in the sink"))));
    assert!(panicked.is_err());
    session.run(&[view(&[1.0_f32])], |_| Ok(())).unwrap();
}

#[test]
fn one_session_serves_threads_one_at_a_time() {
    let session = AddOne::session();
    thread::scope(|scope| {
        for start in 0..4_u8 {
            let session = &session;
            scope.spawn(move || {
                let data = [f32::from(start); 50];
                for _ in 0..50 {
                    session
                        .run(&[view(&data)], |outputs| {
                            assert_eq!(RUNNING.fetch_add(1, Ordering::SeqCst), 0);
                            thread::yield_now();
                            RUNNING.fetch_sub(1, Ordering::SeqCst);
                            assert_eq!(outputs[0].values::<f32>()?, [f32::from(start) + 1.0; 50]);
                            Ok(())
                        })
                        .unwrap();
                }
            });
        }
    });
}

#[test]
fn session_time_excludes_the_sink() {
    let session = AddOne::session();
    timing::start();
    let start = Instant::now();
    session
        .run(&[view(&[1.0_f32])], |_| {
            thread::sleep(Duration::from_millis(30));
            Ok(())
        })
        .unwrap();
    let all = start.elapsed();
    let times = timing::take().unwrap();
    assert!(times.session + Duration::from_millis(30) <= all);
    assert!(times.first_start >= start && times.last_end < start + all);
}
